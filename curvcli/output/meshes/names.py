"""Names of properties as a format can hold them: kept where that is possible, else spelt in another way and said."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable

from ...errors import Notice
from ...support.words import escape_text, pluralize


def fitting(names: Iterable[str], fit: Callable[[str], str], taken: Collection[str] = ()) -> dict[str, str]:
    """What each name is written as: as `fit` spells it, behind `input_` where that is taken.

    taken: names that the format itself gives. Names that need no other spelling are never changed for one that does.
    """
    names = list(names)
    used = {*taken, *(name for name in names if fit(name) == name and name not in taken)}
    written = {}
    for name in names:
        spelt = fit(name)
        if spelt != name or name in taken:
            while spelt in used:
                spelt = f"input_{spelt}"
            used.add(spelt)
        written[name] = spelt
    return written


def respelt(*written: dict[str, str]) -> tuple[Notice, ...]:
    """The notice of names that a format spells in another way; none where there is none."""
    pairs = (pair for each in written for pair in each.items())
    changed = dict.fromkeys(f"{escape_text(name)} -> {escape_text(one)}" for name, one in pairs if name != one)
    if not changed:
        return ()
    words = pluralize(len(changed), "[name|names] of properties that the output spells in another way: ")
    message = words + ", ".join(changed)
    return (Notice("renamed_properties", len(changed), message, "the values are kept under the new names"),)


def one_word(name: str) -> str:
    """A name as one word of text: blanks as underscores, what cannot be printed escaped."""
    return escape_text("_".join(part for part in name.split(" ") if part)) or "_"


def xml_name(name: str) -> str:
    """A name as XML 1.0 can hold it: the few characters that it cannot are escaped as in Python."""
    return "".join(c if _in_xml(c) else c.encode("unicode_escape").decode("ascii") for c in name) or "_"


def _in_xml(c: str) -> bool:
    return c in "\t\n\r" or " " <= c < "\ud800" or "\ue000" <= c < "\ufffe" or c > "\uffff"


def xml_attribute(name: str) -> str:
    """The text between the quotes of an attribute, in ASCII, which a reader of XML turns into the name again."""
    return "".join(c if c.isascii() and c.isprintable() and c not in "<>&\"'" else f"&#{ord(c)};" for c in name)

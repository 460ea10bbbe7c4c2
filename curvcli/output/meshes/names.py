"""Names of properties in the spelling of a format; changes are reported in a notice."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable

from ...errors import Notice
from ...support.words import escape_text, pluralize


def fitting(names: Iterable[str], fit: Callable[[str], str], taken: Collection[str] = ()) -> dict[str, str]:
    """Written form of each name: spelt by `fit`, and with the prefix `input_` if that is taken.

    taken: names of the format itself. A name that needs no other spelling is never changed in favour of one that does.
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
    """Notice of names that a format spells in another way; empty if there are none."""
    pairs = (pair for each in written for pair in each.items())
    changed = dict.fromkeys(
        f"{escape_text(name)} -> {escape_text(spelling)}" for name, spelling in pairs if name != spelling
    )
    if not changed:
        return ()
    opening = pluralize(len(changed), "[name|names] of properties that the output spells in another way: ")
    message = opening + ", ".join(changed)
    return (Notice("renamed_properties", len(changed), message, "the values are kept under the new names"),)


def one_word(name: str) -> str:
    """Name as one word: blanks become underscores, unprintable characters are escaped."""
    return escape_text("_".join(part for part in name.split(" ") if part)) or "_"


def xml_name(name: str) -> str:
    """Name in the characters of XML 1.0; others are escaped as in Python."""
    return "".join(c if _in_xml(c) else c.encode("unicode_escape").decode("ascii") for c in name) or "_"


def _in_xml(c: str) -> bool:
    return c in "\t\n\r" or " " <= c < "\ud800" or "\ue000" <= c < "\ufffe" or c > "\uffff"


def xml_attribute(name: str) -> str:
    """Value of an XML attribute in ASCII; an XML parser turns it into the name again."""
    return "".join(c if c.isascii() and c.isprintable() and c not in "<>&\"'" else f"&#{ord(c)};" for c in name)

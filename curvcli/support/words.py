"""Words for people: plurals, escaped text, suggestions."""

from __future__ import annotations

import re
from collections.abc import Iterable
from contextlib import suppress
from difflib import get_close_matches

_CHOICE = re.compile(r"\[([^][|]*)\|([^][|]*)\]")


def pluralize(count: float, text: str) -> str:
    """The text with each `[one|many]` as the number demands: `[vertex|vertices] that no face uses`."""
    return _CHOICE.sub(r"\1" if count == 1 else r"\2", text)


def counted(count: int, one: str, many: str | None = None) -> str:
    """`1 face`, `1,000 faces`; many: where it is not one with an s."""
    return f"{count:,} {_form(count, one, many)}"


def number_of(count: int, one: str, many: str | None = None) -> str:
    """As `counted`, in the digits that stand in a file: `1000 faces`."""
    return f"{count} {_form(count, one, many)}"


def _form(count: int, one: str, many: str | None) -> str:
    return one if count == 1 else many or one + "s"


def escape_text(text: str) -> str:
    """The text on one line, what cannot be printed escaped."""
    if text.isprintable():
        return text
    with suppress(UnicodeEncodeError):  # of half a pair of surrogates, which stands for no byte
        text = text.encode("utf-8", "surrogateescape").decode("utf-8", "backslashreplace")
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


_ASCII = bytes(range(128))


def escape_json(data: bytes) -> bytes:
    r"""JSON that a terminal can show: the same values, with what cannot be printed in them as `\u`."""
    # Outside of strings all is printable but the ends of lines. ASCII goes first: most of a report is that.
    beyond = set(data.translate(None, _ASCII).decode("utf-8"))
    odd = {c for c in beyond if not c.isprintable()} | ({"\x7f"} if b"\x7f" in data else set())
    return data.decode("utf-8").translate({ord(c): _of_json(c) for c in odd}).encode("utf-8") if odd else data


def _of_json(character: str) -> str:
    units = character.encode("utf-16-be")
    return "".join(f"\\u{units[at]:02x}{units[at + 1]:02x}" for at in range(0, len(units), 2))


# What a spreadsheet takes for the beginning of a formula, in Latin and in full-width letters, behind our own mark.
_FORMULA = re.compile("'*[=+\\-@\t\r\n\uff1d\uff0b\uff0d\uff20]")


_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)


# Not printable by Python's count, yet blanks and joints in the writing of many languages.
_HARMLESS = frozenset("\t\n\u00a0\u1680\u2002\u2003\u2007\u2009\u202f\u3000\u200c\u200d")


def escape_cell(text: str) -> str:
    """Text for a cell of a table in text, from which a spreadsheet computes nothing.

    A text that a spreadsheet would take for a formula gets an apostrophe before it, and so does one that begins with
    apostrophes before such a text: `from_cell` takes it away again. A number stays one. Control characters are escaped,
    which is not undone.
    """
    if not text.isprintable():
        text = "".join(c if c.isprintable() or c in _HARMLESS else escape_text(c) for c in text)
    return f"'{text}" if _FORMULA.match(text) and not _NUMBER.fullmatch(text) else text


def unescape_cell(text: str) -> str:
    """The text of a cell that `in_cell` made."""
    return text[1:] if text.startswith("'") and _FORMULA.match(text) else text


_LINK = re.compile(r"\[(?=[^\[\]]*\]\()")


def escape_sarif(text: str) -> str:
    """Text for a message of SARIF, in which nothing is a link of its dialect."""
    return _LINK.sub(r"\\[", escape_text(text)).replace("](", r"\](")


# Names less alike than this (of `difflib`) are no suggestion.
_CUTOFF = 0.6


# Lists up to this long are given whole where no name is near.
_SHORT = 8


def suggest(name: str, known: Iterable[str]) -> list[str]:
    """Up to three known names like this one, nearest first, whatever the case; `-` and `_` are the same."""
    folded: dict[str, list[str]] = {}
    for one in known:
        folded.setdefault(_folded(one), []).append(one)
    wanted = _folded(name.strip())
    if wanted in folded:
        return folded[wanted][:3]
    near = get_close_matches(wanted, folded, 3, _CUTOFF)
    begun = [key for key in folded if key.startswith(wanted)] if len(wanted) > 2 else []
    return [one for key in dict.fromkeys([*near, *sorted(begun, key=len)]) for one in folded[key]][:3]


def _folded(name: str) -> str:
    return name.casefold().replace("-", "_")


def suggestion(name: str, known: Iterable[str], listing: str = "") -> str:
    """The end of a message about an unknown name: `; nearest: a, b`, the whole of a short list, or what lists all.

    listing: a sentence such as "`curvcli passes` lists them". Empty where nothing is near, the list long and nothing
    lists it.
    """
    names = list(dict.fromkeys(known))
    near = suggest(name, names)
    if near:
        return f"; nearest: {', '.join(near)}"
    if 0 < len(names) <= _SHORT:
        return f"; known: {', '.join(names)}"
    return f"; {listing}" if listing else ""


def format_number(value: float) -> str:
    """The shortest text of a number that reads back, as a person would write it."""
    text = f"{value:.15g}"
    return text if float(text) == value else repr(value)

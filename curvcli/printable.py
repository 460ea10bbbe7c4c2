"""Text as it can be shown, whatever is in it: names of files are any bytes, and what files say is any text."""

from __future__ import annotations

import re
from contextlib import suppress


def shown(text: str) -> str:
    """The text on one line, what cannot be printed escaped."""
    if text.isprintable():
        return text
    with suppress(UnicodeEncodeError):  # of half a pair of surrogates, which stands for no byte
        text = text.encode("utf-8", "surrogateescape").decode("utf-8", "backslashreplace")
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


_ASCII = bytes(range(128))


def in_json(data: bytes) -> bytes:
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


def in_cell(text: str) -> str:
    """Text for a cell of a table in text, from which a spreadsheet computes nothing.

    A text that a spreadsheet would take for a formula gets an apostrophe before it, and so does one that begins with
    apostrophes before such a text: `from_cell` takes it away again. A number stays one. Control characters are escaped,
    which is not undone.
    """
    if not text.isprintable():
        text = "".join(c if c.isprintable() or c in _HARMLESS else shown(c) for c in text)
    return f"'{text}" if _FORMULA.match(text) and not _NUMBER.fullmatch(text) else text


def from_cell(text: str) -> str:
    """The text of a cell that `in_cell` made."""
    return text[1:] if text.startswith("'") and _FORMULA.match(text) else text


_LINK = re.compile(r"\[(?=[^\[\]]*\]\()")


def in_sarif(text: str) -> str:
    """Text for a message of SARIF, in which nothing is a link of its dialect."""
    return _LINK.sub(r"\\[", shown(text)).replace("](", r"\](")

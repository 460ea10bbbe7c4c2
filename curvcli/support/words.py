"""Text for people: plurals, escapes, numbers, suggestions of names."""

from __future__ import annotations

import re
from collections.abc import Iterable
from contextlib import suppress
from difflib import get_close_matches

_CHOICE = re.compile(r"\[([^][|]*)\|([^][|]*)\]")


def pluralize(count: float, text: str) -> str:
    """Choose singular or plural at each `[one|many]` of a text: `[vertex|vertices] that no face uses`."""
    return _CHOICE.sub(r"\1" if count == 1 else r"\2", text)


def counted(count: int, singular: str, plural: str | None = None) -> str:
    """A number with its noun: `1 face`, `1,000 faces`. plural: by default the singular and an s."""
    return f"{count:,} {_form(count, singular, plural)}"


def number_of(count: int, singular: str, plural: str | None = None) -> str:
    """A number with its noun, without thousands separators, as files write it: `1000 faces`."""
    return f"{count} {_form(count, singular, plural)}"


def _form(count: int, singular: str, plural: str | None) -> str:
    return singular if count == 1 else plural or singular + "s"


def escape_text(text: str) -> str:
    """Escape unprintable characters, line ends included."""
    if text.isprintable():
        return text
    with suppress(UnicodeEncodeError):  # a lone surrogate that stands for no byte
        text = text.encode("utf-8", "surrogateescape").decode("utf-8", "backslashreplace")
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


_ASCII = bytes(range(128))


def escape_json(data: bytes) -> bytes:
    r"""Escape unprintable characters in JSON as `\u`; the values stay the same."""
    # Outside strings only line ends are unprintable. ASCII is removed first, because reports consist mostly of it.
    beyond = set(data.translate(None, _ASCII).decode("utf-8"))
    odd = {c for c in beyond if not c.isprintable()} | ({"\x7f"} if b"\x7f" in data else set())
    return data.decode("utf-8").translate({ord(c): _of_json(c) for c in odd}).encode("utf-8") if odd else data


def _of_json(character: str) -> str:
    units = character.encode("utf-16-be")
    return "".join(f"\\u{units[at]:02x}{units[at + 1]:02x}" for at in range(0, len(units), 2))


# First characters of a spreadsheet formula, Latin and full-width, behind any apostrophes that escape them.
_FORMULA = re.compile("'*[=+\\-@\t\r\n\uff1d\uff0b\uff0d\uff20]")


_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)


# Unprintable for Python, but spaces and joiners of many scripts.
_HARMLESS = frozenset("\t\n\u00a0\u1680\u2002\u2003\u2007\u2009\u202f\u3000\u200c\u200d")


def escape_cell(text: str) -> str:
    """Escape text for a cell of a CSV or TSV table, against formula injection and control characters.

    Text that a spreadsheet would evaluate gets an apostrophe in front, and so does such text behind apostrophes;
    `unescape_cell` removes it. Numbers stay numbers. The escape of control characters is not undone.
    """
    if not text.isprintable():
        text = "".join(c if c.isprintable() or c in _HARMLESS else escape_text(c) for c in text)
    return f"'{text}" if _FORMULA.match(text) and not _NUMBER.fullmatch(text) else text


def unescape_cell(text: str) -> str:
    """Undo the apostrophe of `escape_cell`."""
    return text[1:] if text.startswith("'") and _FORMULA.match(text) else text


_LINK = re.compile(r"\[(?=[^\[\]]*\]\()")


def escape_sarif(text: str) -> str:
    """Escape text for a SARIF message, whose Markdown dialect would read `[a](b)` as a link."""
    return _LINK.sub(r"\\[", escape_text(text)).replace("](", r"\](")


# Names with a lower similarity (of `difflib`) are not suggested.
_CUTOFF = 0.6


# Lists up to this length are given in full where no name is similar.
_SHORT = 8


def suggest(name: str, known: Iterable[str]) -> list[str]:
    """Up to three known names similar to this one, best first; case is ignored, `-` and `_` are the same."""
    folded: dict[str, list[str]] = {}
    for candidate in known:
        folded.setdefault(_folded(candidate), []).append(candidate)
    wanted = _folded(name.strip())
    if wanted in folded:
        return folded[wanted][:3]
    near = get_close_matches(wanted, folded, 3, _CUTOFF)
    begun = [key for key in folded if key.startswith(wanted)] if len(wanted) > 2 else []
    return [candidate for key in dict.fromkeys([*near, *sorted(begun, key=len)]) for candidate in folded[key]][:3]


def _folded(name: str) -> str:
    return name.casefold().replace("-", "_")


def suggestion(name: str, known: Iterable[str], listing: str = "") -> str:
    """The end of a message about an unknown name: `; nearest: a, b`, all names of a short list, or `listing`.

    listing: a sentence such as "`curvcli passes` lists them". Empty for a long list without similar names and without a
    listing.
    """
    names = list(dict.fromkeys(known))
    near = suggest(name, names)
    if near:
        return f"; nearest: {', '.join(near)}"
    if 0 < len(names) <= _SHORT:
        return f"; known: {', '.join(names)}"
    return f"; {listing}" if listing else ""


# Rounded numbers from here on have an exponent; 4670 is shorter than 4.67e+03 and has as many digits.
_WITH_EXPONENT = 1e6


def format_rounded(value: float | None, digits: int = 6, undefined: str = "undefined") -> str:
    """A number for people, rounded to significant digits; zero has no minus sign."""
    if value is None or value != value:
        return undefined
    text = f"{value + 0.0:.{digits}g}"
    return f"{float(text):.0f}" if "e+0" in text and abs(value) < _WITH_EXPONENT else text


_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def format_exponent(power: int) -> str:
    """An integer as an exponent."""
    return str(power).translate(_RAISED)


def typeset_number(value: float, digits: int = 4) -> str:
    """A number for pictures, with a minus sign and a power of ten where it is large or small: `−1.2·10⁻⁷`."""
    mantissa, e, power = f"{value:.{digits}g}".partition("e")
    text = f"{mantissa}·10{format_exponent(int(power))}" if e else mantissa
    return text.replace("-", "−")


def format_number(value: float) -> str:
    """The shortest decimal text that reads back as the same number, without a trailing `.0`."""
    text = f"{value:.15g}"
    return text if float(text) == value else repr(value)


def format_point(point: Iterable[float], digits: int = 6) -> str:
    """Coordinates for people: `(0.5, 1, 2)`."""
    return f"({', '.join(format_rounded(value, digits) for value in point)})"

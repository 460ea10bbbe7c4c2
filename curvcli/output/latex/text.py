"""Texts and numbers for LaTeX, without packages: every character stands for itself."""

from __future__ import annotations

import math
import re

from ...support.words import escape_text

# By number where a name, a ligature or a shorthand of a language could change the character.
_SPECIAL = {
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    '"': r"{\char34}",
    "'": r"{\char39}",
    "`": r"{\char96}",
    "[": "{[}",
    "]": "{]}",
    "*": "{*}",
    "=": "{=}",
    **{sign: f"\\{sign}" for sign in "{}$&#%_"},
}
_TABLE = str.maketrans(_SPECIAL)
# Repeated signs would join to a dash, or to one quotation mark, and repeated spaces to one space.
_LIGATURE = re.compile(r"(?<=-)-|(?<=,),")
_SPACE = re.compile(r"^ | $|(?<= ) ")

UNDEFINED = "--"
# Significant digits where none are asked for.
DIGITS = 5


def escape_latex(text: str) -> str:
    """Text in a cell; unprintable characters are escaped first, letters of other scripts stay."""
    escaped = escape_text(text)
    escaped = _SPACE.sub("\0", escaped)
    escaped = _LIGATURE.sub(lambda sign: f"\1{sign[0]}", escaped)
    return escaped.translate(_TABLE).replace("\0", r"\ ").replace("\1", "{}")


def typeset(value: float | int | bool | None, digits: int = DIGITS) -> str:
    """Number in math mode, rounded to significant digits; whole numbers keep all of theirs, in groups of three."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if value is None or math.isnan(value):
        return UNDEFINED
    if math.isinf(value):
        return r"$\infty$" if value > 0 else r"$-\infty$"
    if isinstance(value, int):
        return f"${_grouped(str(value))}$"
    mantissa, e, power = f"{value + 0.0:.{digits}g}".partition("e")
    whole, point, rest = mantissa.partition(".")
    number = f"{_grouped(whole)}{point}{rest}"
    return f"${number} \\times 10^{{{int(power)}}}$" if e else f"${number}$"


def _grouped(digits: str) -> str:
    """Digits in groups of three from ten thousand on."""
    sign, magnitude = ("-", digits[1:]) if digits.startswith("-") else ("", digits)
    return sign + (f"{int(magnitude):,}".replace(",", r"\,") if len(magnitude) > 4 else magnitude)


def unit(text: str) -> str:
    """A unit such as `mm^2`; nothing for a pure number."""
    base, _, exponent = text.rpartition("^")
    if text == "1":
        return ""
    return f"{escape_latex(base)}$^{{{exponent}}}$" if base and re.fullmatch(r"-?\d+", exponent) else escape_latex(text)

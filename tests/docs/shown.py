"""Compare output that a page shows with output that a command prints."""

from __future__ import annotations

import math
import re

OUTPUT = "Output"

# A line of a page that stands for any number of lines of the output.
LEFT_OUT = "…"

# Residuals and sums that vanish are rounding: they differ from one processor to another.
ROUNDING = 1e-9

_NUMBER = re.compile(r"[-+]?\d+(\.\d+)?(e[-+]?\d+)?")
_BETWEEN = re.compile(r"\s+|,")  # the cells of a table, printed or comma-separated


def _same_word(shown: str, printed: str) -> bool:
    """Equal, or two numbers that agree to rounding."""
    numbers = [_NUMBER.fullmatch(word.strip("();:")) for word in (shown, printed)]
    if not all(numbers):
        return shown == printed
    a, b = (float(match[0]) for match in numbers if match)
    return math.isclose(a, b, rel_tol=ROUNDING, abs_tol=ROUNDING)


def _same_line(shown: str, printed: str) -> bool:
    a, b = _BETWEEN.split(shown.strip()), _BETWEEN.split(printed.strip())
    return len(a) == len(b) and all(map(_same_word, a, b))


def missing(shown: str, printed: str) -> list[str]:
    """The lines of a page, from the first that the output does not have in its place; empty if all are there.

    Blank lines and the width of columns do not count. Between two lines of the page that no `…` separates, the output
    has no other line.
    """
    wanted = [line for line in shown.splitlines() if line.strip()]
    lines = [line for line in printed.splitlines() if line.strip()]
    at, gap = 0, False
    for number, line in enumerate(wanted):
        if line.strip() == LEFT_OUT:
            gap = True
            continue
        places = range(at, len(lines)) if gap else range(at, min(at + 1, len(lines)))
        place = next((place for place in places if _same_line(line, lines[place])), None)
        if place is None:
            return wanted[number:]
        at, gap = place + 1, False
    return [] if gap or at == len(lines) else lines[at:]

"""Bending rigidity: the number and unit that turn energies in units of κ into k_BT or J."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from ..errors import UsageError
from ..support.words import format_number

# Units by their spellings without case, blanks and underscores.
UNITS = {
    **dict.fromkeys(("kbt", "kt"), "k_BT"),
    **dict.fromkeys(("j", "joule", "joules"), "J"),
    "zj": "zJ",
    "aj": "aJ",
    **dict.fromkeys(("pnnm", "pn·nm", "pn*nm"), "pN nm"),
}
# No rigidity is smaller in these units, and products with it stay within the range of doubles.
_LEAST = 1e-60
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(.*)", re.ASCII | re.DOTALL)


@dataclass(frozen=True)
class Rigidity:
    """A bending rigidity κ: its size in a unit of energy."""

    size: float
    unit: str

    def __str__(self) -> str:
        return f"{format_number(self.size)} {self.unit}"


def parse_rigidity(text: str) -> Rigidity:
    """Parse `20kBT` or `8e-20J`.

    k_BT stays k_BT, at the temperature that the number was measured at: no temperature is assumed.
    Errors: UsageError for a number that is not positive or an unknown unit.
    """
    match = _NUMBER.fullmatch(text) if isinstance(text, str) else None
    unit = None if match is None else UNITS.get(re.sub(r"[\s_]", "", match[2]).lower())
    size = math.nan if match is None else float(match[1])
    if unit is None or not _LEAST <= size <= 1 / _LEAST:
        known = ", ".join(dict.fromkeys(UNITS.values()))
        raise UsageError(f"bending rigidity {text!r}: expected a positive number with {known}, such as 20kBT or 8e-20J")
    return Rigidity(size, unit)

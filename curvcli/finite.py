"""Numbers as reports have them: what no double holds is none."""

from __future__ import annotations

import math


def or_none(value: float) -> float | None:
    """The number, None where it is infinite or not a number."""
    return value if math.isfinite(value) else None

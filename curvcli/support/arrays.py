"""Type aliases of arrays, and NaN and infinity as None for reports."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Column = NDArray[np.float64]
VectorColumn = NDArray[np.float64]  # (3, n), one contiguous row per coordinate
Flags = NDArray[np.bool_]
Codes = NDArray[np.int8]
Counts = NDArray[np.int32]

# A number or a vector of a report; None is undefined.
Value = float | list[float | None] | None


def or_none(value: float) -> float | None:
    """Replace NaN and infinity by None for reports."""
    return value if math.isfinite(value) else None

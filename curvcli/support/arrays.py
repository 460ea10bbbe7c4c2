"""Type aliases of arrays, and NaN and infinity as None for reports."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

# By the type of their numbers.
Array = NDArray[Any]
Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Index = NDArray[np.int32]
Mask = NDArray[np.bool_]
Sign = NDArray[np.int8]

# As columns of vertices, edges or faces.
Column = Floats
VectorColumn = Floats  # (3, n), one contiguous row per coordinate
Flags = Mask
Codes = NDArray[np.int8]
Counts = NDArray[np.int32]

# A number or a vector of a report; None is undefined.
Value = float | list[float | None] | None


def numbers_or_none(values: Array) -> list[Any]:
    """An array as nested lists of Python's numbers, with None for NaN and infinity."""
    numbers: list[Any] = values.tolist()
    if values.dtype.kind == "f" and not np.isfinite(values).all():
        objects = values.astype(object)
        objects[~np.isfinite(values)] = None
        numbers = objects.tolist()
    return numbers


def or_none(value: float) -> float | None:
    """Replace NaN and infinity by None for reports."""
    return value if math.isfinite(value) else None

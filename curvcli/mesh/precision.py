"""Precision of coordinates: the last decimal written, or the last bit stored."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .surface import Surface

# Rounding to a step has a root mean square error of step/√12.
_UNIFORM = 1 / math.sqrt(12)
# Decimals are counted in the largest coordinates, down to this part of the largest, and up to so many digits.
_DECADE, _DIGITS = 0.1, 14
_SAMPLE = 4096
# Beyond, the powers of ten leave the range of doubles.
_RANGE = 1e-250, 1e250


def precision(surface: Surface) -> float:
    """Standard deviation of the rounding of a surface's coordinates, derived from their values.

    Coordinates that are all float32 numbers have the step of float32; coordinates that are all short decimals have a
    step of their last digit; the finer step where both hold, as for whole numbers; otherwise the step of doubles.
    """
    used = surface.used_coordinates()
    largest = float(np.abs(used).max())
    digits = decimals(used, largest)
    if is_single(used):
        limit = float(np.finfo(np.float32).max) / 2
        step = float(np.spacing(np.float32(min(largest, limit))))
        if digits is not None:
            step = min(step, 10.0**-digits)
    elif digits is not None:
        step = 10.0**-digits
    else:
        step = math.ulp(largest)
    return step * _UNIFORM


def is_single(values: NDArray[np.float64]) -> bool:
    """True if every value is a float32 number, as in binary STL and most PLY files. values: (3, V), or any rows."""
    with np.errstate(over="ignore", under="ignore"):
        return all(bool((row.astype(np.float32) == row).all()) for row in values)


def last_place(surface: Surface, kind: type[np.floating[Any]] = np.float64) -> float:
    """The unit in the last place of the largest coordinate that a face uses, in the unit of computation."""
    used = surface.used_coordinates()
    # np.spacing of the largest double is infinite.
    largest = min(max(float(used.max()), -float(used.min())), float(np.finfo(kind).max) / 2)
    place = np.float64(np.spacing(kind(largest)))
    return float(np.ldexp(place, -surface.unit_exponent))


def decimals(values: NDArray[np.float64], largest: float) -> int | None:
    """Number of digits after the point in the large values; None for as many as doubles hold.

    values: (n,) or (3, n) coordinates as given. largest: the largest absolute value.
    """
    if not _RANGE[0] < largest < _RANGE[1]:
        return None
    large = np.abs(values[np.abs(values) >= _DECADE * largest])
    some = large[:: max(len(large) // _SAMPLE, 1)]
    before = math.floor(math.log10(largest)) + 1
    for digits in range(max(0, 1 - before), _DIGITS - before + 1):
        if _multiples(some, digits) and _multiples(large, digits):
            return digits
    return None


def _multiples(values: NDArray[np.float64], digits: int) -> bool:
    """Test whether all values are multiples of that power of ten, to the rounding of doubles."""
    scaled = values * 10.0**digits
    return bool((np.abs(scaled - np.rint(scaled)) <= 2 * np.finfo(np.float64).eps * scaled).all())

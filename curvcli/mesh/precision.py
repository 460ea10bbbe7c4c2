"""How exactly the coordinates of a mesh are known: to the last digit written, or the last bit stored."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .surface import Surface

# A value that is rounded to a step is off by step/√12 in the root of the mean square.
_UNIFORM = 1 / math.sqrt(12)
# Decimals are looked for in the largest coordinates, down to this part of the largest, and up to so many digits.
_DECADE, _DIGITS = 0.1, 14
_SAMPLE = 4096
# Beyond, the powers of ten that are tried leave the range of doubles.
_RANGE = 1e-250, 1e250


def precision(surface: Surface) -> float:
    """How far rounding has moved the coordinates of a surface, told from their values: a standard deviation.

    Those that are all float32 numbers are taken as stored so; those that are all short decimals as written with so many
    digits after the point; the finer of the two where both hold, as for whole numbers; else they are doubles.
    """
    used = surface.used_coordinates()
    largest = float(np.abs(used).max())
    places = decimals(used, largest)
    if is_single(used):
        limit = float(np.finfo(np.float32).max) / 2
        step = float(np.spacing(np.float32(min(largest, limit))))
        if places is not None:
            step = min(step, 10.0**-places)
    elif places is not None:
        step = 10.0**-places
    else:
        step = math.ulp(largest)
    return step * _UNIFORM


def is_single(values: NDArray[np.float64]) -> bool:
    """Whether every value is a float32 number, as in binary STL and most PLY files."""
    with np.errstate(over="ignore", under="ignore"):
        return all(bool((row.astype(np.float32) == row).all()) for row in values)


def last_place(surface: Surface, kind: type[np.floating[Any]] = np.float64) -> float:
    """The unit in the last place of the largest coordinate that a face uses, in the unit of computation."""
    used = surface.used_coordinates()
    # Beyond the last one there is no number.
    largest = min(max(float(used.max()), -float(used.min())), float(np.finfo(kind).max) / 2)
    place = np.float64(np.spacing(kind(largest)))
    return float(np.ldexp(place, -surface.unit_exponent))


def decimals(values: NDArray[np.float64], largest: float) -> int | None:
    """How many digits after the point the large values have; None for as many as doubles hold."""
    if not _RANGE[0] < largest < _RANGE[1]:
        return None
    large = np.abs(values[np.abs(values) >= _DECADE * largest])
    some = large[:: max(len(large) // _SAMPLE, 1)]
    before = math.floor(math.log10(largest)) + 1
    for places in range(max(0, 1 - before), _DIGITS - before + 1):
        if _multiples(some, places) and _multiples(large, places):
            return places
    return None


def _multiples(values: NDArray[np.float64], places: int) -> bool:
    """Whether values are, to the rounding of doubles, multiples of that power of ten."""
    scaled = values * 10.0**places
    return bool((np.abs(scaled - np.rint(scaled)) <= 2 * np.finfo(np.float64).eps * scaled).all())

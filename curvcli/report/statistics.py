"""Statistics of one column; nulls are left out and counted."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from ..curvatures.quantity import Quantity
from ..support.blocks import slices


class ColumnStatistics(msgspec.Struct):
    """Distribution of a column; percentiles interpolate linearly, std is of the population."""

    symbol: str
    unit: str
    kind: str
    length_exponent: int
    min: float | None
    max: float | None
    mean: float | None
    area_mean: float | None
    std: float | None
    p02: float | None
    median: float | None
    p98: float | None
    nulls: int


def statistics(
    quantity: Quantity, values: NDArray[Any], area: NDArray[np.float64], referenced: NDArray[np.bool_], unit: str
) -> ColumnStatistics:
    """Statistics of a vertex column. area: (V,) barycentric areas, the weights of `area_mean`."""
    numbers = values.astype(np.float64, copy=False)
    known = referenced & ~np.isnan(numbers)
    nulls = len(numbers) - int(np.count_nonzero(known))
    if nulls:
        numbers, area = numbers[known], area[known]
    described = (quantity.symbol.replace("*", ""), unit, quantity.kind, quantity.length_exponent)
    if not len(numbers):
        return ColumnStatistics(*described, None, None, None, None, None, None, None, None, nulls)
    # In units of a power of two near the largest value, so that squares and sums stay within the range of doubles.
    ordered = np.sort(numbers)
    size = np.ldexp(1.0, int(np.frexp(max(abs(ordered[0]), abs(ordered[-1])))[1]) - 1) or 1.0
    low, median, high = (_quantile(ordered, share, size) for share in (0.02, 0.5, 0.98))
    first, last = float(ordered[0]), float(ordered[-1])
    scaled = np.divide(numbers, size, out=ordered)
    mean, weight = float(scaled.mean()), float(area.sum())
    by_area = _sum(lambda block: scaled[block] * area[block], len(scaled))
    square = _sum(lambda block: np.square(scaled[block] - mean), len(scaled))
    return ColumnStatistics(
        *described,
        first,
        last,
        float(mean * size),
        float(by_area / weight * size) if weight > 0 else None,
        float(math.sqrt(square / len(scaled)) * size),
        low,
        median,
        high,
        nulls,
    )


def _sum(part: Callable[[slice], NDArray[np.float64]], count: int) -> float:
    """Sum of numbers that are computed a block at a time."""
    return math.fsum(float(part(block).sum()) for block in slices(count))


def _quantile(ordered: NDArray[np.float64], share: float, size: float) -> float:
    """Value below which a share of the ordered values lies; size: their common divisor."""
    place = share * (len(ordered) - 1)
    below = int(place)
    first, second = ordered[below] / size, ordered[min(below + 1, len(ordered) - 1)] / size
    return float((first + (second - first) * (place - below)) * size)

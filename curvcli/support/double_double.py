"""Double-double arithmetic: sums of two doubles, for thin triangles and for decisions free of rounding."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .arrays import Floats
from .compensated import two_difference, two_product

# In a triangle with a larger cotangent, plain dot products of its edges lose more than 1e-13 of its area.
THIN_COTANGENT = 64.0


@dataclass(frozen=True, slots=True)
class DoubleDouble:
    """Arrays high + low, |low| ≤ ½ ulp(high); sums and products are good to 2⁻¹⁰⁴ of their largest term.

    An infinite result, or one that is not a number, is in `high`, and `low` then has no meaning.
    """

    high: Floats
    low: Floats

    def __add__(self, other: DoubleDouble) -> DoubleDouble:
        total, error = two_difference(self.high, -other.high)
        return _normalised(total, error + (self.low + other.low))

    def __sub__(self, other: DoubleDouble) -> DoubleDouble:
        total, error = two_difference(self.high, other.high)
        return _normalised(total, error + (self.low - other.low))

    def __neg__(self) -> DoubleDouble:
        return DoubleDouble(-self.high, -self.low)

    def __mul__(self, other: DoubleDouble) -> DoubleDouble:
        product, error = two_product(self.high, other.high)
        return _normalised(product, error + (self.high * other.low + self.low * other.high))

    def __truediv__(self, other: DoubleDouble) -> DoubleDouble:
        first = self.high / other.high
        product, error = two_product(first, other.high)
        rest = ((self.high - product) - error) + (self.low - first * other.low)
        return _normalised(first, rest / other.high)

    def sqrt(self) -> DoubleDouble:
        """The square root; 0 of 0."""
        root = np.sqrt(self.high)
        square, error = two_product(root, root)
        rest = ((self.high - square) - error) + self.low
        return _normalised(root, np.divide(rest, 2 * root, out=np.zeros_like(root), where=root > 0))

    def clamped(self) -> DoubleDouble:
        """The numbers, 0 where negative."""
        positive = self.high > 0
        return DoubleDouble(np.where(positive, self.high, 0.0), np.where(positive, self.low, 0.0))

    def at(self, index: Any) -> DoubleDouble:
        """The elements at an index."""
        return DoubleDouble(self.high[index], self.low[index])

    def put(self, index: Any, values: DoubleDouble) -> None:
        """Write elements."""
        self.high[index] = values.high
        self.low[index] = values.low


def empty(size: int) -> DoubleDouble:
    """Allocate numbers without a value; memory that is never written costs nothing."""
    return DoubleDouble(np.empty(size), np.empty(size))


def _normalised(high: Floats, low: Floats) -> DoubleDouble:
    """The same sum with the rounding carried to the low part."""
    total = high + low
    return DoubleDouble(total, low - (total - high))


DoubleDoubleVector = tuple[DoubleDouble, DoubleDouble, DoubleDouble]


def corner_products(xyz: Floats, corners: tuple[NDArray[Any], ...]) -> tuple[DoubleDoubleVector, DoubleDouble]:
    """At each corner of triangles the dot product of the two edges that leave it, and twice the area.

    xyz: (3, V). corners: three index arrays. The area's relative error is about 1e-30 · (longest edge)² / area.
    """
    p, q, r = corners
    u, v, w = (differences(xyz, tail, head) for tail, head in ((p, q), (q, r), (p, r)))
    normal = cross(u, w)
    return (product(u, w), -product(u, v), product(w, v)), product(normal, normal).sqrt()


def cross(a: list[DoubleDouble], b: list[DoubleDouble]) -> list[DoubleDouble]:
    """a × b of vectors given by their components."""
    return [a[i] * b[j] - a[j] * b[i] for i, j in ((1, 2), (2, 0), (0, 1))]


def differences(f: Floats, tail: NDArray[Any], head: NDArray[Any]) -> list[DoubleDouble]:
    """The vectors from points to others, exactly: one number per coordinate. f: (3, V)."""
    return [DoubleDouble(*two_difference(x[head], x[tail])) for x in f]


def product(a: list[DoubleDouble], b: list[DoubleDouble]) -> DoubleDouble:
    """a · b of vectors given by their components."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]

"""Exact orientation predicates: the side of a point of a plane in space, or of a line in a coordinate plane."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from itertools import combinations

import numpy as np

from ...support.arrays import Floats, Sign
from ...support.compensated import two_product
from ..exact_signs import loses_digits, sign_of_sum, terms_of_determinant
from ..triangles import EPSILON, cross, dot

# Subtractions, products and sums have an error below 4ε times the sum of the absolute terms.
_CERTAIN = 8 * EPSILON
# Bounds below this may have lost terms to underflow.
_TINY = 2.0**-900
# Rows decided exactly at a time; each takes 96 terms of eight bytes, and as many again for their rounding errors.
_AT_ONCE = 8192


def orient3d(p: Floats, q: Floats, r: Floats, s: Floats) -> Sign:
    """The signs of (q − p) × (r − p) · (s − p), exactly: +1 where s lies on the side of the plane of p, q, r from
    which these run counterclockwise, −1 on the other, 0 in the plane.

    p, q, r, s: (3, n) coordinates. A floating-point filter decides most, error-free sums the others, rationals those
    with coordinates below 2⁻²⁸⁰.
    Source: J. R. Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates, 1997.
    """
    u, v, w = q - p, r - p, s - p
    value = dot(cross(u, v), w)
    a, b, c = np.abs(u), np.abs(v), np.abs(w)
    terms = (a[1] * b[2] + a[2] * b[1]) * c[0] + (a[2] * b[0] + a[0] * b[2]) * c[1] + (a[0] * b[1] + a[1] * b[0]) * c[2]
    return _certain_or_exact(value, terms, _exact_volume, (p, q, r, s))


def orient2d(p: Floats, q: Floats, r: Floats) -> Sign:
    """The signs of (q − p) × (r − p), exactly: +1 where p, q, r run counterclockwise, 0 where they are collinear.

    p, q, r: (2, n) coordinates.
    """
    u, v = q - p, r - p
    terms = np.abs(u[0] * v[1]) + np.abs(u[1] * v[0])
    return _certain_or_exact(u[0] * v[1] - u[1] * v[0], terms, _exact_area, (p, q, r))


def _certain_or_exact(value: Floats, terms: Floats, exact: Callable[..., Sign], points: tuple[Floats, ...]) -> Sign:
    bound = _CERTAIN * terms
    result = (value > bound).view(np.int8) - (value < -bound).view(np.int8)
    open_ = np.flatnonzero((result == 0) | (terms < _TINY))
    for start in range(0, len(open_), _AT_ONCE):
        part = open_[start : start + _AT_ONCE]
        result[part] = exact(*(point[:, part] for point in points))
    return result


def _exact_volume(*points: Floats) -> Sign:
    """The sign of the determinant of four points with a column of ones, expanded by that column."""
    terms = []
    for rows, turn in zip(combinations(points, 3), (1.0, -1.0, 1.0, -1.0), strict=True):
        terms += terms_of_determinant(*rows, turn)
    # Leaving out the last point has the sign − in (q − p) × (r − p) · (s − p).
    return -_sign_or_rational(terms, points, _rational_volume)


def _exact_area(*points: Floats) -> Sign:
    terms = []
    for (a, b), turn in zip(combinations(points, 2), (1.0, -1.0, 1.0), strict=True):
        for x, y, sign in ((a[0], b[1], turn), (a[1], b[0], -turn)):
            terms += [sign * part for part in two_product(x, y)]
    return _sign_or_rational(terms, points, _rational_area)


def _sign_or_rational(
    terms: list[Floats], points: tuple[Floats, ...], rational: Callable[[list[list[Fraction]]], Fraction]
) -> Sign:
    result = sign_of_sum(np.array(terms))
    for k in np.flatnonzero(loses_digits(*points) | (result == 2)):
        value = rational([[Fraction(x) for x in point[:, k].tolist()] for point in points])
        result[k] = (value > 0) - (value < 0)
    return result


def _rational_volume(points: list[list[Fraction]]) -> Fraction:
    """The determinant whose terms `_exact_volume` sums."""
    p, q, r, s = points
    u, v, w = ([x - y for x, y in zip(end, p, strict=True)] for end in (q, r, s))
    normal = [u[i] * v[j] - u[j] * v[i] for i, j in ((1, 2), (2, 0), (0, 1))]
    return -sum((x * y for x, y in zip(normal, w, strict=True)), start=Fraction(0))


def _rational_area(points: list[list[Fraction]]) -> Fraction:
    p, q, r = points
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

"""Normal cones of stars in exact arithmetic: decisions by integers, angles with 50 digits."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations
from math import gcd

import numpy as np
from mpmath import mp, mpf
from numpy.typing import NDArray

mp.dps = 50

Whole = tuple[int, int, int]


def angle(a: Whole, b: Whole) -> mpf:
    square = along(times(a, b), times(a, b))
    return mp.atan2(mp.sqrt(mpf(square)), mpf(along(a, b)))


def times(a: Whole, b: Whole) -> Whole:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def along(a: Whole, b: Whole) -> int:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def sector(plane: list[Whole], normal: Whole) -> mpf | None:
    """The angle that directions in a plane span; None if they contain a line."""
    for a in plane:
        for b in plane:
            inside = all(along(times(a, d), normal) >= 0 <= along(times(d, b), normal) for d in plane)
            opposite = any(times(a, d) == (0, 0, 0) and along(a, d) < 0 for d in plane)
            if inside and not opposite and (along(times(a, b), normal) > 0 or times(a, b) == (0, 0, 0)):
                return angle(a, b)
    return None


def by_integers(star: list[Whole]) -> mpf:
    """2π less the angles at the apex of the facets of the hull of directions of integers: every decision is exact."""
    planes = set()
    for a, b in combinations(star, 2):
        for normal in (times(a, b), times(b, a)):
            common = gcd(*normal)
            if common and all(along(normal, d) >= 0 for d in star):
                planes.add((normal[0] // common, normal[1] // common, normal[2] // common))
    if not planes:
        one_line = all(times(star[0], d) == (0, 0, 0) for d in star)
        return 2 * mp.pi if one_line and all(along(star[0], d) > 0 for d in star) else mpf(0)
    flat = all(along(normal, d) == 0 for normal in planes for d in star)
    if len(planes) < 3 and not flat:
        return mpf(0)
    sectors = [sector([d for d in star if along(normal, d) == 0], normal) for normal in planes]
    return mpf(0) if None in sectors else 2 * mp.pi - sum(x for x in sectors if x)


def of_star(centre: NDArray[np.float64], around: NDArray[np.float64]) -> mpf:
    """K⁺ at a point with neighbours (d, 3), from all digits of their coordinates."""
    steps = [[Fraction(x) - Fraction(y) for x, y in zip(q, centre.tolist(), strict=True)] for q in around.tolist()]
    unit = max((step.denominator for each in steps for step in each), default=1)
    return by_integers([tuple(int(step * unit) for step in each) for each in steps])  # type: ignore[misc]

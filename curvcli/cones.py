"""Normal cones of the convex hulls of stars: how much of the sphere of directions a vertex supports.

Directions come as (3, d, n): d directions at each of n apices, and everything is computed for all apices at once. Few
directions in general position have their facets counted out, at a cost of n d³ simple operations. The others have
their hull wrapped, at a cost of n d (d + facets of the hull). There decisions are made on unit vectors, so a wrong one
means that a direction within rounding of the hull was taken for a part of it or not, which moves the result by
rounding only.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from .blocks import EPSILON, Floats, Vector, cross, dot
from .topology import Mask

# Squares below this have lost digits to the end of the range of doubles.
_UNDERFLOW = float(np.finfo(np.float64).tiny) / EPSILON
# Directions closer than this are one to rounding.
_SAME = 8 * EPSILON
# The error bound of a determinant of unit vectors, with room.
_COPLANAR = 32 * EPSILON
# An angle that is large against rounding and small against what matters.
_NEARBY = 1e-10
# Up to so many directions, all their determinants cost less than wrapping.
_COUNTED = 16
# A mean direction within about 87° of all directions serves as the axis of their cone.
_WITHIN = 0.05


def normal_cone_areas(directions: Floats, hint: Floats) -> Floats:
    """(n,) solid angle of the normal cone {x: x·d_i ≤ 0} of the cone that the directions span.

    2π − Σ of the angles between neighbouring extreme directions; 0 where the cone contains a line. directions:
    (3, d, n), none of them zero. hint: (3, n) any vectors; where all directions are on one side of it, that saves time.
    """
    if directions.shape[1] > _COUNTED:
        return _by_wrapping(directions, hint)
    area, unsure = _by_facets(directions)
    rest = np.flatnonzero(unsure)
    if len(rest):
        area[rest] = _by_wrapping(directions[:, :, rest], hint[:, rest])
    return area


def _by_facets(directions: Floats) -> tuple[Floats, Mask]:
    """The same where no three directions are coplanar to rounding, and where some are.

    Two directions span a facet if their determinants with all others have one sign. A cone with none is all of space.
    """
    d, n = directions.shape[1:]
    square = dot(directions, directions).max(axis=0)
    rounding = _COPLANAR * square * np.sqrt(square)
    pairs = list(combinations(range(d), 2))
    place = {pair: k for k, pair in enumerate(pairs)}
    sides = np.zeros((len(pairs), n), np.int8)
    unsure = np.full(n, d < 3) | ((_COPLANAR * square) ** 2 < _UNDERFLOW)
    for i, j in pairs:
        later = d - 1 - j
        if not later:
            continue
        determinant = dot(cross(directions[:, i], directions[:, j]), directions[:, j + 1 :])
        sign = (determinant > rounding).view(np.int8) - (determinant < -rounding).view(np.int8)
        unsure |= (sign == 0).any(axis=0)
        with_i, with_j = place[i, j + 1], place[j, j + 1]
        sides[place[i, j]] += sign.sum(axis=0, dtype=np.int8)
        sides[with_i : with_i + later] -= sign
        sides[with_j : with_j + later] += sign
    facets = np.abs(sides) == d - 2
    area = np.full(n, 2 * np.pi)
    for (i, j), facet in zip(pairs, facets, strict=True):
        there = np.flatnonzero(facet)
        a, b = ([x[end].take(there) for x in directions] for end in (i, j))
        normal = cross(a, b)
        area[there] -= np.arctan2(np.sqrt(dot(normal, normal)), dot(a, b))
    return np.where(facets.any(axis=0), np.maximum(area, 0.0), 0.0), unsure


def _by_wrapping(directions: Floats, hint: Floats) -> Floats:
    """The same for directions in any position: an axis of their cone is found and the cone is wrapped round it."""
    square = dot(directions, directions)
    if square.min() < _UNDERFLOW:
        directions = directions / np.abs(directions).max(axis=0)
        square = dot(directions, directions)
    unit = directions / np.sqrt(square)
    axis, pointed = _axes(unit, hint)
    area = np.zeros(unit.shape[2])
    if pointed.all():
        return np.maximum(2 * np.pi - _perimeters(unit, axis), 0.0)
    chosen = np.flatnonzero(pointed)
    if len(chosen):
        area[chosen] = np.maximum(2 * np.pi - _perimeters(unit[:, :, chosen], axis[:, chosen]), 0.0)
    return area


def _axes(unit: Floats, hint: Floats) -> tuple[Floats, Mask]:
    """(3, n) a vector with a positive product with every direction, and whether there is one."""
    if dot(hint, hint).min() < _UNDERFLOW:
        size = np.abs(hint).max(axis=0)
        hint = np.divide(hint, size, where=size > 0, out=np.zeros_like(hint))
    product = dot(unit, hint[:, None])
    lowest, highest = product.min(axis=0), product.max(axis=0)
    axis = np.where(highest < 0, -hint, hint)
    pointed: Mask = (lowest > 0) | (highest < 0)
    rest = np.flatnonzero(~pointed)
    if len(rest):
        axis[:, rest], pointed[rest] = _mean_axes(unit[:, :, rest])
    return axis, pointed


def _mean_axes(unit: Floats) -> tuple[Floats, Mask]:
    """The same without a hint: the mean direction where it is well within, else what elimination finds."""
    total = unit.sum(axis=1)
    length = np.sqrt(dot(total, total))
    # With all products at least δ, the sum is at least d δ long: what is shorter is flat to rounding.
    pointed = length > _COPLANAR * unit.shape[1]
    axis = np.divide(total, length, where=pointed, out=np.zeros_like(total))
    wide = np.flatnonzero(pointed & (dot(unit, axis[:, None]).min(axis=0) <= _WITHIN))
    if len(wide):
        axis[:, wide], pointed[wide] = _wide_axes(unit[:, :, wide], axis[:, wide])
    return axis, pointed


def _wide_axes(unit: Floats, mean: Floats) -> tuple[Floats, Mask]:
    """The same where the mean direction will not do, by eliminating one coordinate (Fourier and Motzkin).

    The cone's section with a plane through its mean direction is spanned by the combinations |y_j| d_i + |y_i| d_j of
    directions on its two sides; the cone is pointed if the section is and leaves room for y between its bounds.
    """
    n = unit.shape[2]
    x = dot(unit, mean[:, None])
    farthest = np.abs(x).argmin(axis=0)
    across = unit[:, farthest, np.arange(n)]
    across = across - dot(across, mean) * mean
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        across /= np.sqrt(dot(across, across))
        beside = np.array(cross(mean, across))
        y, z = dot(unit, across[:, None]), dot(unit, beside[:, None])
        above, size = y >= 0, np.abs(y)
        lefts, rights = np.zeros((2, len(y) - 1, n))
        for i in range(len(y) - 1):
            rest = slice(i + 1, None)
            turn = _diamond(size[rest] * x[i] + size[i] * x[rest], size[rest] * z[i] + size[i] * z[rest])
            turn[above[rest] == above[i]] = 0.0
            np.maximum(lefts[i:], turn, out=lefts[i:])
            np.minimum(rights[i:], turn, out=rights[i:])
        # Opposite directions come to 0 / 0: a line, and the comparisons below are false.
        left, right = _diamond_angle(lefts.max(axis=0)), _diamond_angle(rights.min(axis=0))
        pointed = left - right < np.pi
        middle = 0.5 * (left + right)
        along, aside = np.cos(middle), np.sin(middle)
        height = along * x + aside * z
        bound = -height / y
        lowest = np.where(y > 0, bound, -np.inf).max(axis=0)
        highest = np.where(y < 0, bound, np.inf).min(axis=0)
        slope = 0.5 * (lowest + highest)
        pointed &= (height + slope * y).min(axis=0) > 0
        axis: Floats = along * mean + aside * beside + slope * across
        axis /= np.abs(axis).max(axis=0)
    pointed &= np.isfinite(axis).all(axis=0)
    return np.where(pointed, axis, 0.0), pointed


def _diamond(x: Floats, z: Floats) -> Floats:
    """An increasing function of the angle of (x, z) from -2 to 2, cheaper than the angle itself."""
    turn: Floats = z / (np.abs(x) + np.abs(z))
    np.copyto(turn, np.copysign(2.0, z) - turn, where=x < 0)
    return turn


def _diamond_angle(turn: Floats) -> Floats:
    """The angle of which `_diamond` is the function."""
    x = 1 - np.abs(turn)
    angle: Floats = np.arctan2(np.copysign(1 - np.abs(x), turn), x)
    return angle


def _perimeters(unit: Floats, axis: Floats) -> Floats:
    """(n,) Σ of the angles between neighbouring extreme directions, by wrapping a plane round each cone.

    The direction farthest from the axis is extreme, and the plane through it that touches the circle about the axis
    supports the cone. From a supporting plane at one extreme direction, the next is where the plane, turned about the
    direction, first meets another.
    """
    d, n = unit.shape[1:]
    everyone = np.arange(n)
    perimeter = np.zeros(n)
    first = dot(unit, axis[:, None]).argmin(axis=0)
    start = unit[:, first, everyone]
    at = start
    axis = axis / np.sqrt(dot(axis, axis))
    normal: Vector = axis - dot(axis, at) * at
    unvisited = np.ones((d, n), bool)
    active = everyone
    for step in range(d + 1):
        following, found = _next_directions(unit, unvisited, at, normal)
        count = np.arange(len(active))
        there = unit[:, following, count]
        closed = ~found | (following == first)
        if step:
            # Close to the start, what is ahead of it and what is behind cannot be told: only a longer way can be home.
            closed |= (perimeter[active] > _NEARBY) & _passes(at, start, there)
        there = np.where(closed, start, there)
        normal = cross(at, there)
        sine = np.sqrt(dot(normal, normal))
        perimeter[active] += np.arctan2(sine, dot(at, there))
        unvisited[following, count] = False
        at = there
        # After a short step the product is perpendicular only roughly, which would misplace what is close by.
        normal = np.array(normal) / np.where(sine > 0, sine, 1.0)
        normal -= dot(normal, at) * at
        if closed.any():
            keep = np.flatnonzero(~closed)
            if not len(keep):
                break
            active, first, unit, unvisited = active[keep], first[keep], unit[:, :, keep], unvisited[:, keep]
            at, start, normal = at[:, keep], start[:, keep], normal[:, keep]
    return perimeter


def _next_directions(unit: Floats, unvisited: Mask, at: Floats, normal: Vector) -> tuple[NDArray[np.intp], Mask]:
    """Which direction the supporting plane meets first when it turns about `at`, and whether there is any."""
    ahead = np.array(cross(normal, at))
    forward, inward = dot(unit, ahead[:, None]), dot(unit, np.asarray(normal)[:, None])
    width = np.abs(forward) + np.abs(inward)
    with np.errstate(divide="ignore", invalid="ignore"):
        turn = 1 - forward / width
    # Rounding puts directions in the plane below it: turned a little less than 0 ahead, a little more than π behind.
    turn = np.where(inward >= 0, turn, np.where(forward > 0, -turn, 4 - turn))
    turn[~unvisited | (width <= _SAME)] = np.inf
    following = turn.argmin(axis=0)
    return following, turn[following, np.arange(turn.shape[1])] < np.inf


def _passes(at: Floats, start: Floats, there: Floats) -> Mask:
    """Whether the way from one direction to the next leads over the start, which rounding has hidden in its plane."""
    normal = cross(at, there)
    near = np.abs(dot(normal, start)) <= _COPLANAR
    between = (dot(cross(at, start), normal) >= 0) & (dot(cross(start, there), normal) >= 0)
    gap = at - start
    passes: Mask = (near & between) | (dot(gap, gap) <= _SAME**2)
    return passes

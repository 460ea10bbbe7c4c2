"""Normal cones of the hulls of stars by wrapping them, for directions in any position.

The cost is n d (d + facets of the hull) for d directions at n apices. Decisions are made on unit vectors, so a wrong
one means that a direction within rounding of the hull was taken for a part of it or not, which moves the result by
rounding only.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .blocks import EPSILON, Floats, Vector, cross, dot
from .topology import Mask

# Squares below this have lost digits to the end of the range of doubles.
UNDERFLOW = float(np.finfo(np.float64).tiny) / EPSILON
# Directions closer than this are one to rounding.
_SAME = 8 * EPSILON
# The error bound of a determinant of unit vectors, with room.
COPLANAR = 32 * EPSILON
# An angle that is large against rounding and small against what matters.
_NEARBY = 1e-10
# A mean direction within about 87° of all directions serves as the axis of their cone.
_WITHIN = 0.05


def wrapped_cone_areas(directions: Floats, hint: Floats) -> Floats:
    """(n,) solid angle of the normal cone of the cone that the directions span, as `normal_cone_areas` has it.

    An axis of the cone is found, and a plane wrapped round it. directions: (3, d, n). hint: (3, n).
    """
    square = dot(directions, directions)
    if square.min() < UNDERFLOW:
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
    if dot(hint, hint).min() < UNDERFLOW:
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
    pointed = length > COPLANAR * unit.shape[1]
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
    near = np.abs(dot(normal, start)) <= COPLANAR
    between = (dot(cross(at, start), normal) >= 0) & (dot(cross(start, there), normal) >= 0)
    gap = at - start
    passes: Mask = (near & between) | (dot(gap, gap) <= _SAME**2)
    return passes

"""Contact of two triangles, decided exactly: apart, crossing, overlapping, folded over, or touching."""

from __future__ import annotations

from functools import reduce

import numpy as np

from ...support.arrays import Floats, Ints, Mask, Sign
from ..triangles import EPSILON, cross, dot
from .predicates import orient2d, orient3d

# Kinds of contact, beyond the corners and the edge that two faces share.
KINDS = ("apart", "crossing", "overlapping", "folded", "touching")
APART, CROSSING, OVERLAPPING, FOLDED, TOUCHING = range(5)

# Dot products of differences of coordinates have an error below 3ε times the sum of the absolute terms.
_CERTAIN = 8 * EPSILON
_EDGES = ((0, 1), (1, 2), (2, 0))


def contacts(p: Floats, q: Floats, shared: int) -> Sign:
    """(n,) kinds of contact of triangles p and q, (3, 3, n) each: corner, coordinate, pair; neither without area.

    shared: 0, 1 or 2, the number of corners in common, which come first in both, in the same order.
    * crossing: they meet along a segment, and each has corners on both sides of the other's plane;
    * overlapping: they lie in one plane and have an area in common;
    * folded over: the same, and they share an edge;
    * touching: they meet elsewhere than in shared corners and edges, in none of these ways.
    Source of the test of two triangles without a common corner: P. Guigue and O. Devillers, Fast and Robust
    Triangle-Triangle Overlap Test Using Orientation Predicates, 2003.
    """
    result = np.full(p.shape[-1], APART, np.int8)
    separated, decide = (
        (_apart, _without_common_corner),
        (_apart_at_corner, _with_common_corner),
        (_apart_at_edge, _with_common_edge),
    )[shared]
    rows = np.flatnonzero(~separated(p, q))
    if len(rows):
        result[rows] = decide(p[..., rows], q[..., rows])
    return result


# ---------------------------------------------------------------------- certainly apart, in floating point


def _apart(p: Floats, q: Floats) -> Mask:
    """(n,) flags: a plane perpendicular to the line between the centres lies between the two, beyond rounding."""
    p, q = p - p[0], q - p[0]
    normal = q.sum(axis=0) - p.sum(axis=0)
    size = np.abs(normal)
    error = _CERTAIN * reduce(np.maximum, (dot(size, np.abs(x)) for x in (*p[1:], *q)))
    below = reduce(np.maximum, (dot(normal, x) for x in p[1:]), np.zeros(p.shape[-1]))
    above: Floats = reduce(np.minimum, (dot(normal, x) for x in q))
    return np.asarray(above - below > 2 * error)


def _apart_at_corner(p: Floats, q: Floats) -> Mask:
    """(n,) flags: a plane through the common corner lies between the two, beyond rounding."""
    ends, others = p[1:] - p[0], q[1:] - p[0]
    normal: Floats = _unit(others[0]) + _unit(others[1]) - _unit(ends[0]) - _unit(ends[1])
    size = np.abs(normal)
    separated = np.ones(p.shape[-1], bool)
    for turn, corners in ((-1, ends), (1, others)):
        for x in corners:
            separated &= turn * dot(normal, x) > _CERTAIN * dot(size, np.abs(x))
    return separated


def _apart_at_edge(p: Floats, q: Floats) -> Mask:
    """(n,) flags: the angle between the two faces, seen along their common edge, exceeds 90°, beyond rounding."""
    edge, to_apex, to_other_apex = p[1] - p[0], p[2] - p[0], q[2] - p[0]
    square = dot(edge, edge)
    value = square * dot(to_apex, to_other_apex) - dot(edge, to_apex) * dot(edge, to_other_apex)
    lengths = square * np.sqrt(dot(to_apex, to_apex) * dot(to_other_apex, to_other_apex))
    return np.asarray((value < -4 * _CERTAIN * lengths) & (lengths > 0))


def _unit(x: Floats) -> Floats:
    """Vectors of about unit length; 0 of 0."""
    length = np.sqrt(dot(x, x))
    return np.asarray(x / np.where(length > 0, length, 1.0))


# ---------------------------------------------------------------------- exact decisions


def _without_common_corner(p: Floats, q: Floats) -> Sign:
    result = np.full(p.shape[-1], APART, np.int8)
    above = np.stack([_height(p, x) for x in q])
    rows = np.flatnonzero(~_one_sided(above))
    above, p, q = above[:, rows], p[..., rows], q[..., rows]
    below = np.stack([_height(q, x) for x in p])
    flat = ~above.any(axis=0)
    result[rows[flat]] = _in_one_plane(p[..., flat], q[..., flat], 0)
    left = np.flatnonzero(~flat & ~_one_sided(below))
    above, below, p, q, rows = above[:, left], below[:, left], p[..., left], q[..., left], rows[left]
    # Turn both so that the first corner is alone on its side of the other's plane, and swap the other two where it
    # lies below: all chords then run the same way along the line in which the planes meet.
    a, b, c = _lone_first(p, below)
    d, e, f = _lone_first(q, above)
    low = _lone_below(below)
    e, f = np.where(low, f, e), np.where(low, e, f)
    low = _lone_below(above)
    b, c = np.where(low, c, b), np.where(low, b, c)
    first_sign, second_sign = orient3d(a, b, d, e), orient3d(a, c, f, d)
    both_sides = _mixed(above) & _mixed(below)
    meet = (first_sign <= 0) & (second_sign <= 0)
    along = (first_sign < 0) & (second_sign < 0)
    result[rows] = np.where(meet, np.where(along & both_sides, CROSSING, TOUCHING), APART)
    return result


def _with_common_corner(p: Floats, q: Floats) -> Sign:
    result = np.full(p.shape[-1], APART, np.int8)
    above = np.stack([_height(p, x) for x in q[1:]])
    rows = np.flatnonzero(~_one_sided(above))
    above, p, q = above[:, rows], p[..., rows], q[..., rows]
    below = np.stack([_height(q, x) for x in p[1:]])
    flat = ~above.any(axis=0)
    result[rows[flat]] = _in_one_plane(p[..., flat], q[..., flat], 1)
    # Each cuts the other's plane in a ray from the corner; the two meet beyond it if the rays run the same way.
    codirectional = np.sign(below[0] - below[1]) == np.sign(above[1] - above[0])
    meet = ~flat & ~_one_sided(below) & codirectional
    crossing = _mixed(above) & _mixed(below)
    result[rows[meet]] = np.where(crossing, CROSSING, TOUCHING)[meet]
    return result


def _with_common_edge(p: Floats, q: Floats) -> Sign:
    flat = np.flatnonzero(_height(p, q[2]) == 0)
    result = np.full(p.shape[-1], APART, np.int8)
    if len(flat):
        (u, v, a), (_, _, b) = _projected(p[..., flat], q[..., flat])
        result[flat[orient2d(u, v, a) == orient2d(u, v, b)]] = FOLDED
    return result


def _in_one_plane(p: Floats, q: Floats, shared: int) -> Sign:
    """(n,) kinds of contact of triangles in one plane: common area, common points, or none."""
    if not p.shape[-1]:
        return np.zeros(0, np.int8)
    p, q = _projected(p, q)
    open_, closed = np.ones(p.shape[-1], bool), np.ones(p.shape[-1], bool)
    for triangle, other in ((p, q), (q, p)):
        turn = _area(triangle)
        for a, b in _EDGES:
            sides = np.stack([orient2d(triangle[a], triangle[b], x) for x in other]) * turn
            open_ &= (sides > 0).any(axis=0)
            closed &= (sides >= 0).any(axis=0)
    if shared:
        # They touch beyond their common corner where two of their edges leave it in one direction.
        closed = np.logical_or.reduce(
            [(orient2d(p[0], a, b) == 0) & _same_way(p[0], a, b) for a in p[1:] for b in q[1:]]
        )
    return np.where(open_, OVERLAPPING, np.where(closed, TOUCHING, APART)).astype(np.int8)


def _same_way(origin: Floats, a: Floats, b: Floats) -> Mask:
    """(n,) flags of collinear points: a and b lie on the same side of the origin."""
    signs = np.sign(a - origin), np.sign(b - origin)
    return np.asarray((signs[0] == signs[1]).all(axis=0))


def _projected(p: Floats, q: Floats) -> tuple[Floats, Floats]:
    """Two triangles of one plane in the coordinate plane in which their area is largest: (3, 2, n) each."""
    normal = np.abs(np.stack(cross(p[1] - p[0], p[2] - p[0])))
    axes = np.argsort(-normal, axis=0)
    chosen, column = axes[0], np.arange(p.shape[-1])
    for axis in axes[1:]:
        # Rounding may have made a component of the normal that is 0 the largest.
        flat = np.flatnonzero(_area(_dropped(p, chosen, column)) == 0)
        if not len(flat):
            break
        chosen[flat] = axis[flat]
    return _dropped(p, chosen, column), _dropped(q, chosen, column)


def _dropped(corners: Floats, axis: Ints, column: Ints) -> Floats:
    """Corners without one of their coordinates."""
    return np.stack([corners[:, (axis + k) % 3, column] for k in (1, 2)], axis=1)


def _height(face: Floats, point: Floats) -> Sign:
    """The side of a point about the plane of a face."""
    return orient3d(face[0], face[1], face[2], point)


def _area(face: Floats) -> Sign:
    """The sign of the area of a triangle in a coordinate plane."""
    return orient2d(face[0], face[1], face[2])


def _one_sided(signs: Sign) -> Mask:
    """(n,) flags: all corners lie strictly on one side."""
    return np.asarray((signs > 0).all(axis=0) | (signs < 0).all(axis=0))


def _mixed(signs: Sign) -> Mask:
    """(n,) flags: corners lie strictly on both sides."""
    return np.asarray((signs > 0).any(axis=0) & (signs < 0).any(axis=0))


def _lone(signs: Sign) -> Ints:
    """The only corner of its sign, else the one in the plane, with the other two on one side."""
    positive, negative = (signs > 0).sum(axis=0) == 1, (signs < 0).sum(axis=0) == 1
    lone = np.where(
        positive, signs.argmax(axis=0), np.where(negative, signs.argmin(axis=0), np.abs(signs).argmin(axis=0))
    )
    return np.asarray(lone, np.int64)


def _lone_first(corners: Floats, signs: Sign) -> list[Floats]:
    """The corners in cyclic order, the lone one first."""
    lone, column = _lone(signs), np.arange(corners.shape[-1])
    return [corners[(lone + step) % 3, :, column].T for step in range(3)]


def _lone_below(signs: Sign) -> Mask:
    """(n,) flags: the lone corner lies below the other two."""
    lone, column = _lone(signs), np.arange(signs.shape[-1])
    lone_sign = signs[lone, column]
    return np.asarray((lone_sign < 0) | ((lone_sign == 0) & (signs.sum(axis=0) > 0)))

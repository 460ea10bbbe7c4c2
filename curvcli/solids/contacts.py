"""Where closed surfaces touch or cross each other: pairs of faces in contact, and points on both sides of it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..blocks import cross, dot
from .sides import CERTAIN, ROUNDING, Floats, Ints, Mask, Sides, Vector, absolute, certain_sign, permanent, size

_EDGES = ((0, 1), (1, 2), (2, 0))


class Contacts(NamedTuple):
    """Pairs of faces, of two surfaces each, that touch or are within rounding of it, and the pairs that cross.

    pair: (n,) number of the pair of surfaces. one, other: (n,) faces. crossing: pairs of surfaces of which an edge
    passes through the inside of a face, beyond rounding.
    """

    pair: Ints
    one: Ints
    other: Ints
    crossing: Ints


def find_contacts(sides: Sides, one: Ints, other: Ints) -> Contacts:
    """The contacts of pairs of surfaces. one, other: (n,) the surfaces of each pair."""
    crossing = np.zeros(len(one), bool)
    found = [np.zeros((3, 0), np.int64)]
    for pair, f, g in sides.tree.meeting(one, other):
        open_ = ~crossing[pair]
        pair, f, g = pair[open_], f[open_], g[open_]
        touching, through = _test(sides, f, g)
        crossing[pair[through]] = True
        found.append(np.stack([pair, f, g])[:, touching & ~through])
    pair, f, g = np.concatenate(found, axis=1)
    open_ = ~crossing[pair]
    return Contacts(pair[open_], f[open_], g[open_], np.flatnonzero(crossing))


def _test(sides: Sides, f: Ints, g: Ints) -> tuple[Mask, Mask]:
    """Whether faces f and g may touch, and whether an edge of one surely passes through the inside of the other."""
    p, q = sides.corners(f), sides.corners(g)
    rounding = ROUNDING * np.maximum(sides.reach.take(f), sides.reach.take(g))
    above, below = _heights(p, q, rounding), _heights(q, p, rounding)
    apart = (np.abs(above.sum(axis=0)) == 3) | (np.abs(below.sum(axis=0)) == 3)
    touching, through = np.zeros(len(f), bool), np.zeros(len(f), bool)
    left = np.flatnonzero(~apart)
    if len(left):
        p, q = ([[x[left] for x in corner] for corner in face] for face in (p, q))
        for ends, face, height in ((p, q, above[:, left]), (q, p, below[:, left])):
            for a, b in _EDGES:
                may, surely = _pierces(ends[a], ends[b], face, height[a], height[b], rounding[left])
                touching[left] |= may
                through[left] |= surely
    return touching, through


def _heights(points: list[list[Floats]], face: list[list[Floats]], rounding: Floats) -> Ints:
    """(3, n) on which side of the plane of a face three points lie, 0 within rounding of it."""
    a, b, c = face
    u, w = ([y - x for x, y in zip(a, corner, strict=True)] for corner in (b, c))
    normal, terms, lengths = cross(u, w), permanent(absolute(u), absolute(w)), size(u) + size(w)
    area = size(normal)
    found = []
    for point in points:
        d = [y - x for x, y in zip(a, point, strict=True)]
        error = CERTAIN * dot(terms, absolute(d)) + rounding * (area + lengths * size(d))
        found.append(certain_sign(dot(normal, d), error))
    return np.stack(found).astype(np.int64)


def _pierces(
    p: Vector, q: Vector, face: list[list[Floats]], side_p: Ints, side_q: Ints, rounding: Floats
) -> tuple[Mask, Mask]:
    """Whether the edge from p to q may touch a face, and whether it surely passes through the inside of it."""
    along = [y - x for x, y in zip(p, q, strict=True)]
    d = [[y - x for x, y in zip(p, corner, strict=True)] for corner in face]
    length, lengths, sizes = size(along), [size(x) for x in d], absolute(along)
    signs = []
    for a, b in _EDGES:
        value = dot(along, cross(d[a], d[b]))
        spread = lengths[a] * lengths[b] + length * (lengths[a] + lengths[b])
        error = CERTAIN * dot(sizes, permanent(absolute(d[a]), absolute(d[b]))) + rounding * spread
        signs.append(certain_sign(value, error))
    least, most = np.min(signs, axis=0), np.max(signs, axis=0)
    missed = ((least < 0) & (most > 0)) | (side_p * side_q > 0)
    inside = (least > 0) | (most < 0)
    return ~missed, inside & (side_p * side_q < 0)


class Samples(NamedTuple):
    """Points on surfaces: points (3, n), pair (n,) the pair of surfaces, first (n,) whether on the first of the two."""

    points: Floats
    pair: Ints
    first: Mask


def samples(sides: Sides, contacts: Contacts, most: int) -> Samples:
    """Points of faces in contact: the middle of each, and of the pieces into which contact cuts their edges.

    Two surfaces cross within edges only if some such piece lies inside and another outside; where all edges lie on the
    other surface, the middles of faces tell. most: pairs of faces that are looked at, evenly spread over all.
    """
    chosen = np.arange(len(contacts.pair))
    if len(chosen) > most:
        chosen = np.linspace(0, len(chosen) - 1, most).astype(np.int64)
    pair, f, g = contacts.pair[chosen], contacts.one[chosen], contacts.other[chosen]
    corners = sides.corners(f), sides.corners(g)
    found = []
    for first, face, ends, cutter in ((True, f, *corners), (False, g, corners[1], corners[0])):
        unique = np.unique(_keys(sides, pair, face), return_index=True)[1]
        middle = np.stack([sum(x[unique] for x in axis) / 3 for axis in zip(*ends, strict=True)])
        found.append((middle, pair[unique], np.full(len(unique), first)))
        for a, b in _EDGES:
            cuts = _cuts(ends[a], ends[b], cutter)
            part, row = _pieces(cuts, _keys(sides, pair, face))
            points = np.stack([p[row] + part * (q[row] - p[row]) for p, q in zip(ends[a], ends[b], strict=True)])
            found.append((points, pair[row], np.full(len(row), first)))
    points, pairs, firsts = zip(*found, strict=True)
    return Samples(np.concatenate(points, axis=1), np.concatenate(pairs), np.concatenate(firsts))


def _cuts(p: Vector, q: Vector, face: list[list[Floats]]) -> Floats:
    """(4, n) where an edge, from p at 0 to q at 1, meets the plane of a face and, seen along its normal, the lines of
    its edges; 0 where it does not."""
    a, b, c = face
    normal = cross([y - x for x, y in zip(a, b, strict=True)], [y - x for x, y in zip(a, c, strict=True)])
    walls = [normal]
    for tail, head in ((a, b), (b, c), (c, a)):
        walls.append(cross(normal, [y - x for x, y in zip(tail, head, strict=True)]))
    cuts = []
    for wall, through in zip(walls, (a, a, b, c), strict=True):
        start, end = (dot(wall, [y - x for x, y in zip(through, point, strict=True)]) for point in (p, q))
        at = np.divide(start, start - end, where=start != end, out=np.zeros_like(start))
        cuts.append(np.where((at > 0) & (at < 1), at, 0.0))
    return np.stack(cuts)


def _keys(sides: Sides, pair: Ints, face: Ints) -> Ints:
    """A number for each face in each pair of surfaces."""
    return pair * sides.faces.shape[1] + face


def _pieces(cuts: Floats, key: Ints) -> tuple[Floats, Ints]:
    """The middle of each piece of an edge, as a part of its length, and a row that has the edge; key: of the edges."""
    _, first, edge = np.unique(key, return_index=True, return_inverse=True)
    number = len(first)
    of = np.concatenate([np.tile(edge.ravel(), len(cuts)), np.arange(number), np.arange(number)])
    at = np.concatenate([cuts.ravel(), np.zeros(number), np.ones(number)])
    order = np.lexsort((at, of))
    of, at = of[order], at[order]
    piece = np.flatnonzero((of[1:] == of[:-1]) & (at[1:] > at[:-1]))
    return at[piece] / 2 + at[piece + 1] / 2, first[of[piece]]

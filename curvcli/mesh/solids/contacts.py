"""Contacts of closed surfaces: pairs of touching or crossing faces, and sample points on both sides of them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...support.arrays import Floats, Ints, Mask
from ..triangles import cross, dot
from .sides import CERTAIN, ROUNDING, Sides, certain_sign, permanent, size

_EDGES = ((0, 1), (1, 2), (2, 0))
# Sample points on an edge, and from there towards the opposite corner.
_INWARDS = (0.0, 1 / 64, 1 / 4)


class Contacts(NamedTuple):
    """Pairs of faces of two surfaces that touch within rounding, and pairs of surfaces that cross.

    pair: (n,) number of the pair of surfaces. first, second: (n,) faces. crossing: pairs of surfaces of which two faces
    meet along a segment within both, beyond rounding.
    """

    pair: Ints
    first: Ints
    second: Ints
    crossing: Ints


def find_contacts(sides: Sides, first: Ints, second: Ints) -> Contacts:
    """The contacts of pairs of surfaces. first, second: (n,) the surfaces of each pair."""
    crossing = np.zeros(len(first), bool)
    touches = [np.zeros((3, 0), np.int64)]
    for pair, f, g in sides.tree.meeting(first, second):
        open_ = ~crossing[pair]
        pair, f, g = pair[open_], f[open_], g[open_]
        touching, through = _test(sides, f, g)
        crossing[pair[through]] = True
        touches.append(np.stack([pair, f, g])[:, touching])
    pair, f, g = np.concatenate(touches, axis=1)
    open_ = ~crossing[pair]
    return Contacts(pair[open_], f[open_], g[open_], np.flatnonzero(crossing))


def _test(sides: Sides, f: Ints, g: Ints) -> tuple[Mask, Mask]:
    """(n,) flags: faces f and g may touch; faces f and g certainly meet along a segment inside both."""
    rounding = ROUNDING * np.maximum(sides.reach.take(f), sides.reach.take(g))
    p, q = sides.corners(f), sides.corners(g)
    above, below = _heights(p, q, rounding), _heights(q, p, rounding)
    apart = (np.abs(above.sign.sum(axis=0)) == 3) | (np.abs(below.sign.sum(axis=0)) == 3)
    touching, through = np.zeros(len(f), bool), np.zeros(len(f), bool)
    left = np.flatnonzero(~apart)
    if len(left):
        p, q, rounding = p[..., left], q[..., left], rounding[left]
        above, below = above.at(left), below.at(left)
        for ends, face, height in ((p, q, above.sign), (q, p, below.sign)):
            for a, b in _EDGES:
                touching[left] |= _may_meet(ends[a], ends[b], face, height[a] * height[b], rounding)
        through[left] = _cut(p, q, above, below, rounding)
    return touching & ~through, through


class _Heights(NamedTuple):
    """Heights of three corners over the plane of a face, all (3, n): 6 × volumes, their errors and certain signs."""

    value: Floats
    error: Floats
    sign: NDArray[np.int8]

    def at(self, chosen: NDArray[np.intp]) -> _Heights:
        """The heights for some faces."""
        return _Heights(self.value[:, chosen], self.error[:, chosen], self.sign[:, chosen])


def _heights(points: Floats, face: Floats, rounding: Floats) -> _Heights:
    """Sides of three points about the plane of a face, 0 within rounding of it."""
    a, b, c = face
    u, w = b - a, c - a
    normal, terms, lengths = cross(u, w), permanent(np.abs(u), np.abs(w)), size(u) + size(w)
    area = size(normal)
    d = [point - a for point in points]
    value = np.stack([dot(normal, x) for x in d])
    error = np.stack([CERTAIN * dot(terms, np.abs(x)) + rounding * (area + lengths * size(x)) for x in d])
    return _Heights(value, error, certain_sign(value, error))


def _may_meet(p: Floats, q: Floats, face: Floats, sides: NDArray[np.int8], rounding: Floats) -> Mask:
    """(n,) flags: the edge pq may touch a face. sides: ±1 if both ends certainly lie on one side of its plane."""
    along, d = q - p, face - p
    length, lengths, sizes = size(along), [size(x) for x in d], np.abs(along)
    signs = []
    for a, b in _EDGES:
        value = dot(along, cross(d[a], d[b]))
        spread = lengths[a] * lengths[b] + length * (lengths[a] + lengths[b])
        error = CERTAIN * dot(sizes, permanent(np.abs(d[a]), np.abs(d[b]))) + rounding * spread
        signs.append(certain_sign(value, error))
    missed: Mask = ((np.min(signs, axis=0) < 0) & (np.max(signs, axis=0) > 0)) | (sides > 0)
    return ~missed


def _cut(p: Floats, q: Floats, above: _Heights, below: _Heights, rounding: Floats) -> Mask:
    """(n,) flags: faces p and q certainly meet along a segment inside both.

    Each has corners on both sides of the other's plane, and their chords on the common line overlap.
    """
    through = np.zeros(p.shape[-1], bool)
    mixed = [(height.sign.min(axis=0) < 0) & (height.sign.max(axis=0) > 0) for height in (above, below)]
    chosen = np.flatnonzero(mixed[0] & mixed[1])
    if not len(chosen):
        return through
    p, q, rounding = p[..., chosen], q[..., chosen], rounding[chosen]
    normals = [cross(face[1] - face[0], face[2] - face[0]) for face in (p, q)]
    line = np.stack(cross(*normals))
    line /= np.maximum(size(line), np.finfo(np.float64).tiny)
    chords = [_chord(face, q[0], line, height.at(chosen)) for face, height in ((p, above), (q, below))]
    low, high = (np.stack([chord[k] for chord in chords]) for k in (0, 1))
    through[chosen] = high.min(axis=0) - low.max(axis=0) > chords[0][2] + chords[1][2] + 4 * rounding
    return through


def _chord(face: Floats, origin: Floats, line: Floats, height: _Heights) -> tuple[Floats, Floats, Floats]:
    """Ends of a face's chord on its line of intersection with a plane, and their error."""
    # The corner alone on its side of the plane.
    lone = np.where((height.sign > 0).sum(axis=0) == 1, height.sign.argmax(axis=0), height.sign.argmin(axis=0))
    column = np.arange(len(lone))
    p, above = face[lone, :, column].T, height.value[lone, column]
    ends, errors = [], []
    for step in (1, 2):
        other = (lone + step) % 3
        along = face[other, :, column].T - p
        drop = above - np.where(height.sign[other, column] == 0, 0.0, height.value[other, column])
        ends.append(dot(line, p + above / drop * along - origin))
        part = (height.error[lone, column] + height.error[other, column]) / np.abs(drop)
        errors.append(size(along) * (part + 4 * CERTAIN) + CERTAIN * size(p - origin))
    return np.minimum(*ends), np.maximum(*ends), errors[0] + errors[1]


class Samples(NamedTuple):
    """Points on surfaces: points (3, n), pair (n,) the pair of surfaces, first (n,) True on the first of the two."""

    points: Floats
    pair: Ints
    first: Mask


def samples(sides: Sides, contacts: Contacts, most: int) -> Samples:
    """Sample faces in contact: centres, and points on and beside the pieces into which contact cuts their edges.

    If faces cross along their edges only, points on or beside the edges lie inside and outside.
    most: number of pairs of faces sampled per pair of surfaces, evenly spread over all.
    """
    order = np.argsort(contacts.pair, kind="stable")
    count = np.bincount(contacts.pair)
    rank = np.arange(len(order)) - (np.cumsum(count) - count)[contacts.pair[order]]
    chosen = order[rank % -(-count // most)[contacts.pair[order]] == 0]
    pair, f, g = contacts.pair[chosen], contacts.first[chosen], contacts.second[chosen]
    corners = sides.corners(f), sides.corners(g)
    pieces = []
    for first, face, ends, cutter in ((True, f, *corners), (False, g, corners[1], corners[0])):
        unique = np.unique(_keys(sides, pair, face), return_index=True)[1]
        pieces.append((ends[..., unique].mean(axis=0), pair[unique], np.full(len(unique), first)))
        for a, b in _EDGES:
            part, row = _pieces(_cuts(ends[a], ends[b], cutter), _keys(sides, pair, face))
            p, q, opposite = ends[a][:, row], ends[b][:, row], ends[3 - a - b][:, row]
            for inwards in _INWARDS:
                points = (1 - inwards) * (p + part * (q - p)) + inwards * opposite
                pieces.append((points, pair[row], np.full(len(row), first)))
    points, pairs, firsts = zip(*pieces, strict=True)
    return Samples(np.concatenate(points, axis=1), np.concatenate(pairs), np.concatenate(firsts))


def _cuts(p: Floats, q: Floats, face: Floats) -> Floats:
    """(4, n) parameters on the edge from p (0) to q (1) at the plane of a face and, in projection along its normal, at
    the lines of its three edges; 0 for no intersection."""
    a, b, c = face
    normal = cross(b - a, c - a)
    walls = [normal, *(cross(normal, head - tail) for tail, head in ((a, b), (b, c), (c, a)))]
    cuts = []
    for wall, through in zip(walls, (a, a, b, c), strict=True):
        start, end = (dot(wall, point - through) for point in (p, q))
        at = np.divide(start, start - end, where=start != end, out=np.zeros_like(start))
        cuts.append(np.where((at > 0) & (at < 1), at, 0.0))
    return np.stack(cuts)


def _keys(sides: Sides, pair: Ints, face: Ints) -> Ints:
    """A unique key of each face in each pair of surfaces."""
    keys: Ints = pair * sides.faces.shape[1] + face
    return keys


def _pieces(cuts: Floats, key: Ints) -> tuple[Floats, Ints]:
    """Parameter of the middle of each piece of an edge, and a row with the edge. key: of the edges."""
    _, first, edge = np.unique(key, return_index=True, return_inverse=True)
    number = len(first)
    of = np.concatenate([np.tile(edge.ravel(), len(cuts)), np.arange(number), np.arange(number)])
    at = np.concatenate([cuts.ravel(), np.zeros(number), np.ones(number)])
    order = np.lexsort((at, of))
    of, at = of[order], at[order]
    piece = np.flatnonzero((of[1:] == of[:-1]) & (at[1:] > at[:-1]))
    return at[piece] / 2 + at[piece + 1] / 2, first[of[piece]]

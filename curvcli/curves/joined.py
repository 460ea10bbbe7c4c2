"""Joining of polyline records into curves at shared ends, in any order and direction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..mesh.file import Polylines
from ..support.arrays import Mask
from .boundary import walk_directed
from .polygon import Rows


@dataclass(frozen=True)
class Joined:
    """Curves joined from the records of a file.

    vertex: (n,) of all curves, concatenated, without the repeated end of closed ones. start: (m + 1,).
    closed: (m,). branching: vertices with more than two edges, at which curves end.
    """

    vertex: Rows
    start: Rows
    closed: Mask
    branching: Rows


@dataclass(frozen=True)
class _Chains:
    """Runs of vertices in the array of all records, from `first` to `last` both included; closed: of closed records."""

    vertex: Rows
    first: Rows
    last: Rows
    closed: Mask


def join(polylines: Polylines) -> Joined:
    """Join records end to end: two that end in one vertex, and nothing else there, are one curve.

    All curves end at a vertex of more than two edges at which a record ends: no pair of them is the one that goes on.
    A record that passes through its own vertices goes on in its own order. A record whose last vertex is its first
    is a closed curve by itself, and joins nothing. A curve begins and runs as its first record does; curves come in the
    order of these. A record that stays in a vertex of others is left out, since it adds no edge.
    Sorts the ends; the rest is linear.
    """
    vertex, start = polylines.vertex.astype(np.int64), polylines.start.astype(np.int64)
    filled = np.flatnonzero(np.diff(start) > 0)
    first, last = start[filled], start[filled + 1] - 1
    if not len(filled):
        return Joined(np.empty(0, np.int64), np.zeros(1, np.int64), np.empty(0, bool), np.empty(0, np.int64))
    count = int(vertex.max()) + 1
    # A record of one vertex has no ends that could be joined, and a closed one needs nothing else.
    open_ = vertex[first] != vertex[last]
    degree = _degrees(vertex, first[open_], last[open_], count)
    ends = np.bincount(vertex[np.concatenate([first[open_], last[open_]])], minlength=count)
    branching = (degree > 2) & (ends > 0)
    staying = _staying(vertex, first, last) & (degree[vertex[first]] > 0)
    pieces = _cut(vertex, first[~staying], last[~staying], branching)
    return Joined(*_chained(pieces, (ends == 2) & ~branching), np.flatnonzero(branching))


def _within(size: int, first: Rows, last: Rows) -> Mask:
    """(n,) positions in runs without the last of each, those with a leaving edge."""
    step = np.zeros(size + 1, np.int64)
    step[first] += 1
    step[last] -= 1
    return np.asarray(np.cumsum(step)[:-1] > 0)


def _degrees(vertex: Rows, first: Rows, last: Rows, count: int) -> Rows:
    """Number of edges between different vertices at each vertex."""
    tail = np.flatnonzero(_within(len(vertex), first, last))
    tail = tail[vertex[tail] != vertex[tail + 1]]
    return np.asarray(np.bincount(vertex[tail], minlength=count) + np.bincount(vertex[tail + 1], minlength=count))


def _staying(vertex: Rows, first: Rows, last: Rows) -> Mask:
    """(records,) mask of the records with several indices, all equal."""
    moved = np.concatenate([[0], np.cumsum(vertex[1:] != vertex[:-1])])
    return np.asarray((last > first) & (moved[last] == moved[first]))


def _cut(vertex: Rows, first: Rows, last: Rows, branching: Mask) -> _Chains:
    """Cut records at branching vertices in their interior."""
    inner = _within(len(vertex), first, last)
    inner[first] = False
    at = np.flatnonzero(inner & branching[vertex])
    closed = vertex[first] == vertex[last]
    at = at[~closed[np.searchsorted(first, at, side="right") - 1]]
    order = np.argsort(np.concatenate([first, at]), kind="stable")
    begin, end = np.concatenate([first, at])[order], np.sort(np.concatenate([last, at]))
    return _Chains(vertex, begin, end, np.concatenate([closed, np.zeros(len(at), bool)])[order] & (end > begin))


def _chained(pieces: _Chains, joins: Mask) -> tuple[Rows, Rows, Mask]:
    """Chain pieces to curves: vertices, starts and flags of closed curves. joins: vertices that join two pieces."""
    count = len(pieces.first)
    end = pieces.vertex[np.concatenate([pieces.first, pieces.last])]
    apart = end[:count] != end[count:]
    joined = np.flatnonzero(joins[end] & np.tile(apart, 2))
    order = joined[np.argsort(end[joined], kind="stable")]
    partner = np.full(2 * count, -1)
    partner[order[::2]], partner[order[1::2]] = order[1::2], order[::2]
    single = np.flatnonzero(pieces.closed)
    partner[single], partner[count + single] = count + single, single
    # Piece e arrives at end count + e, against its direction at end e; from end x directed piece x leaves.
    mate = np.concatenate([partner[count:], partner[:count]])
    directed, start, closed = walk_directed(mate, np.zeros(count, bool))
    return _listed(pieces, directed, start, closed)


def _listed(pieces: _Chains, directed: Rows, start: Rows, closed: Mask) -> tuple[Rows, Rows, Mask]:
    """Concatenate the vertices of directed pieces, each without its last, which is kept at the end of open curves."""
    piece, backward = directed % len(pieces.first), directed >= len(pieces.first)
    sizes = pieces.last[piece] - pieces.first[piece]
    sizes[start[1:][~closed] - 1] += 1
    begin = np.concatenate([[0], np.cumsum(sizes)])
    step = np.arange(begin[-1]) - np.repeat(begin[:-1], sizes)
    origin = np.where(backward, pieces.last[piece], pieces.first[piece])
    place = np.repeat(origin, sizes) + step * np.repeat(np.where(backward, -1, 1), sizes)
    return pieces.vertex[place], begin[start], closed

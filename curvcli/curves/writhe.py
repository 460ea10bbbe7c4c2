"""Writhe: the Gauss integral of a polygon with itself, exact for every pair of edges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UsageError
from ..mesh.triangles import EPSILON
from ..support.arrays import Floats
from .plane import plane_curves
from .polygon import Curves, Rows
from .turning import Turning

MAX_EDGES = 20_000
"""Edges of the largest double sum by default: about ten seconds."""

UNSURE = 0.25
"""Turns: where the bound of the error is larger, no value is given, and no integer that follows from one."""

# A block of pairs whose temporaries stay in the second-level cache.
_ROWS, _COLUMNS = 16, 1024
# Curves of equal size up to so many edges are summed together.
_SMALL = 96
_TOGETHER = 1 << 15


def writhe(curves: Curves, max_edges: int | None = MAX_EDGES) -> tuple[Floats, Floats]:
    """Writhe of each curve in turns, and a bound of its rounding error; NaN where the bound exceeds a quarter.

    (1/4π) ∬ (T × T′)·(x − x′)/|x − x′|³: the number of crossings with their signs, averaged over all directions of
    view. For two edges the integral is the solid angle of the directions between them, a spherical quadrilateral,
    taken as two triangles by atan2 (Banchoff; Klenin–Langowski by another formula). Changes sign under reflection.
    As one edge passes through another it jumps by two. Half-way between is what two edges add that end in one point,
    and all edges of a curve that is plane to rounding: nothing. Other edges that meet leave an error of one turn.

    curves: in E³, open or closed, without repeated points. max_edges: the double sums are refused beyond this size:
    curves are taken from the smallest up while √Σ edges² ≤ max_edges; the others get NaN. None: no limit.
    Returns (m,) twice. Time is quadratic in the edges of a curve, memory linear.
    Errors: UsageError for other dimensions. Source: Sullivan, Curves; Fuller, The writhing number of a space curve.
    """
    if curves.dimension != 3:
        raise UsageError(f"the writhe needs curves in E^3, not in E^{curves.dimension}")
    chosen = within(curves.edges, max_edges)
    turns, error = np.full(len(curves), np.nan), np.full(len(curves), np.nan)
    xyz, _ = curves.local
    flat = chosen & plane_curves(Turning(curves)).plane
    turns[flat] = error[flat] = 0.0
    chosen &= ~flat
    for size in np.unique(curves.edges[chosen & (curves.edges <= _SMALL)]).tolist():
        alike = np.flatnonzero(chosen & (curves.edges == size))
        step = max(1, _TOGETHER // max(1, size * size))
        for begin in range(0, len(alike), step):
            some = alike[begin : begin + step]
            turns[some], error[some] = _small(_corners(curves, xyz, some, size))
    for curve in np.flatnonzero(chosen & (curves.edges > _SMALL)):
        corners = _corners(curves, xyz, np.array([curve]), int(curves.edges[curve]))[:, 0]
        turns[curve], error[curve] = _large(corners, bool(curves.closed[curve]))
    return np.where(error > UNSURE, np.nan, turns), error


def within(edges: Rows, max_edges: int | None) -> NDArray[np.bool_]:
    """(m,) mask of the curves with a double sum: from the smallest up while √Σ edges² ≤ max_edges."""
    if max_edges is None:
        return np.ones(len(edges), bool)
    order = np.argsort(edges, kind="stable")
    chosen = np.empty(len(edges), bool)
    chosen[order] = np.cumsum(edges[order].astype(np.float64) ** 2) <= float(max_edges) ** 2
    return chosen


def _corners(curves: Curves, xyz: Floats, chosen: Rows, edges: int) -> Floats:
    """(3, m, edges + 1) the corners of curves with that many edges, the first again at the end of closed ones."""
    position = np.arange(edges + 1)
    last = np.where(curves.closed[chosen], 0, edges)
    row = np.where(position < edges, position, last[:, None])
    return xyz[:, np.minimum(curves.start[chosen][:, None] + row, curves.size - 1)]


def _small(corners: Floats) -> tuple[Floats, Floats]:
    """Writhe of m curves of k edges, corners (3, m, k + 1)."""
    k = corners.shape[2] - 1
    pairs = edge_pairs(corners, corners)
    apart = np.broadcast_to(np.triu(np.ones((k, k), bool), 2), pairs.angle.shape).copy()
    # The first and the last edge meet where the curve is closed.
    apart[(corners[:, :, 0] == corners[:, :, -1]).all(axis=0), 0, k - 1] = False
    total, bound, crossings = pairs.summed(apart, axis=(1, 2))
    return total / (2 * np.pi), (16 + np.log2(k * k)) * EPSILON * bound / (2 * np.pi) + crossings


def _large(corners: Floats, closed: bool) -> tuple[float, float]:
    """Writhe of one curve of k edges, corners (3, k + 1), block by block of the pairs i + 1 < j."""
    k = corners.shape[1] - 1
    sums: list[tuple[Any, ...]] = []
    for i in range(0, k, _ROWS):
        rows = corners[:, None, i : min(i + _ROWS, k) + 1]
        for j in range(i, k, _COLUMNS):
            columns = corners[:, None, j : min(j + _COLUMNS, k) + 1]
            pairs, apart = edge_pairs(rows, columns), None
            if j < i + _ROWS + 2:
                apart = np.arange(j, j + columns.shape[2] - 1) > np.arange(i, i + rows.shape[2] - 1)[:, None] + 1
            if closed and i == 0 and j + columns.shape[2] - 1 == k:
                apart = np.ones(pairs.angle.shape[1:], bool) if apart is None else apart
                apart[0, -1] = False
            sums.append(pairs.summed(apart))
    total, bound, crossings = np.sum(sums, axis=0).tolist()
    return total / (2 * np.pi), (16 + np.log2(k * k)) * EPSILON * bound / (2 * np.pi) + crossings


@dataclass(frozen=True)
class _EdgePairs:
    """Pairs of edges, (m, r, c).

    angle: signed solid angle of the directions from the one edge to the other. condition: how much the angle changes
    per relative change of its terms. crossing: pairs that meet, to rounding, elsewhere than in a common end, so that
    the sign of their angle of 2π is lost; None where no pair does.
    """

    angle: Floats
    condition: Floats
    crossing: NDArray[np.bool_] | None

    def summed(self, apart: NDArray[np.bool_] | None, axis: tuple[int, ...] | None = None) -> tuple[Any, ...]:
        """Sums of the angles, of the conditions and of the crossings, over the pairs that are apart on the curve."""
        terms = (self.angle, self.condition, self.crossing)
        kept = terms if apart is None else [None if term is None else np.where(apart, term, 0) for term in terms]
        return tuple(0.0 if term is None else term.sum(axis) for term in kept)


def edge_pairs(corners: Floats, others: Floats) -> _EdgePairs:
    """Signed solid angle of the directions from each edge of `corners` to each of `others`, with its condition.

    corners: (3, m, r + 1), others: (3, m, c + 1). The sum of the two triangles' half-angles is the argument of
    (D₁ + iV)(D₂ + iV), V the triple product of the quadrilateral, D = abc + (a·b)c + (b·c)a + (c·a)b (Van Oosterom and
    Strackee).
    """
    span = [q[:, None, :] - p[:, :, None] for p, q in zip(corners, others, strict=True)]
    e = [np.diff(p)[:, :, None] for p in corners]
    f = [np.diff(q)[:, None, :] for q in others]
    norm = np.sqrt(span[0] * span[0] + span[1] * span[1] + span[2] * span[2])
    beside = sum(x[:, :, :-1] * x[:, :, 1:] for x in span)
    below = sum(x[:, :-1, :] * x[:, 1:, :] for x in span)
    across = sum(x[:, :-1, :-1] * x[:, 1:, 1:] for x in span)
    # From p_i: a to q_j, b to q_{j+1}; from p_{i+1}: d to q_j, c to q_{j+1}.
    a, b, d, c = norm[:, :-1, :-1], norm[:, :-1, 1:], norm[:, 1:, :-1], norm[:, 1:, 1:]
    ac = a * c
    first = (ac + across) * b + beside[:, :-1] * c + below[:, :, 1:] * a
    second = (ac + across) * d + below[:, :, :-1] * c + beside[:, 1:] * a
    x, y, z = (each[:, :-1, :-1] for each in span)
    volume = x * (e[2] * f[1] - e[1] * f[2]) + y * (e[0] * f[2] - e[2] * f[0]) + z * (e[1] * f[0] - e[0] * f[1])
    product = first * second
    # Directions between points of two edges lie in a plane beside the origin: the angle is less than 2π, as wide as a
    # hemisphere, and D₁ + D₂ is positive but for rounding, which would turn an angle near 2π into one near −2π.
    angle = 2 * np.arctan2(volume * np.maximum(first + second, 0.0), product - volume * volume)
    length = np.sqrt(e[0] ** 2 + e[1] ** 2 + e[2] ** 2) * np.sqrt(f[0] ** 2 + f[1] ** 2 + f[2] ** 2)
    # V is known to about ε |a||e||f|; below that it has no sign, and where edges meet the angle is that of its sign.
    lost = np.abs(volume) <= 8 * EPSILON * a * length
    angle[lost] = 0.0
    crossing = lost & (product <= 0) & (np.minimum(ac, b * d) > 0) if lost.any() else None
    size = np.sqrt(np.minimum(first * first, second * second) + volume * volume)
    with np.errstate(divide="ignore", invalid="ignore"):
        # V is known to that and D to about 8 ε |a||b||c|; D moves the angle by V / |D + iV| of that.
        condition = a * (length + 8 * c * (b + d) * np.abs(volume) / size) / size
    return _EdgePairs(angle, np.where(size > 0, condition, 0.0), crossing)

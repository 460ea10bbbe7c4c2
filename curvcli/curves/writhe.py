"""Writhe: the Gauss integral of a polygon with itself, exact for every pair of edges."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blocks import EPSILON
from ..errors import UsageError
from .polygon import Curves, Floats, Rows

MAX_EDGES = 20_000
"""Edges of the largest double sum that is done unless more is asked for: some ten seconds."""

# A block of pairs whose temporaries stay in the second-level cache.
_ROWS, _COLUMNS = 16, 1024
# Up to so many edges curves of equal size are summed together.
_SMALL = 96
_TOGETHER = 1 << 15


def writhe(curves: Curves, max_edges: int | None = MAX_EDGES) -> tuple[Floats, Floats]:
    """Writhe of each curve in turns, and a bound of its rounding error.

    (1/4π) ∬ (T × T′)·(x − x′)/|x − x′|³: the number of crossings with their signs, averaged over all directions of
    view. For two edges the integral is the solid angle of the directions between them, a spherical quadrilateral,
    taken as two triangles by atan2 (Banchoff; Klenin–Langowski by another formula). Changes sign under reflection.
    Where two edges meet it jumps by two as the one passes through the other, and half-way between is what they add:
    nothing, as all of a plane curve.

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
    # Two edges always lie in a plane.
    flat = chosen & (curves.edges < 3)
    turns[flat] = error[flat] = 0.0
    chosen &= ~flat
    for size in np.unique(curves.edges[chosen & (curves.edges <= _SMALL)]).tolist():
        alike = np.flatnonzero(chosen & (curves.edges == size))
        step = max(1, _TOGETHER // max(1, size * size))
        for begin in range(0, len(alike), step):
            some = alike[begin : begin + step]
            turns[some], error[some] = _small(_corners(curves, xyz, some, size))
    for one in np.flatnonzero(chosen & (curves.edges > _SMALL)):
        corners = _corners(curves, xyz, np.array([one]), int(curves.edges[one]))[:, 0]
        turns[one], error[one] = _large(corners, bool(curves.closed[one]))
    return turns, error


def within(edges: Rows, max_edges: int | None) -> NDArray[np.bool_]:
    """(m,) curves whose double sums are done: from the smallest up while √Σ edges² ≤ max_edges."""
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
    angle, error = _pairs(corners, corners)
    apart = np.triu(np.ones((k, k), bool), 2)
    # The first and the last edge meet where the curve is closed.
    meet = (corners[:, :, 0] == corners[:, :, -1]).all(axis=0)
    angle[meet, 0, k - 1] = error[meet, 0, k - 1] = 0.0
    total, bound = (np.where(apart, each, 0.0).sum(axis=(1, 2)) for each in (angle, error))
    return total / (2 * np.pi), (16 + np.log2(k * k)) * EPSILON * bound / (2 * np.pi)


def _large(corners: Floats, closed: bool) -> tuple[float, float]:
    """Writhe of one curve of k edges, corners (3, k + 1), block by block of the pairs i + 1 < j."""
    k = corners.shape[1] - 1
    sums: list[float] = []
    bounds: list[float] = []
    for i in range(0, k, _ROWS):
        rows = corners[:, None, i : min(i + _ROWS, k) + 1]
        for j in range(i, k, _COLUMNS):
            columns = corners[:, None, j : min(j + _COLUMNS, k) + 1]
            angle, error = _pairs(rows, columns)
            if j < i + _ROWS + 2:
                apart = np.arange(j, j + angle.shape[2]) > np.arange(i, i + angle.shape[1])[:, None] + 1
                angle, error = np.where(apart, angle, 0.0), np.where(apart, error, 0.0)
            if closed and i == 0 and j + angle.shape[2] == k:
                angle[0, 0, -1] = error[0, 0, -1] = 0.0
            sums.append(float(angle.sum()))
            bounds.append(float(error.sum()))
    bound = (16 + np.log2(k * k)) * EPSILON * float(np.sum(bounds))
    return float(np.sum(sums)) / (2 * np.pi), bound / (2 * np.pi)


def _pairs(one: Floats, other: Floats) -> tuple[Floats, Floats]:
    """(m, r, c) signed solid angle of the directions from each edge of `one` to each of `other`, and its condition.

    one: (3, m, r + 1) corners, other: (3, m, c + 1). The sum of the two triangles' half-angles is the argument of
    (D₁ + iV)(D₂ + iV), V the triple product of the quadrilateral, D = abc + (a·b)c + (b·c)a + (c·a)b (Van Oosterom and
    Strackee). The condition is how much the angle changes per relative change of its terms.
    """
    span = [q[:, None, :] - p[:, :, None] for p, q in zip(one, other, strict=True)]
    e = [np.diff(p)[:, :, None] for p in one]
    f = [np.diff(q)[:, None, :] for q in other]
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
    angle = 2 * np.arctan2(volume * (first + second), first * second - volume * volume)
    length = np.sqrt(e[0] ** 2 + e[1] ** 2 + e[2] ** 2) * np.sqrt(f[0] ** 2 + f[1] ** 2 + f[2] ** 2)
    # V is known to about ε |a||e||f|; below that it has no sign, and where edges meet the angle is that of its sign.
    angle[np.abs(volume) <= 8 * EPSILON * a * length] = 0.0
    size = np.sqrt(np.minimum(first * first, second * second) + volume * volume)
    with np.errstate(divide="ignore", invalid="ignore"):
        # V is known to that and D to about 8 ε |a||b||c|; D moves the angle by V / |D + iV| of that.
        condition = a * (length + 8 * c * (b + d) * np.abs(volume) / size) / size
    return angle, np.where(size > 0, condition, 0.0)

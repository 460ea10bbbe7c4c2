"""Ear clipping: triangulation of one simple polygon in the plane."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

EFFORT_PER_CORNER = 10_000
"""A usual effort, of which a glance at a corner takes 50 and a search for corners inside an ear 1000 and more."""
_ROUNDING = 2.0**-48


def clip_ears(p: NDArray[np.float64], most: int) -> tuple[NDArray[np.intp], bool, int]:
    """Triangulate a counter-clockwise polygon p (2, k): triangles (k - 2, 3), a flag, and the effort.

    The flag is true if p is simple and all triangles are ears. p has size 1. An ear is a convex corner whose
    triangle contains no other corner; only reflex corners between the left and the right end of the triangle are
    tested. An ear with a corner within rounding of its border is cut only if there is no better one. A polygon that
    crosses itself, or takes more than the given effort, is finished as a fan.
    """
    n = p.shape[1]
    x, y = p
    x_list, y_list = x.tolist(), y.tolist()
    before, after = [*range(-1, n - 1)], [*range(1, n + 1)]
    before[0], after[-1] = n - 1, 0

    def turn(a: int, b: int, c: int) -> float:
        ax, ay = x_list[a], y_list[a]
        return float((x_list[b] - ax) * (y_list[c] - ay) - (y_list[b] - ay) * (x_list[c] - ax))

    order = np.argsort(x, kind="stable")
    rank = np.empty(n, np.intp)
    rank[order] = np.arange(n)
    sorted_x, sorted_y = x[order], y[order]
    reflex = np.array([turn(before[b], b, after[b]) <= 0 for b in range(n)])[order]
    effort, margin = 0, _ROUNDING

    def is_ear(a: int, b: int, c: int) -> bool:
        nonlocal effort
        effort += 50
        if turn(a, b, c) <= margin:
            return False
        xs, ys = (x_list[a], x_list[b], x_list[c]), (y_list[a], y_list[b], y_list[c])
        lo, hi = np.searchsorted(sorted_x, (min(xs), np.nextafter(max(xs), np.inf))).tolist()
        near = lo + np.flatnonzero(reflex[lo:hi])
        effort += 1000 + hi - lo
        qx, qy = sorted_x[near], sorted_y[near]
        inside = np.ones(len(near), np.bool_)
        for i, j in ((0, 1), (1, 2), (2, 0)):
            inside &= (xs[j] - xs[i]) * (qy - ys[i]) - (ys[j] - ys[i]) * (qx - xs[i]) >= -margin
        for i in range(3):  # the corners themselves, and others at the same position: polygons that touch themselves
            inside &= (qx != xs[i]) | (qy != ys[i])
        return not inside.any()

    cut: list[tuple[int, int, int]] = []
    b, misses, left = 0, 0, n
    while left > 3 and effort <= most:
        if misses > left:
            if not margin:
                break
            misses, margin = 0, 0.0
        a, c = before[b], after[b]
        if not is_ear(a, b, c):
            b, misses = c, misses + 1
            continue
        cut.append((a, b, c))
        after[a], before[c] = c, a
        left, misses, margin = left - 1, 0, _ROUNDING
        reflex[rank[b]] = False
        for q in (a, c):
            reflex[rank[q]] = turn(before[q], q, after[q]) <= 0
        b = after[c]  # not c: cutting at every second corner leaves fewer slivers
    simple = left <= 3 and _turns_once(p)
    while left >= 3:
        cut.append((before[b], b, after[b]))
        after[before[b]], before[after[b]] = after[b], before[b]
        b, left = after[b], left - 1
    return np.array(cut, np.intp).reshape(-1, 3), simple, effort


def _turns_once(p: NDArray[np.float64]) -> bool:
    """Test whether the sum of the turning angles is 2π, as for every simple polygon."""
    step = np.roll(p, -1, 1) - p
    after = np.roll(step, -1, 1)
    angles = np.arctan2(step[0] * after[1] - step[1] * after[0], (step * after).sum(0))
    return bool(abs(angles.sum() - 2 * np.pi) < 1)

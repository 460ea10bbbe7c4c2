"""Geometry of simplices in E^d: orthonormal frames, conormals of the ridges, heights."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...mesh.triangles import EPSILON
from ...support.arrays import Floats, Ints
from .simplicial import odd


@dataclass(frozen=True)
class Frames:
    """Geometry of some n-simplices in E^d.

    frames: (C, n, d) orthonormal rows that span each simplex, right-handed with the order of its corners.
    inward: (C, n + 1, n) in these frames, the unit conormal of the ridge opposite each corner, towards that corner.
    stretch: (C,) longest edge over smallest height: the factor by which angles magnify rounding of the points.
    """

    frames: Floats
    inward: Floats
    stretch: Floats


def frames(points: Floats, simplices: Ints) -> Frames:
    """Frames by QR of the edges of each simplex's shortest tree, conormals as gradients of barycentric coordinates.

    Short edges are differences of neighbouring points, so that needles and flat simplices keep their digits. The
    gradients g_k solve g_k · (p_b − p_a) = [k = b] − [k = a] over the edges ab of the tree; 1 / |g_k| is a height.
    points: (V, d). simplices: (C, n + 1). Errors: InputError for a degenerate simplex, one whose smallest height is at
    most 4 n ε of its longest edge.
    """
    count, corners = simplices.shape
    n = corners - 1
    corner, parent, longest = _shortest_tree(points[simplices])
    each = np.arange(count)[:, None]
    edges = points[simplices[each, corner[:, 1:]]] - points[simplices[each, parent]]
    q, r = np.linalg.qr(edges.swapaxes(1, 2))
    sign = np.where(np.diagonal(r, axis1=1, axis2=2) < 0, -1.0, 1.0)
    # Each corner was added after its predecessor, so the tree's edges are oriented as the corners in that order.
    sign[odd(corner), -1] *= -1
    q, r = q * sign[:, None, :], r * sign[:, :, None]
    incidence = np.zeros((count, n, corners))
    which = np.arange(n)[None, :]
    incidence[each, which, corner[:, 1:]] = 1.0
    incidence[each, which, parent] = -1.0
    flat = (np.diagonal(r, axis1=1, axis2=2) == 0).any(axis=1)
    _refuse_degenerate(simplices, flat)
    gradient = np.linalg.solve(r.swapaxes(1, 2), incidence).swapaxes(1, 2)
    size = np.sqrt((gradient * gradient).sum(axis=2))
    stretch = longest * size.max(axis=1)
    _refuse_degenerate(simplices, ~(stretch * (4 * n * EPSILON) < 1))
    return Frames(np.ascontiguousarray(q.swapaxes(1, 2)), gradient / size[:, :, None], stretch)


def _shortest_tree(p: Floats) -> tuple[Ints, Ints, Floats]:
    """A shortest spanning tree of each simplex's corners p (C, n + 1, d), by Prim's rule in all of them at once.

    Returns the corners in the order in which they join, (C, n + 1); the corner each joins to, (C, n); longest edges.
    """
    count, corners, _ = p.shape
    each = np.arange(count)
    edge = p[:, :, None, :] - p[:, None, :, :]
    square = (edge * edge).sum(axis=3)
    longest = np.sqrt(square.max(axis=(1, 2)))
    joined, parents = np.zeros((count, corners), np.int64), np.zeros((count, corners - 1), np.int64)
    nearest, distance = np.zeros((count, corners), np.int64), square[:, 0].copy()
    distance[:, 0] = np.inf
    outside = np.ones((count, corners), bool)
    outside[:, 0] = False
    for step in range(1, corners):
        new = np.argmin(np.where(outside, distance, np.inf), axis=1)
        joined[:, step], parents[:, step - 1] = new, nearest[each, new]
        outside[each, new] = False
        closer = square[each, new] < distance
        distance = np.where(closer, square[each, new], distance)
        nearest = np.where(closer & outside, new[:, None], nearest)
    return joined, parents, longest


def _refuse_degenerate(simplices: Ints, flat: NDArray[np.bool_]) -> None:
    if flat.any():
        c = int(np.argmax(flat))
        corners = ", ".join(map(str, simplices[c].tolist()))
        raise InputError(
            f"({corners}) is degenerate: its corners lie in a plane of lower dimension",
            place=f"simplex {c}",
            hint=f"{int(np.count_nonzero(flat))} such simplices; remove them or move their corners apart",
        )

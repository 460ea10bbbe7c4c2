"""Delaunay triangulations of random points on a flat torus."""

from __future__ import annotations

import numpy as np

from .model import FloatArray, IntArray, demand


def periodic_delaunay(points: FloatArray, period: tuple[float, float]) -> IntArray:
    """Counterclockwise triangles (2 V, 3) of points (V, 2) that repeat with the two periods along the axes.

    UsageError where the points are too few, or too unevenly spread, for a simplicial torus.
    """
    from scipy.spatial import Delaunay

    size = len(points)
    base = points % np.asarray(period)
    # Copies beyond each side, far enough that no circumcircle of a kept triangle reaches past them.
    margin = 12 * np.sqrt(period[0] * period[1] / size)
    copies, owners = [base], [np.arange(size)]
    for i in (-1, 0, 1):
        for j in (-1, 0, 1):
            if (i, j) != (0, 0):
                moved = base + np.array([i * period[0], j * period[1]])
                near = ((moved > -margin) & (moved < np.asarray(period) + margin)).all(axis=1)
                copies.append(moved[near])
                owners.append(np.flatnonzero(near))
    owner = np.concatenate(owners)
    plane = np.concatenate(copies)
    # In the plane scipy lists the corners counterclockwise.
    corners = Delaunay(plane).simplices
    # Of the copies of a triangle exactly one has its lowest-numbered corner among the points themselves.
    faces = owner[corners]
    lowest = np.take_along_axis(corners, faces.argmin(axis=1)[:, None], axis=1)[:, 0]
    kept = lowest < size
    faces = faces[kept]
    directed = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).astype(np.int64)
    key, back = directed[:, 0] * size + directed[:, 1], directed[:, 1] * size + directed[:, 0]
    closed = len(np.unique(key)) == len(key) == 6 * size and np.array_equal(np.sort(key), np.sort(back))
    demand(
        closed and len(np.unique(faces)) == size, "these random points do not make a torus; take more or another seed"
    )
    return np.ascontiguousarray(faces, np.int32)

"""Surface of a page: the whole surface, or one vertex of the file for each cell of a grid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...mesh.surface import Surface
from ...support.arrays import Index

# Relative gap allowed between the number of cells and its limit, and the most trials of the size of a cell.
_NEAR, _TRIES = 0.9, 8


@dataclass(frozen=True)
class Display:
    """Shown surface: vertices keep their positions, values are not averaged.

    vertices: (n,) indices in the file, ascending. faces: (m, 3), boundary, crowded: (k, 2), of indices in `vertices`;
    crowded are the edges where more than two faces meet. whole: true if every vertex and face is there.
    """

    vertices: Index
    faces: Index
    boundary: Index
    crowded: Index
    whole: bool


def whole(surface: Surface) -> Display:
    """Every vertex that a face uses, and every face."""
    vertices = np.flatnonzero(surface.referenced).astype(np.int32)
    place = np.zeros(surface.n_vertices, np.int32)
    place[vertices] = np.arange(len(vertices), dtype=np.int32)
    return _display(surface, vertices, place, place[surface.faces], whole=True)


def simplified(surface: Surface, most: int) -> Display:
    """At most `most` vertices: the first of the file in each cell of a grid stands for all in it.

    Faces whose corners collapse, and repeated ones, are left out. If almost no face is left, as for many small pieces,
    faces at equal steps are shown unchanged.
    """
    used = np.flatnonzero(surface.referenced).astype(np.int32)
    first, number = _cells(surface.xyz[:, used], most)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    vertices = used[first[order]]
    place = np.zeros(surface.n_vertices, np.int32)
    place[used] = rank[number]
    faces = place[surface.faces]
    faces = _distinct(faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)], len(vertices))
    if len(faces) < max(1, len(vertices) // 4):
        chosen = np.linspace(0, surface.n_faces - 1, max(1, most // 3)).astype(np.int64)
        vertices, corners = np.unique(surface.faces[np.unique(chosen)], return_inverse=True)
        place = np.full(surface.n_vertices, -1, np.int32)
        place[vertices] = np.arange(len(vertices), dtype=np.int32)
        faces = corners.reshape(-1, 3).astype(np.int32)
    return _display(surface, vertices, place, faces, whole=False)


def _display(surface: Surface, vertices: Index, place: Index, faces: Index, *, whole: bool) -> Display:
    lines = []
    for chosen in (surface.boundary_edges, surface.nonmanifold_edges):
        a, b = place[surface.edges.a[chosen]], place[surface.edges.b[chosen]]
        kept = (a != b) & (a >= 0) & (b >= 0)
        ends = np.stack([np.minimum(a, b), np.maximum(a, b)], axis=1)[kept]
        lines.append(ends if whole else np.unique(ends, axis=0))
    return Display(vertices, faces, lines[0], lines[1], whole)


def _cells(xyz: NDArray[np.float64], most: int) -> tuple[NDArray[Any], NDArray[Any]]:
    """First vertex of each occupied cell, and the cell of each vertex, for the finest grid within the limit."""
    low, high = xyz.min(axis=1), xyz.max(axis=1)
    extent = float((high - low).max()) or 1.0
    # A surface meets about 3 n² cells of a cube of n³: their number grows with the square of the resolution.
    finest = float(2**20)
    cells = min(np.sqrt(most / 3.0), finest)
    best = 1.0
    for _ in range(_TRIES):
        count = len(np.unique(_keys(xyz, low, extent, cells)))
        if count <= most:
            best = max(best, cells)
            if count >= _NEAR * most or cells >= finest:
                break
        cells = min(cells * np.sqrt(0.96 * most / count), finest)
    _, first, number = np.unique(_keys(xyz, low, extent, best), return_index=True, return_inverse=True)
    return first, number


def _keys(xyz: NDArray[np.float64], low: NDArray[np.float64], extent: float, cells: float) -> NDArray[np.int64]:
    place = np.minimum((xyz - low[:, None]) * (cells / extent), cells).astype(np.int64)
    side = int(cells) + 1
    key: NDArray[np.int64] = (place[0] * side + place[1]) * side + place[2]
    return key


def _distinct(faces: Index, n: int) -> Index:
    """Faces without those that have the corners of an earlier one."""
    low, high = faces.min(axis=1).astype(np.int64), faces.max(axis=1).astype(np.int64)
    middle = faces.sum(axis=1, dtype=np.int64) - low - high
    _, first = np.unique((low * n + middle) * n + high, return_index=True)
    return faces[np.sort(first)]

"""Borders between regions of faces: the vertices of several regions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..support.arrays import Index, Mask
from .groups import stable_order


def vertex_regions(faces: Index, face: Index, n_vertices: int) -> tuple[Index, Mask]:
    """(V,) the region of a face at each vertex, -1 where no face is, and the mask of the vertices of several regions.

    face: (F,) region of each face, -1 for none, which counts as a region.
    """
    label = np.full(n_vertices, -1, np.int32)
    corners = faces.T
    for corner in corners:
        label[corner] = face
    mixed = np.zeros(n_vertices, bool)
    for corner in corners:
        mixed[corner[label[corner] != face]] = True
    return label, mixed


def split_vertices(
    faces: Index, face: Index, label: Index, mixed: Mask, count: int
) -> tuple[NDArray[np.int64], Index, Index]:
    """A copy of each vertex for each region of its faces, region after region, each in ascending order.

    faces: (F, 3) those with a region. face: (F,) their regions. label, mixed: of `vertex_regions`, where faces may have
    the region -1. count: of the regions.
    Returns (n,) the vertex and (n,) the region of each copy, and (F, 3) the copy at each corner.
    """
    n_vertices = len(label)
    inner = np.flatnonzero((label >= 0) & ~mixed)
    inner = inner[stable_order(label[inner], count)]
    at = np.flatnonzero(mixed[faces])
    # The copies on borders are few: only they are sorted by region and vertex.
    key, inverse = np.unique(face[at // 3].astype(np.int64) * n_vertices + faces.ravel()[at], return_inverse=True)
    on_border = np.searchsorted(label[inner].astype(np.int64) * n_vertices + inner, key) + np.arange(len(key))
    inside = np.ones(len(inner) + len(key), bool)
    inside[on_border] = False
    vertex, region = np.empty(len(inside), np.int64), np.empty(len(inside), np.int32)
    vertex[inside], vertex[on_border] = inner, key % n_vertices
    region[inside], region[on_border] = label[inner], key // n_vertices
    copy = np.zeros(n_vertices, np.int32)
    copy[inner] = np.flatnonzero(inside)
    corners = copy[faces]
    corners.ravel()[at] = on_border[inverse]
    return vertex, region, corners

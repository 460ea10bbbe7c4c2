"""Sheets: a surface cut along its non-manifold edges and vertices, so that estimates use one sheet at a time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..support.arrays import Index
from .orientation import same_direction
from .surface import Surface
from .topology import Edges, faces_at, find_edges, label_graph, neighbouring_corners


def sheets(surface: Surface) -> Surface:
    """Cut a surface into a manifold by giving every fan of every patch its own vertex; the orientation is kept.

    Two faces of a patch are neighbours across an edge where the patch has exactly these two, in spite of other faces.
    The values on a sheet so depend on the faces of its patch alone. The first fan of a vertex keeps its number, the
    others are appended: vertices with one fan keep their numbers and stars.
    """
    vertex, faces = _one_vertex_per_fan(surface)
    sign = surface.orientation.face_sign
    if sign is not None:
        faces[sign < 0] = faces[sign < 0][:, [0, 2, 1]]
    file = surface.file
    given = None if file is None else file.vertex_normals
    if file is not None and given is not None:
        normals = given.take(vertex, axis=1)
        if file.corner_normals is not None:
            # Normals given at corners are sums over all sheets at the vertex, and belong to none of them.
            normals[:, surface.nonmanifold[vertex]] = np.nan
        file = replace(file, corner_normals=normals)
    return Surface(surface.points[vertex], faces, file=file)


def on_single_fans(surface: Surface, columns_of_sheets: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """(V,) or (3, V) columns of the surface from those of its sheets: null or False at vertices of several fans."""
    columns = {}
    for name, column in columns_of_sheets.items():
        column = column[..., : surface.n_vertices].copy()
        column[..., surface.nonmanifold] = np.nan if column.dtype.kind == "f" else 0
        column.setflags(write=False)
        columns[name] = column
    return columns


def _one_vertex_per_fan(surface: Surface) -> tuple[NDArray[np.intp], Index]:
    """The old vertex of every new one, and the faces with new indices."""
    chosen = faces_at(surface.faces, surface.nonmanifold)
    near = surface.faces[chosen]
    edges = find_edges(near, surface.n_vertices)
    inner, crowded = edges.pairs, _pairs_of_patches(surface, chosen, edges)
    both = (np.concatenate(sides) for sides in zip(inner, crowded, strict=True))
    _, label = label_graph(near.size, *neighbouring_corners(near, *both))
    corner = np.flatnonzero(surface.nonmanifold[near.ravel()])
    _, first, fan = np.unique(label[corner], return_index=True, return_inverse=True)
    order = np.argsort(first)
    vertex = near.ravel()[corner[first[order]]]
    added = np.ones(len(vertex), bool)
    added[np.unique(vertex, return_index=True)[1]] = False
    number = np.empty(len(vertex), np.int32)
    number[order] = np.where(added, surface.n_vertices + np.cumsum(added) - 1, vertex)
    faces = surface.faces.copy()
    faces.reshape(-1)[3 * chosen[corner // 3] + corner % 3] = number[fan]
    return np.concatenate([np.arange(surface.n_vertices), vertex[added]]), faces


def _pairs_of_patches(surface: Surface, chosen: NDArray[np.intp], edges: Edges) -> tuple[Index, Index]:
    """Pairs of half-edges of the chosen faces at edges with n_e > 2 where a patch has exactly two faces.

    On an orientable patch the two half-edges must be opposite; other pairs stay cut open.
    """
    near, orientation = surface.faces[chosen], surface.orientation
    crowded = np.flatnonzero(edges.valence > 2)
    half_edges = edges.half_edges(crowded)
    patch: Index = orientation.patch[chosen[half_edges // 3]]
    edge: NDArray[np.intp] = np.repeat(crowded, edges.valence[crowded])
    order = np.lexsort((patch, edge))
    count = np.unique(np.stack([edge, patch]), axis=1, return_counts=True)[1]
    start = (np.cumsum(count) - count)[count == 2]
    half_edge, twin = (half_edges[order[start + k]] for k in (0, 1))
    same = same_direction(near, half_edge, twin)
    if orientation.face_sign is not None:
        same ^= orientation.face_sign[chosen[half_edge // 3]] != orientation.face_sign[chosen[twin // 3]]
    kept = ~same | ~orientation.orientable[orientation.patch[chosen[half_edge // 3]]]
    return half_edge[kept], twin[kept]

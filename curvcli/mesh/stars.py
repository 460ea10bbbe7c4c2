"""Fans and boundary of all stars, by walks round every vertex.

The walks use the faces at each vertex only, and no edge is sorted: all vertices with the same number of faces are
walked round at once, in contiguous arrays.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ..support.arrays import Index, Mask
from ..support.blocks import LONG, slices
from .orientation import same_direction
from .topology import Edges, faces_at, find_edges, label_graph, neighbouring_corners

# Stars with more faces use the graph of corners, because the walk compares each face with each.
_WALK_LIMIT = 16
# Corners per block; smaller blocks spend more time in calls than in arithmetic.
_CORNERS = 65536


@dataclass(frozen=True)
class Stars:
    """The stars of all vertices.

    corner_count: (V,) number of faces. lowest: (V,) the lowest vertex of the star. split: (V,) mask of the stars with
    several fans of faces joined through edges with n_e = 2; ends of edges with n_e > 2 may be missing.
    coherent: no edge has two half-edges of the same direction, and so none has more than two faces.
    rim: half-edges of edges with one face, unordered; only some of them if not coherent.
    """

    corner_count: Index
    lowest: Index
    split: Mask
    coherent: bool
    rim: Index

    def __post_init__(self) -> None:
        for array in (self.corner_count, self.lowest, self.split, self.rim):
            array.setflags(write=False)


class _Walked(NamedTuple):
    """Vertices whose faces the walk does not prove to be one fan, and the boundary half-edges leaving the others."""

    undecided: NDArray[np.intp]
    rim: Index


def find_stars(faces: Index, vertices: int) -> Stars:
    """Compute the stars of all vertices. faces: (F, 3). vertices: number of rows."""
    corners = _by_vertex(faces, vertices)
    count = np.diff(corners.indptr)
    lowest = np.arange(vertices, dtype=np.int32)
    undecided, rim = count > _WALK_LIMIT, []
    for size, some in _by_face_count(count):
        walk = _walk(faces, corners, size, some, lowest)
        undecided[walk.undecided] = True
        rim.append(walk.rim)
    split, coherent = np.zeros(vertices, bool), True
    if undecided.any():
        chosen = faces_at(faces, undecided)
        near = faces[chosen]
        np.minimum.at(lowest, near.ravel(), np.repeat(near.min(axis=1), 3))
        edges = find_edges(near, vertices)
        coherent = not (edges.valence > 2).any() and not same_direction(near, *edges.pairs).any()
        split = undecided & _split_by_graph(near, edges, vertices)
        alone = edges.half_edges(np.flatnonzero(edges.valence == 1))
        alone = alone[undecided[near.ravel()[alone]]]  # all faces of the others need not be near
        rim.append((3 * chosen[alone // 3] + alone % 3).astype(np.int32))
    return Stars(count, lowest, split, coherent, np.concatenate(rim))


def _by_vertex(faces: Index, vertices: int) -> Any:
    """The corners by vertex: a sparse matrix with faces as row indices and positions of corners in them as data."""
    n = len(faces)
    place, start = np.empty(3 * n, np.int8), np.empty(n + 1, np.int32)
    corners = np.tile(np.arange(3, dtype=np.int8), min(n, LONG))
    start[n] = 3 * n
    for block in slices(n, LONG):
        place[3 * block.start : 3 * block.stop] = corners[: 3 * (block.stop - block.start)]
        start[block] = np.arange(3 * block.start, 3 * block.stop, 3, dtype=np.int32)
    return csr_array((place, faces.ravel(), start), shape=(n, vertices)).tocsc()


def _by_face_count(count: Index) -> Iterator[tuple[int, NDArray[np.intp]]]:
    """Yield blocks of vertices with equally many faces, and that number."""
    for size in np.flatnonzero(np.bincount(count)[1 : _WALK_LIMIT + 1]) + 1:
        vertices = np.flatnonzero(count == size)
        for part in slices(len(vertices), _CORNERS // int(size)):
            yield int(size), vertices[part]


def _walk(faces: Index, corners: Any, size: int, vertices: NDArray[np.intp], lowest: Index) -> _Walked:
    """Walk round vertices with equally many faces, from face to face across the edge that arrives at the vertex.

    Each face has one edge that leaves the vertex and one that arrives at it. In the next face the edge that leaves is
    the one that arrives in this face. The star is one fan if the walk meets all faces.
    """
    # Rows are positions in the star, for contiguous operands; bits stand for sets of positions.
    at = corners.indptr.take(vertices).astype(np.intp) + np.arange(size)[:, None]
    place = corners.data.take(at)
    first = corners.indices.take(at)
    first *= np.int32(3)
    after = place + np.int8(1)
    after -= 3 * (place == 2).view(np.int8)
    to = faces.ravel().take(first + after)
    origin = faces.ravel().take(first + (3 - place - after))
    lowest[vertices] = np.minimum(vertices, np.minimum(to.min(axis=0), origin.min(axis=0)))

    bit = np.left_shift(1, np.arange(size), dtype=np.uint8 if size <= 8 else np.uint16, casting="unsafe")
    next_face = np.bitwise_or.reduce((to[:, None] == origin).view(np.uint8) * bit[:, None, None], axis=0)
    every = np.bitwise_or.reduce(bit)
    begin = every ^ np.bitwise_or.reduce(next_face, axis=0)
    ends = begin != 0
    front = (begin & -begin) | ~ends
    met = front.copy()
    for _ in range(size - 1):
        front = np.bitwise_or.reduce(next_face * ((front & bit[:, None]) != 0), axis=0)
        met |= front
    # If two faces leave for one vertex, or arrive from one, a position has two bits, or the walk does not end.
    single = (next_face & (next_face - 1)) == 0
    fan = (met == every) & single.all(axis=0) & ((next_face == 0).any(axis=0) == ends)
    some = np.flatnonzero(fan & ends)
    row = np.argmax((begin[some] & bit[:, None]) != 0, axis=0)
    return _Walked(vertices[~fan], first[row, some] + place[row, some])


def _split_by_graph(faces: Index, edges: Edges, vertices: int) -> Mask:
    """`split` by connected components of corners, for any winding; right at vertices with all of their faces given."""
    _, label = label_graph(3 * len(faces), *neighbouring_corners(faces, *edges.pairs))
    vertex = faces.ravel()
    first = np.empty(vertices, np.int32)
    first[vertex] = label
    split = np.zeros(vertices, bool)
    split[vertex[label != first[vertex]]] = True
    return split

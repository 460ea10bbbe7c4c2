"""Which vertices have one fan of faces about them, and where the boundary is: by walking round every vertex.

Every edge is met at both its ends, so that the faces at each vertex are all that is looked at, and no edge is sorted:
all vertices with as many faces are walked round at once, in arrays that are read in order.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ..support.blocks import LONG, slices
from .orientation import same_direction
from .topology import Edges, Index, Mask, faces_at, find_edges, label_graph, neighbouring_corners

# Stars of more faces go through the graph of corners: here each face is compared with each.
_WALK_LIMIT = 16
# As many corners at a time: fewer, and calls cost more than what they do.
_CORNERS = 65536


@dataclass(frozen=True)
class Stars:
    """What the faces at each vertex say.

    corner_count: (V,) number of faces. lowest: (V,) the lowest vertex of the star. split: (V,) stars of more than one
    fan of faces joined through edges with n_e = 2; ends of edges with n_e > 2 may be missed.
    coherent: whether no two faces run along an edge the same way, so that no edge has more than two.
    rim: half-edges whose edge has no other face, in no order; only some of them if not coherent.
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
    """Vertices whose faces are not seen to be one fan, and the boundary half-edges that leave the others."""

    undecided: NDArray[np.intp]
    rim: Index


def find_stars(faces: Index, vertices: int) -> Stars:
    """Walk round all vertices."""
    corners = _by_vertex(faces, vertices)
    count = np.diff(corners.indptr)
    lowest = np.arange(vertices, dtype=np.int32)
    undecided, rim = count > _WALK_LIMIT, []
    for size, some in _alike(count):
        found = _walk(faces, corners, size, some, lowest)
        undecided[found.undecided] = True
        rim.append(found.rim)
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
    """The corners by vertex: a sparse matrix with the faces as row indices and the places of the corners as data."""
    n = len(faces)
    place, start = np.empty(3 * n, np.int8), np.empty(n + 1, np.int32)
    places = np.tile(np.arange(3, dtype=np.int8), min(n, LONG))
    start[n] = 3 * n
    for block in slices(n, LONG):
        place[3 * block.start : 3 * block.stop] = places[: 3 * (block.stop - block.start)]
        start[block] = np.arange(3 * block.start, 3 * block.stop, 3, dtype=np.int32)
    return csr_array((place, faces.ravel(), start), shape=(n, vertices)).tocsc()


def _alike(count: Index) -> Iterator[tuple[int, NDArray[np.intp]]]:
    """Vertices with equally many faces, some at a time, and how many."""
    for size in np.flatnonzero(np.bincount(count)[1 : _WALK_LIMIT + 1]) + 1:
        vertices = np.flatnonzero(count == size)
        for part in slices(len(vertices), _CORNERS // int(size)):
            yield int(size), vertices[part]


def _walk(faces: Index, corners: Any, size: int, vertices: NDArray[np.intp], lowest: Index) -> _Walked:
    """Walk round some vertices with equally many faces, from face to face across the edge that arrives at the vertex.

    Each face has one edge that leaves the vertex and one that arrives there: the next face is the one that leaves for
    where this one arrives from. It is one fan if this meets all faces and, at both ends of the boundary, ends.
    """
    # Rows are places in the star: operands are contiguous, and bits stand for sets of places.
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
    here = (begin & -begin) | ~ends
    met = here.copy()
    for _ in range(size - 1):
        here = np.bitwise_or.reduce(next_face * ((here & bit[:, None]) != 0), axis=0)
        met |= here
    # Where two faces leave for one vertex, or arrive from one, a place has two bits, or the walk has no end.
    single = (next_face & (next_face - 1)) == 0
    fan = (met == every) & single.all(axis=0) & ((next_face == 0).any(axis=0) == ends)
    some = np.flatnonzero(fan & ends)
    row = np.argmax((begin[some] & bit[:, None]) != 0, axis=0)
    return _Walked(vertices[~fan], first[row, some] + place[row, some])


def _split_by_graph(faces: Index, edges: Edges, vertices: int) -> Mask:
    """The same by connected components of corners, for any winding; right at vertices all of whose faces are there."""
    _, label = label_graph(3 * len(faces), *neighbouring_corners(faces, *edges.pairs))
    vertex = faces.ravel()
    first = np.empty(vertices, np.int32)
    first[vertex] = label
    split = np.zeros(vertices, bool)
    split[vertex[label != first[vertex]]] = True
    return split

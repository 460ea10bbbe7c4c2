"""How triangles hang together: edges, twins, fans and connected pieces, from the face list alone.

Half-edge 3 f + k runs from corner k to corner k + 1 (mod 3) of face f; its index is also that of its tail's corner.
Everything is counting and gathering over whole arrays, linear in the mesh.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

Index = NDArray[np.int32]
Mask = NDArray[np.bool_]

# Stars are walked corner by corner up to this many faces; the rare larger ones go through the corner graph.
_WALK_LIMIT = 64


@dataclass(frozen=True)
class Edges:
    """The edges of a face list, sorted by (a, b).

    a, b: (E,) ends, a < b. valence: (E,) number of faces n_e. order: (3F,) half-edges grouped by edge.
    start: (E + 1,) where each edge's half-edges begin in `order`.
    """

    a: Index
    b: Index
    valence: Index
    order: Index
    start: Index

    def __post_init__(self) -> None:
        for array in (self.a, self.b, self.valence, self.order, self.start):
            array.setflags(write=False)

    def __len__(self) -> int:
        return len(self.a)

    def half_edges(self, edges: Mask | Index) -> Index:
        """The first half-edge of each of the given edges (the only one on the boundary)."""
        return self.order[self.start[:-1][edges]]

    def pairs(self) -> tuple[Index, Index]:
        """The two half-edges of every edge with n_e = 2."""
        if (self.valence == 2).all():
            return self.order[::2], self.order[1::2]
        begin = self.start[:-1][self.valence == 2]
        return self.order[begin], self.order[begin + 1]


def ends(faces: Index) -> tuple[Index, Index]:
    """Tail and head of every half-edge, (3F,) each."""
    return faces.ravel(), faces.take([1, 2, 0], axis=1).ravel()


def find_edges(faces: Index, vertices: int) -> Edges:
    """Sort the half-edges by their ends with two counting sorts (the transposition of a sparse matrix is one)."""
    by_high = _by_high(faces, vertices)
    n = len(by_high.data)
    by_low = csr_array((by_high.indices, by_high.data, by_high.indptr), shape=(vertices, vertices)).tocsc()
    del by_high  # each array let go is memory that need not be touched for the first time
    high, order, rows = by_low.indices, by_low.data, by_low.indptr
    low = np.repeat(np.arange(vertices, dtype=np.int32), np.diff(rows))
    first = np.ones(n, bool)
    np.not_equal(high[1:], high[:-1], out=first[1:])
    first[1:] |= low[1:] != low[:-1]
    start = np.full(int(np.count_nonzero(first)) + 1, n, np.int32)
    start[:-1] = np.flatnonzero(first)
    return Edges(low[start[:-1]], high[start[:-1]], np.diff(start), order, start)


def _by_high(faces: Index, vertices: int) -> Any:
    """The half-edges sorted by their higher end: a sparse matrix of lower ends, a row for each half-edge."""
    tail, head = ends(faces)
    n = len(tail)
    low, high = np.minimum(tail, head), np.maximum(tail, head, out=head)
    return csr_array((low, high, np.arange(n + 1, dtype=np.int32)), shape=(n, vertices)).tocsc()


def find_twins(edges: Edges) -> Index:
    """(3F,) the other half-edge of each edge with n_e = 2, -1 on the boundary and where more than two faces meet."""
    twin = np.full(len(edges.order), -1, np.int32)
    one, other = edges.pairs()
    twin[one], twin[other] = other, one
    return twin


def label_graph(nodes: int, one: NDArray[np.integer], other: NDArray[np.integer]) -> tuple[int, Index]:
    """Number of connected components of an undirected graph, and the component of each node."""
    graph = csr_array((np.ones(len(one), np.int8), (one, other)), shape=(nodes, nodes))
    count, label = connected_components(graph, directed=False)
    return int(count), label


def vertex_components(edges: Edges, vertices: int) -> tuple[int, Index]:
    """Pieces connected by shared vertices; an unreferenced vertex is a piece of its own here.

    Every vertex points to its lowest neighbour if that is lower, and pointers are followed to their ends; the few
    vertices without a lower neighbour are left to be joined.
    """
    own = np.arange(vertices, dtype=np.int32)
    parent = own.copy()
    parent[edges.b[::-1]] = edges.a[::-1]  # edges are sorted by a: the lowest is written last
    while not np.array_equal(further := parent[parent], parent):
        parent = further
    lowest = np.flatnonzero(parent == own)
    number = own
    number[lowest] = np.arange(len(lowest), dtype=np.int32)
    piece = number[parent]
    one, other = piece[edges.a], piece[edges.b]
    across = np.flatnonzero(one != other)
    count, label = label_graph(len(lowest), one[across], other[across])
    return count, label[piece]


def renumber_by_lowest_member(label: Index, count: int) -> tuple[int, Index]:
    """Number labels 0, 1, … in the order of the lowest index that carries them; labels nobody carries vanish."""
    lowest = np.full(count, len(label), np.int64)
    np.minimum.at(lowest, label, np.arange(len(label)))
    order = np.argsort(lowest, kind="stable")
    used = int(np.count_nonzero(lowest < len(label)))
    new = np.empty(count, np.int32)
    new[order] = np.arange(count, dtype=np.int32)
    return used, new[label]


def neighbouring_corners(faces: Index, one: Index, other: Index) -> tuple[Index, Index]:
    """Pairs of corners at the same vertex on the two sides of each edge given by its two half-edges."""
    tail = faces.ravel()

    def next_corner(h: Index) -> Index:
        return h + np.where(h % 3 == 2, -2, 1).astype(np.int32)

    same_way = tail[one] == tail[other]
    at_tail = np.where(same_way, other, next_corner(other))
    at_head = np.where(same_way, next_corner(other), other)
    return np.concatenate([one, next_corner(one)]), np.concatenate([at_tail, at_head])


def split_stars(faces: Index, edges: Edges, twin: Index, consistent: bool, boundary_edges: Index) -> Mask:
    """(V,) vertices whose star is more than one fan of faces joined through edges with n_e = 2.

    boundary_edges: (V,) number of edges with n_e = 1 at each vertex. Unreferenced vertices count as one fan.
    """
    vertices = len(boundary_edges)
    corners = np.bincount(faces.ravel(), minlength=vertices)
    split: Mask = boundary_edges > 2
    if not consistent:
        return split | _split_by_graph(faces, edges, np.arange(len(faces), dtype=np.int32), vertices)
    # With one winding, turning counterclockwise about a vertex is a partial permutation of its corners: the star is one
    # fan exactly if the walk meets every corner. It starts at the clockwise end of the fan where there is one.
    turn = twin.reshape(-1, 3).take([2, 0, 1], axis=1).ravel()
    tail = faces.ravel()
    start = np.full(vertices, -1, np.int32)
    start[tail] = np.arange(len(tail), dtype=np.int32)
    open_corners = np.flatnonzero(twin < 0).astype(np.int32)
    start[tail[open_corners]] = open_corners
    active = np.flatnonzero(corners > 1)
    at, begin, length = start[active], start[active], corners[active]
    for step in range(1, _WALK_LIMIT):
        at = turn[at]
        stopped = (at < 0) | (at == begin)
        split[active[stopped]] = True
        going = (length > step + 1) & ~stopped
        if not going.all():
            active, at, begin, length = active[going], at[going], begin[going], length[going]
        if not len(active):
            return split
    large = np.zeros(vertices, bool)
    large[active] = True
    return split | (large & _split_by_graph(faces, edges, np.flatnonzero(large[faces].any(axis=1)), vertices))


def _split_by_graph(faces: Index, edges: Edges, chosen: NDArray[np.integer], vertices: int) -> Mask:
    """The same by connected components of corners, for any winding; right at vertices all of whose faces are chosen."""
    one, other = edges.pairs()
    if len(chosen) < len(faces):
        inside = np.zeros(len(faces), bool)
        inside[chosen] = True
        keep = inside[one // 3] & inside[other // 3]
        one, other = one[keep], other[keep]
    _, label = label_graph(3 * len(faces), *neighbouring_corners(faces, one, other))
    corner = (3 * chosen[:, None] + np.arange(3)).ravel()
    vertex = faces.ravel()[corner]
    first = np.empty(vertices, np.int32)
    first[vertex] = label[corner]
    split = np.zeros(vertices, bool)
    split[vertex[label[corner] != first[vertex]]] = True
    return split

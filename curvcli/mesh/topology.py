"""Edges, twins and connected components of triangles, from the face list alone.

Half-edge 3 f + k runs from corner k to corner k + 1 (mod 3) of face f; its index is also that of the corner at its
tail. All functions count and gather over whole arrays, in linear time.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from ..support.arrays import Index, Mask
from ..support.blocks import LONG, for_each, slices

# The first search uses one of so many faces; they nearly always join all pieces that can be joined.
_SAMPLE = 8


class InnerEdges(NamedTuple):
    """Some (n,) edges with n_e = 2, indices as intp for fast gathers and scatters.

    where: index of the edges. a, b: (n,) their ends. half_edge, twin: (n,) their two half-edges.
    """

    where: slice | NDArray[np.intp]
    a: NDArray[np.intp]
    b: NDArray[np.intp]
    half_edge: NDArray[np.intp]
    twin: NDArray[np.intp]


@dataclass(frozen=True)
class Edges:
    """The edges of a face list, sorted by (a, b).

    a, b: (E,) ends, a < b. order: (3F,) half-edges grouped by edge.
    starts: (E + 1,) first entry of each edge's half-edges in `order`; None if every edge has two.
    """

    a: Index
    b: Index
    order: Index
    starts: Index | None = None

    def __post_init__(self) -> None:
        for array in (self.a, self.b, self.order, self.starts):
            if array is not None:
                array.setflags(write=False)

    def __len__(self) -> int:
        return len(self.a)

    @cached_property
    def start(self) -> Index:
        """(E + 1,) first entry of each edge's half-edges in `order`."""
        start = np.arange(0, len(self.order) + 1, 2, dtype=np.int32) if self.starts is None else self.starts
        start.setflags(write=False)
        return start

    @cached_property
    def valence(self) -> Index:
        """(E,) number of faces n_e."""
        if self.starts is None:
            return np.broadcast_to(np.int32(2), len(self))  # a view without memory of its own
        valence = np.diff(self.starts)
        valence.setflags(write=False)
        return valence

    @cached_property
    def unpaired(self) -> NDArray[np.intp]:
        """(n,) indices of the edges with n_e ≠ 2."""
        edges = np.zeros(0, np.intp) if self.starts is None else np.flatnonzero(self.valence != 2)
        edges.setflags(write=False)
        return edges

    @cached_property
    def inner(self) -> slice | NDArray[np.intp]:
        """The edges with n_e = 2 as an index: (n,), or a slice of all edges."""
        if not len(self.unpaired):
            return slice(None)
        edges = np.flatnonzero(self.valence == 2)
        edges.setflags(write=False)
        return edges

    @cached_property
    def pairs(self) -> tuple[Index, Index]:
        """The two half-edges of every edge with n_e = 2, (n,) each."""
        paired = self.order
        if len(self.unpaired):
            kept = np.ones(len(paired), bool)
            kept[self._places(self.unpaired)] = False
            paired = paired[kept]
            paired.setflags(write=False)
        return paired[::2], paired[1::2]

    def inner_edges(self, block: slice) -> InnerEdges:
        """A block of the edges with n_e = 2; their number is that of `pairs`."""
        where = block if isinstance(self.inner, slice) else self.inner[block]
        both = self.a[where], self.b[where], self.pairs[0][block], self.pairs[1][block]
        return InnerEdges(where, *(np.ascontiguousarray(each, np.intp) for each in both))

    def half_edges(self, edges: NDArray[np.integer]) -> Index:
        """(Σ n_e,) all half-edges of the (n,) given edges, one edge after the other."""
        chosen: Index = self.order[self._places(edges)]
        return chosen

    def _places(self, edges: NDArray[np.integer]) -> NDArray[np.intp]:
        """Positions in `order` of all half-edges of the given edges, one edge after the other."""
        valence = self.valence[edges]
        before = np.cumsum(valence) - valence
        positions: NDArray[np.intp] = np.repeat(self.start[edges] - before, valence) + np.arange(valence.sum())
        return positions


def _ends(faces: Index) -> tuple[Index, Index]:
    """Tail and head of every half-edge, (3F,) each."""
    tail = faces.ravel()
    head = np.empty_like(tail)
    head[:-1] = tail[1:]
    head[2::3] = tail[::3]
    return tail, head


def ends_of(faces: Index, half_edges: NDArray[np.integer]) -> tuple[Index, Index]:
    """Tail and head of the (n,) given half-edges. faces: (F, 3)."""
    corners = faces.ravel()
    return corners.take(half_edges), corners.take(next_corner(half_edges))


def faces_at(faces: Index, chosen: Mask) -> NDArray[np.intp]:
    """(n,) indices of the faces with a corner among the chosen vertices. faces: (F, 3). chosen: (V,) mask."""
    result = [np.zeros(0, np.intp)]
    for block in slices(len(faces), LONG):
        a, b, c = (chosen.take(corner) for corner in faces[block].T)
        result.append(np.flatnonzero(a | b | c) + block.start)
    return np.concatenate(result)


def find_edges(faces: Index, vertices: int) -> Edges:
    """Sort the half-edges by their ends with two counting sorts (the transposition of a sparse matrix is one).

    faces: (F, 3). vertices: V.
    """
    by_high = _by_high(faces, vertices)
    n = len(by_high.data)
    by_low = csr_array((by_high.indices, by_high.data, by_high.indptr), shape=(vertices, vertices)).tocsc()
    high, order, rows = by_low.indices, by_low.data, by_low.indptr
    del by_high  # freed memory is reused and saves page faults
    first = np.ones(n, bool)
    np.not_equal(high[1:], high[:-1], out=first[1:])
    first[rows[rows < n]] = True
    count = int(np.count_nonzero(first))
    if 2 * count == n and first[::2].all():  # as on closed surfaces
        low_end = np.repeat(np.arange(vertices, dtype=np.int32), np.diff(rows) // 2)
        return Edges(low_end, high[::2].copy(), order)
    low_end, high_end = np.empty(count, np.int32), np.empty(count, np.int32)
    start = np.full(count + 1, n, np.int32)
    done = 0
    for block in slices(vertices, LONG):
        begin, end = rows[block.start], rows[block.stop]
        each = np.flatnonzero(first[begin:end])
        new = slice(done, done + len(each))
        low = np.repeat(np.arange(block.start, block.stop, dtype=np.int32), np.diff(rows[block.start : block.stop + 1]))
        low_end[new], high_end[new], start[new] = low.take(each), high[begin:end].take(each), each + begin
        done = new.stop
    return Edges(low_end, high_end, order, start)


def _by_high(faces: Index, vertices: int) -> Any:
    """The half-edges sorted by their higher end: a sparse matrix of lower ends, a row for each half-edge."""
    n = 3 * len(faces)
    low, high, start = np.empty(n, np.int32), np.empty(n, np.int32), np.empty(n + 1, np.int32)
    start[n] = n

    def sort_ends(block: slice) -> None:
        tail, head = _ends(faces[block])
        half_edges = slice(3 * block.start, 3 * block.stop)
        np.minimum(tail, head, out=low[half_edges])
        np.maximum(tail, head, out=high[half_edges])
        start[half_edges] = np.arange(half_edges.start, half_edges.stop, dtype=np.int32)

    for_each(slices(len(faces), LONG), sort_ends)
    return csr_array((low, high, start), shape=(n, vertices)).tocsc()


def find_twins(edges: Edges) -> Index:
    """(3F,) the twin of each half-edge across edges with n_e = 2; -1 at edges with n_e ≠ 2."""
    twin = np.full(len(edges.order), -1, np.int32)
    pairs = edges.pairs
    for block in slices(len(pairs[0]), LONG):
        half_edge, opposite = (np.ascontiguousarray(half_edges[block]) for half_edges in pairs)
        twin[half_edge.astype(np.intp)], twin[opposite.astype(np.intp)] = opposite, half_edge
    return twin


def label_graph(nodes: int, tail: NDArray[np.integer], head: NDArray[np.integer]) -> tuple[int, Index]:
    """Number of connected components of an undirected graph, and the component of each node."""
    graph = csr_array((np.ones(len(tail), np.int8), (tail, head)), shape=(nodes, nodes))
    count, label = connected_components(graph, directed=False)
    return int(count), label


def vertex_components(faces: Index, lowest: Index, referenced: Mask) -> tuple[int, Index]:
    """Number of components connected by shared vertices, and the component of each referenced vertex.

    lowest: (V,) the lowest vertex of each star.
    Every vertex points to its lowest neighbour if that is lower, and pointers are followed to their ends. The few
    roots, vertices without a lower neighbour, are then joined: first by some faces, then by the rest as needed.
    """
    parent, roots = lowest.copy(), []
    for block in slices(len(parent)):  # pointers lead down, to vertices with a final pointer
        pointers = parent[block]
        while not np.array_equal(further := parent.take(pointers), pointers):
            pointers[:] = further
        own = pointers == np.arange(block.start, block.stop, dtype=np.int32)
        roots.append(np.flatnonzero(own & referenced[block]) + block.start)
    ends = np.concatenate(roots)
    count, number = len(ends), np.zeros_like(parent)
    number[ends] = np.arange(count, dtype=np.int32)
    piece = number.take(parent)
    for step in (_SAMPLE, 1):
        if count == 1:
            break
        across = [np.zeros((2, 0), np.int32)]
        for block in slices(len(faces), LONG * step):
            a, b, c = (piece.take(corner) for corner in faces[block][::step].T)
            for tail, head in ((a, b), (b, c)):
                apart = np.flatnonzero(tail != head)
                across.append(np.stack([tail.take(apart), head.take(apart)]))
        count, label = label_graph(count, *np.concatenate(across, axis=1))
        piece = label.take(piece)
    return count, piece


def renumber_by_lowest_member(label: Index, count: int) -> tuple[int, Index]:
    """Renumber labels 0, 1, … in the order of their first member; unused labels vanish.

    label: (n,) below count. Returns the number of labels and the new label of each member.
    """
    lowest = np.full(count, len(label), np.int64)
    np.minimum.at(lowest, label, np.arange(len(label)))
    order = np.argsort(lowest, kind="stable")
    used = int(np.count_nonzero(lowest < len(label)))
    new = np.empty(count, np.int32)
    new[order] = np.arange(count, dtype=np.int32)
    return used, new[label]


def next_corner(half_edges: NDArray[np.integer]) -> NDArray[np.integer]:
    """(n,) next half-edge of the same face, which is also the next corner."""
    # numpy's integer division is several times faster than its remainder.
    first = half_edges // 3 * 3
    following: NDArray[np.integer] = half_edges + 1 - 3 * (half_edges == first + 2).astype(half_edges.dtype)
    return following


def previous_corner(half_edges: NDArray[np.integer]) -> NDArray[np.integer]:
    """(n,) previous half-edge of the same face, which is also the previous corner."""
    return half_edges + np.where(half_edges % 3 == 0, 2, -1).astype(half_edges.dtype)


def neighbouring_corners(faces: Index, half_edge: Index, twin_half_edge: Index) -> tuple[Index, Index]:
    """(2n,) pairs of corners at the same vertex on both sides of n edges, each given by its two half-edges."""
    tail = faces.ravel()
    same_way = tail[half_edge] == tail[twin_half_edge]
    at_tail = np.where(same_way, twin_half_edge, next_corner(twin_half_edge))
    at_head = np.where(same_way, next_corner(twin_half_edge), twin_half_edge)
    return np.concatenate([half_edge, next_corner(half_edge)]), np.concatenate([at_tail, at_head])

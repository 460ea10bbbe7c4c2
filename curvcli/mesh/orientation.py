"""Coherent orientation: patches, the sign of every face, and local orientations of stars."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..support.arrays import Index, Mask, Sign
from ..support.blocks import LONG, slices
from .topology import Edges, ends_of, label_graph, neighbouring_corners, renumber_by_lowest_member


@dataclass(frozen=True)
class Orientation:
    """The orientation of the faces of a surface for the computation.

    patch: (F,) patch of each face, numbered by lowest face; a patch is joined through edges with n_e = 2.
    orientable: (patches,). face_sign: (F,) +1 where the file's winding is kept, -1 where the face is turned; None when
    every face is kept. On a patch that is not orientable the file's winding is kept.
    """

    patch: Index
    orientable: Mask
    face_sign: Sign | None

    def __post_init__(self) -> None:
        for array in (self.patch, self.orientable, self.face_sign):
            if array is not None:
                array.setflags(write=False)

    @property
    def flipped(self) -> int:
        """Number of faces whose winding is turned for the computation."""
        return 0 if self.face_sign is None else int(np.count_nonzero(self.face_sign < 0))


def same_direction(faces: Index, half_edge: Index, twin: Index) -> Mask:
    """(n,) flags: two half-edges of one edge have the same direction, so that their faces disagree."""
    tail, same = faces.ravel(), np.empty(len(half_edge), bool)
    for block in slices(len(half_edge), LONG):
        np.equal(tail.take(half_edge[block]), tail.take(twin[block]), out=same[block])
    return same


def orient(faces: Index, edges: Edges) -> Orientation:
    """Propagate the winding of each patch's lowest face; a patch is orientable if its double cover falls in two."""
    half_edge, twin = edges.pairs
    disagree = same_direction(faces, half_edge, twin)
    face, neighbour = half_edge // 3, twin // 3
    n = len(faces)
    if not disagree.any():
        labels, patch = label_graph(n, face, neighbour)
        count, patch = renumber_by_lowest_member(patch, labels)
        return Orientation(patch, np.ones(count, bool), None)
    sheet = _double_cover(n, face, neighbour, disagree)
    # The two sheets over a patch carry one label where it is not orientable, two where it is.
    count, patch = renumber_by_lowest_member(np.minimum(sheet[:n], sheet[n:]), 2 * n)
    lowest = np.full(count, n, np.int64)
    np.minimum.at(lowest, patch, np.arange(n))
    orientable = sheet[lowest] != sheet[lowest + n]
    sign = np.where(orientable[patch] & (sheet[:n] != sheet[lowest[patch]]), -1, 1).astype(np.int8)
    return Orientation(patch, orientable, sign if (sign < 0).any() else None)


def orient_stars(faces: Index, edges: Edges) -> Sign:
    """(F, 3) a sign for each corner that orients the star of its vertex alone, starting from the star's lowest corner.

    A Möbius strip has no global normal, but every star with one fan has a local one; it defines all quantities that are
    even in the normal.
    """
    half_edge, twin = edges.pairs
    disagree = np.tile(same_direction(faces, half_edge, twin), 2)
    corner, neighbour = neighbouring_corners(faces, half_edge, twin)
    n = 3 * len(faces)
    sheet = _double_cover(n, corner, neighbour, disagree)
    vertex = faces.ravel()
    lowest = np.full(int(vertex.max()) + 1, n, np.int64)
    np.minimum.at(lowest, vertex, np.arange(n))
    sign = np.where(sheet[:n] == sheet[lowest[vertex]], 1, -1)
    return sign.astype(np.int8).reshape(-1, 3)


def edge_directions(faces: Index, half_edges: Index, orientation: Orientation) -> Sign:
    """(n,) +1 where the oriented face runs along its half-edge from the lower end to the higher, else -1."""
    tail, head = ends_of(faces, half_edges)
    way = np.where(tail < head, 1, -1).astype(np.int8)
    if orientation.face_sign is not None:
        way *= np.repeat(orientation.face_sign, 3)[half_edges]
    return way


class Uncancelled(NamedTuple):
    """Edges with unequally many half-edges of oriented faces in the two directions.

    a, b: (n,) their ends. surplus: (n,) half-edges from a to b less those from b to a.
    """

    a: Index
    b: Index
    surplus: NDArray[np.int32]


def uncancelled(faces: Index, edges: Edges, orientation: Orientation, consistent: bool) -> Uncancelled:
    """The edges whose oriented half-edges do not cancel.

    faces: (F, 3). edges: all edges of the faces.
    consistent: no edge with n_e = 2 has two half-edges of the same direction.
    """
    if consistent and orientation.face_sign is None:
        # Two coherent faces cancel: a surplus remains only at edges with n_e ≠ 2.
        edge = edges.unpaired
        half_edges = edges.half_edges(edge)
    else:
        edge, half_edges = np.arange(len(edges)), edges.order
    if not len(edge):
        return Uncancelled(edges.a[edge], edges.b[edge], np.zeros(0, np.int32))
    valence, way = edges.valence[edge], edge_directions(faces, half_edges, orientation)
    surplus = np.add.reduceat(way, np.cumsum(valence) - valence, dtype=np.int32)
    left = np.flatnonzero(surplus)
    return Uncancelled(edges.a[edge[left]], edges.b[edge[left]], surplus[left])


def uncancelled_rim(faces: Index, rim: Index, orientation: Orientation) -> Uncancelled:
    """`uncancelled` for coherent (F, 3) faces. rim: (n,) half-edges of the edges with n_e = 1."""
    tail, head = ends_of(faces, rim)
    surplus = edge_directions(faces, rim, orientation).astype(np.int32)
    return Uncancelled(np.minimum(tail, head), np.maximum(tail, head), surplus)


def closed_patches(faces: Index, edges: Edges, orientation: Orientation) -> Mask:
    """(patches,) flag: each edge of the patch has exactly two of its own faces, with opposite half-edges."""
    closed = np.ones(len(orientation.orientable), bool)
    odd = edges.unpaired
    if len(odd):
        half_edges, edge = edges.half_edges(odd), np.repeat(odd, edges.valence[odd])
        key = edge * len(closed) + orientation.patch[half_edges // 3].astype(np.int64)
        key, where, count = np.unique(key, return_inverse=True, return_counts=True)
        unbalanced = (count != 2) | (np.bincount(where, edge_directions(faces, half_edges, orientation)) != 0)
        closed[(key % len(closed))[unbalanced]] = False
    return closed


def _double_cover(nodes: int, tail: Index, head: Index, crossing: Mask) -> Index:
    """Components of the graph's double cover (nodes, then their copies); crossing edges change the sheet."""
    up, down = head + np.where(crossing, nodes, 0), head + np.where(crossing, 0, nodes)
    return label_graph(2 * nodes, np.concatenate([tail, tail + nodes]), np.concatenate([up, down]))[1]

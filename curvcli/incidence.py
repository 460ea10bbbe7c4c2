"""Incidence: what the faces alone say of edges, stars and the boundary, worked out once and on demand."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from .arrays import frozen
from .fans import split_stars
from .orientation import same_direction
from .topology import Edges, Index, Mask, ends_of, find_edges, label_graph, renumber_by_lowest_member


class Incidence:
    """Which edges, faces and vertices meet.

    faces: (F, 3) corners. n_vertices: rows of the file, unreferenced ones included.
    """

    faces: Index
    n_vertices: int

    @property
    def n_faces(self) -> int:
        """Triangles that are computed with."""
        return len(self.faces)

    @cached_property
    def corner_count(self) -> Index:
        """(V,) number of faces at each vertex."""
        return self.edges.corner_count

    @cached_property
    @frozen
    def referenced(self) -> Mask:
        """(V,) vertices that some face uses."""
        mask: Mask = self.corner_count > 0
        return mask

    @cached_property
    def edges(self) -> Edges:
        """Edges with their faces."""
        return find_edges(self.faces, self.n_vertices)

    @cached_property
    @frozen
    def degree(self) -> Index:
        """(V,) number of edges at each vertex."""
        # Each face has two edges at a corner, so the numbers n_e of the edges at a vertex add up to twice its faces:
        # only edges with another n_e than 2 make a difference.
        twice, odd = 2 * self.corner_count, self.edges.unpaired
        for end in (self.edges.a, self.edges.b):
            np.add.at(twice, end[odd], 2 - self.edges.valence[odd])
        return twice // np.int32(2)

    def _edge_ends(self, chosen: Mask) -> Index:
        """(V,) how many of the chosen edges end at each vertex."""
        count, edges = np.zeros(self.n_vertices, np.int32), np.flatnonzero(chosen)
        for end in (self.edges.a, self.edges.b):
            np.add.at(count, end[edges], np.int32(1))
        return count

    @cached_property
    @frozen
    def boundary_edges(self) -> Mask:
        """(E,) edges with n_e = 1."""
        mask: Mask = self.edges.valence == 1
        return mask

    @cached_property
    @frozen
    def boundary_degree(self) -> Index:
        """(V,) number of boundary edges at each vertex."""
        return self._edge_ends(self.boundary_edges)

    @cached_property
    @frozen
    def boundary(self) -> Mask:
        """(V,) boundary vertices: some edge there has n_e = 1."""
        mask: Mask = self.boundary_degree > 0
        return mask

    @cached_property
    @frozen
    def boundary_half_edges(self) -> Index:
        """Half-edges of the boundary edges, in edge order."""
        return self.edges.half_edges(np.flatnonzero(self.boundary_edges))

    @cached_property
    def boundary_loop_of(self) -> tuple[int, Index]:
        """Number of boundary curves and the curve of each boundary half-edge, joined at shared vertices."""
        half_edges = self.boundary_half_edges
        tail, head = ends_of(self.faces, half_edges)
        at, where = np.unique(np.concatenate([tail, head]), return_inverse=True)
        count, label = label_graph(len(at), where[: len(tail)], where[len(tail) :])
        return renumber_by_lowest_member(label[where[: len(tail)]], count) if len(at) else (0, half_edges)

    @cached_property
    @frozen
    def nonmanifold_edges(self) -> Mask:
        """(E,) edges with n_e > 2."""
        mask: Mask = self.edges.valence > 2
        return mask

    @cached_property
    @frozen
    def nonmanifold_ends(self) -> Mask:
        """(V,) ends of edges with n_e > 2."""
        mask: Mask = self._edge_ends(self.nonmanifold_edges) > 0
        return mask

    @cached_property
    @frozen
    def split_stars(self) -> Mask:
        """(V,) vertices whose star is not one fan and which are not the end of an edge with n_e > 2."""
        corners, boundary = self.corner_count, self.boundary_degree
        split = split_stars(self.faces, self.edges, corners, self.consistent_winding, boundary)
        return split & ~self.nonmanifold_ends

    @cached_property
    @frozen
    def nonmanifold(self) -> Mask:
        """(V,) vertices of status `nonmanifold`."""
        return self.split_stars | self.nonmanifold_ends

    @cached_property
    @frozen
    def interior(self) -> Mask:
        """(V,) vertices with one closed fan: neither on the boundary nor non-manifold nor unreferenced."""
        return self.referenced & ~self.boundary & ~self.nonmanifold

    @cached_property
    def is_manifold(self) -> bool:
        """Whether every n_e ≤ 2 and every star is one fan."""
        return not self.nonmanifold.any()

    @cached_property
    @frozen
    def winding_conflicts(self) -> Mask:
        """(E,) edges with n_e = 2 whose two faces run along them the same way in the file."""
        conflict = np.zeros(len(self.edges), bool)
        same = same_direction(self.faces, *self.edges.pairs)
        if same.any():
            conflict[self.edges.inner] = same
        return conflict

    @cached_property
    def consistent_winding(self) -> bool:
        """Whether the file's winding is coherent across every edge with n_e = 2."""
        return not self.winding_conflicts.any()

"""Incidence: edges, stars and boundary from the face list alone, computed on demand and cached."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ..support.arrays import Index, Mask
from .arrays import frozen
from .orientation import same_direction
from .stars import Stars, find_stars
from .topology import Edges, ends_of, find_edges, label_graph, renumber_by_lowest_member


class Incidence:
    """Incidence of edges, faces and vertices.

    faces: (F, 3) corners. n_vertices: rows of the file, unreferenced ones included.
    """

    faces: Index
    n_vertices: int

    @property
    def n_faces(self) -> int:
        """Number of triangles, without those with a repeated corner."""
        return len(self.faces)

    @cached_property
    def stars(self) -> Stars:
        """Stars of all vertices: face counts, fans and boundary, see `find_stars`."""
        return find_stars(self.faces, self.n_vertices)

    @cached_property
    def corner_count(self) -> Index:
        """(V,) number of faces at each vertex."""
        return self.stars.corner_count

    @cached_property
    def coherent(self) -> bool:
        """True if no edge has two half-edges of the same direction in the file, and so none has more than two faces."""
        return self.stars.coherent

    @cached_property
    @frozen
    def referenced(self) -> Mask:
        """(V,) mask of the vertices with at least one face."""
        mask: Mask = self.corner_count > 0
        return mask

    @cached_property
    def edges(self) -> Edges:
        """Edges with their faces."""
        return find_edges(self.faces, self.n_vertices)

    @cached_property
    def n_edges(self) -> int:
        """Number of edges, computed without the list of edges if no edge has more than two faces."""
        # Σ n_e = 3F, so that the number of edges follows from 3F and the edges with n_e ≠ 2.
        return (3 * self.n_faces + len(self.boundary_half_edges) - int(self._crowd.sum())) // 2

    @cached_property
    @frozen
    def _crowd(self) -> Index:
        """n_e − 2 of the edges with n_e > 2."""
        return np.zeros(0, np.int32) if self.coherent else self.edges.valence[self.nonmanifold_edges] - np.int32(2)

    @cached_property
    @frozen
    def degree(self) -> Index:
        """(V,) number of edges at each vertex."""
        # Each face has two edges at a corner: Σ n_e over the edges at a vertex is twice its number of faces.
        twice = 2 * self.corner_count + self.boundary_degree
        if len(self._crowd):
            for end in (self.edges.a, self.edges.b):
                np.subtract.at(twice, end[self.nonmanifold_edges], self._crowd)
        return twice // np.int32(2)

    @cached_property
    @frozen
    def boundary_edges(self) -> Mask:
        """(E,) mask of the edges with n_e = 1."""
        return self.edges.valence == 1 if len(self.boundary_half_edges) else np.zeros(self.n_edges, bool)

    @cached_property
    @frozen
    def boundary_degree(self) -> Index:
        """(V,) number of boundary edges at each vertex."""
        count = np.zeros(self.n_vertices, np.int32)
        for end in ends_of(self.faces, self.boundary_half_edges):
            np.add.at(count, end, np.int32(1))
        return count

    @cached_property
    @frozen
    def boundary(self) -> Mask:
        """(V,) mask of the boundary vertices: an edge at the vertex has n_e = 1."""
        mask: Mask = self.boundary_degree > 0
        return mask

    @cached_property
    @frozen
    def boundary_half_edges(self) -> Index:
        """(n,) half-edges of the boundary edges, in edge order."""
        if not self.coherent:
            return self.edges.half_edges(np.flatnonzero(self.edges.valence == 1))
        tail, head = ends_of(self.faces, self.stars.rim)
        return self.stars.rim[np.lexsort([np.maximum(tail, head), np.minimum(tail, head)])]

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
        """(E,) mask of the edges with n_e > 2."""
        return np.zeros(self.n_edges, bool) if self.coherent else self.edges.valence > 2

    @cached_property
    @frozen
    def nonmanifold_ends(self) -> Mask:
        """(V,) mask of the ends of edges with n_e > 2."""
        mask = np.zeros(self.n_vertices, bool)
        if not self.coherent:
            for end in (self.edges.a, self.edges.b):
                mask[end[self.nonmanifold_edges]] = True
        return mask

    @cached_property
    @frozen
    def split_stars(self) -> Mask:
        """(V,) mask of the vertices whose star has several fans, without the ends of edges with n_e > 2."""
        return self.stars.split & ~self.nonmanifold_ends

    @cached_property
    @frozen
    def nonmanifold(self) -> Mask:
        """(V,) mask of the vertices of status `nonmanifold`."""
        return self.split_stars | self.nonmanifold_ends

    @cached_property
    @frozen
    def interior(self) -> Mask:
        """(V,) mask of the vertices with one closed fan: neither boundary nor non-manifold nor unreferenced."""
        return self.referenced & ~self.boundary & ~self.nonmanifold

    @cached_property
    def is_manifold(self) -> bool:
        """True if every edge has n_e ≤ 2 and every star is one fan."""
        return not self.nonmanifold.any()

    @cached_property
    @frozen
    def winding_conflicts(self) -> Mask:
        """(E,) mask of the edges with n_e = 2 whose two half-edges have the same direction in the file."""
        conflict = np.zeros(self.n_edges, bool)
        if not self.coherent:
            conflict[self.edges.inner] = same_direction(self.faces, *self.edges.pairs)
        return conflict

    @cached_property
    def consistent_winding(self) -> bool:
        """True if the file's winding is coherent across every edge with n_e = 2."""
        return not self.winding_conflicts.any()

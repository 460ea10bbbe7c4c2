"""Boundary curves of a surface, as ordered vertices and half-edges."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import breadth_first_order

from ..mesh.surface import Surface
from ..mesh.topology import ends_of, label_graph, neighbouring_corners, next_corner
from ..support.arrays import Mask
from ..support.cache import cached
from .polygon import Curves, Rows


@dataclass(frozen=True)
class Walk:
    """The order of the boundary of a surface, without a reference to the surface.

    half_edge: (n,) the boundary half-edge that leaves each vertex of a curve, -1 at the end of an open
    one. forward: (n,) whether the curve runs along it as the file winds its face. vertex: (n,) vertex of the surface.
    start: (m + 1,) first vertex of each curve. closed: (m,).
    """

    fans: Fans
    half_edge: Rows
    forward: Mask
    vertex: Rows
    start: Rows
    closed: Mask


class Boundary:
    """The boundary of a surface as curves: `surface` and the arrays of `Walk`."""

    def __init__(self, surface: Surface, walk: Walk) -> None:
        self.surface, self.fans = surface, walk.fans
        self.half_edge, self.forward, self.vertex = walk.half_edge, walk.forward, walk.vertex
        self.start, self.closed = walk.start, walk.closed

    @cached_property
    def curves(self) -> Curves:
        """The curves in the file's unit of length."""
        return Curves(np.ascontiguousarray(self.surface.xyz_given[:, self.vertex]), self.start, self.closed)

    @cached_property
    def component(self) -> Rows:
        """(m,) component of the surface at each curve."""
        return self.surface.components.face[self.half_edge[self.start[:-1]] // 3].astype(np.int64)

    @cached_property
    def fan(self) -> Rows:
        """(n,) fan of faces at each vertex of a curve; at an open end, the fan of its only edge."""
        return self.fans.of_corners(self.corner)

    @cached_property
    def corner(self) -> Rows:
        """(n,) a corner at the vertex, in the face at the edge that leaves it (at an open end, arrives)."""
        half_edge = np.where(self.half_edge < 0, np.roll(self.half_edge, 1), self.half_edge)
        at_tail = self.forward == (self.half_edge >= 0)
        return np.where(at_tail, half_edge, next_corner(half_edge))


class Fans:
    """Fans of faces at boundary vertices: runs of faces joined through edges with n_e = 2.

    A fan that is a whole star has the number of its vertex; the fans of other vertices are numbered from V on.
    """

    def __init__(self, surface: Surface) -> None:
        self.faces, self.n_vertices = surface.faces, surface.n_vertices
        self.irregular = surface.nonmanifold & surface.boundary
        self.count = surface.n_vertices
        if not self.irregular.any():
            return
        faces = surface.faces
        half_edge, twin = surface.edges.pairs
        near = np.logical_or(*(self.irregular[end] for end in ends_of(faces, half_edge)))
        corner, neighbour = neighbouring_corners(faces, half_edge[near], twin[near])
        self._corners = np.flatnonzero(self.irregular[faces.ravel()])
        inside = self.irregular[faces.ravel()[corner]]
        pairs = (np.searchsorted(self._corners, each[inside]) for each in (corner, neighbour))
        extra, self._label = label_graph(len(self._corners), *pairs)
        self.count += extra

    def of_corners(self, corner: Rows) -> Rows:
        """The fan of each corner (3 f + k)."""
        vertex = self.faces.ravel()[corner].astype(np.int64)
        split = self.irregular[vertex]
        if split.any():
            vertex[split] = self.n_vertices + self._label[np.searchsorted(self._corners, corner[split])]
        return vertex


def boundary_loops(surface: Surface) -> Boundary:
    """Order the boundary of a surface into curves, sorted by their lowest vertex; a closed curve starts at it.

    They run with the surface on their left, seen from the tip of ν; on a patch without an orientation as the file winds
    the face at the curve's first edge (a, b), the lowest. At a vertex of several fans each fan keeps its own
    boundary, so that curves pass through such vertices and stay closed; they end only at vertices where their fan runs
    into an edge with more than two faces, and are open then. Linear in the boundary.
    """
    return Boundary(surface, walk_boundary(surface))


@cached
def walk_boundary(surface: Surface) -> Walk:
    """Order the half-edges along the boundary curves, see `boundary_loops`."""
    half_edge = surface.boundary_half_edges.astype(np.int64)
    fans = Fans(surface)
    mate, forward = _mates(surface, fans, half_edge)
    first, second = _ends(surface, half_edge, forward)
    order, start, closed = walk_directed(mate, first > second)
    edge, backward = order % max(len(half_edge), 1), order >= len(half_edge)
    along = forward[edge] != backward
    leaving = half_edge[edge]
    tail, head = _ends(surface, leaving, along)
    # An open curve has one more vertex than edges: the head of its last edge.
    last = start[1:][~closed]
    leaving = np.insert(leaving, last, -1)
    vertex = np.insert(tail, last, head[last - 1])
    along = np.insert(along, last, along[last - 1])
    start = start + np.concatenate([[0], np.cumsum(~closed)])
    return Walk(fans, leaving, along, vertex, start, closed)


def _ends(surface: Surface, half_edge: Rows, forward: Mask) -> tuple[Rows, Rows]:
    """First and second end of each half-edge in the direction of its curve."""
    tail, head = (end.astype(np.int64) for end in ends_of(surface.faces, half_edge))
    return np.where(forward, tail, head), np.where(forward, head, tail)


def _mates(surface: Surface, fans: Fans, half_edge: Rows) -> tuple[Rows, Mask]:
    """The successor of each directed boundary edge, and flags of edges directed as the file winds them.

    Directed edge e < B runs with the orientation, B + e against it; -1 where a curve ends.
    """
    count = len(half_edge)
    sign = surface.orientation.face_sign
    forward = np.ones(count, bool) if sign is None else sign[half_edge // 3] > 0
    after = next_corner(half_edge)
    tail, head = np.where(forward, half_edge, after), np.where(forward, after, half_edge)
    # Both ends of all edges, first the tails; two ends in one fan follow one another.
    fan = fans.of_corners(np.concatenate([tail, head]))
    order = np.argsort(fan, kind="stable")
    alike = np.flatnonzero(fan[order[1:]] == fan[order[:-1]])
    partner = np.full(2 * count, -1)
    partner[order[alike]], partner[order[alike + 1]] = order[alike + 1], order[alike]
    # End e < B is the tail of edge e, end B + e its head. Directed edge e arrives at end B + e, B + e at end e; from an
    # end x it is directed edge x that leaves, for both kinds alike.
    mate = np.concatenate([partner[count:], partner[:count]])
    return mate, forward


def walk_directed(mate: Rows, descending: Mask) -> tuple[Rows, Rows, Mask]:
    """Order directed edges along each curve: the edges, the start of each curve, and flags of closed curves.

    descending: (B,) edges from the higher to the lower vertex; a closed curve begins behind one.
    All curves are concatenated to one path, the end of each linked to the start of the next, so that one graph search
    orders all of them.
    """
    count = len(descending)
    if not count:
        return np.empty(0, np.int64), np.zeros(1, np.int64), np.empty(0, bool)
    if (mate[:count] < count).all() and not ((mate[count:] >= 0) & (mate[count:] < count)).any():
        mate = mate[:count]  # one orientation: no edge runs against it
    states = len(mate)
    tied = np.flatnonzero(mate >= 0)
    curves, label = label_graph(states, tied, mate[tied])
    lowest = np.full(curves, 2 * states)
    rank = 2 * (np.arange(states) % count) + (np.arange(states) >= count)
    np.minimum.at(lowest, label, rank)
    # Of the two directions of a curve, the one whose lowest edge follows the orientation.
    kept = np.flatnonzero(lowest % 2 == 0)
    kept = kept[np.argsort(lowest[kept])]
    lowest = lowest[kept] // 2
    number = np.full(curves, -1)
    number[kept] = np.arange(len(kept))
    curve = number[label]
    back = np.full(states, -1)
    back[mate[tied]] = tied
    first = np.full(len(kept), -1)
    opening = np.flatnonzero((back < 0) & (curve >= 0))
    first[curve[opening]] = opening
    closed = first < 0
    first[closed] = np.where(descending[lowest[closed]], mate[lowest[closed]], lowest[closed])
    return _thread(mate, back, curve, first, closed)


def _thread(mate: Rows, back: Rows, curve: Rows, first: Rows, closed: Mask) -> tuple[Rows, Rows, Mask]:
    """Order edges from successors, predecessors, curves (-1: left out), and the first edge of each curve."""
    used = curve >= 0
    onward = np.where(used, mate, -1)
    last = np.empty(len(first), np.int64)
    last[closed] = back[first[closed]]
    ending = np.flatnonzero(used & (mate < 0))
    last[curve[ending]] = ending
    onward[last[:-1]] = first[1:]
    onward[last[-1]] = -1
    tied = onward >= 0
    indptr = np.concatenate([[0], np.cumsum(tied)])
    graph = csr_array((np.ones(int(indptr[-1])), onward[tied], indptr), shape=(len(mate), len(mate)))
    order = breadth_first_order(graph, int(first[0]), return_predecessors=False).astype(np.int64)
    start = np.concatenate([[0], np.cumsum(np.bincount(curve[used], minlength=len(first)))])
    return order, start, closed

"""Separation of bodies that share vertices, edges or walls: an edge with 2k faces becomes k edges with two faces."""

from __future__ import annotations

import numpy as np

from ..support.arrays import Index, Ints
from .orientation import edge_directions
from .surface import Surface
from .topology import ends_of, label_graph, neighbouring_corners, previous_corner
from .triangles import EPSILON, cross, dot


def split_bodies(surface: Surface) -> Surface:
    """Give each body its own vertices, faces in the same order; a surface without n_e > 2 is returned as it is.

    At an edge with n_e > 2, two faces of one patch with opposite half-edges stay together. The other faces, sorted by
    their angle about the edge, are paired so that each pair encloses material. Edges with unequally many half-edges in
    the two directions stay as they are.
    """
    crowded = np.flatnonzero(surface.nonmanifold_edges)
    if not len(crowded):
        return surface
    edges = surface.edges
    half_edges = edges.half_edges(crowded)
    edge = np.repeat(np.arange(len(crowded)), edges.valence[crowded])
    way = edge_directions(surface.faces, half_edges, surface.orientation).astype(np.int64)
    mate = _of_one_patch(surface, half_edges, edge, way)
    left = np.flatnonzero(mate < 0)
    balanced = np.bincount(edge[left], way[left], minlength=len(crowded)) == 0
    left = left[balanced[edge[left]]]
    matches = _round(surface, half_edges[left], edge[left], way[left])
    mate[left[matches[0]]] = left[matches[1]]
    matched = np.flatnonzero(mate >= 0)
    pairs = [edges.pairs, (half_edges[matched], half_edges[mate[matched]])]
    # At all other edges a face stays with its neighbour.
    chained = np.flatnonzero((edge[1:] == edge[:-1]) & ~balanced[edge[1:]])
    pairs.append((half_edges[chained], half_edges[chained + 1]))
    corners = [neighbouring_corners(surface.faces, *(side.astype(np.int32) for side in both)) for both in pairs]
    count, label = label_graph(3 * surface.n_faces, *(np.concatenate(side) for side in zip(*corners, strict=True)))
    vertex = np.empty(count, np.int32)
    vertex[label] = surface.faces.ravel()
    return Surface(surface.points[vertex], label.reshape(-1, 3))


def _of_one_patch(surface: Surface, half_edges: Index, edge: Ints, way: Ints) -> Ints:
    """(n,) the opposite half-edge of the same patch at the same edge, if the patch has exactly two there, else -1."""
    patch = surface.orientation.patch[half_edges // 3]
    key, where, count = np.unique(edge * np.int64(surface.n_faces) + patch, return_inverse=True, return_counts=True)
    twice = (count == 2) & (np.bincount(where, way, minlength=len(key)) == 0)
    mine = np.flatnonzero(twice[where])
    order = mine[np.argsort(where[mine], kind="stable")].reshape(-1, 2)
    mate = np.full(len(half_edges), -1, np.int64)
    mate[order[:, 0]], mate[order[:, 1]] = order[:, 1], order[:, 0]
    return mate


def _round(surface: Surface, half_edges: Index, edge: Ints, way: Ints) -> tuple[Ints, Ints]:
    """Pairs of positions in a list of half-edges, sorted by edge, that have material between them.

    A face whose half-edge runs from the lower end to the higher has its normal towards growing angles: material ends
    there, and begins at a face with the opposite half-edge. Of coincident faces the ending one comes first.
    """
    if not len(half_edges):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    turn = _angles(surface, half_edges, edge)
    order = np.lexsort((half_edges, -way, turn, edge))
    edge, begins = edge[order], -way[order]
    start = np.flatnonzero(np.r_[True, edge[1:] != edge[:-1]])
    size = np.diff(np.append(start, len(edge)))
    open_ = np.cumsum(begins)  # the sum over each edge is 0
    # Start where no wedge is open: after the position with the fewest open wedges.
    least = np.repeat(np.minimum.reduceat(open_, start), size)
    place = np.arange(len(edge)) - np.repeat(start, size)
    first = np.minimum.reduceat(np.where(open_ == least, place, len(edge)), start) + 1
    place = (place - np.repeat(first, size)) % np.repeat(size, size)
    level = np.where(begins > 0, open_, open_ + 1)
    matched = order[np.lexsort((place, level, edge))].reshape(-1, 2)
    return matched[:, 0], matched[:, 1]


def _angles(surface: Surface, half_edges: Index, edge: Ints) -> Ints:
    """(n,) the rank of each half-edge's face by angle about its edge; angles within rounding have equal rank."""
    tail, head = ends_of(surface.faces, half_edges)
    a, b = np.minimum(tail, head), np.maximum(tail, head)
    apex = surface.faces.ravel()[previous_corner(half_edges)]
    start = np.flatnonzero(np.r_[True, edge[1:] != edge[:-1]])
    size = np.diff(np.append(start, len(edge)))
    along = surface.xyz[:, b] - surface.xyz[:, a]
    along /= np.sqrt(dot(along, along))
    out = surface.xyz[:, apex] - surface.xyz[:, a]
    out = out - dot(out, along) * along
    height = np.sqrt(dot(out, out))
    ahead = np.repeat(out[:, start], size, axis=1)
    angle = np.arctan2(dot(np.stack(cross(along, ahead)), out), dot(ahead, out))
    reach = np.abs(surface.xyz[:, np.stack([a, b, apex])]).max(axis=(0, 1))
    with np.errstate(divide="ignore"):
        error = 16 * EPSILON * (1 + reach / np.minimum(height, np.repeat(height[start], size)))
    angle = np.where(angle < -error, angle + 2 * np.pi, angle)
    order = np.lexsort((angle, edge))
    step = np.r_[True, (np.diff(angle[order]) > error[order][1:]) | (edge[order][1:] != edge[order][:-1])]
    rank = np.empty(len(order), np.int64)
    rank[order] = np.cumsum(step)
    return rank

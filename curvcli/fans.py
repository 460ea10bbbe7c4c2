"""Which vertices have one fan of faces about them: by walking round each, or by the graph of corners."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .slices import LONG, slices
from .topology import Edges, Index, Mask, find_twins, label_graph, neighbouring_corners, previous_corner

# Stars are walked corner by corner up to this many faces; the rare larger ones go through the corner graph.
_WALK_LIMIT = 64


def split_stars(faces: Index, edges: Edges, corner_count: Index, consistent: bool, boundary_edges: Index) -> Mask:
    """(V,) vertices whose star is more than one fan of faces joined through edges with n_e = 2.

    corner_count, boundary_edges: (V,) number of faces, and of edges with n_e = 1, at each vertex. Unreferenced vertices
    count as one fan; ends of edges with n_e > 2 may be missed.
    """
    vertices = len(corner_count)
    split: Mask = boundary_edges > 2
    if not consistent:
        return split | _split_by_graph(faces, edges, np.arange(len(faces), dtype=np.int32), vertices)
    # With one winding, turning counterclockwise about a vertex is a partial permutation of its corners: the star is one
    # fan exactly if the walk meets every corner. It starts at the clockwise end of the fan where there is one.
    turn, start = _turns(edges), np.full(vertices, -1, np.int32)
    tail = faces.ravel()
    for block in slices(len(tail), LONG):
        start[tail[block].astype(np.intp)] = np.arange(block.start, block.stop, dtype=np.int32)
    if len(edges.unpaired):
        clockwise_end = previous_corner(np.flatnonzero(turn < 0))
        start[tail[clockwise_end]] = clockwise_end
    large = np.zeros(vertices, bool)
    for block in slices(vertices, LONG):
        apart, longer = _walk(turn, start[block], corner_count[block])
        split[block][apart] = True
        large[block][longer] = True
    if not large.any():
        return split
    return split | (large & _split_by_graph(faces, edges, np.flatnonzero(large[faces].any(axis=1)), vertices))


def _turns(edges: Edges) -> Index:
    """(3F,) the corner next to each about its vertex, across the half-edge that arrives there; -1 if there is none."""
    turn = find_twins(edges)
    for block in slices(len(turn), 3 * LONG):
        twin = turn[block].copy()
        turn[block][1:], turn[block][::3] = twin[:-1], twin[2::3]
    return turn


def _walk(turn: Index, start: Index, corners: Index) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Of some vertices those where turning does not meet every corner, and those with too many corners to tell."""
    split = np.zeros(len(start), bool)
    active = np.flatnonzero(corners > 1)
    at, length = start.take(active), corners.take(active)
    begin = at
    for step in range(1, _WALK_LIMIT):
        if not len(active):
            break
        at = turn.take(at)
        # One corner alone is no fan, unless the surface ends on both its sides: there the walk would have begun.
        going = length > step + 2
        stopped = (at < 0) | (at == begin)
        if stopped.any():
            split[active[stopped]] = True
            going &= ~stopped
        left = np.flatnonzero(going)
        if len(left) < len(active):
            active, at, begin, length = active.take(left), at.take(left), begin.take(left), length.take(left)
    return np.flatnonzero(split), active


def _split_by_graph(faces: Index, edges: Edges, chosen: NDArray[np.integer], vertices: int) -> Mask:
    """The same by connected components of corners, for any winding; right at vertices all of whose faces are chosen."""
    one, other = edges.pairs
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

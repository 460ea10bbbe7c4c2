"""Common walls of bodies: coincident faces with opposite winding."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..support.cache import cached
from ..support.words import counted
from .counts import duplicate_faces
from .surface import Surface
from .topology import faces_at, label_graph

Pairs = NDArray[np.int64]


@cached
def facing_pairs(surface: Surface) -> Pairs:
    """(n, 2) pairs of faces with the same corners and opposite winding between two bodies, sorted by their lower face.

    At the rim of a wall at least two more faces meet, one of each body; a double-sided sheet is no wall.
    """
    pairs = _opposite(surface)
    if not len(pairs):
        return pairs
    corners = np.sort(surface.faces[pairs[:, 0]], axis=1).astype(np.int64)
    keys = np.concatenate([corners[:, i] * surface.n_vertices + corners[:, j] for i, j in ((0, 1), (0, 2), (1, 2))])
    edge, where, walls = np.unique(keys, return_inverse=True, return_counts=True)
    edges = surface.edges
    place = np.searchsorted(edges.a.astype(np.int64) * surface.n_vertices + edges.b, edge)
    others = edges.valence[place] - 2 * walls
    # Pairs that share an edge belong to one wall.
    pair = np.tile(np.arange(len(pairs)), 3)
    count, wall = label_graph(len(pairs) + len(edge), pair, len(pairs) + where)
    of_edge = wall[len(pairs) :]
    ends = np.bincount(of_edge, others >= 2, minlength=count) > 0
    ends &= np.bincount(of_edge, (walls == 1) & (others < 2), minlength=count) == 0
    result: Pairs = pairs[ends[wall[: len(pairs)]]]
    return result


def _opposite(surface: Surface) -> Pairs:
    """Pairs of faces with the same corners and opposite winding in the file; each face in one pair."""
    later = duplicate_faces(surface)
    if not len(later):
        return np.zeros((0, 2), np.int64)
    corner = np.zeros(surface.n_vertices, bool)
    corner[surface.faces[later]] = True
    chosen = faces_at(surface.faces, corner)
    chosen = chosen[corner[surface.faces[chosen]].all(axis=1)]
    faces = surface.faces[chosen]
    order = np.argsort(faces, axis=1)
    # The winding is the sign of the permutation that sorts the corners.
    even = (order[:, 1] - order[:, 0]) % 3 == 1
    ordered = np.sort(faces, axis=1)
    _, group = np.unique(ordered, axis=0, return_inverse=True)
    group = group.ravel()
    both = []
    for way in (even, ~even):
        rows = np.flatnonzero(way)
        rows = rows[np.argsort(group[rows], kind="stable")]
        start = np.r_[True, group[rows][1:] != group[rows][:-1]] if len(rows) else np.zeros(0, bool)
        rank = np.arange(len(rows)) - np.maximum.accumulate(np.where(start, np.arange(len(rows)), 0))
        both.append((rows, group[rows] * np.int64(len(chosen)) + rank))
    (ones, keys), (others, others_keys) = both
    _, here, there = np.intersect1d(keys, others_keys, assume_unique=True, return_indices=True)
    pairs = np.sort(np.stack([chosen[ones[here]], chosen[others[there]]], axis=1), axis=1)
    return np.asarray(pairs[np.argsort(pairs[:, 0])], np.int64)


def describe_walls(surface: Surface) -> str:
    """Describe the pairs of coincident faces with opposite winding; empty if there are none."""
    pairs = len(facing_pairs(surface))
    if not pairs:
        return ""
    return f"{counted(pairs, 'pair of coincident faces faces', 'pairs of coincident faces face')} each other: {WALL}"


WALL = "bodies with a common wall"

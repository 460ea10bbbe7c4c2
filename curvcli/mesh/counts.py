"""Counts and topology (χ, components, genus, loops) of groups of faces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..support.arrays import Ints, Mask
from ..support.blocks import slices
from ..support.cache import cached
from .groups import Groups
from .surface import Surface
from .triangles import by_corner
from .welding import position_keys, weld_exact


@dataclass(frozen=True)
class GroupCounts:
    """Counts and flags, (G,) each.

    Vertices and edges are those that faces of the group use, χ = V − E + F. closed: no boundary edge. manifold: at most
    two faces at an edge, one fan at a vertex. orientable: all its patches are. consistent_winding: two faces of an edge
    run along it in opposite ways, as oriented. balanced: the oriented half-edges of every edge cancel.
    """

    vertices: Ints
    edges: Ints
    faces: Ints
    euler_characteristic: Ints
    boundary_edges: Ints
    nonmanifold_edges: Ints
    nonmanifold_vertices: Ints
    closed: Mask
    manifold: Mask
    orientable: Mask
    consistent_winding: Mask
    balanced: Mask


@cached
def count_groups(surface: Surface, groups: Groups) -> GroupCounts:
    """Count vertices, edges, faces and defects of every group; χ, V and E count referenced vertices only."""
    vertices = groups.vertices.count_true(surface.referenced)
    # The group `whole` is taken from this surface, since the groups may come from another one.
    faces = np.array([surface.n_faces]) if groups.faces.label is None else groups.faces.members()
    boundary = groups.faces.count_of(surface.boundary_half_edges // 3)
    many = excess = conflicts = np.zeros(groups.count, np.int64)
    if not surface.coherent:
        lower, crowded = surface.edges.a, np.flatnonzero(surface.nonmanifold_edges)
        many = groups.vertices.count_of(lower[crowded])
        excess = groups.vertices.count_of(np.repeat(lower[crowded], surface.edges.valence[crowded] - 2))
    if not surface.coherent or _turned(surface) is not None:
        conflicts = groups.vertices.count_of(surface.edges.a[_winding_conflicts(surface)])
    # Σ n_e = 3F, so that the number of edges follows from 3F and the edges with n_e ≠ 2.
    edges = (3 * faces + boundary - excess) // 2
    split = groups.vertices.count_true(surface.split_stars)
    if surface.orientable:
        orientable = np.ones(groups.count, bool)
    else:
        orientable = ~groups.faces.any(~surface.orientation.orientable[surface.orientation.patch])
    return GroupCounts(
        vertices,
        edges,
        faces,
        vertices - edges + faces,
        boundary,
        many,
        split,
        boundary == 0,
        (many == 0) & (split == 0),
        orientable,
        conflicts == 0,
        groups.vertices.count_of(surface.uncancelled.a) == 0,
    )


def _turned(surface: Surface) -> Mask | None:
    """(F,) mask of the faces wound opposite to the file; None if there is none."""
    return None if surface.cut_from is None else surface.cut_from.turned


def _winding_conflicts(surface: Surface) -> Mask:
    """(E,) mask of the edges with n_e = 2 whose two half-edges have the same direction in the file."""
    turned = _turned(surface)
    if turned is None:
        return surface.winding_conflicts
    face, neighbour = (turned[half_edges // 3] for half_edges in surface.edges.pairs)
    conflict = surface.winding_conflicts.copy()
    conflict[surface.edges.inner] ^= face != neighbour
    return conflict


@dataclass(frozen=True)
class Classification:
    """Components per group, and their boundary loops, genus and crosscaps summed, (G,) each.

    boundary_loops, genus, crosscaps: NaN where that of a component is null: it is no manifold, or of the other kind.
    """

    components: Ints
    boundary_loops: NDArray[np.float64]
    genus: NDArray[np.float64]
    crosscaps: NDArray[np.float64]


def classify(surface: Surface, groups: Groups) -> Classification:
    """Classify the components that are manifolds: χ = 2 − 2g − loops if orientable, 2 − crosscaps − loops if not."""
    pieces = surface.components
    counts = count_groups(surface, pieces)
    loops = np.zeros(pieces.count)
    if len(surface.boundary_half_edges):
        number, loop_of = surface.boundary_loop_of
        component = np.empty(number, np.int64)
        component[loop_of] = pieces.face[surface.boundary_half_edges // 3]
        loops = np.bincount(component, minlength=pieces.count).astype(np.float64)
    loops[~counts.manifold] = np.nan
    missing = 2 - counts.euler_characteristic - loops
    first = np.unique(pieces.face, return_index=True)[1] if pieces.count > 1 else np.zeros(1, np.int64)
    group = groups.face[first]

    def summed(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(np.bincount(group, values, minlength=groups.count), np.float64)

    return Classification(
        np.bincount(group, minlength=groups.count),
        summed(loops),
        summed(np.where(counts.orientable, missing / 2, np.nan)),
        summed(np.where(counts.orientable, np.nan, missing)),
    )


@cached
def duplicate_vertices(surface: Surface) -> NDArray[np.int64]:
    """(n,) indices of the referenced vertices beyond the first at exactly the same position."""
    if surface.cut_from is not None:  # the cut surface has several vertices at one position
        original = surface.cut_from
        again = np.zeros(original.surface.n_vertices, bool)
        again[duplicate_vertices(original.surface)] = True
        return np.flatnonzero(again[original.vertex])
    shared = _shared_keys(lambda: position_keys(surface.xyz_given))
    suspects = np.flatnonzero(shared & surface.referenced)
    first, _ = weld_exact(surface.xyz_given[:, suspects])
    again = np.ones(len(suspects), bool)
    again[first] = False
    return suspects[again]


@cached
def duplicate_faces(surface: Surface) -> NDArray[np.int64]:
    """(n,) indices of the faces beyond the first with the same three corners in any order."""
    if surface.cut_from is not None and not len(duplicate_faces(surface.cut_from.surface)):
        return np.zeros(0, np.int64)
    suspects = np.flatnonzero(_shared_keys(lambda: _corner_keys(surface)))
    if not len(suspects):
        return suspects
    corners = np.sort(surface.faces[suspects], axis=1)
    order = np.lexsort(corners.T)
    again = (np.diff(corners[order], axis=0) == 0).all(axis=1)
    return np.sort(suspects[order[1:][again]])


def _corner_keys(surface: Surface) -> NDArray[np.uint64]:
    """(F,) hash of the set of corners of each face."""
    key = np.random.default_rng(0).integers(0, 2**63, surface.n_vertices, np.uint64)
    keys = np.empty(surface.n_faces, np.uint64)
    for block in slices(surface.n_faces):
        a, b, c = by_corner(surface.faces[block])
        keys[block] = key[a] + key[b] + key[c]
    return keys


def _shared_keys(make: Callable[[], NDArray[np.uint64]]) -> Mask:
    """Mask of the members with a repeated key; keys are sorted in place and recomputed only if any repeats."""
    ordered = make()
    ordered.sort()
    same = ordered[1:] == ordered[:-1]
    if not same.any():
        return np.zeros(len(ordered), bool)
    repeated = ordered[1:][same]
    del ordered
    return np.isin(make(), repeated)

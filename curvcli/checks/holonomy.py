"""Holonomy: parallel transport round a vertex rotates a vector by the curvature K."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mesh.groups import Groups
from ..mesh.surface import Surface
from ..mesh.topology import ends_of, find_twins, next_corner, previous_corner
from ..mesh.triangles import EPSILON, cross, dot
from ..support.arrays import Column, VectorColumn
from ..support.blocks import for_each, slices
from ..support.words import counted
from .base import IdentityValues, check

# Stars with more faces are left out: the walk takes one step per face.
LARGEST_STAR = 256


@check(
    gap="rotation − K_p (mod 2π)",
    applies="interior vertices of at most 256 faces, all of which have an area",
    bound="(16 + log₂n)ε · πn, n the most faces at a vertex: one rotation of a few ε per face",
    failure="K of a vertex is not the rotation that the faces round it make: an angle, or the order of the faces, is "
    "wrong there.",
    after="fenchel",
)
def holonomy(surface: Surface, groups: Groups, K: Column, unit_normal: VectorColumn) -> IdentityValues:
    """Carrying a tangent vector counterclockwise round p, across one edge after another, turns it by +K_p (mod 2π)."""
    count = surface.corner_count
    inside = surface.interior & ~np.isnan(K)
    walked = np.flatnonzero(inside & (count <= LARGEST_STAR))
    angle = _transport(surface, walked, unit_normal)
    gap = np.full(surface.n_vertices, np.nan)
    gap[walked] = np.abs(np.remainder(angle - K[walked] + np.pi, 2 * np.pi) - np.pi)
    # Each step has an error of a few ε, and K is a sum of as many angles of up to π.
    faces = np.where(inside, count, 0).astype(np.float64)
    most = groups.vertices.max(faces)
    tolerance = (16 + np.log2(np.maximum(most, 2.0))) * EPSILON
    tolerance = tolerance * np.pi * np.maximum(most, 1.0)
    residual = groups.vertices.max(gap)
    left_out = groups.vertices.count_true(inside & np.isnan(gap))

    def detail(g: int) -> str:
        rest = f"; {counted(int(left_out[g]), 'vertex', 'vertices')} not walked" if left_out[g] else ""
        return f"largest deviation of the rotation from K{rest}"

    outcome = IdentityValues(residual, np.zeros(groups.count), tolerance, detail=detail)
    outcome.exclude(np.isnan(residual), "no interior vertex whose faces all have an area")
    return outcome


def _transport(surface: Surface, vertices: NDArray[np.intp], unit_normal: VectorColumn) -> Column:
    """The rotation angle of parallel transport round each vertex; v keeps its components along and across each edge.

    The walk goes counterclockwise as the first face is wound; where a neighbour is wound the other way its normal is
    reversed, so that no orientation of the surface is needed.
    """
    tail = surface.faces.reshape(-1)
    twin = find_twins(surface.edges)
    start = np.full(surface.n_vertices, -1, np.int64)
    start[tail] = np.arange(len(tail))
    angle = np.empty(len(vertices))

    def walk(block: slice) -> None:
        corner, steps = start[vertices[block]], surface.corner_count[vertices[block]]
        upright = np.ones(len(corner))
        normal = unit_normal[:, corner // 3]
        begin = _direction(surface, corner)
        vector = begin.copy()
        active = np.arange(len(corner))
        for step in range(int(steps.max(initial=0))):
            active = active[steps[active] > step]
            old_corner, up = corner[active], upright[active]
            # The counterclockwise neighbour lies across the edge that enters the corner, or, for a reversed face,
            # across the edge that leaves it.
            edge = np.where(up > 0, previous_corner(old_corner), old_corner)
            across = twin[edge]
            same_way = tail[across] == tail[edge]
            starts_here = tail[across] == tail[old_corner]
            new_corner = np.where(starts_here, across, next_corner(across))
            span = _direction(surface, edge)
            before = up * unit_normal[:, old_corner // 3]
            up = np.where(same_way, -up, up)
            after = up * unit_normal[:, new_corner // 3]
            moving = vector[:, active]
            along, sideways = dot(moving, span), dot(moving, cross(before, span))
            vector[:, active] = along * span + sideways * np.array(cross(after, span))
            corner[active], upright[active] = new_corner, up
        angle[block] = np.arctan2(dot(cross(begin, vector), normal), dot(begin, vector))

    for_each(slices(len(vertices)), walk)
    return angle


def _direction(surface: Surface, half_edges: NDArray[np.integer[Any]]) -> VectorColumn:
    """Unit vectors along half-edges."""
    a, b = ends_of(surface.faces, half_edges)
    span = surface.xyz[:, b] - surface.xyz[:, a]
    square = dot(span, span)
    return span / np.sqrt(np.where(square > np.finfo(np.float64).tiny, square, np.nan))

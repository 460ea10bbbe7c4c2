"""Bobenko's conformal energy, from the intersection angles of circumcircles."""

from __future__ import annotations

import numpy as np

from ..mesh.surface import Surface
from ..mesh.topology import previous_corner
from ..mesh.triangles import cross, dot
from ..support.arrays import Column, Flags
from ..support.blocks import for_each, slices
from .edges import EDGES_PER_BLOCK
from .registry import curvature_pass
from .star import null_where


@curvature_pass(
    symbol="β_e",
    formula="atan2(|Im q|, −Re q), q = (a−c)(c−b)⁻¹(b−d)(d−a)⁻¹",
    on="edge",
    kind="angle",
    preserves="invariant under Möbius transformations",
    boundary="null; also where n_e ≠ 2",
    source="Sullivan, CMC and Willmore surfaces; Bobenko, A conformal energy for simplicial surfaces",
    after="kappa_across",
)
def beta(surface: Surface, degenerate_face: Flags) -> Column:
    """Exterior intersection angle of the circumcircles of the edge's two faces."""
    angle = np.full(len(surface.edges), np.nan)
    corners = surface.faces.reshape(-1)

    def meet(block: slice) -> None:
        edges = surface.edges.inner_edges(block)
        left, right = (corners.take(previous_corner(half_edges)) for half_edges in (edges.half_edge, edges.twin))
        a, b, c, d = (surface.xyz.take(vertex, axis=1) for vertex in (edges.a, edges.b, left, right))
        # Up to a positive factor q is the product of four imaginary quaternions, xy = −x·y + x × y.
        u, v, w, z = a - c, c - b, b - d, d - a
        s, t = -dot(u, v), -dot(w, z)
        p, q = cross(u, v), cross(w, z)
        pq = cross(p, q)
        imaginary = [s * y + t * x + xy for x, y, xy in zip(p, q, pq, strict=True)]
        angles = np.arctan2(np.sqrt(dot(imaginary, imaginary)), dot(p, q) - s * t)
        lost = degenerate_face.take(edges.half_edge // 3) | degenerate_face.take(edges.twin // 3)
        angle[edges.where] = np.where(lost, np.nan, angles)

    for_each(slices(len(surface.edges.pairs[0]), EDGES_PER_BLOCK), meet)
    return angle


@curvature_pass(
    symbol="W_p",
    formula="½ (Σ_{e at p} β_e − 2π)",
    total="willmore_conformal",
    preserves="invariant under Möbius transformations; 0 on meshes inscribed in a sphere with convex stars",
    boundary="null",
    source="Sullivan, CMC and Willmore surfaces; Bobenko, A conformal energy for simplicial surfaces",
    after="willmore_normal",
    total_after="willmore_normal",
)
def willmore_conformal(surface: Surface, beta: Column) -> Column:
    """Bobenko's conformal energy of the vertex, never negative.

    An inversion about p turns the circumcircles at p into the lines of a closed polygon, and β_e into its turning
    angles, whose sum is at least 2π (Fenchel). A sum below that is due to rounding, and its energy is 0.
    """
    total = np.zeros(surface.n_vertices)
    for block in slices(len(beta)):
        for ends in (surface.edges.a, surface.edges.b):
            np.add.at(total, ends[block].astype(np.intp), beta[block])
    return null_where(~surface.interior, np.maximum(0.5 * (total - 2 * np.pi), 0.0))

"""Bobenko's conformal energy: how far the circumcircles of a star are from touching like those of a sphere."""

from __future__ import annotations

import numpy as np

from ..blocks import cross, dot
from ..declare import Column, Flags, curvature_pass
from ..slices import slices
from ..surface import Surface
from ..threads import for_each
from .edges import EDGES_PER_BLOCK
from .star import null_where


@curvature_pass(
    symbol="β_e",
    formula="atan2(|Im q|, −Re q), q = (a−c)(c−b)⁻¹(b−d)(d−a)⁻¹",
    on="edge",
    kind="angle",
    preserves="invariant under Möbius transformations",
    boundary="null; also where n_e ≠ 2",
    source="Sullivan, CMC and Willmore surfaces; Bobenko, A conformal energy for simplicial surfaces",
)
def beta(surface: Surface, degenerate_face: Flags) -> Column:
    """Exterior intersection angle of the circumcircles of the edge's two faces."""
    angle = np.full(len(surface.edges), np.nan)
    inner = np.flatnonzero(surface.edges.valence == 2)
    corners = surface.faces.reshape(-1)

    def meet(block: slice) -> None:
        edges = inner[block]
        start = surface.edges.start[edges]
        sides = surface.edges.order[start], surface.edges.order[start + 1]
        a, b = (np.stack([x[end[edges]] for x in surface.xyz]) for end in (surface.edges.a, surface.edges.b))
        c, d = (surface.xyz[:, corners[h - h % 3 + (h + 2) % 3]] for h in sides)
        # Up to a positive factor q is the product of four imaginary quaternions, xy = −x·y + x × y.
        u, v, w, z = a - c, c - b, b - d, d - a
        s, t = -dot(u, v), -dot(w, z)
        p, q = cross(u, v), cross(w, z)
        pq = cross(p, q)
        imaginary = [s * y + t * x + xy for x, y, xy in zip(p, q, pq, strict=True)]
        found = np.arctan2(np.sqrt(dot(imaginary, imaginary)), dot(p, q) - s * t)
        lost = degenerate_face[sides[0] // 3] | degenerate_face[sides[1] // 3]
        angle[edges] = np.where(lost, np.nan, found)

    for_each(slices(len(inner), EDGES_PER_BLOCK), meet)
    return angle


@curvature_pass(
    symbol="W_p",
    formula="½ (Σ_{e at p} β_e − 2π)",
    total="willmore_conformal",
    preserves="invariant under Möbius transformations; 0 on meshes inscribed in a sphere with convex stars",
    boundary="null",
    source="Sullivan, CMC and Willmore surfaces; Bobenko, A conformal energy for simplicial surfaces",
)
def willmore_conformal(surface: Surface, beta: Column) -> Column:
    """Bobenko's conformal energy of the vertex, never negative."""
    total = np.zeros(surface.n_vertices)
    for ends in (surface.edges.a, surface.edges.b):
        np.add.at(total, ends, beta)
    return null_where(~surface.interior, 0.5 * (total - 2 * np.pi))

"""Dirichlet energy of the identity map against area, and their gradients."""

from __future__ import annotations

import numpy as np

from ..mesh.groups import Groups
from ..mesh.surface import Surface
from ..mesh.triangles import EPSILON, dot
from ..support.arrays import Column, Flags, VectorColumn
from ..support.words import format_rounded
from .base import IdentityValues, check, exclude_null, rounding


@check(
    gap="E(id) − area",
    applies="surfaces without degenerate faces, whose cotangents are undefined",
    bound="(16 + log₂N)ε · ¼Σ |opposite edge|²/sin θ over the corners; at each vertex (16 + faces)ε · ½Σ |e|/sin of "
    "the angle opposite e",
    failure="a cotangent weight is wrong. Needles weaken the test: the sines of their angles are small, and the bound "
    "is as large as their rounding.",
    after="first_variation",
)
def dirichlet(
    surface: Surface,
    groups: Groups,
    dirichlet: Column,
    dirichlet_gradient: VectorColumn,
    face_area: Column,
    star_curvature: VectorColumn,
    degenerate: Flags,
    dirichlet_terms: Column,
    dirichlet_gradient_terms: Column,
) -> IdentityValues:
    """E(id) = area and ∇_p E(id) = ∇_p area: the identity is harmonic where the surface is discrete minimal."""
    value, expected = groups.faces.sum(dirichlet), groups.faces.sum(face_area)
    tolerance = rounding(surface, groups.faces.sum(dirichlet_terms))
    gap = dirichlet_gradient + star_curvature
    # Each gradient is a running sum over the star, so that its bound grows with the number of faces.
    allowed = (16 + surface.corner_count) * EPSILON * dirichlet_gradient_terms
    with np.errstate(divide="ignore", invalid="ignore"):
        strain = np.where(allowed > 0, np.sqrt(dot(gap, gap)) / allowed, np.nan)
    lost = np.isnan(dirichlet_gradient).any(axis=0) | np.isnan(star_curvature).any(axis=0)
    strain[lost & surface.referenced & ~degenerate] = np.inf
    worst = groups.vertices.max(strain)

    def detail(g: int) -> str:
        share = format_rounded(worst[g], 2)
        return f"E(id) against the area; ∇_p E(id) differs from ∇_p area by at most {share} of what is allowed"

    # Both must hold: the residual includes the gradient's residual, scaled by the ratio of the bounds.
    residual = np.abs(value - expected)
    residual = np.where(worst > 1, np.maximum(residual, tolerance * worst), residual)
    outcome = IdentityValues(value, expected, tolerance, length_exponent=2, detail=detail, residual=residual)
    exclude_null(outcome, groups, surface, degenerate, "the cotangent of a degenerate face")
    return outcome

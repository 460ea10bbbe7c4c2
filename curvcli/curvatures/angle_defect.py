"""Angle defects: Gauss curvature inside, geodesic curvature on the boundary."""

from __future__ import annotations

import numpy as np

from ..mesh.surface import Surface
from ..support.arrays import Column, Flags
from .registry import curvature_pass
from .star import null_where


@curvature_pass(public=False)
def general_defect(surface: Surface, angle_sum: Column, coincident: Flags) -> Column:
    """Compute 2π − Σθ − (π/2) Σ_{e at p} (2 − n_e), the defect of any triangle complex, pinched or with any n_e.

    Every face at p has two edges there, so the last sum is 2 (deg − faces). Null where a corner coincides with another.
    """
    excess = surface.degree - surface.corner_count
    defect = (2 * np.pi - angle_sum) - np.pi * excess
    return null_where(coincident | ~surface.referenced, defect)


@curvature_pass(
    symbol="K_p",
    formula="2π − Σθ_i",
    total="K",
    signed=True,
    preserves="gauss_bonnet: ΣK + Σκ_g = 2πχ; holonomy about p is a rotation by K_p",
    boundary="null, the defect is kappa_g there",
    source="Sullivan, Discrete surfaces",
    after="degree",
    total_after="area",
)
def K(boundary: Flags, general_defect: Column) -> Column:
    """Gauss curvature of the star: its angle defect, a measure in radians."""
    return null_where(boundary, general_defect)


@curvature_pass(
    symbol="κ_g",
    formula="π − Σθ_i",
    total="kappa_g",
    signed=True,
    preserves="gauss_bonnet: ΣK + Σκ_g = 2πχ",
    boundary="the turning of the boundary at p, positive where the surface is convex in itself; null inside",
    source="Sullivan, Discrete surfaces",
    after="K",
    total_after="K",
)
def kappa_g(boundary: Flags, general_defect: Column) -> Column:
    """Geodesic curvature of the boundary at the vertex: how far it turns, a measure in radians."""
    return null_where(~boundary, general_defect)


@curvature_pass(
    symbol="K_comb",
    formula="(π/3)(6 − deg − Σ_{e at p} (2 − n_e)), inside (π/3)(6 − deg)",
    preserves="gauss_bonnet_combinatorial: ΣK_comb = 2πχ",
    boundary="same: (π/3)(4 − deg)",
    signed=True,
    source="Sullivan, Discrete surfaces",
    after="kappa_g",
)
def K_comb(surface: Surface) -> Column:
    """Combinatorial curvature: the angle defect the vertex would have if every triangle were equilateral."""
    excess = 2 * (surface.degree - surface.corner_count)
    return null_where(~surface.referenced, (np.pi / 3) * (6.0 - surface.degree - excess))

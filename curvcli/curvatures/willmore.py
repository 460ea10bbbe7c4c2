"""Discretisations of the Willmore energy of stars."""

from __future__ import annotations

import numpy as np

from ..mesh.triangles import dot
from ..support.arrays import Column, Flags, VectorColumn
from .mean import pointed
from .registry import curvature_pass
from .star import ratio


@curvature_pass(
    symbol="h_p² A_p",
    formula="h_p² A_p",
    mean_degree=2,
    total="willmore",
    preserves="Σ → 16π on spheres, 8π² on the Clifford torus; never below willmore_hks",
    boundary="null",
    source="Sullivan, CMC and Willmore surfaces",
    pointwise=True,
    after="curvedness",
    total_after="K_abs",
)
def willmore(h: Column, star_area: Column) -> Column:
    """Willmore energy of the star from h, a measure without unit."""
    return h * h * star_area


@curvature_pass(
    symbol="|**H**_p|²/A_p",
    formula="|**H**_p|² / A_p",
    mean_degree=2,
    total="willmore_hks",
    preserves="Σ → 16π on spheres, 8π² on the Clifford torus",
    boundary="null",
    source="Sullivan, CMC and Willmore surfaces; Hsu, Kusner and Sullivan, Minimizing the squared mean curvature",
    pointwise=True,
    after="willmore",
    total_after="willmore",
)
def willmore_hks(interior: Flags, H_vec: VectorColumn, star_area: Column) -> Column:
    """Willmore energy of the star from the mean curvature vector and the area."""
    return ratio(dot(H_vec, H_vec), star_area, interior)


@curvature_pass(
    symbol="h_⊥² A_p",
    formula="h_⊥² A_p",
    mean_degree=2,
    total="willmore_perp",
    preserves="Σ → 16π on spheres, 8π² on the Clifford torus",
    boundary="null",
    source="Sullivan, CMC and Willmore surfaces",
    pointwise=True,
    after="willmore_hks",
    total_after="willmore_hks",
)
def willmore_perp(interior: Flags, H_vec: VectorColumn, star_vector: VectorColumn, star_area: Column) -> Column:
    """Willmore energy of the star from h_perp; needs no global orientation."""
    square = dot(star_vector, star_vector)
    perp = ratio(dot(H_vec, star_vector), square, pointed(interior, np.sqrt(square), star_area))
    return perp * perp * star_area


@curvature_pass(
    symbol="h_N² A_p",
    formula="h_N² A_p",
    mean_degree=2,
    total="willmore_normal",
    preserves="Σ → 16π on spheres, 8π² on the Clifford torus",
    boundary="null",
    source="Sullivan, CMC and Willmore surfaces",
    pointwise=True,
    after="willmore_perp",
    total_after="willmore_perp",
)
def willmore_normal(normal_ratio: Column, star_area: Column) -> Column:
    """Willmore energy of the star from h_normal; needs no global orientation."""
    return normal_ratio * normal_ratio * star_area

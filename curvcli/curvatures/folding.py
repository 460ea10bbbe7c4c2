"""Rectified curvatures and the indices of cortical folding, as measures of vertices."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..support.arrays import Column
from .registry import curvature_pass

_VAN_ESSEN = (
    "Van Essen and Drury, Structural and functional analyses of human cerebral cortex using a surface-based atlas; "
    "FreeSurfer's mris_anatomical_stats"
)
_GAUSS: dict[str, Any] = {
    "kind": "measure",
    "boundary": "null; at other vertices that K is",
    "pointwise": True,
}


@curvature_pass(
    symbol="max(K_p, 0)",
    formula="max(K_p, 0)",
    total="K_positive",
    after="h_sigma",
    total_after="willmore_fit",
    preserves="K_positive + K_negative = K; Σ → ∫max(K, 0), 4π on convex bodies",
    source="curvcli",
    **_GAUSS,
)
def K_positive(K: Column) -> Column:
    """Positive part of the Gauss curvature of the vertex. It is 0 at a saddle, where `K_plus` need not be."""
    return np.maximum(K, 0.0)


@curvature_pass(
    symbol="min(K_p, 0)",
    formula="min(K_p, 0)",
    total="K_negative",
    after="K_positive",
    total_after="K_positive",
    preserves="K_positive + K_negative = K; Σ → ∫min(K, 0), 0 on convex bodies",
    source="curvcli",
    **_GAUSS,
)
def K_negative(K: Column) -> Column:
    """Negative part of the Gauss curvature of the vertex, not positive."""
    return np.minimum(K, 0.0)


@curvature_pass(
    symbol="|K_p|",
    formula="|K_p|",
    total="K_rectified",
    after="K_negative",
    total_after="K_negative",
    preserves="K_positive − K_negative = K_rectified; Σ → ∫|K|",
    source="FreeSurfer's mris_anatomical_stats: integrated rectified Gaussian curvature, times the area",
    **_GAUSS,
)
def K_rectified(K: Column) -> Column:
    """Absolute value of the Gauss curvature of the vertex. `K_abs` = K⁺ + K⁻ is never less."""
    return np.abs(K)


@curvature_pass(
    symbol="h_p A_p",
    formula="h_p A_p",
    length_exponent=1,
    mean_degree=1,
    total="H_rectified",
    after="K_rectified",
    total_after="K_rectified",
    preserves="Σ → ∫|H|, 8πr on spheres; needs no orientation",
    boundary="null",
    source="FreeSurfer's mris_anatomical_stats: integrated rectified mean curvature, times the area",
    pointwise=True,
)
def H_rectified(h: Column, star_area: Column) -> Column:
    """Integral of |H| over the star of the vertex."""
    return h * star_area


@curvature_pass(
    symbol="|κ|(|κ| − |κ'|)A_p/4π",
    formula="(1/4π) |κ|(|κ| − |κ'|) A_p with |κ| ≥ |κ'| the sizes of κ₁ and κ₂: h/2 ± √(h²/4 − K_density)",
    total="folding_index",
    after="H_rectified",
    total_after="H_rectified",
    rooted=True,
    preserves="0 where |κ₁| = |κ₂|; Σ → L/2r on a cylinder of length L and radius r; needs no orientation",
    boundary="null",
    source=_VAN_ESSEN,
    pointwise=True,
)
def folding_index(h: Column, K_density: Column, star_area: Column) -> Column:
    """Folding index of the star: large on ridges and folds, 0 on spheres and on minimal surfaces."""
    half = 0.5 * h
    root = np.sqrt(np.maximum(half * half - K_density, 0.0))
    larger, smaller = half + root, np.abs(half - root)
    index: Column = larger * (larger - smaller) * star_area / (4 * np.pi)
    return index


@curvature_pass(
    symbol="max(K_p, 0)/4π",
    formula="max(K_p, 0) / 4π",
    total="intrinsic_index",
    after="folding_index",
    total_after="folding_index",
    preserves="Σ = 1 on convex bodies exactly, at least 1 on closed surfaces",
    source=_VAN_ESSEN,
    **_GAUSS,
)
def intrinsic_index(K: Column) -> Column:
    """Intrinsic curvature index of the vertex: its positive Gauss curvature in units of that of a sphere."""
    return np.maximum(K, 0.0) / (4 * np.pi)

"""Shape indices, curvednesses and Willmore energies at the scale of --rings or --radius, from estimates there."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..mesh.precision import last_place
from ..mesh.surface import Surface
from ..mesh.triangles import EPSILON
from ..support.arrays import Column, Flags
from .principal import koenderink
from .quantity import Quantity
from .registry import curvature_pass
from .star import null_where

# Ends displaced by ½√3 of the last place on either side of a vertex lift an edge by 2√3 of it; κ|e|² is twice that.
_LIFTED = 4 * np.sqrt(3)
_ARITHMETIC = 64 * EPSILON

_INDEX: dict[str, Any] = {
    "symbol": "S",
    "kind": "ratio",
    "parity": "odd",
    "signed": True,
    "preserves": "invariant under scaling; +1 on a convex cap, 0 on a symmetric saddle, −1 in a cup",
}
_CURVEDNESS: dict[str, Any] = {
    "symbol": "C",
    "kind": "density",
    "length_exponent": -1,
    "preserves": "even in the normal, but null where the estimates are: they need an orientation",
}
_ENERGY: dict[str, Any] = {
    "mean_degree": 2,
    "preserves": "Σ → 16π on spheres, 8π² on the Clifford torus, with noise and steps below the scale averaged out",
    "boundary": "null",
    "source": "curvcli, after h_p² A_p of Sullivan, with an estimate in the place of h_p",
    "pointwise": True,
}
_SOURCE = "Koenderink and van Doorn, Surface shape and curvature scales; the curvatures are those of "


def _shapes(suffix: str, boundary: str, after: str) -> tuple[Quantity, ...]:
    """The declarations of the shape index and the curvedness of the estimates with this suffix."""
    source = f"{_SOURCE}kappa_1_{suffix} and kappa_2_{suffix}"
    return (
        Quantity(
            f"shape_index_{suffix}",
            formula=f"(2/π) atan2(κ₁ + κ₂, κ₁ − κ₂) of kappa_1_{suffix} and kappa_2_{suffix}",
            boundary=boundary,
            source=source,
            description="Koenderink's shape index at the scale of --rings or --radius: +1 or −1 at umbilics; "
            "null where both curvatures bend a star by no more than the last digit of the coordinates.",
            after=after,
            **_INDEX,
        ),
        Quantity(
            f"curvedness_{suffix}",
            formula=f"√((κ₁² + κ₂²)/2) of kappa_1_{suffix} and kappa_2_{suffix}",
            boundary=boundary,
            source=source,
            description="Koenderink's curvedness at the scale of --rings or --radius: the size of the bend.",
            after=f"shape_index_{suffix}",
            **_CURVEDNESS,
        ),
    )


def _koenderink(
    surface: Surface, kappa_1: Column, kappa_2: Column, star_area: Column, magnified: Column | float = 1.0
) -> tuple[Column, Column]:
    """Shape index and curvedness of estimates.

    Flat is κA ≤ 4√3 of the last place of the coordinates, and κ√A ≤ 64 ε, the rounding of the estimate, magnified.
    """
    index, curvedness = koenderink(kappa_1, kappa_2)
    size = np.maximum(np.abs(kappa_1), np.abs(kappa_2))
    bend = size * np.sqrt(star_area)
    flat = (size * star_area <= _LIFTED * last_place(surface)) | (bend <= _ARITHMETIC * magnified)
    return null_where(flat, index), curvedness


@curvature_pass(provides=_shapes("ring", "null", after="condition_fit"))
def ring_shapes(
    surface: Surface, kappa_1_ring: Column, kappa_2_ring: Column, star_area: Column
) -> tuple[Column, Column]:
    """Shape index and curvedness of the curvature tensor of the neighbourhood."""
    return _koenderink(surface, kappa_1_ring, kappa_2_ring, star_area)


@curvature_pass(provides=_shapes("corrected", "one-sided, as kappa_1_corrected", after="curvedness_ring"))
def corrected_shapes(
    surface: Surface, kappa_1_corrected: Column, kappa_2_corrected: Column, star_area: Column
) -> tuple[Column, Column]:
    """Shape index and curvedness of the corrected curvatures."""
    return _koenderink(surface, kappa_1_corrected, kappa_2_corrected, star_area)


@curvature_pass(provides=_shapes("fit", "one-sided, as kappa_1_fit", after="curvedness_corrected"))
def fitted_shapes(
    surface: Surface, kappa_1_fit: Column, kappa_2_fit: Column, condition_fit: Column, star_area: Column
) -> tuple[Column, Column]:
    """Shape index and curvedness of the local fit, whose condition magnifies its rounding."""
    return _koenderink(surface, kappa_1_fit, kappa_2_fit, star_area, condition_fit)


def _energy(interior: Flags, h: Column, star_area: Column) -> Column:
    return null_where(~interior, h * h * star_area)


@curvature_pass(
    symbol="H̄² A_p",
    formula="h_ring² A_p",
    total="willmore_ring",
    **_ENERGY,
    after="curvedness_fit",
    total_after="helfrich",
)
def willmore_ring(interior: Flags, h_ring: Column, star_area: Column) -> Column:
    """Willmore energy of the star from the mean curvature of the neighbourhood, a measure without unit."""
    return _energy(interior, h_ring, star_area)


@curvature_pass(
    symbol="Ĥ² A_p",
    formula="h_corrected² A_p",
    total="willmore_corrected",
    **_ENERGY,
    after="willmore_ring",
    total_after="willmore_ring",
)
def willmore_corrected(interior: Flags, h_corrected: Column, star_area: Column) -> Column:
    """Willmore energy of the star from the corrected mean curvature: that of the smooth surface behind a rough mesh."""
    return _energy(interior, h_corrected, star_area)


@curvature_pass(
    symbol="H² A_p",
    formula="h_fit² A_p",
    total="willmore_fit",
    **_ENERGY,
    after="willmore_corrected",
    total_after="willmore_corrected",
)
def willmore_fit(interior: Flags, h_fit: Column, star_area: Column) -> Column:
    """Willmore energy of the star from the mean curvature of the local fit, a measure without unit."""
    return _energy(interior, h_fit, star_area)

"""Helfrich's bending energy of membranes."""

from __future__ import annotations

import numpy as np

from ..mesh.surface import Surface
from ..support.arrays import Column
from .registry import curvature_pass
from .setting import Setting


@curvature_pass(
    symbol="½(H − c₀)²A_p",
    formula="½ (H − c₀)² A_p in units of κ, H = h_signed = κ₁ + κ₂",
    energy=True,
    total="helfrich",
    preserves="½ willmore where c₀ = 0: Σ → 8π on spheres; Σ → 0 on a sphere of radius 2/c₀",
    boundary="null, as willmore; where c₀ ≠ 0, null also where h_signed is",
    source="Helfrich, Elastic properties of lipid bilayers: theory and possible experiments",
    settings={
        "c0": Setting(
            "spontaneous curvature c₀ of κ₁ + κ₂, also with --mean average; positive where the membrane tends to be "
            "convex seen from the side its normals point to",
            length_exponent=-1,
            parity="odd",
        )
    },
)
def helfrich(
    surface: Surface, h: Column, h_signed: Column, star_area: Column, face_area: Column, c0: float | Column = 0.0
) -> Column:
    """Helfrich's bending energy of the star, in units of the bending rigidity κ.

    The energy ½κ(κ₁ + κ₂ − c₀)² per area. If c₀ differs from face to face, each face has its part of the star with its
    own c₀, so that the sum over vertices is the sum over faces.
    """
    mean, spread = (c0, 0.0) if np.ndim(c0) == 0 else _over_stars(surface, star_area, face_area, np.asarray(c0))
    with np.errstate(over="ignore", invalid="ignore"):
        bent = np.where(mean == 0, h, h_signed - mean)
        energy: Column = 0.5 * (bent * bent * star_area + spread)
    return np.where(np.isinf(energy), np.nan, energy)


def _over_stars(surface: Surface, star_area: Column, face_area: Column, values: Column) -> tuple[Column, Column]:
    """Mean over the star of each vertex of a value of faces, weighted by area, and ⅓ Σ area (value − mean)²."""
    corner = surface.faces.ravel()

    def third(weights: Column) -> Column:
        sums: Column = np.bincount(corner, weights / 3, surface.n_vertices).astype(np.float64, copy=False)
        return sums

    with np.errstate(divide="ignore", invalid="ignore"):
        mean = third(np.repeat(face_area * values, 3)) / star_area
    gap = np.repeat(values, 3) - mean[corner]
    return mean, third(np.repeat(face_area, 3) * gap * gap)

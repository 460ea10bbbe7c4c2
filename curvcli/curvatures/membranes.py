"""Helfrich's bending energy of membranes, and the area difference and the reduced volume of vesicles."""

from __future__ import annotations

import numpy as np

from ..errors import UsageError
from ..mesh.surface import Surface
from ..support.arrays import Column, Flags, Floats
from .derived import derived_total
from .registry import curvature_pass
from .setting import Setting
from .star import null_where

_C0 = (
    "spontaneous curvature c₀ of κ₁ + κ₂, also with --mean average; positive where the membrane tends to be convex "
    "seen from the side its normals point to"
)


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


def _of_faces(
    surface: Surface, h: Column, h_signed: Column, star_area: Column, face_area: Column, c0: float | Column = 0.0
) -> tuple[Column, Column]:
    """Parts of the faces in `helfrich`, each with its own c₀, and the sizes ½ Σ (|H| + |c₀|)² of their terms."""
    third, own = np.repeat(face_area, 3) / 3, np.repeat(np.broadcast_to(np.asarray(c0), face_area.shape), 3)
    corner = surface.faces.ravel()
    bent = np.bincount(corner, third * np.abs(own), surface.n_vertices)[corner] > 0
    with np.errstate(over="ignore", invalid="ignore"):
        terms = 0.5 * third * np.where(bent, h_signed[corner] - own, h[corner]) ** 2
        sizes = 0.5 * third * (h[corner] + np.abs(own)) ** 2
    sizes[np.isnan(terms)] = 0.0
    return np.nansum(terms.reshape(-1, 3), axis=1), sizes.reshape(-1, 3).sum(axis=1)


def _bending(
    surface: Surface, h: Column, h_signed: Column, star_area: Column, face_area: Column, c0: float | Column
) -> Column:
    """½(H − c₀)²A, from |H| where c₀ is 0 in the star.

    Errors: UsageError for an energy beyond the range of doubles.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        mean, spread = (c0, 0.0) if np.ndim(c0) == 0 else _over_stars(surface, star_area, face_area, np.asarray(c0))
        bent = np.where((mean == 0) & (spread == 0), h, h_signed - mean)
        energy: Column = 0.5 * (bent * bent * star_area + spread)
    if np.isinf(energy).any():
        raise UsageError("helfrich.c0: (h_signed − c0)² A is beyond the range of doubles on this mesh")
    return energy


@curvature_pass(
    symbol="½(H − c₀)²A_p",
    formula="½ (H − c₀)² A_p in units of κ, H = h_signed = κ₁ + κ₂",
    energy=True,
    total="helfrich",
    preserves="½ willmore where c₀ = 0: Σ → 8π on spheres; Σ → 0 on a sphere of radius 2/c₀",
    boundary="null, as willmore; where c₀ ≠ 0, null also where h_signed is",
    source="Helfrich, Elastic properties of lipid bilayers: theory and possible experiments",
    settings={"c0": Setting(_C0, length_exponent=-1, parity="odd")},
    after="willmore_conformal",
    total_after="dirichlet",
    of_faces=_of_faces,
)
def helfrich(
    surface: Surface, h: Column, h_signed: Column, star_area: Column, face_area: Column, c0: float | Column = 0.0
) -> Column:
    """Helfrich's bending energy of the star, in units of the bending rigidity κ.

    The energy ½κ(κ₁ + κ₂ − c₀)² per area. If c₀ differs from face to face, each face has its part of the star with its
    own c₀, so that the sum over vertices is the sum over faces.
    """
    return _bending(surface, h, h_signed, star_area, face_area, c0)


def _corrected_of_faces(
    surface: Surface,
    interior: Flags,
    h_corrected: Column,
    star_area: Column,
    face_area: Column,
    c0: float | Column = 0.0,
) -> tuple[Column, Column]:
    """Parts of the faces in `helfrich_corrected`, and the sizes of their terms."""
    H = null_where(~interior, h_corrected)
    return _of_faces(surface, np.abs(H), H, star_area, face_area, c0)


@curvature_pass(
    symbol="½(Ĥ − c₀)²A_p",
    formula="½ (h_corrected − c₀)² A_p in units of κ",
    energy=True,
    total="helfrich_corrected",
    preserves="as helfrich, with noise and steps below the scale averaged out",
    boundary="null",
    source="curvcli, after Helfrich, with an estimate in the place of h_signed",
    settings={"c0": Setting(_C0, length_exponent=-1, parity="odd", owner="helfrich")},
    after="willmore_fit",
    total_after="willmore_fit",
    of_faces=_corrected_of_faces,
)
def helfrich_corrected(
    surface: Surface,
    interior: Flags,
    h_corrected: Column,
    star_area: Column,
    face_area: Column,
    c0: float | Column = 0.0,
) -> Column:
    """Helfrich's bending energy of the star from the corrected mean curvature: of the membrane behind a rough mesh."""
    H = null_where(~interior, h_corrected)
    return _bending(surface, np.abs(H), H, star_area, face_area, c0)


@derived_total(
    symbol="v",
    formula="V / (4π/3 R³), R = √(area/4π)",
    parity="odd",
    beside="helfrich",
    source="Seifert, Configurations of fluid membranes and vesicles",
)
def reduced_volume(area: Floats, volume: Floats) -> Floats:
    """Reduced volume of a closed component: its volume over that of the sphere with its area, 1 for a sphere."""
    ratio: Floats = 6 * np.sqrt(np.pi) * volume / (area * np.sqrt(area))
    return ratio


@derived_total(
    symbol="ΔA",
    formula="D Σ θ_e|e| = D ΣH_theta",
    length_exponent=2,
    parity="odd",
    source="Svetina and Žekš, Membrane bending energy and shape determination of phospholipid vesicles and red blood "
    "cells; Miao, Seifert, Wortis and Döbereiner, Budding transitions of fluid-bilayer vesicles",
    settings={
        "thickness": Setting(
            "distance D between the neutral surfaces of the two leaflets, in the unit of the file",
            length_exponent=1,
            minimum=0.0,
        )
    },
)
def area_difference(H_theta: Floats, thickness: float = 0.0) -> Floats:
    """Area difference of the leaflets of a closed bilayer, outer minus inner.

    Parallel surfaces at ±D/2 have the areas A ± ½D ΣH_theta + ¼D² ΣK, so that the difference is D ΣH_theta exactly.
    """
    return thickness * H_theta


@derived_total(
    symbol="Δa",
    formula="ΣH_theta / (8πR), R = √(area/4π); ΔA = 8πRD Δa",
    parity="odd",
    beside="helfrich",
    source="Miao, Seifert, Wortis and Döbereiner, Budding transitions of fluid-bilayer vesicles",
)
def reduced_area_difference(area: Floats, H_theta: Floats) -> Floats:
    """Reduced area difference of a closed component: ΔA over that of the sphere with its area, 1 for a sphere."""
    ratio: Floats = H_theta / (4 * np.sqrt(np.pi) * np.sqrt(area))
    return ratio


@derived_total(
    symbol="E_ADE",
    formula="8π² α (Δa − Δa₀)² = ½ α π (ΔA − ΔA₀)² / (area D²), in units of κ",
    energy=True,
    source="Miao, Seifert, Wortis and Döbereiner, Budding transitions of fluid-bilayer vesicles",
    settings={
        "ratio": Setting("ratio α of the nonlocal bending rigidity to κ", minimum=0.0),
        "preferred": Setting("preferred reduced area difference Δa₀", parity="odd"),
    },
)
def area_difference_energy(reduced_area_difference: Floats, ratio: float = 1.0, preferred: float = 1.0) -> Floats:
    """Elastic energy of the area difference of a closed component, in units of the bending rigidity κ.

    The thickness D cancels. `helfrich` plus this is the energy of the area-difference elasticity model.
    """
    gap = reduced_area_difference - preferred
    return 8 * np.pi**2 * ratio * gap * gap

"""Averaged measures: the curvature measures summed over a neighbourhood, then divided."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..mesh.neighbourhoods import sums
from ..mesh.scale import Scale
from ..mesh.surface import Surface
from ..mesh.triangles import dot
from ..support.arrays import Column, Flags, Floats, VectorColumn
from ..support.blocks import slices
from .directions import star_tensors
from .kernels.tensor import tangential
from .mean import pointed, with_sign
from .quantity import Quantity
from .registry import curvature_pass
from .star import null_where, ratio

_SHARED: dict[str, Any] = {
    "kind": "density",
    "signed": True,
    "boundary": "null; vertices on the boundary or without K and **H**_p add neither measure nor area",
    "source": "Cohen-Steiner and Morvan, Restricted Delaunay triangulations and normal cycle, 2003; the measures are "
    "those of K, H_vec, A_vec and A",
}


def _sums(surface: Surface, scale: Scale, used: Flags, rows: list[Floats]) -> Floats:
    """(k, V) sums of the rows over neighbourhoods, with unused entries as 0."""
    data = np.where(used, rows, 0.0).T
    return np.ascontiguousarray(sums(surface, scale, np.ascontiguousarray(data)).T)


@curvature_pass(
    provides=(
        Quantity("ring_area", public=False, length_exponent=2),
        Quantity("ring_K", public=False),
        Quantity("ring_H_vec", public=False, vector=True, length_exponent=1, mean_degree=1),
        Quantity("ring_vector", public=False, vector=True, length_exponent=2, parity="odd"),
        Quantity("ring_extent", public=False, length_exponent=1),
    )
)
def ring_sums(
    surface: Surface,
    scale: Scale,
    K: Column,
    H_vec: VectorColumn,
    star_vector: VectorColumn,
    star_area: Column,
    star_extent: Column,
) -> tuple[Column, ...]:
    """ΣA, ΣK, Σ**H**, Σ**A** and the extents of the stars of the vertices of each neighbourhood."""
    used = surface.interior & np.isfinite(K) & np.isfinite(H_vec[0])
    total = _sums(surface, scale, used, [star_area, K, *H_vec, *star_vector, star_extent])
    return total[0], total[1], total[2:5], total[5:8], total[8]


@curvature_pass(
    symbol="K̄",
    formula="ΣK_p / ΣA_p over the neighbourhood",
    length_exponent=-2,
    preserves="K_ring times the area of the neighbourhood is its exact Gauss curvature",
    **_SHARED,
    after="helfrich",
)
def K_ring(surface: Surface, ring_K: Column, ring_area: Column) -> Column:
    """Gauss curvature of the neighbourhood per area: the exact measure at the scale of --rings or --radius."""
    return ratio(ring_K, ring_area, surface.interior)


@curvature_pass(
    symbol="H̄",
    formula="|Σ**H**_p| / |Σ**A**_p| over the neighbourhood, positive where Σ**H**·Σ**A** < 0",
    length_exponent=-1,
    mean_degree=1,
    parity="odd",
    preserves="Σ**H**_p is the force on the rim of the neighbourhood, exactly",
    **_SHARED,
    after="K_ring",
)
def h_ring(
    surface: Surface, ring_H_vec: VectorColumn, ring_vector: VectorColumn, ring_area: Column, ring_extent: Column
) -> Column:
    """Mean curvature κ₁ + κ₂ of the neighbourhood, positive where convex; null where |ΣA_vec| < 1e-12 ΣA.

    Also null where ΣH_vec and ΣA_vec are at right angles to rounding, so that there is no sign.
    """
    length = np.sqrt(dot(ring_vector, ring_vector))
    size = ratio(np.sqrt(dot(ring_H_vec, ring_H_vec)), length, pointed(surface.interior, length, ring_area))
    return null_where(surface.without_orientation, with_sign(size, ring_H_vec, ring_vector, ring_extent))


_KAPPA: dict[str, Any] = {
    "length_exponent": -1,
    "parity": "odd",
    "preserves": "Σ θ_e|e| of the neighbourhood, up to what is not tangential",
    **_SHARED,
}


@curvature_pass(
    provides=(
        Quantity(
            "kappa_1_ring",
            symbol="κ̄₁",
            formula="larger eigenvalue of ½ΣΣ θ_e|e| ê⊗ê / ΣA_p orthogonally to Σ**A**_p",
            description="Larger principal curvature of the neighbourhood, from its curvature tensor.",
            partner="kappa_2_ring",
            **_KAPPA,
            after="h_ring",
        ),
        Quantity(
            "kappa_2_ring",
            symbol="κ̄₂",
            formula="smaller eigenvalue of ½ΣΣ θ_e|e| ê⊗ê / ΣA_p orthogonally to Σ**A**_p",
            description="Smaller principal curvature of the neighbourhood, from its curvature tensor.",
            partner="kappa_1_ring",
            **_KAPPA,
            after="kappa_1_ring",
        ),
    )
)
def ring_principal_curvatures(
    surface: Surface, scale: Scale, theta: Column, star_vector: VectorColumn, star_area: Column
) -> tuple[Column, ...]:
    """Eigenvalues of the curvature tensor of the neighbourhood per area; half of each edge's goes to each end."""
    tensor, _ = star_tensors(surface, theta)
    used = surface.interior & np.isfinite(tensor[0])
    total = _sums(surface, scale, used, [star_area, *star_vector, *tensor])
    result = np.full((2, surface.n_vertices), np.nan)
    area, vector = total[0], total[1:4]
    length = np.sqrt(dot(vector, vector))
    known = pointed(surface.interior, length, area) & (area > 0) & ~surface.without_orientation
    for block in slices(surface.n_vertices):
        with np.errstate(divide="ignore", invalid="ignore"):
            middle, half, _, _ = tangential(0.5 * total[4:, block] / area[block], vector[:, block] / length[block])
        result[:, block] = np.where(known[block], [middle + half, middle - half], np.nan)
    return result[0], result[1]

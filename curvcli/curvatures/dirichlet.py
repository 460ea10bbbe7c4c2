"""The Dirichlet energy of the identity, which is the area computed from cotangents."""

from __future__ import annotations

import numpy as np

from ..mesh.surface import Surface
from ..support.arrays import Column, Flags, VectorColumn
from .kernels.cotangents import dirichlet as sweep
from .quantity import Quantity
from .registry import curvature_pass
from .star import null_where


@curvature_pass(
    provides=(
        Quantity(
            "dirichlet",
            symbol="E(id)_T",
            formula="¼ Σ cot θ |opposite edge|²",
            on="face",
            length_exponent=2,
            total="dirichlet",
            preserves="dirichlet: E(id) = area, and ∇_p E(id) = ∇_p area",
            boundary="same",
            source="Sullivan, Discrete surfaces",
            description="Dirichlet energy of the identity on the face, by cotangents; null on degenerate faces.",
            after="normal",
            total_after="willmore_conformal",
        ),
        Quantity("dirichlet_gradient", public=False, vector=True, length_exponent=1),
        Quantity("dirichlet_terms", on="face", public=False, length_exponent=2),
        Quantity("dirichlet_gradient_terms", public=False, length_exponent=1),
    )
)
def dirichlet_identity(surface: Surface, degenerate: Flags) -> tuple[Column | VectorColumn, ...]:
    """E(id) of each face, ∇_p E(id) = ½ Σ (cot α + cot β)(p − q), and the sizes of the terms they are summed from.

    Null on degenerate faces and at their corners: cotangents have no meaning there.
    """
    result = sweep(surface, surface.xyz)
    null = degenerate | ~surface.referenced
    return (
        result.energy,
        np.asarray(null_where(null, result.gradient)),
        result.energy_terms,
        null_where(null, result.gradient_terms),
    )

"""Principal curvatures from the mean and the Gauss curvature."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mesh.precision import is_single, last_place
from ..mesh.surface import Surface
from ..mesh.triangles import EPSILON
from ..support.arrays import Column, Flags
from .quantity import FlagNotice, Quantity
from .registry import curvature_pass
from .star import null_where

# Rounding of an angle defect; the root of the radicand halves its digits.
_DEFECT = 16 * EPSILON * 2 * np.pi

_SHARED: dict[str, Any] = {
    "kind": "density",
    "length_exponent": -1,
    "parity": "odd",
    "signed": True,
    "rooted": True,
    "preserves": "κ₁ + κ₂ = h_signed, and κ₁ κ₂ = K_density where the radicand is not clamped",
    "boundary": "null",
    "source": "Sullivan, Curvatures of smooth surfaces",
}


def _clamped(surface: Surface, columns: Mapping[str, Any]) -> NDArray[np.intp]:
    """Vertices with a clamped radicand; flat ones, where K is below the rounding of the coordinates, are left out.

    Coordinates that change by one unit in the last place turn the edges of a flat star by about place/√A, and K is
    quadratic in that.
    """
    clamped = np.flatnonzero(columns["kappa_clamped"])
    if not len(clamped):
        return clamped
    place = last_place(surface, np.float32 if is_single(surface.xyz_given) else np.float64)
    turned = surface.degree[clamped] * place / np.sqrt(columns["star_area"][clamped])
    kept: NDArray[np.intp] = clamped[np.abs(columns["K"][clamped]) > turned * turned]
    return kept


@curvature_pass(
    provides=(
        Quantity(
            "kappa_1",
            symbol="κ₁",
            formula="H/2 + √(H²/4 − K_density), H = h_signed",
            partner="kappa_2",
            **_SHARED,
            after="K_density",
        ),
        Quantity(
            "kappa_2",
            symbol="κ₂",
            formula="H/2 − √(H²/4 − K_density), H = h_signed",
            partner="kappa_1",
            **_SHARED,
            after="kappa_1",
        ),
        Quantity(
            "kappa_clamped",
            kind="flag",
            public=False,
            notice=FlagNotice(
                "clamped_radicand",
                "[vertex|vertices] with H² < 4K; [its|their] principal curvatures are taken equal",
                "H and K are discretised apart: at umbilics, as on spheres, a small error does it; elsewhere the mesh "
                "is coarse or noisy",
                after="",
                select=_clamped,
            ),
        ),
    ),
    pointwise=True,
)
def principal_curvatures(h_signed: Column, K_density: Column, cell_area: Column) -> tuple[Column | Flags, ...]:
    """Principal curvatures, κ₁ ≥ κ₂; a negative radicand, where H² < 4K, is clamped at 0 and counted.

    A radicand that the rounding of K makes negative is clamped too, but not counted.
    """
    half = 0.5 * h_signed
    root = half * half
    root -= K_density
    clamped = root * cell_area < -_DEFECT
    np.sqrt(np.maximum(root, 0.0, out=root), out=root)
    larger = half + root
    return larger, np.subtract(half, root, out=half), clamped


@curvature_pass(
    symbol="max |κ|",
    formula="h/2 + √(h²/4 − K_density) = max(|κ₁|, |κ₂|)",
    kind="density",
    length_exponent=-1,
    rooted=True,
    preserves="even in the normal: defined where the surface has no orientation; 1/kappa_max is the tightest radius",
    boundary="null",
    source="curvcli; κ₁ and κ₂ as in Sullivan, Curvatures of smooth surfaces",
    pointwise=True,
    after="kappa_2",
)
def kappa_max(h: Column, K_density: Column) -> Column:
    """The larger of |κ₁| and |κ₂|: how tightly the surface bends, inwards or outwards."""
    half = 0.5 * h
    return half + np.sqrt(np.maximum(half * half - K_density, 0.0))


def koenderink(kappa_1: Column, kappa_2: Column) -> tuple[Column, Column]:
    """Koenderink's shape index (2/π) atan2(κ₁ + κ₂, κ₁ − κ₂) and curvedness √((κ₁² + κ₂²)/2), for κ₁ ≥ κ₂."""
    index = (2 / np.pi) * np.arctan2(kappa_1 + kappa_2, kappa_1 - kappa_2)
    return index, np.hypot(kappa_1, kappa_2) * np.sqrt(0.5)


@curvature_pass(
    symbol="S",
    formula="(2/π) atan2(κ₁ + κ₂, κ₁ − κ₂)",
    kind="ratio",
    parity="odd",
    signed=True,
    preserves="invariant under scaling; +1 on a convex cap, 0 on a symmetric saddle, −1 in a cup",
    boundary="null",
    source="Sullivan, Curvatures of smooth surfaces; Koenderink and van Doorn, Surface shape and curvature scales",
    pointwise=True,
    after="dir_2",
)
def shape_index(kappa_1: Column, kappa_2: Column, cell_area: Column) -> Column:
    """Koenderink's shape index; +1 or −1 at umbilics, null where κ₁ and κ₂ are both no more than K's rounding makes."""
    size = np.maximum(np.abs(kappa_1), np.abs(kappa_2))
    return null_where(size * size * cell_area <= 4 * _DEFECT, koenderink(kappa_1, kappa_2)[0])


@curvature_pass(
    symbol="C",
    formula="√((κ₁² + κ₂²)/2)",
    kind="density",
    length_exponent=-1,
    rooted=True,
    preserves="even in the normal: defined where the surface has no orientation",
    boundary="null",
    source="Sullivan, Curvatures of smooth surfaces; Koenderink and van Doorn, Surface shape and curvature scales",
    pointwise=True,
    after="shape_index",
)
def curvedness(h: Column, K_density: Column) -> Column:
    """Koenderink's curvedness: how strongly the surface is bent, whichever way."""
    half = 0.5 * h
    root = np.sqrt(np.maximum(half * half - K_density, 0.0))
    size: Column = np.hypot(half + root, half - root) * np.sqrt(0.5)
    return size

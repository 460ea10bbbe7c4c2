"""Interpolated corrected curvatures: measures of triangles with normals interpolated between their vertices."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from scipy.sparse import csr_array

from ..mesh.neighbourhoods import sums
from ..mesh.scale import Scale
from ..mesh.surface import Surface
from ..mesh.triangles import EPSILON, by_corner, cross, dot
from ..support.arrays import Column, Floats, Index, VectorColumn
from ..support.blocks import for_each, slices
from .kernels.tensor import ENTRIES, half_gap, line, tangential
from .quantity import Quantity
from .registry import curvature_pass
from .star import null_where

# Least ratio of Σμ₀ to the area; below it the normals do not match the faces, and quotients by Σμ₀ are meaningless.
_ASTRAY = 0.25
# Eigenvalues nearer to each other than this part of their size differ by rounding only.
_UMBILIC = 512 * EPSILON
# Rows of the vertex measures.
_MU_0, _AREA, _MU_2, _TENSOR = 0, 1, 2, slice(3, 9)

_SHARED: dict[str, Any] = {
    "boundary": "one-sided: the faces that there are; null at vertices of status nonmanifold, and where Σμ₀ is less "
    "than a quarter of the area: there the normals do not belong to the faces",
    "source": "Lachaud, Romon, Thibert and Coeurjolly, Interpolated corrected curvature measures for polygonal "
    "surfaces, 2020; Lachaud, Romon and Thibert, Corrected curvature measures, 2022",
    "preserves": "exact on spheres, and wherever the normals are those of a surface of constant curvatures",
}


@curvature_pass(
    provides=(
        Quantity("corrected_gauss", public=False, length_exponent=-2),
        Quantity("corrected_tensor", public=False, length_exponent=-1, parity="odd"),
        Quantity("corrected_area", public=False, length_exponent=2),
    )
)
def corrected_measures(
    surface: Surface, scale: Scale, normals: Literal["mesh", "file"], fitted_normal: VectorColumn, K: Column
) -> tuple[Column, ...]:
    """Σμ₂/Σμ₀ (V,) and Σμ_XY/Σμ₀ (6, V), sharpened, and Σμ₀.

    Each face's measures go to its corners in equal parts and are summed over neighbourhoods. The loss of peaks by
    averaging is estimated by averaging once more, and added back: x̂ = 2 x̄ − x̿.
    |Σμ₂/Σμ₀| is bounded by the angle defects in reach of the two averages: a sheet without defects is flat, and other
    values are errors of the normals, such as those that one-sided neighbourhoods tilt at a rim.
    """
    corners = _Corners(surface)
    measures = _measures(surface, fitted_normal)
    mean, defects = _averaged(surface, scale, corners.gather(measures), _sizes_of_defects(surface, K))
    _spread(surface, mean, measures)
    defects[np.isnan(mean[:, _MU_0])] = np.inf  # a neighbourhood left empty
    again, defects = _averaged(surface, scale, corners.gather(measures), defects)
    del measures
    result = np.empty((7, surface.n_vertices))
    for block in slices(surface.n_vertices):
        known = np.isfinite(fitted_normal[:, block]).all(axis=0)
        sharp = 2 * mean[block, _MU_2:] - again[block, _MU_2:]
        result[:, block] = np.where(known, sharp.T, np.nan)
        if normals == "mesh":
            most = defects[block] / mean[block, _MU_0]
            result[0, block] = np.clip(result[0, block], -most, most) + 0.0  # no -0
    return result[0], result[1:], mean[:, _MU_0].copy()


def _sizes_of_defects(surface: Surface, K: Column) -> Column:
    """(V,) |K| at interior vertices, 0 within rounding, infinite for null."""
    size = np.where(surface.interior, np.abs(K), 0.0)
    size[size <= 8 * EPSILON * surface.degree] = 0.0
    size[np.isnan(size)] = np.inf
    return size


def _averaged(surface: Surface, scale: Scale, measures: Floats, defects: Column) -> tuple[Floats, Column]:
    """(V, 9) averages over neighbourhoods of the measures at the vertices, and (V,) sums of the sizes of defects."""
    total = sums(surface, scale, np.column_stack([measures, defects]))
    return _divided(np.ascontiguousarray(total[:, :-1])), total[:, -1].copy()


@curvature_pass(
    symbol="K̂",
    formula="Σμ₂/Σμ₀ over the neighbourhood, sharpened; of each face μ₀ = ½⟨ū, d₁ × d₂⟩ and μ₂ = ½⟨u₀, u₁ × u₂⟩",
    kind="density",
    length_exponent=-2,
    signed=True,
    **_SHARED,
    after="kappa_2_ring",
)
def K_corrected(corrected_gauss: Column) -> Column:
    """Gauss curvature estimated from interpolated normals at the scale of --rings or --radius.

    Of a face u₀, u₁, u₂ are the normals at its corners, ū is their mean, and d₁, d₂ are its edges from corner 0.
    Sharpened: 2x̄ − x̿, where x̄ is the quotient and x̿ what comes of averaging it once more. With the mesh's normals,
    its size is at most Σ|K_p| of the vertices in reach over Σμ₀: 0 on developable sheets, up to their rims.
    """
    return corrected_gauss


_TENSOR_OF_A_FACE = (
    "\n\nOf each face μ_XY is the symmetric part of ½(e₁ ⊗ (d₂ × ū) + e₂ ⊗ (ū × d₁)), in the letters of h_corrected."
)
_DENSITY: dict[str, Any] = {"kind": "density", "length_exponent": -1, "parity": "odd", "signed": True, **_SHARED}


@curvature_pass(
    symbol="Ĥ",
    formula="Σμ₁/Σμ₀ over the neighbourhood, sharpened; of each face μ₁ = ½⟨ū, e₁ × d₂ + d₁ × e₂⟩",
    mean_degree=1,
    **_DENSITY,
    after="K_corrected",
)
def h_corrected(surface: Surface, corrected_tensor: Column) -> Column:
    """Mean curvature κ₁ + κ₂ estimated from interpolated normals, positive where convex.

    The letters are those of K_corrected; e₁ = u₁ − u₀ and e₂ = u₂ − u₀.
    """
    return null_where(surface.without_orientation, corrected_tensor[0] + corrected_tensor[3] + corrected_tensor[5])


@curvature_pass(
    provides=(
        Quantity(
            "kappa_1_corrected",
            symbol="κ̂₁",
            formula="Ĥ/2 + half the difference of the tangential eigenvalues of Σμ_XY/Σμ₀, sharpened",
            description=f"Larger principal curvature estimated from interpolated normals.{_TENSOR_OF_A_FACE}",
            partner="kappa_2_corrected",
            **_DENSITY,
            after="h_corrected",
        ),
        Quantity(
            "kappa_2_corrected",
            symbol="κ̂₂",
            formula="Ĥ/2 − half the difference of the tangential eigenvalues of Σμ_XY/Σμ₀, sharpened",
            description=f"Smaller principal curvature estimated from interpolated normals.{_TENSOR_OF_A_FACE}",
            partner="kappa_1_corrected",
            **_DENSITY,
            after="kappa_1_corrected",
        ),
    )
)
def corrected_principal_curvatures(
    surface: Surface, corrected_tensor: Column, fitted_normal: VectorColumn, h_corrected: Column
) -> tuple[Column, ...]:
    """Principal curvatures of the corrected tensor within the tangent planes, about half its trace."""
    half = np.empty(surface.n_vertices)

    def halve(block: slice) -> None:
        half[block] = half_gap(corrected_tensor[:, block], fitted_normal[:, block])

    for_each(slices(surface.n_vertices), halve)
    return 0.5 * h_corrected + half, 0.5 * h_corrected - half


_LINE: dict[str, Any] = {"kind": "direction", "vector": True, "line": True, **_SHARED}


@curvature_pass(
    provides=(
        Quantity(
            "dir_1_corrected",
            symbol="**ê**₁",
            formula="tangential eigenvector, to the larger eigenvalue, of Σμ_XY/Σμ₀ as for kappa_1_corrected",
            description="Direction of kappa_1_corrected, a line; null also at umbilics and without an orientation.",
            partner="dir_2_corrected",
            **_LINE,
            after="kappa_2_corrected",
        ),
        Quantity(
            "dir_2_corrected",
            symbol="**ê**₂",
            formula="tangential eigenvector, to the smaller eigenvalue, of Σμ_XY/Σμ₀ as for kappa_1_corrected",
            description="Direction of kappa_2_corrected, a line; null also at umbilics and without an orientation.",
            partner="dir_1_corrected",
            **_LINE,
            after="dir_1_corrected",
        ),
    )
)
def corrected_directions(
    surface: Surface, corrected_tensor: Column, fitted_normal: VectorColumn, corrected_area: Column
) -> tuple[VectorColumn, ...]:
    """Eigenvectors of the corrected tensor within the tangent planes: lines, their largest component positive."""
    result = np.empty((2, 3, surface.n_vertices))

    def turn(block: slice) -> None:
        tensor = corrected_tensor[:, block]
        _, gap, *pair = tangential(tensor, fitted_normal[:, block])
        # Rounding of unit normals acts like a curvature of ε per size of a face.
        rounding = np.abs(tensor).max(axis=0) + 1 / np.sqrt(corrected_area[block])
        distinct = (gap > _UMBILIC * rounding) & ~surface.without_orientation[block]
        result[:, :, block] = np.where(distinct, [line(vector) for vector in pair], np.nan)

    for_each(slices(surface.n_vertices), turn)
    return result[0], result[1]


class _Corners:
    """The corners at each vertex, for gathering measures of faces."""

    def __init__(self, surface: Surface) -> None:
        shape = (surface.n_faces, surface.n_vertices)
        start = np.arange(0, 3 * surface.n_faces + 1, 3, dtype=np.int32)
        self._plain = self._odd = self._at_vertices(np.ones(3 * surface.n_faces), surface.faces, start, shape)
        if surface.corner_sign is not None:
            sign = surface.corner_sign.ravel().astype(np.float64)
            self._odd = self._at_vertices(sign, surface.faces, start, shape)

    def _at_vertices(self, data: Floats, faces: Index, start: Index, shape: tuple[int, int]) -> csr_array:
        by_vertex = csr_array((data, faces.ravel(), start), shape=shape).tocsc()
        return csr_array((by_vertex.data, by_vertex.indices, by_vertex.indptr), shape=shape[::-1])

    def gather(self, measures: Floats) -> Floats:
        """(V, 9) sums over the faces at each vertex of measures (F, 9), the tensor as the star is oriented."""
        result: Floats = self._plain @ measures
        if self._odd is not self._plain:
            result[:, _TENSOR] = self._odd @ np.ascontiguousarray(measures[:, _TENSOR])
        return result


def _measures(surface: Surface, normal: VectorColumn) -> Floats:
    """(F, 9) a third of each face's μ₀, of its area, of μ₂ and of the tensor ∫∇u.

    A face with a null normal at a corner adds nothing. With d the edges and e the differences of the normals from
    corner 0, ∫∇u = ½ (e₁ ⊗ (d₂ × ū) + e₂ ⊗ (ū × d₁)) for u linear on the face; its trace is μ₁.
    """
    result = np.empty((surface.n_faces, 9))
    sign = surface.corner_sign

    def measure(block: slice) -> None:
        face = by_corner(surface.faces[block])
        p = [[x.take(corner) for x in surface.xyz] for corner in face]
        n = [[x.take(corner) for x in normal] for corner in face]
        if sign is not None:
            n = [[x * sign[block, k] for x in vector] for k, vector in enumerate(n)]
        d_1, d_2 = ([b - a for a, b in zip(p[0], p[k], strict=True)] for k in (1, 2))
        e_1, e_2 = ([b - a for a, b in zip(n[0], n[k], strict=True)] for k in (1, 2))
        mean = [(a + b + c) / 3 for a, b, c in zip(*n, strict=True)]
        upright = cross(d_1, d_2)
        across, along = cross(d_2, mean), cross(mean, d_1)
        rows = [dot(mean, upright), np.sqrt(dot(upright, upright)), dot(n[0], cross(n[1], n[2]))]
        for i, j in ENTRIES:
            entry = e_1[i] * across[j] + e_2[i] * along[j]
            rows.append(entry if i == j else 0.5 * (entry + e_1[j] * across[i] + e_2[j] * along[i]))
        unknown = np.isnan(rows[_MU_0])
        if unknown.any():
            rows = [np.where(unknown, 0.0, row) for row in rows]
        result[block] = np.stack(rows, axis=1) / 6

    for_each(slices(surface.n_faces), measure)
    return result


def _divided(total: Floats) -> Floats:
    """Divide the sums of measures, from μ₂ on, by Σμ₀; null where Σμ₀ is too small."""
    mu_0 = total[:, _MU_0].copy()
    unsound = ~((mu_0 > 0) & (mu_0 >= _ASTRAY * total[:, _AREA]))
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        total[:, _MU_2:] /= mu_0[:, None]
    total[unsound | np.isinf(total).any(axis=1)] = np.nan
    return total


def _spread(surface: Surface, density: Floats, measures: Floats) -> None:
    """Replace the measures of the faces by those of a density at the vertices; μ₀ stays."""
    sign = surface.corner_sign

    def spread(block: slice) -> None:
        total = np.zeros((block.stop - block.start, 9))
        for k, corner in enumerate(surface.faces[block].T):
            each = density.take(corner, axis=0)
            if sign is not None:
                each[:, _TENSOR] *= sign[block, k, None]
            total += each
        mu_0 = measures[block, _MU_0].copy()
        total *= mu_0[:, None] / 3
        total[:, _MU_0] = mu_0
        total[:, _AREA] = np.abs(mu_0)
        total[np.isnan(total[:, _MU_2])] = 0.0
        measures[block] = total

    for_each(slices(surface.n_faces), spread)

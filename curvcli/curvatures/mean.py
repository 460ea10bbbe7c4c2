"""Areas, vector areas and mean curvature of stars."""

from __future__ import annotations

import numpy as np

from ..mesh.conormals import conormals
from ..mesh.surface import Surface
from ..mesh.topology import ends_of
from ..mesh.triangles import EPSILON, LOST, dot
from ..support.arrays import Column, Flags, VectorColumn
from .registry import curvature_pass
from .star import null_where, ratio

# Sums over a star are known to this part of the extents of its faces.
_ROUNDING = 8 * EPSILON


@curvature_pass(
    symbol="A_p",
    formula="⅓ Σ area(T)",
    length_exponent=2,
    preserves="ΣA_p = area",
    boundary="same",
    source="Sullivan, Discrete surfaces",
    after="K_abs",
)
def A(referenced: Flags, star_area: Column) -> Column:
    """Area of the vertex: a third of its star's."""
    return null_where(~referenced, star_area)


@curvature_pass(
    symbol="**A**_p",
    formula="⅓ Σ area(T) ν_T = ∇_p volume",
    length_exponent=2,
    parity="odd",
    vector=True,
    total="A_vec",
    preserves="volume: Σ p·A_p = 3 vol on closed surfaces; vector_area",
    boundary="same",
    source="Sullivan, Discrete surfaces",
    after="A_voronoi",
    total_after="kappa_g",
)
def A_vec(without_orientation: Flags, star_vector: VectorColumn) -> VectorColumn:
    """Vector area of the vertex: the gradient of the volume; null on patches without an orientation."""
    return null_where(without_orientation, star_vector)


@curvature_pass(
    symbol="∇_p area",
    formula="½ Σ (cot α + cot β)(p − p_i)",
    length_exponent=1,
    vector=True,
    preserves="area_gradient: Σ∇_p area = 0 and Σ p·∇_p area = 2 area",
    boundary="one cotangent on a boundary edge",
    source="Sullivan, Discrete surfaces",
    after="H_vec",
)
def area_gradient(star_curvature: VectorColumn) -> VectorColumn:
    """Gradient of the area with respect to the vertex; null at corners of degenerate faces."""
    return 0.0 - star_curvature


@curvature_pass(
    symbol="**H**_p",
    formula="½ Σ **H**_e over the edges at p with n_e ≥ 2, **H**_e = −Σ η_i|e|; inside −∇_p area",
    length_exponent=1,
    mean_degree=1,
    vector=True,
    total="H_vec",
    preserves="force_balance: Σ_∂ η|e| = Σ H_p; torque_balance; position_balance",
    boundary="same (a curvature measure): the edges inside the surface count, those of the boundary do not",
    source="Sullivan, Discrete surfaces",
    after="A_vec",
    total_after="A_vec",
)
def H_vec(surface: Surface, star_curvature: VectorColumn) -> VectorColumn:
    """Mean curvature vector of the vertex, a measure; points inwards where the surface is convex."""
    half_edges = surface.boundary_half_edges
    if not len(half_edges):
        return star_curvature
    vector, half = star_curvature.copy(), conormals(surface, half_edges)
    half *= 0.5
    for end in ends_of(surface.faces, half_edges):
        for component, part in zip(vector, half, strict=True):
            np.add.at(component, end, part)
    return vector


@curvature_pass(
    symbol="h_p",
    formula="|**H**_p| / |**A**_p|",
    kind="density",
    length_exponent=-1,
    mean_degree=1,
    preserves="the first variation: the fastest change of area, over that of volume, is |∇_p area| / |∇_p volume| = h",
    boundary="null",
    source="Sullivan, CMC and Willmore surfaces",
    pointwise=True,
    after="area_gradient",
)
def h(interior: Flags, H_vec: VectorColumn, star_vector: VectorColumn, star_area: Column) -> Column:
    """Mean curvature of the vertex without its sign; null where |A_vec| < 1e-12 A."""
    length = np.sqrt(dot(star_vector, star_vector))
    return ratio(np.sqrt(dot(H_vec, H_vec)), length, pointed(interior, length, star_area))


def pointed(interior: Flags, length: Column, area: Column) -> Flags:
    """(n,) interior vertices where a vector area of this length has not lost its direction to rounding."""
    mask: Flags = interior & (length >= LOST * area)
    return mask


@curvature_pass(
    symbol="H",
    formula="h_p, positive where **H**_p·**A**_p < 0",
    kind="density",
    length_exponent=-1,
    mean_degree=1,
    parity="odd",
    signed=True,
    preserves="see h",
    boundary="null; also where **H**_p ⊥ **A**_p to rounding",
    source="Sullivan, CMC and Willmore surfaces",
    pointwise=True,
    after="h",
)
def h_signed(
    without_orientation: Flags, h: Column, H_vec: VectorColumn, star_vector: VectorColumn, star_extent: Column
) -> Column:
    """The mean curvature H = κ₁ + κ₂ with its sign: +2/r on a sphere of radius r seen from outside.

    Null where |H·A| < 1e-12 |H||A| and H is not 0: the sign would be rounding; 0 where H is rounding itself. On
    saddle-like and minimal meshes, whose two normals can be at right angles, h_perp is the signed value, which is
    continuous.
    """
    return null_where(without_orientation, with_sign(h, H_vec, star_vector, star_extent))


def with_sign(size: Column, H_vec: VectorColumn, vector: VectorColumn, extent: Column) -> Column:
    """Mean curvatures of a size |**H**|/|**A**|, positive where **H**·**A** < 0; where that sign is rounding NaN, or 0
    if **H** is rounding too.

    extent: (n,) of the faces that **H** and **A** are summed from, to which the rounding of **H** is proportional.
    """
    product, square = dot(H_vec, vector), dot(H_vec, H_vec)
    signed = 0.0 - size
    np.copyto(signed, size, where=product < 0)
    # |H·A| below a part of |H||A|, or of what rounding makes of |A|, both sides times |H|/|A|.
    product *= size
    product *= product
    room = extent * extent
    lost = product < np.maximum(LOST**2 * square, _ROUNDING**2 * room) * square
    if lost.any():
        signed[lost] = np.where(square[lost] > LOST**2 * room[lost], np.nan, 0.0)
    return signed


@curvature_pass(
    symbol="|**H**_p|/A_p",
    formula="|**H**_p| / A_p",
    kind="density",
    length_exponent=-1,
    mean_degree=1,
    preserves="see H_vec and A",
    boundary="null",
    source="Sullivan, CMC and Willmore surfaces; Hsu, Kusner and Sullivan, Minimizing the squared mean curvature",
    pointwise=True,
    after="h_signed",
)
def h_hks(interior: Flags, H_vec: VectorColumn, star_area: Column) -> Column:
    """Mean curvature vector per area."""
    return ratio(np.sqrt(dot(H_vec, H_vec)), star_area, interior)


@curvature_pass(
    symbol="h_⊥",
    formula="−**H**·**A** / |**A**|²",
    kind="density",
    length_exponent=-1,
    mean_degree=1,
    parity="odd",
    signed=True,
    preserves="the part of **H**_p along **A**_p: how area changes when the vertex moves along its normal",
    boundary="null",
    source="Sullivan, CMC and Willmore surfaces",
    pointwise=True,
    after="h_hks",
)
def h_perp(
    interior: Flags, without_orientation: Flags, H_vec: VectorColumn, star_vector: VectorColumn, star_area: Column
) -> Column:
    """Mean curvature from the component of H_vec along A_vec, positive where convex."""
    square = dot(star_vector, star_vector)
    perp = ratio(-dot(H_vec, star_vector), square, pointed(interior, np.sqrt(square), star_area))
    return null_where(without_orientation, perp)


@curvature_pass(public=False, pointwise=True)
def normal_ratio(interior: Flags, H_vec: VectorColumn, star_vector: VectorColumn, star_area: Column) -> Column:
    """−|**H**|²/(**H**·**A**) by the star's own orientation, also where the surface has none."""
    product, square, area_square = dot(H_vec, star_vector), dot(H_vec, H_vec), dot(star_vector, star_vector)
    kept = np.abs(product) >= LOST * np.sqrt(square * area_square)
    quotient = ratio(square, np.abs(product), kept & pointed(interior, np.sqrt(area_square), star_area))
    return np.where(product < 0, quotient, 0.0 - quotient)


@curvature_pass(
    symbol="h_N",
    formula="−|**H**|² / (**H**·**A**)",
    kind="density",
    length_exponent=-1,
    mean_degree=1,
    parity="odd",
    signed=True,
    preserves="how area changes per volume when the vertex moves along **H**_p",
    boundary="null",
    source="Sullivan, CMC and Willmore surfaces",
    pointwise=True,
    after="h_perp",
)
def h_normal(without_orientation: Flags, normal_ratio: Column) -> Column:
    """Mean curvature when the vertex moves along H_vec, positive where convex; null where |H·A| < 1e-12 |H||A|."""
    return null_where(without_orientation, normal_ratio)

"""First variations: gradients of area and volume with respect to the vertices."""

from __future__ import annotations

import numpy as np

from ..mesh.counts import count_groups
from ..mesh.enclosed_volume import volumes
from ..mesh.groups import Groups
from ..mesh.surface import Surface
from ..mesh.triangles import EPSILON
from ..support.arrays import Column, VectorColumn, or_none
from ..support.words import format_rounded
from .balance import dot_offset, moments, vector_sum
from .base import IdentityValues, check, exclude_null, rounding


@check(
    gap="Σp·∇_p area − 2 area",
    applies="not where area_gradient is undefined at a corner of a degenerate face",
    bound="(16 + log₂N)ε · Σ over the corners of faces of the extent · distance from the base; for the "
    "sum of gradients without the distance",
    failure="the gradient of area is wrong at some vertex; detail names its sum if that is not zero either.",
    after="vector_area",
)
def area_gradient(
    surface: Surface, groups: Groups, area_gradient: VectorColumn, face_area: Column, star_extent: Column
) -> IdentityValues:
    """Σ ∇_p area = 0 and Σ p·∇_p area = 2 area: area is invariant under translation and of degree two in scale."""
    value = groups.vertices.sum(dot_offset(surface, area_gradient))
    expected = 2 * groups.faces.sum(face_area)
    tolerance = rounding(surface, groups.vertices.sum(moments(surface, star_extent)))
    drift = np.sqrt((vector_sum(groups.vertices, area_gradient) ** 2).sum(axis=1))
    drift_tolerance = rounding(surface, groups.vertices.sum(star_extent))

    shown = [surface.in_file_unit(side, 1) for side in (drift, drift_tolerance)]

    def detail(g: int) -> str:
        drift, allowed = (format_rounded(or_none(side[g]), 3) for side in shown)
        return f"Σ p·∇_p area against 2 area; |Σ ∇_p area| = {drift} (allowed {allowed})"

    # Both must hold: the residual includes the drift, scaled by the ratio of the bounds.
    residual = np.abs(value - expected)
    over = drift > drift_tolerance
    with np.errstate(divide="ignore", invalid="ignore"):
        residual = np.where(over, np.maximum(residual, tolerance * drift / drift_tolerance), residual)
    outcome = IdentityValues(value, expected, tolerance, length_exponent=2, detail=detail, residual=residual)
    exclude_null(outcome, groups, surface, np.isnan(area_gradient[0]), "area_gradient")
    return outcome


@check(
    gap="Σp·A_p − 3 vol",
    applies="closed orientable surfaces whose oriented faces cancel at every edge",
    bound="(16 + log₂N)ε · Σ (area of the star + ε · (Σ extents)²) · distance from the base, over the stars",
    failure="A_vec of some vertex or the volume is wrong.",
    after="area_gradient",
)
def volume(
    surface: Surface, groups: Groups, A_vec: VectorColumn, star_area: Column, star_extent: Column
) -> IdentityValues:
    """Σ p·A_p = 3 vol on closed orientable surfaces."""
    counts = count_groups(surface, groups)
    value = groups.vertices.sum(dot_offset(surface, A_vec))
    expected = 3 * volumes(surface, groups)
    # The area vector of a needle, in compensated arithmetic, has an error of ε² times a product of its edges.
    sizes = 3 * star_area + EPSILON * star_extent**2
    tolerance = rounding(surface, groups.vertices.sum(moments(surface, sizes)))
    outcome = IdentityValues(
        value, expected, tolerance, length_exponent=3, detail="Σ p·A_p against three times the volume"
    )
    outcome.exclude(~counts.closed, "the surface is not closed")
    outcome.exclude(~counts.orientable, "the surface has no orientation")
    outcome.exclude(np.isnan(expected), "the oriented faces do not cancel at every edge")
    exclude_null(outcome, groups, surface, np.isnan(A_vec[0]), "A_vec")
    return outcome

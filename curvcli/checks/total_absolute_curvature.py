"""Lower bound of total absolute curvature by topology (Chern–Lashof, Kuiper)."""

from __future__ import annotations

import numpy as np

from ..mesh.counts import classify, count_groups
from ..mesh.groups import Groups
from ..mesh.surface import Surface
from ..mesh.triangles import EPSILON
from ..support.arrays import Column
from ..support.words import format_rounded
from .base import IdentityValues, check, exclude_null


@check(
    gap="2π(4 − χ) − ΣK⁺ − ΣK⁻",
    applies="closed manifolds, one-sided ones too, per component",
    bound="16ε(F + V)",
    failure="the normal cones of K⁺ or K⁻ are too small somewhere: every closed surface has at least this much "
    "curvature.",
    after="holonomy",
)
def total_absolute_curvature(surface: Surface, groups: Groups, K_plus: Column, K_minus: Column) -> IdentityValues:
    """ΣK⁺ + ΣK⁻ ≥ 2π(4 − χ) for each closed component, one-sided or not (Chern–Lashof, Kuiper); if equal, tight."""
    counts = count_groups(surface, groups)
    value = groups.vertices.sum(K_plus) + groups.vertices.sum(K_minus)
    # 2 + 2g if orientable, 2 + the number of crosscaps if not
    bound = np.asarray(2 * np.pi * (4 * classify(surface, groups).components - counts.euler_characteristic), np.float64)
    tolerance = np.asarray(16 * EPSILON * (counts.faces + counts.vertices), np.float64)
    surplus = value - bound

    def detail(group: int) -> str:
        if surplus[group] <= tolerance[group]:
            return "tight: no more curvature than the topology demands"
        return f"{format_rounded(surplus[group])} more than the topology demands"

    outcome = IdentityValues(value, bound, tolerance, detail=detail, residual=np.maximum(-surplus, 0.0))
    outcome.exclude(~counts.closed, "the surface is not closed")
    outcome.exclude(~counts.manifold, "the surface is not a manifold")
    exclude_null(outcome, groups, surface, np.isnan(K_plus), "K_plus")
    return outcome

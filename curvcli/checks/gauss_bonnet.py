"""Gauss–Bonnet: total Gauss curvature is 2πχ."""

from __future__ import annotations

import numpy as np

from ..mesh.counts import count_groups
from ..mesh.groups import Groups
from ..mesh.surface import Surface
from ..mesh.triangles import EPSILON
from ..support.arrays import Column
from .base import IdentityValues, check, exclude_null, rounding


@check(
    gap="ΣK + Σκ_g − 2πχ",
    applies="every triangle complex, also pinched, open, one-sided or with more than two faces at an edge; not where "
    "K is undefined at a vertex",
    bound="16ε(F + V): π and 2π are rounded once at each face and each vertex, and each angle has an error of a few ε",
    failure="an angle, a vertex's curvature or χ is wrong. No mesh fails it for its shape.",
    after="",
)
def gauss_bonnet(surface: Surface, groups: Groups, K: Column, kappa_g: Column) -> IdentityValues:
    """ΣK + Σκ_g = 2πχ for any triangle complex; certifies the curvatures and χ, not that the mesh is sound."""
    counts = count_groups(surface, groups)
    value = groups.vertices.sum(K) + groups.vertices.sum(kappa_g)
    expected = np.asarray(2 * np.pi * counts.euler_characteristic, np.float64)
    tolerance = np.asarray(16 * EPSILON * (counts.faces + counts.vertices), np.float64)
    outcome = IdentityValues(value, expected, tolerance, detail=lambda g: f"χ = {counts.euler_characteristic[g]}")
    exclude_null(outcome, groups, surface, np.isnan(K) & np.isnan(kappa_g), "the angle defect")
    return outcome


@check(
    gap="ΣK_comb − 2πχ",
    applies="every triangle complex",
    bound="(16 + log₂N)ε · (Σ|K_comb| + 2π|χ|)",
    failure="edges, degrees or χ were counted wrongly: topology contradicts itself.",
    after="gauss_bonnet",
)
def gauss_bonnet_combinatorial(surface: Surface, groups: Groups, K_comb: Column) -> IdentityValues:
    """ΣK_comb = 2πχ: Gauss–Bonnet with every triangle equilateral; counts the mesh against itself."""
    counts = count_groups(surface, groups)
    terms = groups.vertices.sum(np.abs(K_comb))
    expected = np.asarray(2 * np.pi * counts.euler_characteristic, np.float64)
    tolerance = rounding(surface, terms + np.abs(expected))
    detail = "the combinatorial angle defects"
    return IdentityValues(groups.vertices.sum(K_comb), expected, tolerance, detail=detail)

"""Total Gauss curvature is topological."""

from __future__ import annotations

import numpy as np

from ..blocks import EPSILON
from ..census import census
from ..declare import Column
from ..groups import Groups
from ..surface import Surface
from .base import Outcome, check, exclude_null, rounding


@check
def gauss_bonnet(surface: Surface, groups: Groups, K: Column, kappa_g: Column) -> Outcome:
    """ΣK + Σκ_g = 2πχ for any triangle complex; certifies the curvatures and χ, not that the mesh is sound."""
    counts = census(surface, groups)
    value = groups.vertices.sum(K) + groups.vertices.sum(kappa_g)
    expected = np.asarray(2 * np.pi * counts.euler_characteristic, np.float64)
    tolerance = np.asarray(16 * EPSILON * (counts.faces + counts.vertices), np.float64)
    outcome = Outcome(value, expected, tolerance, detail=lambda g: f"χ = {counts.euler_characteristic[g]}")
    exclude_null(outcome, groups, surface, np.isnan(K) & np.isnan(kappa_g), "the angle defect")
    return outcome


@check
def gauss_bonnet_combinatorial(surface: Surface, groups: Groups, K_comb: Column) -> Outcome:
    """ΣK_comb = 2πχ: Gauss–Bonnet with every triangle equilateral; counts the mesh against itself."""
    counts = census(surface, groups)
    terms = groups.vertices.sum(np.abs(K_comb))
    expected = np.asarray(2 * np.pi * counts.euler_characteristic, np.float64)
    tolerance = rounding(surface, terms + np.abs(expected))
    detail = "the combinatorial angle defects"
    return Outcome(groups.vertices.sum(K_comb), expected, tolerance, detail=detail)

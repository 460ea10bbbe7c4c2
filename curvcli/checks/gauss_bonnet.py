"""Total Gauss curvature is topological."""

from __future__ import annotations

import numpy as np

from ..blocks import EPSILON
from ..census import census
from ..declare import Column
from ..groups import Groups
from ..surface import Surface
from .base import Outcome, check, exclude_null


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

"""Curvature per area."""

from __future__ import annotations

from ..support.arrays import Column, Flags
from .registry import curvature_pass
from .star import ratio


@curvature_pass(
    symbol="K",
    formula="K_p / area, the area chosen by --area",
    kind="density",
    length_exponent=-2,
    signed=True,
    preserves="Σ K_density · area = ΣK inside",
    boundary="null",
    source="Sullivan, Discrete surfaces",
    pointwise=True,
    after="h_normal",
)
def K_density(interior: Flags, K: Column, cell_area: Column) -> Column:
    """Gauss curvature per area; exact in sum, but on irregular triangulations it does not converge pointwise."""
    return ratio(K, cell_area, interior)

"""Averaged measures: the curvature measures summed over a neighbourhood, then divided."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..declare import Column, Quantity, VectorColumn, curvature_pass
from ..neighbourhoods import sums
from ..settings import Scale
from ..surface import Surface
from .star import ratio

_SHARED: dict[str, Any] = {
    "kind": "density",
    "signed": True,
    "boundary": "null; vertices where K or H_vec is undefined or on the boundary add neither measure nor area",
    "source": "Cohen-Steiner and Morvan, Restricted Delaunay triangulations and normal cycle; "
    "measures: Sullivan, Discrete surfaces",
}


@curvature_pass(
    provides=(
        Quantity("ring_area", public=False, length_exponent=2),
        Quantity("ring_vector", public=False, vector=True, length_exponent=2, parity="odd"),
        Quantity("ring_H_vec", public=False, vector=True, length_exponent=1, mean_degree=1),
        Quantity("ring_K", public=False),
    )
)
def ring_sums(
    surface: Surface, scale: Scale, K: Column, H_vec: VectorColumn, A_vec: VectorColumn, star_area: Column
) -> tuple[Column, ...]:
    """Sums of the measures over each neighbourhood."""
    used = surface.interior & np.isfinite(K) & np.isfinite(H_vec).all(axis=0)
    data = np.where(used, [star_area, K, *H_vec, *A_vec], 0.0)
    total = sums(surface, scale, np.ascontiguousarray(data.T)).T.copy()
    return total[0], total[5:8], total[2:5], total[1]


@curvature_pass(
    symbol="K̄",
    formula="ΣK_p / ΣA_p over the neighbourhood",
    length_exponent=-2,
    preserves="its measure is that of the neighbourhood, exactly",
    **_SHARED,
)
def K_ring(surface: Surface, ring_K: Column, ring_area: Column) -> Column:
    """Gauss curvature of the neighbourhood per area."""
    return ratio(ring_K, ring_area, surface.interior)

"""Surfaces over a round disk: caps, paraboloids and saddles."""

from __future__ import annotations

import math

import numpy as np

from .catalogue import sample
from .curvature import constant
from .facts import orientable
from .grids import disk, rings_for
from .model import Sample, demand, demand_positive


@sample(
    summary="half a sphere, bounded by its equator",
    exact="Every vertex lies on the sphere: K = 1/radius^2, H = 2/radius; the boundary is a geodesic.",
)
def hemisphere(*, size: int = 1000, radius: float = 1.0) -> Sample:
    """Rings at equal distances from the pole."""
    return _cap(size, radius, math.pi / 2)


def _cap(size: int, radius: float, opening: float) -> Sample:
    demand_positive(size=size, radius=radius)
    demand(0 < opening < math.pi, f"the angle must be between 0 and 180 degrees, not {math.degrees(opening)!r}")
    rho, phi, faces = disk(rings_for(size))
    polar = rho * opening
    points = np.stack([np.sin(polar) * np.cos(phi), np.sin(polar) * np.sin(phi), np.cos(polar)], axis=1)
    turned = 2 * math.pi * (1 - math.cos(opening))
    limit = {
        "area": turned * radius**2,
        "K": turned,
        "kappa_g": 2 * math.pi - turned,
        "H_theta": 2 * turned * radius,
        "willmore": 4 * turned,
    }
    exact = constant(len(points), 1 / radius, 1 / radius)
    return Sample(points * radius, faces, exact, orientable(loops=1), limit)

"""One-sided surfaces; what is odd in the normal has no value on them."""

from __future__ import annotations

import numpy as np

from .catalogue import sample
from .curvature import of_parametrisation, one_sided
from .facts import nonorientable
from .grids import split, table, triangles
from .model import Columns, FloatArray, Sample, demand, demand_positive


@sample(
    summary="a Moebius strip, embedded, one boundary loop",
    exact="K_density and h of the ruled strip are exact at every vertex; chi = 0, one loop, not orientable.",
)
def mobius(*, size: int = 1000, radius: float = 1.0, width: float = 0.6) -> Sample:
    """Across the strip a straight segment, turned by half a turn on its way round."""
    demand_positive(size=size, radius=radius, width=width)
    demand(width < 2 * radius, f"width must be less than twice the radius {radius!r}, not {width!r}")
    rows, columns = split(size, 2 * np.pi * radius / width)
    u = np.repeat(2 * np.pi * np.arange(rows) / rows, columns)
    v = np.tile(np.linspace(-width / 2, width / 2, columns), rows)
    numbers = table(rows, columns)
    faces = triangles(np.concatenate([numbers, numbers[:1, ::-1]]))
    zero = np.zeros_like(v)
    points, exact = _half_turned(u, radius, (v, zero), (zero + 1, zero), (zero, zero))
    return Sample(points, faces, exact, nonorientable(crosscaps=1, loops=1))


Plane = tuple[FloatArray, FloatArray]


def _half_turned(u: FloatArray, radius: float, profile: Plane, slope: Plane, bend: Plane) -> tuple[FloatArray, Columns]:
    """A plane curve carried round a circle while its plane turns by u/2, and the curvatures of the surface it sweeps.

    profile, slope, bend: the curve and its first two derivatives along v, each two arrays (V,).
    """
    (p, q), (pv, qv), (pvv, qvv) = (_turned(u / 2, *plane) for plane in (profile, slope, bend))
    out = np.stack([np.cos(u), np.sin(u), np.zeros_like(u)], axis=1)
    on = np.stack([-np.sin(u), np.cos(u), np.zeros_like(u)], axis=1)
    up = np.array([0.0, 0.0, 1.0])

    def vector(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
        return np.asarray(a[:, None] * out + b[:, None] * on + c[:, None] * up)

    # d/du turns (p, q) into (-q, p)/2, out into on, on into -out.
    zero = np.zeros_like(u)
    points = vector(radius + p, zero, q)
    xu, xv = vector(-q / 2, radius + p, p / 2), vector(pv, zero, qv)
    xuu, xuv, xvv = vector(-p / 4 - radius - p, -q, -q / 4), vector(-qv / 2, pv, pv / 2), vector(pvv, zero, qvv)
    return points, one_sided(of_parametrisation(xu, xv, xuu, xuv, xvv))


def _turned(angle: FloatArray, p: FloatArray, q: FloatArray) -> Plane:
    return np.cos(angle) * p - np.sin(angle) * q, np.sin(angle) * p + np.cos(angle) * q

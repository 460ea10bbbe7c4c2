"""One-sided surfaces; quantities that are odd in the normal are undefined on them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .catalogue import sample
from .curvature import inverted, of_parametrisation, one_sided
from .facts import nonorientable
from .grids import disk, looped, rings_for, split, table, triangles
from .model import ExactColumns, FloatArray, Sample, demand, demand_positive

ComplexArray = NDArray[np.complex128]
Plane = tuple[FloatArray, FloatArray]


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


@sample(
    summary="a Klein bottle, immersed: a figure eight carried round with half a turn",
    exact="K_density and h of the immersion are exact at every vertex; chi = 0, total curvature 0, not orientable.",
)
def klein_bottle(*, size: int = 1500, radius: float = 2.0, width: float = 1.0) -> Sample:
    """The eight is (sin v, sin 2v) times width; on the circle where it cuts itself only one branch has vertices."""
    demand_positive(size=size, radius=radius, width=width)
    demand(width < radius, f"width must be less than radius {radius!r}, not {width!r}")
    rows, columns = split(size, radius / width / 1.5)
    # An odd number of columns: v = 0 is a vertex, the other branch of the crossing v = pi is not.
    columns += 1 - columns % 2
    u = np.repeat(2 * np.pi * np.arange(rows) / rows, columns)
    v = np.tile(2 * np.pi * np.arange(columns) / columns, rows)
    numbers = looped(table(rows, columns), 1)
    # Half a turn takes the eight to itself with v -> -v.
    faces = triangles(np.concatenate([numbers, numbers[:1, ::-1]]))
    eight = (width * np.sin(v), width * np.sin(2 * v))
    slope, bend = (width * np.cos(v), 2 * width * np.cos(2 * v)), (-eight[0], -4 * eight[1])
    points, exact = _half_turned(u, radius, eight, slope, bend)
    return Sample(points, faces, exact, nonorientable(crosscaps=2))


@sample(
    summary="Boy's surface: the projective plane immersed with least Willmore energy",
    exact="K_density and h of Bryant and Kusner's immersion are exact; Willmore energy 48 pi, total curvature 2 pi.",
)
def projective_plane(*, size: int = 1500) -> Sample:
    """The unit disk, opposite points of its rim made one, mapped by an inverted minimal surface with 3 flat ends."""
    demand_positive(size=size)
    rings = rings_for(size)
    rho, phi, faces = disk(rings)
    inner = 1 + 3 * rings * (rings - 1)
    count = inner + 3 * rings
    faces = np.where(faces >= count, faces - 3 * rings, faces).astype(np.int32)
    w = (rho * np.exp(1j * phi))[:count]
    film, first, second = _three_ends(w)
    xu, xv, xuu, xuv = first.real, -first.imag, second.real, -second.imag
    kappa = of_parametrisation(xu, xv, xuu, xuv, -xuu)["kappa_1"]
    normal = np.cross(xu, xv)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    exact = one_sided(inverted(kappa, -kappa, normal, film))
    points = film / np.einsum("ij,ij->i", film, film)[:, None]
    return Sample(points, faces, exact, nonorientable(crosscaps=1), {"K": 2 * np.pi, "willmore": 48 * np.pi})


def _three_ends(w: ComplexArray) -> tuple[FloatArray, ComplexArray, ComplexArray]:
    """Kusner's minimal surface Re f(w), (V, 3), and the complex derivatives f' and f''."""
    below = np.poly1d([1, 0, 0, math.sqrt(5), 0, 0, -1])
    above = [
        np.poly1d([-1, 0, 0, 0, 1, 0]) * 1.5j,
        np.poly1d([1, 0, 0, 0, 1, 0]) * -1.5,
        np.poly1d([1, 0, 0, 0, 0, 0, 1]) * -1j,
    ]
    values = []
    for top in above:
        slope = top.deriv() * below - top * below.deriv()
        bend = slope.deriv() * below - 2 * slope * below.deriv()
        values.append((top(w) / below(w), slope(w) / below(w) ** 2, bend(w) / below(w) ** 3))
    f, first, second = (np.stack(components, axis=1) for components in zip(*values, strict=True))
    return f.real - np.array([0.0, 0.0, 0.5]), first, second


def _half_turned(
    u: FloatArray, radius: float, profile: Plane, slope: Plane, bend: Plane
) -> tuple[FloatArray, ExactColumns]:
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

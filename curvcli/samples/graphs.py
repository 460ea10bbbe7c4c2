"""Surfaces over a round disk: caps, paraboloids and saddles."""

from __future__ import annotations

import math

import numpy as np

from .catalogue import sample
from .curvature import constant, facing, of_graph
from .facts import orientable
from .grids import disk, rings_for
from .model import FloatArray, IntArray, Sample, demand, demand_positive


@sample(
    summary="half a sphere, bounded by its equator",
    exact="Every vertex lies on the sphere: K = 1/radius^2, H = 2/radius; the boundary is a geodesic.",
)
def hemisphere(*, size: int = 1000, radius: float = 1.0) -> Sample:
    """Rings at equal distances from the pole."""
    return _cap(size, radius, math.pi / 2)


@sample(
    summary="a cap of a sphere, up to the given angle from its pole",
    exact="Every vertex lies on the sphere: K = 1/radius^2, H = 2/radius; total curvature 2 pi (1 - cos angle).",
)
def cap(*, size: int = 1000, radius: float = 1.0, angle: float = 50.0) -> Sample:
    """Rings at equal distances from the pole; angle in degrees."""
    return _cap(size, radius, math.radians(angle))


@sample(
    summary="a dome: a paraboloid over a disk",
    exact="Curvatures of z = (radius^2 - x^2 - y^2)/(2 focus) everywhere; area and total curvature in closed form.",
)
def paraboloid(*, size: int = 1000, radius: float = 1.0, focus: float = 1.0) -> Sample:
    """focus: the radius of curvature at the top (twice the focal length)."""
    x, y, faces = _round(size, radius, focus)
    second_derivative = np.full_like(x, -1 / focus)
    exact = of_graph(-x / focus, -y / focus, second_derivative, 0 * x, second_derivative)
    height = (radius**2 - x**2 - y**2) / (2 * focus)
    total = 2 * math.pi * (1 - 1 / math.hypot(1, radius / focus))
    limit = {"area": _quadratic_area(radius, focus), "K": total, "kappa_g": 2 * math.pi - total}
    return Sample(np.stack([x, y, height], axis=1), faces, exact, orientable(loops=1), limit)


@sample(
    summary="a saddle: a hyperbolic paraboloid over a disk",
    exact="Curvatures of z = (x^2 - y^2)/(2 focus) everywhere; area and total curvature in closed form.",
)
def saddle(*, size: int = 1000, radius: float = 1.0, focus: float = 1.0) -> Sample:
    """focus: the radius of both principal curvatures in the middle."""
    x, y, faces = _round(size, radius, focus)
    second_derivative = np.full_like(x, 1 / focus)
    exact = of_graph(x / focus, -y / focus, second_derivative, 0 * x, -second_derivative)
    total = -2 * math.pi * (1 - 1 / math.hypot(1, radius / focus))
    limit = {"area": _quadratic_area(radius, focus), "K": total, "kappa_g": 2 * math.pi - total, "H_theta": 0.0}
    return Sample(np.stack([x, y, (x**2 - y**2) / (2 * focus)], axis=1), faces, exact, orientable(loops=1), limit)


@sample(
    summary="a saddle for a rider with a tail: three valleys, flat in the middle",
    exact="Curvatures of z = (x^3 - 3 x y^2)/(3 focus^2) at every vertex; K = 0 in the middle; exact total curvature.",
)
def monkey_saddle(*, size: int = 1000, radius: float = 1.0, focus: float = 1.0) -> Sample:
    """focus: the distance from the middle at which the slope is 1."""
    x, y, faces = _round(size, radius, focus)
    scale = focus**2
    bend = 2 * x / scale
    exact = of_graph((x**2 - y**2) / scale, -2 * x * y / scale, bend, -2 * y / scale, -bend)
    total = -4 * math.pi * (1 - 1 / math.hypot(1, (radius / focus) ** 2))
    limit = {"K": total, "kappa_g": 2 * math.pi - total, "H_theta": 0.0}
    height = (x**3 - 3 * x * y**2) / (3 * scale)
    return Sample(np.stack([x, y, height], axis=1), faces, exact, orientable(loops=1), limit)


def _round(size: int, radius: float, focus: float) -> tuple[FloatArray, FloatArray, IntArray]:
    """Vertices x, y and upward faces over a disk."""
    demand_positive(size=size, radius=radius, focus=focus)
    rho, phi, faces = disk(rings_for(size))
    return radius * rho * np.cos(phi), radius * rho * np.sin(phi), faces


def _quadratic_area(radius: float, focus: float) -> float:
    """Area of a graph of slope r/focus over the disk."""
    return 2 * math.pi / 3 * focus**2 * (math.hypot(1, radius / focus) ** 3 - 1)


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
    exact = facing(constant(len(points), 1 / radius, 1 / radius), points)
    return Sample(points * radius, faces, exact, orientable(loops=1), limit)

"""Minimal surfaces: mean curvature zero."""

from __future__ import annotations

import math

import numpy as np

from .catalogue import sample
from .curvature import facing, of_graph, principal, revolved
from .facts import orientable
from .grids import disk, revolve, rings_for, split, table, triangles
from .model import ExactColumns, FloatArray, Sample, demand, demand_positive


@sample(
    summary="a catenoid: the soap film between two rings",
    exact="H = 0, K = -1/(neck^2 cosh^4(z/neck)) at every vertex; area and total curvature in closed form.",
)
def catenoid(*, size: int = 1000, neck: float = 1.0, height: float = 2.0) -> Sample:
    """Profile neck cosh(z/neck) between -height/2 and height/2."""
    demand_positive(size=size, neck=neck, height=height)
    end = height / (2 * neck)
    swept = 2 * math.pi * (end + math.sinh(end) * math.cosh(end))
    # Equal steps of arc length sinh t.
    rows, columns = split(size, (2 * math.sinh(end)) ** 2 / swept, least=2)
    t = np.arcsinh(np.linspace(-math.sinh(end), math.sinh(end), rows))
    points, faces, row = revolve(neck * np.cosh(t), neck * t, max(columns, 3))
    total = -4 * math.pi * math.tanh(end)
    limit = _film(swept * neck**2, total, 0)
    exact = facing(_balanced(1 / (neck * np.cosh(t[row]) ** 2)), revolved(points, 1, -np.sinh(t[row])))
    return Sample(points, faces, exact, orientable(loops=2), limit)


@sample(
    summary="a helicoid: a spiral ramp",
    exact="H = 0, K = -pitch^2/(pitch^2 + r^2)^2 at every vertex; area and total curvature in closed form.",
)
def helicoid(*, size: int = 1000, radius: float = 1.0, pitch: float = 0.5, turns: float = 1.0) -> Sample:
    """(r cos t, r sin t, pitch t) for |r| <= radius; pitch is the rise per radian."""
    demand_positive(size=size, radius=radius, pitch=pitch, turns=turns)
    angle = 2 * math.pi * turns
    swept = angle * (radius * math.hypot(radius, pitch) + pitch**2 * math.asinh(radius / pitch))
    rows, columns = split(size, (2 * radius) ** 2 / swept, least=2)
    r = np.repeat(np.linspace(-radius, radius, rows), columns)
    t = np.tile(np.linspace(-angle / 2, angle / 2, columns), rows)
    points = np.stack([r * np.cos(t), r * np.sin(t), pitch * t], axis=1)
    limit = _film(swept, -2 * angle * radius / math.hypot(radius, pitch), 1)
    exact = facing(_balanced(pitch / (pitch**2 + r**2)), np.stack([pitch * np.sin(t), -pitch * np.cos(t), r], axis=1))
    return Sample(points, triangles(table(rows, columns)), exact, orientable(loops=1), limit)


@sample(
    summary="the middle of Enneper's surface, as far as it does not meet itself",
    exact="H = 0, K = -4/(1 + rho^2)^4 at every vertex; area and total curvature in closed form.",
)
def enneper(*, size: int = 1000, reach: float = 1.0) -> Sample:
    """(u - u^3/3 + u v^2, v - v^3/3 + v u^2, u^2 - v^2) over the disk rho <= reach, embedded up to sqrt(3)."""
    demand_positive(size=size, reach=reach)
    demand(reach < math.sqrt(3), f"reach must be less than sqrt(3), not {reach!r}, or the surface cuts itself")
    rho, phi, faces = disk(rings_for(size))
    u, v = reach * rho * np.cos(phi), reach * rho * np.sin(phi)
    points = np.stack([u - u**3 / 3 + u * v**2, v - v**3 / 3 + v * u**2, u**2 - v**2], axis=1)
    square = reach**2
    limit = _film(math.pi * (square + square**2 + square**3 / 3), -4 * math.pi * square / (1 + square), 1)
    exact = facing(_balanced(2 / (1 + u**2 + v**2) ** 2), np.stack([-2 * u, 2 * v, 1 - u**2 - v**2], axis=1))
    return Sample(points, faces, exact, orientable(loops=1), limit)


@sample(
    summary="a patch of Scherk's first surface: a saddle that is a soap film",
    exact="Curvatures of z = log(cos y/cos x) at every vertex, H = 0.",
)
def scherk(*, size: int = 1000, reach: float = 1.2) -> Sample:
    """Over the disk of radius reach, below pi/2."""
    demand_positive(size=size, reach=reach)
    demand(reach < math.pi / 2, f"reach must be less than pi/2, not {reach!r}, where the surface runs off to infinity")
    rho, phi, faces = disk(rings_for(size))
    x, y = reach * rho * np.cos(phi), reach * rho * np.sin(phi)
    points = np.stack([x, y, np.log(np.cos(y) / np.cos(x))], axis=1)
    graph = of_graph(np.tan(x), -np.tan(y), np.cos(x) ** -2, 0 * x, -(np.cos(y) ** -2))
    limit = {"H_theta": 0.0, "willmore": 0.0}
    exact = graph | _balanced(np.sqrt(-graph["K_density"]))
    return Sample(points, faces, exact, orientable(loops=1), limit)


def _balanced(kappa: FloatArray) -> ExactColumns:
    """Columns of principal curvatures kappa and -kappa."""
    return principal(kappa, -kappa)


def _film(area: float, total: float, chi: int) -> dict[str, float]:
    """Totals of a minimal surface."""
    return {"area": area, "K": total, "kappa_g": 2 * math.pi * chi - total, "H_theta": 0.0, "willmore": 0.0}

"""Closed tubes about closed curves: tori and knots."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from .catalogue import sample
from .curvature import facing, inverted, principal
from .facts import orientable
from .flat_torus import periodic_delaunay
from .grids import closed_grid, shaken, split
from .model import FloatArray, IntArray, Sample, demand, demand_positive


@sample(
    summary="a torus of revolution on a regular grid",
    exact="Principal curvatures 1/tube and cos v/(radius + tube cos v) at every vertex; total curvature 0.",
)
def torus(
    *,
    size: int = 1200,
    radius: float = 1.0,
    tube: float = 0.4,
    aspect: float = 1.0,
    jitter: float = 0.0,
    seed: int = 0,
) -> Sample:
    """Rows round the axis, columns round the tube.

    aspect: how much longer than wide the squares are, along the tube. jitter: the largest shift of a vertex in its
    parameters, in steps of the grid, below 1/2.
    """
    _demand_torus(size, radius, tube)
    demand_positive(aspect=aspect)
    rows, columns = split(size, radius / tube / aspect)
    shift = shaken(rows * columns, jitter, seed)
    u = 2 * np.pi * (np.repeat(np.arange(rows), columns) + shift[:, 0]) / rows
    v = 2 * np.pi * (np.tile(np.arange(columns), rows) + shift[:, 1]) / columns
    return _torus(u, v, closed_grid(rows, columns), radius, tube)


@sample(
    summary="a torus of revolution through random points, triangles of every shape",
    exact="Principal curvatures 1/tube and cos v/(radius + tube cos v) at every vertex; total curvature 0.",
)
def irregular_torus(*, size: int = 1200, radius: float = 1.0, tube: float = 0.4, seed: int = 0) -> Sample:
    """As many vertices as asked for, uniform by area, joined by Delaunay's rule in conformal coordinates."""
    _demand_torus(size, radius, tube)
    demand(size >= 100, f"size must be at least 100, not {size!r}, for random points to make a torus")
    demand(seed >= 0, f"seed must not be negative, not {seed!r}")
    random = np.random.default_rng(seed)
    u = random.uniform(0, 2 * np.pi, size)
    v = _uniform_by_area(random.uniform(0, 2 * np.pi, size), tube / radius)
    # The torus is conformal to the plane: (radius + tube cos v)^2 (du^2 + dw^2), dw = tube dv/(radius + tube cos v).
    slope = math.sqrt(radius**2 - tube**2)
    w = 2 * tube / slope * np.arctan2(slope / (radius + tube) * np.sin(v / 2), np.cos(v / 2))
    faces = periodic_delaunay(np.stack([u, w], axis=1), (2 * math.pi, 2 * math.pi * tube / slope))
    return _torus(u, v, faces, radius, tube)


@sample(
    summary="the Clifford torus, whose Willmore energy is least of all tori",
    exact="The torus with radius/tube = sqrt(2): Willmore energy 8 pi^2, total curvature 0.",
)
def clifford_torus(*, size: int = 1200, radius: float = 1.0) -> Sample:
    """Stereographic image of the flat torus in the three-sphere."""
    made: Sample = torus.function(size=size, radius=radius, tube=radius / math.sqrt(2))
    return replace(made, limit=made.limit | {"willmore": 8 * math.pi**2})


@sample(
    summary="Dupin's cyclide: a Clifford torus turned inside out about a point outside it",
    exact="Principal curvatures are exact at every vertex; the Willmore energy stays 8 pi^2, since inversions keep it.",
)
def cyclide(*, size: int = 1200, distance: float = 2.5) -> Sample:
    """The Clifford torus of radius 1, inverted about a point in its plane at that distance from its axis."""
    made: Sample = clifford_torus.function(size=size, radius=1.0)
    demand(distance > 1 + math.sqrt(0.5), f"distance must be above {1 + math.sqrt(0.5):.4g}, not {distance!r}")
    on_axis = np.hypot(made.points[:, 0], made.points[:, 1])
    circle = made.points * np.array([1.0, 1.0, 0.0]) / on_axis[:, None]
    offset = made.points - np.array([distance, 0.0, 0.0])
    exact = inverted(made.exact["kappa_1"], made.exact["kappa_2"], (made.points - circle) * math.sqrt(2), offset)
    points = offset / np.einsum("ij,ij->i", offset, offset)[:, None]
    limit = {"K": 0.0, "willmore": 8 * math.pi**2}
    return Sample(points, made.faces[:, ::-1], exact, made.facts, limit)


@sample(
    summary="a tube about a trefoil knot: a knotted torus",
    exact="Principal curvatures 1/tube and -k cos t/(1 - tube k cos t), k that of the knot; exact area and volume.",
)
def trefoil_tube(*, size: int = 2000, radius: float = 1.0, tube: float = 0.4) -> Sample:
    """Circles about radius (sin t + 2 sin 2t, cos t - 2 cos 2t, -sin 3t), counted from its principal normal."""
    demand_positive(size=size, radius=radius, tube=tube)
    demand(tube < 0.6 * radius, f"tube must be less than {0.6 * radius!r}, not {tube!r}, or the tube cuts itself")
    _, speed, bend, *_ = _trefoil(2 * np.pi * np.arange(4096) / 4096)
    length = 2 * math.pi * radius * float(speed.mean())
    rows, columns = split(size, length / (2 * math.pi * tube))
    along, around = np.repeat(np.arange(rows), columns), np.tile(np.arange(columns), rows)
    centre, _, curvature, normal, binormal = _trefoil(2 * np.pi * along / rows)
    v = 2 * np.pi * around / columns
    points = radius * centre + tube * (np.cos(v)[:, None] * normal + np.sin(v)[:, None] * binormal)
    inner = curvature / radius * np.cos(v)
    outward = np.cos(v)[:, None] * normal + np.sin(v)[:, None] * binormal
    exact = facing(principal(np.full(len(v), 1 / tube), -inner / (1 - tube * inner)), outward)
    limit = {
        "area": 2 * math.pi * tube * length,
        "volume": math.pi * tube**2 * length,
        "K": 0.0,
        "H_theta": 2 * math.pi * length,
        # The trapezoidal sum of a periodic analytic function is exact to rounding.
        "willmore": float((4 * np.pi**2 * radius / tube * speed / np.sqrt(1 - (tube / radius * bend) ** 2)).mean()),
    }
    return Sample(points, closed_grid(rows, columns)[:, ::-1], exact, orientable(genus=1, convex=False), limit)


def _trefoil(t: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
    """Position (V, 3), speed (V,), curvature (V,), principal normal and binormal (V, 3) of the trefoil."""
    where = np.stack([np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), -np.sin(3 * t)], axis=1)
    first = np.stack([np.cos(t) + 4 * np.cos(2 * t), -np.sin(t) + 4 * np.sin(2 * t), -3 * np.cos(3 * t)], axis=1)
    second = np.stack([-np.sin(t) - 8 * np.sin(2 * t), -np.cos(t) + 8 * np.cos(2 * t), 9 * np.sin(3 * t)], axis=1)
    speed = np.linalg.norm(first, axis=1)
    binormal = np.cross(first, second)
    size = np.linalg.norm(binormal, axis=1)
    binormal /= size[:, None]
    return where, speed, size / speed**3, np.cross(binormal, first / speed[:, None]), binormal


def _uniform_by_area(mean: FloatArray, ratio: float) -> FloatArray:
    """Solve v + ratio sin v = mean (Kepler's equation), so that v has density 1 + ratio cos v, by bisection."""
    low, high = np.zeros_like(mean), np.full_like(mean, 2 * np.pi)
    for _ in range(52):
        middle = (low + high) / 2
        above = middle + ratio * np.sin(middle) > mean
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return np.asarray((low + high) / 2)


def _demand_torus(size: int, radius: float, tube: float) -> None:
    demand_positive(size=size, radius=radius, tube=tube)
    demand(tube < radius, f"tube must be less than radius {radius!r}, not {tube!r}, or the torus cuts itself")


def _torus(u: FloatArray, v: FloatArray, faces: IntArray, radius: float, tube: float) -> Sample:
    """The torus at parameters u round the axis and v round the tube, with what is known of it."""
    distance = radius + tube * np.cos(v)
    points = np.stack([distance * np.cos(u), distance * np.sin(u), tube * np.sin(v)], axis=1)
    ratio = radius / tube
    limit = {
        "area": 4 * math.pi**2 * radius * tube,
        "volume": 2 * math.pi**2 * radius * tube**2,
        "K": 0.0,
        "H_theta": 4 * math.pi**2 * radius,
        "willmore": 4 * math.pi**2 * ratio**2 / math.sqrt(ratio**2 - 1),
    }
    outward = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], axis=1)
    exact = facing(principal(np.full(len(u), 1 / tube), np.cos(v) / distance), outward)
    return Sample(points, faces, exact, orientable(genus=1, convex=False), limit)

"""Closed tubes about closed curves: tori and knots."""

from __future__ import annotations

import math

import numpy as np

from .catalogue import sample
from .curvature import principal
from .facts import orientable
from .grids import looped, split, table, triangles
from .model import FloatArray, IntArray, Sample, demand, demand_positive


@sample(
    summary="a torus of revolution on a regular grid",
    exact="Principal curvatures 1/tube and cos v/(radius + tube cos v) at every vertex; total curvature 0.",
)
def torus(*, size: int = 1200, radius: float = 1.0, tube: float = 0.4) -> Sample:
    """Rows round the axis, columns round the tube, cut so that outer squares are square."""
    _demand_torus(size, radius, tube)
    rows, columns = split(size, radius / tube)
    u = np.repeat(2 * np.pi * np.arange(rows) / rows, columns)
    v = np.tile(2 * np.pi * np.arange(columns) / columns, rows)
    return _torus(u, v, closed_grid(rows, columns), radius, tube)


def closed_grid(rows: int, columns: int) -> IntArray:
    """Faces of a grid that closes up in both directions."""
    return triangles(looped(looped(table(rows, columns), 0), 1))


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
    exact = principal(np.full(len(u), 1 / tube), np.cos(v) / distance)
    return Sample(points, faces, exact, orientable(genus=1, convex=False), limit)

"""Flat pieces, and one that is bent without being stretched."""

from __future__ import annotations

import math

import numpy as np

from .catalogue import sample
from .curvature import constant, facing, principal
from .facts import orientable
from .grids import disk as rings_disk
from .grids import looped, rings_for, shaken, split, table, triangles
from .model import ExactColumns, FloatArray, Sample, demand, demand_positive


@sample(
    summary="a flat square, if wanted with its inner vertices shaken",
    exact="Every curvature is 0 inside, that of the mesh too; the boundary turns by 2 pi, in four corners.",
)
def plane(*, size: int = 1000, width: float = 1.0, jitter: float = 0.0, seed: int = 0) -> Sample:
    """jitter: the largest shift of a vertex in steps of the grid, below 1/2; it stays in its side of the square."""
    demand_positive(size=size, width=width)
    side = max(2, round(math.sqrt(size)))
    row, column = np.divmod(np.arange(side * side), side)
    shift = shaken(side * side, jitter, seed)
    edge_x, edge_y = np.isin(row, [0, side - 1]), np.isin(column, [0, side - 1])
    x = np.where(edge_x, row, row + shift[:, 0]) / (side - 1) - 0.5
    y = np.where(edge_y, column, column + shift[:, 1]) / (side - 1) - 0.5
    points = np.stack([x * width, y * width, np.zeros(side * side)], axis=1)
    facts = orientable(loops=1, area=width**2)
    return Sample(points, triangles(table(side, side)), _flat(edge_x | edge_y), facts)


@sample(
    summary="a flat disk of nearly equilateral triangles",
    exact="Every curvature is 0 inside, that of the mesh too; the boundary turns by 2 pi, evenly.",
)
def disk(*, size: int = 1000, radius: float = 1.0) -> Sample:
    """Rings of 6, 12, 18, ... vertices; the boundary is a regular polygon."""
    demand_positive(size=size, radius=radius)
    rings = rings_for(size)
    rho, phi, faces = rings_disk(rings)
    points = radius * np.stack([rho * np.cos(phi), rho * np.sin(phi), np.zeros_like(phi)], axis=1)
    facts = orientable(loops=1, area=3 * rings * radius**2 * math.sin(math.pi / (3 * rings)))
    return Sample(points, faces, _flat(rho == 1), facts, {"area": math.pi * radius**2})


@sample(
    summary="a flat ring between two circles",
    exact="Every curvature is 0 inside, that of the mesh too; the outer boundary turns by 2 pi, the inner by -2 pi.",
)
def annulus(*, size: int = 1000, radius: float = 1.0, hole: float = 0.4) -> Sample:
    """Both boundaries are regular polygons with as many sides."""
    demand_positive(size=size, radius=radius, hole=hole)
    demand(hole < radius, f"hole must be less than radius {radius!r}, not {hole!r}")
    rows, columns = split(size, (radius - hole) / (math.pi * (radius + hole)), least=2)
    columns = max(columns, 3)
    distance = np.repeat(np.linspace(hole, radius, rows), columns)
    phi = np.tile(2 * np.pi * np.arange(columns) / columns, rows)
    points = np.stack([distance * np.cos(phi), distance * np.sin(phi), np.zeros_like(phi)], axis=1)
    row = np.repeat(np.arange(rows), columns)
    polygon = columns / 2 * math.sin(2 * math.pi / columns)
    facts = orientable(loops=2, area=polygon * (radius**2 - hole**2))
    limit = {"area": math.pi * (radius**2 - hole**2)}
    return Sample(
        points, triangles(looped(table(rows, columns), 1)), _flat((row == 0) | (row == rows - 1)), facts, limit
    )


@sample(
    summary="a strip of paper bent into an S: an isometric image of a plane rectangle",
    exact="K = 0 inside, of the mesh too, however it is bent; H = -s 2 bend/length at the distance s from the middle.",
)
def developable_strip(
    *, size: int = 1000, length: float = 4.0, width: float = 1.0, bend: float = 2.0, jitter: float = 0.3, seed: int = 0
) -> Sample:
    """A cylinder over a clothoid, which bends from -bend at one end to bend at the other (in 1/length).

    The mesh is folded along its rulings only, along which the vertices are shaken by up to `jitter` steps.
    """
    from scipy.special import fresnel

    demand_positive(size=size, length=length, width=width, bend=bend)
    rows, columns = split(size, length / width, least=2)
    s = np.linspace(-length / 2, length / 2, rows)
    rate = 2 * bend / length
    unit = math.sqrt(math.pi / rate)
    sine, cosine = fresnel(s / unit)
    row, column = np.divmod(np.arange(rows * columns), columns)
    ends = np.isin(column, [0, columns - 1])
    shift = shaken(rows * columns, jitter, seed)[:, 0]
    y = width * (np.where(ends, column, column + shift) / (columns - 1) - 0.5)
    points = np.stack([unit * cosine[row], y, unit * sine[row]], axis=1)
    rim = ends | np.isin(row, [0, rows - 1])
    turn = rate * s[row] ** 2 / 2
    normal = np.stack([-np.sin(turn), np.zeros(len(row)), np.cos(turn)], axis=1)
    exact = facing(principal(np.zeros(len(row)), -rate * s[row]), normal) | {"K": np.where(rim, np.nan, 0.0)}
    limit = {"area": length * width, "K": 0.0, "H_theta": 0.0, "willmore": width * rate**2 * length**3 / 12}
    return Sample(points, triangles(table(rows, columns)), exact, orientable(loops=1), limit)


def _flat(rim: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]) -> ExactColumns:
    """All curvatures zero; the angle defect too, where it is one."""
    defect: FloatArray = np.where(rim, np.nan, 0.0)
    return facing(constant(len(rim), 0.0, 0.0), [0.0, 0.0, 1.0]) | {"K": defect}

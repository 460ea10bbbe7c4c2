"""Surfaces of revolution about the z axis, and the Schwarz lantern."""

from __future__ import annotations

import math

import numpy as np

from .catalogue import sample
from .curvature import constant, facing, principal, revolved
from .facts import orientable
from .grids import revolve, split, table
from .model import Sample, demand, demand_positive


@sample(
    summary="the side of a cylinder, open at both ends",
    exact="kappa_1 = 1/radius, kappa_2 = 0; K = 0 inside, of the mesh too; both boundaries are geodesics.",
)
def cylinder(*, size: int = 1000, radius: float = 1.0, height: float = 2.0, aspect: float = 1.0) -> Sample:
    """aspect: how much longer than wide the squares are, along the axis."""
    demand_positive(size=size, radius=radius, height=height, aspect=aspect)
    rows, columns = split(size, height / (2 * math.pi * radius) / aspect, least=2)
    columns = max(columns, 3)
    z = np.linspace(-height / 2, height / 2, rows)
    points, faces, row = revolve(np.full(rows, radius), z, columns)
    defect = np.where(np.isin(row, [0, rows - 1]), np.nan, 0.0)
    exact = facing(constant(len(points), 1 / radius, 0.0), revolved(points, 1, 0)) | {"K": defect}
    facts = orientable(loops=2, area=2 * columns * radius * math.sin(math.pi / columns) * height)
    area = 2 * math.pi * radius * height
    limit = {"area": area, "K": 0.0, "kappa_g": 0.0, "H_theta": area / radius, "willmore": area / radius**2}
    return Sample(points, faces, exact, facts, limit)


@sample(
    summary="a cylinder closed by two flat disks",
    exact="K = 2 pi/n at the n vertices of each rim, 0 elsewhere; area, volume and H_theta of the mesh are exact.",
)
def closed_cylinder(*, size: int = 1000, radius: float = 1.0, height: float = 2.0) -> Sample:
    """The disks are fans of rings about a vertex in the middle; on the rims the smooth curvatures have no value."""
    demand_positive(size=size, radius=radius, height=height)
    rows, columns = split(size, (height + 2 * radius) / (2 * math.pi * radius))
    columns = max(columns, 3)
    share = radius / (height + 2 * radius)
    inner, upright = max(1, round(share * rows)), max(1, round((1 - 2 * share) * rows))
    out = radius * np.arange(inner) / inner
    side = np.linspace(-height / 2, height / 2, upright + 1)
    distance = np.concatenate([out, np.full(upright + 1, radius), out[::-1]])
    z = np.concatenate([np.full(inner, side[0]), side, np.full(inner, side[-1])])
    points, faces, row = revolve(distance, z, columns)
    rim = np.isin(row, [inner, inner + upright])
    across = np.where((row > inner) & (row < inner + upright), 1 / radius, 0.0)
    exact = principal(np.where(rim, np.nan, across), np.where(rim, np.nan, 0.0))
    exact = facing(exact, revolved(points, np.where(rim, np.nan, across), np.where(across > 0, 0.0, points[:, 2])))
    exact["K"] = np.where(rim, 2 * math.pi / columns, 0.0)
    chord, base = 2 * radius * math.sin(math.pi / columns), columns / 2 * radius**2 * math.sin(2 * math.pi / columns)
    facts = orientable(
        area=columns * chord * height + 2 * base,
        volume=base * height,
        H_theta=2 * math.pi * height + math.pi * columns * chord,
        convex=True,
    )
    limit = {
        "area": 2 * math.pi * radius * (radius + height),
        "volume": math.pi * radius**2 * height,
        "K": 4 * math.pi,
        "H_theta": 2 * math.pi * height + 2 * math.pi**2 * radius,
    }
    return Sample(points, faces, exact, facts, limit)


@sample(
    summary="the side of a cone, open below, with its apex",
    exact="K = 0 but at the apex, of the mesh too: there 2 pi - 2 n asin(radius sin(pi/n)/slant), n to a ring.",
)
def cone(*, size: int = 1000, radius: float = 1.0, height: float = 1.0) -> Sample:
    """Rings at equal distances; at the apex the smooth curvatures have no value."""
    demand_positive(size=size, radius=radius, height=height)
    slant = math.hypot(radius, height)
    rows, columns = split(size, slant / (math.pi * radius), least=2)
    columns = max(columns, 3)
    step = np.arange(rows + 1) / rows
    points, faces, row = revolve(radius * step[::-1], height * step, columns)
    apex = row == rows
    around = height / slant / (radius * np.where(apex, np.nan, 1 - step[row]))
    exact = facing(principal(around, 0 * around), revolved(points, np.where(apex, np.nan, height), radius))
    tip = 2 * math.pi - 2 * columns * math.asin(radius * math.sin(math.pi / columns) / slant)
    exact["K"] = np.select([apex, row == 0], [tip, np.nan], 0.0)
    base = math.hypot(height, radius * math.cos(math.pi / columns))
    facts = orientable(loops=1, area=columns * radius * math.sin(math.pi / columns) * base)
    total = 2 * math.pi * (1 - radius / slant)
    limit = {
        "area": math.pi * radius * slant,
        "K": total,
        "kappa_g": 2 * math.pi - total,
        "H_theta": 2 * math.pi * height,
    }
    return Sample(points, faces, exact, facts, limit)


@sample(
    summary="a piece of the pseudosphere (tractroid): constant negative curvature",
    exact="K = -1/radius^2 at every vertex, kappa_1 = sinh(t)/radius; area and total curvature in closed form.",
)
def pseudosphere(*, size: int = 1000, radius: float = 1.0, start: float = 0.4, end: float = 2.5) -> Sample:
    """Profile radius (1/cosh t, t - tanh t) from t = start, above the edge at 0, to t = end."""
    demand_positive(size=size, radius=radius, start=start)
    demand(end > start, f"end must be above start {start!r}, not {end!r}")
    length = math.log(math.cosh(end) / math.cosh(start))
    spread = (1 / math.cosh(start) - 1 / math.cosh(end)) / length
    rows, columns = split(size, length / (2 * math.pi * spread), least=2)
    columns = max(columns, 3)
    # Equal steps of arc length log cosh t.
    t = np.arccosh(math.cosh(start) * np.exp(length * np.arange(rows) / (rows - 1)))
    points, faces, row = revolve(radius / np.cosh(t), radius * (t - np.tanh(t)), columns)
    around = np.sinh(t)[row] / radius
    slope = revolved(points, np.tanh(t[row]), 1 / np.cosh(t[row]))
    exact = facing(principal(around, -1 / (radius**2 * around)), slope)
    exact["K_density"] = np.full(len(row), -1 / radius**2)
    turned = 2 * math.pi * (1 / math.cosh(start) - 1 / math.cosh(end))
    limit = {"area": turned * radius**2, "K": -turned, "kappa_g": turned}
    return Sample(points, faces, exact, orientable(loops=2), limit)


@sample(
    summary="Schwarz's lantern: every vertex on a cylinder, yet too much area",
    exact="Vertices lie on the cylinder; its area is 2 m n radius sin(pi/n) sqrt((height/m)^2 + sagitta^2).",
)
def schwarz_lantern(*, size: int = 1000, radius: float = 1.0, height: float = 2.0, folding: float = 0.5) -> Sample:
    """n vertices to each of m + 1 rings, every other turned by half a step; folding = m/n^2.

    With the folding kept, finer lanterns tend to the area 2 pi radius sqrt(height^2 + (pi^2 radius folding/2)^2).
    """
    demand_positive(size=size, radius=radius, height=height, folding=folding)
    sides = max(3, round((size / folding) ** (1 / 3)))
    bands = max(1, round(folding * sides**2), round(size / sides) - 1 if sides == 3 else 1)
    row, place = np.divmod(np.arange((bands + 1) * sides), sides)
    phi = 2 * np.pi * (place + row % 2 / 2) / sides
    z = height * (row / bands - 0.5)
    points = np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=1)
    here = table(bands + 1, sides)
    below, above, turned = here[:-1], here[1:], (np.arange(bands) % 2 == 1)[:, None]
    next_below, next_above = np.roll(below, -1, axis=1), np.roll(above, -1, axis=1)
    standing = np.stack([below, next_below, np.where(turned, next_above, above)], axis=-1)
    hanging = np.stack([np.where(turned, below, next_below), next_above, above], axis=-1)
    faces = np.concatenate([standing, hanging], axis=1).reshape(-1, 3)
    sagitta = radius * (1 - math.cos(math.pi / sides))
    area = 2 * bands * sides * radius * math.sin(math.pi / sides) * math.hypot(height / bands, sagitta)
    smooth = 2 * math.pi * radius * height
    limit = {"area": smooth, "K": 0.0, "kappa_g": 0.0, "H_theta": smooth / radius, "willmore": smooth / radius**2}
    exact = facing(constant(len(points), 1 / radius, 0.0), revolved(points, 1, 0))
    return Sample(points, faces, exact, orientable(loops=2, area=area), limit)

"""Surfaces that are not manifolds: a pinch and a book."""

from __future__ import annotations

import math

import numpy as np

from .catalogue import sample
from .facts import nonmanifold
from .grids import looped, split, table, triangles
from .model import Sample, demand, demand_positive


@sample(
    summary="two cones that share their apex: a non-manifold vertex",
    exact="The apex is the only non-manifold vertex, K = 2 pi - both angle sums there; K = 0 elsewhere inside.",
)
def pinched(*, size: int = 600, radius: float = 1.0, height: float = 1.0) -> Sample:
    """Vertex 0 is the apex; each cone has rings of n vertices."""
    demand_positive(size=size, radius=radius, height=height)
    slant = math.hypot(radius, height)
    rows, columns = split(size // 2, slant / (math.pi * radius), least=2)
    columns = max(columns, 3)
    step = np.repeat(np.arange(1, rows + 1) / rows, columns)
    phi = np.tile(2 * np.pi * np.arange(columns) / columns, rows)
    upper = np.stack([radius * step * np.cos(phi), radius * step * np.sin(phi), height * step], axis=1)
    numbers = looped(np.concatenate([np.zeros((1, columns), np.int32), 1 + table(rows, columns)]), 1)
    up = triangles(numbers.T)
    # The lower cone is the mirror image, which turns every face round.
    down = np.where(up > 0, up + rows * columns, 0)[:, ::-1]
    points = np.concatenate([np.zeros((1, 3)), upper, upper * np.array([1.0, 1.0, -1.0])])
    defect = np.tile(np.where(step == 1, np.nan, 0.0), 2)
    sharp = 2 * columns * math.asin(radius * math.sin(math.pi / columns) / slant)
    exact = {"K": np.concatenate([[2 * math.pi - 2 * sharp], defect])}
    faces = np.concatenate([up, down]).astype(np.int32)
    return Sample(points, faces, exact, nonmanifold(chi=1, vertices=1))


@sample(
    summary="a book: three or more half planes that meet in one line",
    exact="Every edge of the spine has as many faces as there are pages and is non-manifold; flat pages, chi = 1.",
)
def book(*, size: int = 600, pages: int = 3, width: float = 1.0, height: float = 1.0) -> Sample:
    """Pages at equal angles about the z axis; the vertices of the spine come first."""
    demand_positive(size=size, width=width, height=height)
    demand(pages >= 3, f"pages must be at least 3, not {pages!r}, or nothing is wrong with the book")
    rows, columns = split(size // pages, height / width, least=2)
    spine = np.arange(rows, dtype=np.int32)[:, None]
    inner = table(rows, columns - 1)
    z = height * np.arange(rows) / (rows - 1)
    points = [np.stack([0 * z, 0 * z, z], axis=1)]
    faces = []
    for page in range(pages):
        angle = 2 * math.pi * page / pages
        out = np.tile(width * np.arange(1, columns) / (columns - 1), rows)
        points.append(np.stack([out * math.cos(angle), out * math.sin(angle), np.repeat(z, columns - 1)], axis=1))
        faces.append(triangles(np.concatenate([spine, rows + page * inner.size + inner], axis=1)))
    facts = nonmanifold(chi=1, edges=rows - 1, area=pages * width * height)
    return Sample(np.concatenate(points), np.concatenate(faces), {}, facts)

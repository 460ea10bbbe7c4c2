"""Triangulations of random points on surfaces whose curvatures are known, of 10,000 vertices by default."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from curvcli.samples import get

Floats = NDArray[np.float64]


class Known(NamedTuple):
    """Points (V, 3) and faces (F, 3), Gauss and mean curvature κ₁ + κ₂ and the outward unit normal at each vertex."""

    points: Floats
    faces: NDArray[np.int32]
    K: Floats
    H: Floats
    normal: Floats


def _ball(count: int, regular: bool, seed: int) -> tuple[Floats, NDArray[np.int32]]:
    if regular:
        made = get("icosphere")(size=count)
        return made.points / np.linalg.norm(made.points, axis=1, keepdims=True), made.faces
    points = np.random.default_rng(seed).normal(size=(count, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    faces = ConvexHull(points).simplices.astype(np.int32)
    a, b, c = (points[faces[:, k]] for k in range(3))
    inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), a + b + c) < 0
    faces[inwards] = faces[inwards][:, ::-1]
    return points, faces


def sphere(count: int = 10_000, regular: bool = False, seed: int = 0, radius: float = 2.0) -> Known:
    points, faces = _ball(count, regular, seed)
    ones = np.ones(len(points))
    return Known(points * radius, faces, ones / radius**2, ones * 2 / radius, points)


def ellipsoid(count: int = 10_000, regular: bool = False, seed: int = 0) -> Known:
    a, b, c = 1.5, 1.0, 0.7
    points, faces = _ball(count, regular, seed)
    points = points * [a, b, c]
    gradient = points / np.square([a, b, c])
    q = np.square(gradient).sum(axis=1)
    K = 1 / (a * b * c * q) ** 2
    H = (a * a + b * b + c * c - np.square(points).sum(axis=1)) / ((a * b * c) ** 2 * q**1.5)
    return Known(points, faces, K, H, gradient / np.sqrt(q)[:, None])


def torus(count: int = 10_000, regular: bool = False, seed: int = 0) -> Known:
    major, minor = 2.0, 0.7
    around = round((count * major / minor) ** 0.5)
    across = round(count / around)
    u, w = np.meshgrid(np.arange(around) / around, np.arange(across) / across, indexing="ij")
    if not regular:
        rng = np.random.default_rng(seed)
        u = u + rng.uniform(-0.35, 0.35, u.shape) / around
        w = w + rng.uniform(-0.35, 0.35, u.shape) / across
    u, w = 2 * np.pi * u.ravel(), 2 * np.pi * w.ravel()
    out = major + minor * np.cos(w)
    points = np.stack([out * np.cos(u), out * np.sin(u), minor * np.sin(w)], axis=1)
    normal = np.stack([np.cos(w) * np.cos(u), np.cos(w) * np.sin(u), np.sin(w)], axis=1)
    corner = np.arange(around * across, dtype=np.int32).reshape(around, across)
    a, b = corner, np.roll(corner, -1, 0)
    c, d = np.roll(b, -1, 1), np.roll(corner, -1, 1)
    faces = np.concatenate([np.stack(face, axis=-1).reshape(-1, 3) for face in ((a, b, c), (a, c, d))])
    kappa = np.cos(w) / out
    return Known(points, faces, kappa / minor, kappa + 1 / minor, normal)


SURFACES = {"sphere": sphere, "torus": torus, "ellipsoid": ellipsoid}


def error(found: Floats, exact: Floats) -> float:
    """The relative L² error over the vertices; NaN if any value is null."""
    return float(np.linalg.norm(found - exact) / np.linalg.norm(exact))

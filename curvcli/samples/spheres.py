"""Spheres and ellipsoids."""

from __future__ import annotations

import math

import numpy as np

from .catalogue import sample
from .curvature import constant, facing, of_quadric
from .facts import orientable
from .grids import revolve, split
from .model import FloatArray, IntArray, Sample, demand, demand_positive
from .polyhedra import icosahedron_corners


@sample(
    summary="a sphere: icosahedron of any frequency, nearly equilateral triangles",
    exact="Every vertex lies on the sphere: K = 1/radius^2, H = 2/radius; total curvature 4 pi, Willmore energy 16 pi.",
)
def icosphere(*, size: int = 1000, radius: float = 1.0) -> Sample:
    """10 f^2 + 2 vertices; corners and edges of the icosahedron are shared by number, never by position."""
    demand_positive(size=size, radius=radius)
    return _sphere(*icosahedral_directions(_frequency(size)), radius)


@sample(
    summary="a sphere: convex hull of random points, triangles of every shape",
    exact="Every vertex lies on the sphere: K = 1/radius^2, H = 2/radius; total curvature 4 pi, Willmore energy 16 pi.",
)
def irregular_sphere(*, size: int = 1000, radius: float = 1.0, seed: int = 0) -> Sample:
    """As many vertices as asked for, independent and uniformly distributed."""
    demand_positive(radius=radius)
    return _sphere(*_random_directions(size, seed), radius)


@sample(
    summary="a sphere: meridians and parallels, with two poles",
    exact="Every vertex lies on the sphere: K = 1/radius^2, H = 2/radius; total curvature 4 pi, Willmore energy 16 pi.",
)
def uv_sphere(*, size: int = 1000, radius: float = 1.0) -> Sample:
    """Twice as many meridians as steps from pole to pole; the poles are single vertices."""
    demand_positive(size=size, radius=radius)
    rows, columns = split(size - 2, 0.5, least=2)
    polar = np.pi * np.arange(rows + 2) / (rows + 1)
    across = np.sin(polar)
    across[[0, -1]] = 0
    directions, faces, _ = revolve(across, -np.cos(polar), max(columns, 3))
    return _sphere(directions, faces, radius)


@sample(
    summary="an ellipsoid with three axes: a regular sphere, stretched",
    exact="Every vertex lies on the ellipsoid: curvatures from its implicit equation; area, H_theta by Carlson's R_G.",
)
def ellipsoid(*, size: int = 1000, a: float = 1.0, b: float = 0.8, c: float = 0.6) -> Sample:
    """The icosphere of that size with half axes a, b, c."""
    demand_positive(size=size)
    return _ellipsoid(*icosahedral_directions(_frequency(size)), (a, b, c))


@sample(
    summary="an ellipsoid with three axes: an irregular sphere, stretched",
    exact="Every vertex lies on the ellipsoid: curvatures from its implicit equation; area, H_theta by Carlson's R_G.",
)
def irregular_ellipsoid(*, size: int = 1000, a: float = 1.0, b: float = 0.8, c: float = 0.6, seed: int = 0) -> Sample:
    """The irregular sphere of that size with half axes a, b, c."""
    return _ellipsoid(*_random_directions(size, seed), (a, b, c))


def _frequency(size: int) -> int:
    return max(1, round(math.sqrt(max(size - 2, 1) / 10)))


def _random_directions(size: int, seed: int) -> tuple[FloatArray, IntArray]:
    """Random unit vectors and the outward faces of their convex hull."""
    from scipy.spatial import ConvexHull

    demand(size >= 10, f"size must be at least 10, not {size!r}, or random points need not surround the centre")
    demand(seed >= 0, f"seed must not be negative, not {seed!r}")
    directions = np.random.default_rng(seed).standard_normal((size, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    faces = ConvexHull(directions).simplices.astype(np.int32)
    demand(len(faces) == 2 * size - 4, f"with seed {seed} two points fall together; take another seed")
    a, b, c = (directions[corner] for corner in faces.T)
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a - directions.mean(axis=0)) < 0
    faces[inward] = faces[inward][:, ::-1]
    return directions, faces


def icosahedral_directions(frequency: int) -> tuple[FloatArray, IntArray]:
    """Unit vectors (10 f^2 + 2, 3) and faces (20 f^2, 3) of the icosahedron with every edge cut into f."""
    corners, base = icosahedron_corners()
    f = frequency
    ends = np.sort(np.concatenate([base[:, [0, 1]], base[:, [1, 2]], base[:, [2, 0]]]), axis=1)
    ends = np.unique(ends, axis=0)
    edge_of = {(int(a), int(b)): number for number, (a, b) in enumerate(ends)}
    inner = (f - 1) * (f - 2) // 2
    t = np.arange(1, f)[None, :, None] / f
    along = (1 - t) * corners[ends[:, 0], None] + t * corners[ends[:, 1], None]
    # Row i of a face runs i steps from corner a to b, column j from a to c.
    i, j = (axis.ravel() for axis in np.indices((f + 1, f + 1)))
    i, j = i[i + j <= f], j[i + j <= f]
    inside = (i > 0) & (j > 0) & (i + j < f)
    number = np.full((f + 1, f + 1), -1, np.int32)
    weights = np.stack([f - i - j, i, j], axis=1)[inside] / f
    filled, faces = [], []
    for place, (a, b, c) in enumerate(base.tolist()):
        number[0, 0], number[f, 0], number[0, f] = a, b, c
        steps = np.arange(1, f)
        for start, end, rows, columns in ((a, b, steps, 0 * steps), (a, c, 0 * steps, steps), (b, c, f - steps, steps)):
            forward = steps if start < end else f - steps
            number[rows, columns] = 12 + edge_of[min(start, end), max(start, end)] * (f - 1) + forward - 1
        number[i[inside], j[inside]] = 12 + 30 * (f - 1) + place * inner + np.arange(inner)
        filled.append(weights @ corners[[a, b, c]])
        faces.append(_face_triangles(number))
    points = np.concatenate([corners, along.reshape(-1, 3), *filled])
    return points / np.linalg.norm(points, axis=1)[:, None], np.concatenate(faces)


def _face_triangles(number: IntArray) -> IntArray:
    """The f^2 triangles of one triangular table."""
    f = len(number) - 1
    i, j = (axis.ravel() for axis in np.indices((f, f)))
    up, down = i + j < f, i + j < f - 1
    standing = np.stack([number[i, j], number[i + 1, j], number[i, j + 1]], axis=1)[up]
    hanging = np.stack([number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]], axis=1)[down]
    return np.concatenate([standing, hanging])


def _sphere(directions: FloatArray, faces: IntArray, radius: float) -> Sample:
    limit = {
        "area": 4 * math.pi * radius**2,
        "volume": 4 / 3 * math.pi * radius**3,
        "K": 4 * math.pi,
        "H_theta": 8 * math.pi * radius,
        "willmore": 16 * math.pi,
    }
    exact = facing(constant(len(directions), 1 / radius, 1 / radius), directions)
    return Sample(directions * radius, faces, exact, orientable(convex=True), limit)


def _ellipsoid(directions: FloatArray, faces: IntArray, axes: tuple[float, float, float]) -> Sample:
    from scipy.special import elliprg

    a, b, c = axes
    demand_positive(a=a, b=b, c=c)
    points = directions * np.array(axes)
    limit = {
        "area": 4 * math.pi * float(elliprg((a * b) ** 2, (b * c) ** 2, (c * a) ** 2)),
        "volume": 4 / 3 * math.pi * a * b * c,
        "K": 4 * math.pi,
        "H_theta": 8 * math.pi * float(elliprg(a**2, b**2, c**2)),
    }
    exact = of_quadric((a**-2, b**-2, c**-2), points)
    return Sample(points, faces, exact, orientable(convex=True), limit)

"""Closed surfaces inside, beside and through one another, and their nesting by brute force."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog
from scipy.spatial import ConvexHull

from curvcli.samples.assembled import boundary
from tests.helpers import meshes
from tests.helpers.meshes import Mesh, mesh

Floats = NDArray[np.float64]


def volume(given: Mesh) -> float:
    """The signed volume about the mean of the points."""
    a, b, c = (given.points - given.points.mean(axis=0))[given.faces].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def outward(given: Mesh) -> Mesh:
    return given if volume(given) > 0 else meshes.reversed_faces(given)


def box(low: Sequence[float], high: Sequence[float]) -> Mesh:
    """Eight corners and twelve outward faces."""
    corners = np.array(list(product(*zip(low, high, strict=True))), float)
    squares = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return outward(mesh(corners, [[q[0], *q[k : k + 2]] for q in squares for k in (1, 2)]))


def block(cut: int) -> Mesh:
    """The unit cube, each side cut into cut² squares."""
    points, faces = boundary(np.ones((cut, cut, cut), bool))
    return mesh(points / cut, faces)


def prism(start: float, end: float) -> Mesh:
    """A triangle of unit legs, drawn along x."""
    ends = [[x, y, z] for x in (start, end) for y, z in ((0, 0), (1, 0), (0, 1))]
    faces = [[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]]
    return outward(mesh(ends, faces))


def hull(rng: np.random.Generator, count: int = 20) -> Mesh:
    """A random polyhedron inscribed in the unit sphere that holds the ball of radius ¼."""
    while True:
        points = rng.normal(size=(count, 3))
        points /= np.linalg.norm(points, axis=1)[:, None]
        found = ConvexHull(points)
        if found.equations[:, 3].max() < -0.25:
            faces = found.simplices
            turned = np.einsum("ij,ij->i", points[faces[:, 0]], np.cross(points[faces[:, 1]], points[faces[:, 2]])) < 0
            faces[turned] = faces[turned][:, ::-1]
            return mesh(points, faces)


def star(rng: np.random.Generator) -> Mesh:
    """A star-shaped body: a hull whose corners are drawn in by up to a half, and which holds the ball of radius ⅛."""
    body = hull(rng, 40)
    return body.moved(body.points * rng.uniform(0.5, 1.0, (len(body.points), 1)))


def ring(rng: np.random.Generator) -> Mesh:
    """A torus inside the unit ball, through whose tube nothing else goes; it holds no ball about the origin."""
    torus = meshes.of_sample("irregular_torus", size=100)
    return outward(torus.moved(torus.points / np.linalg.norm(torus.points, axis=1).max()))


@dataclass
class Nest:
    """Parts with the depth of each, its volume (positive), and whether it is wound the wrong way."""

    parts: list[Mesh]
    depth: list[int]
    volume: list[float]
    wrong: list[bool]

    @property
    def solid(self) -> float:
        """The volume of the solid: bodies less cavities plus cores."""
        return sum((-1) ** d * v for d, v in zip(self.depth, self.volume, strict=True))


def random_nest(rng: np.random.Generator, flip: float = 0.5) -> Nest:
    """Two bodies side by side, cavities in them, cores in these and so on, each wound at random."""
    nest = Nest([], [], [], [])

    def add(centre: Floats, radius: float, depth: int) -> None:
        kind = rng.integers(3) if depth else 0
        part = [hull, star, ring][kind](rng)
        holds = [0.24, 0.11, 0.0][kind] * radius
        placed = part.moved(part.points @ meshes.rotation(int(rng.integers(1000))).T * radius + centre)
        wrong = bool(rng.random() < flip)
        inward = (depth % 2 == 1) != wrong
        nest.parts.append(meshes.reversed_faces(placed) if inward else placed)
        nest.depth.append(depth)
        nest.volume.append(volume(placed))
        nest.wrong.append(wrong)
        if depth < 4 and holds:
            sides = rng.normal(size=3)
            sides /= np.linalg.norm(sides)
            for way in (-1, 1)[: int(rng.integers(1, 3))]:
                add(centre + way * sides * holds / 2, holds * 0.49, depth + 1)

    add(np.zeros(3), 1.0, 0)
    add(np.array([2.5, 0.3, -0.2]), 1.0, 0)
    return nest


def together(parts: Sequence[Mesh], rng: np.random.Generator | None = None) -> tuple[Mesh, NDArray[np.int64]]:
    """All parts in one mesh and the part of each face; with rng its faces shuffled and begun at any corner."""
    first = np.cumsum([0, *(len(part.points) for part in parts)])
    faces = np.concatenate([part.faces + n for part, n in zip(parts, first, strict=False)])
    label = np.repeat(np.arange(len(parts)), [len(part.faces) for part in parts])
    if rng is not None:
        order = rng.permutation(len(faces))
        start = rng.integers(3, size=len(faces))
        faces, label = faces[order], label[order]
        faces = np.take_along_axis(faces, (start[:, None] + np.arange(3)) % 3, axis=1)
    return mesh(np.concatenate([part.points for part in parts]), faces), label


def lattice_body(rng: np.random.Generator, wide: int) -> Mesh:
    """A small convex polyhedron whose corners have integer coordinates from 0 to `wide`."""
    while True:
        points = rng.integers(0, wide + 1, (int(rng.integers(4, 8)), 3)).astype(float)
        if np.linalg.matrix_rank(points[1:] - points[0]) < 3:
            continue
        used, faces = np.unique(ConvexHull(points).simplices, return_inverse=True)
        body = mesh(points[used], faces.reshape(-1, 3))
        a, b, c = body.points[body.faces].transpose(1, 0, 2)
        inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), a - body.points.mean(axis=0)) < 0
        body.faces[inwards] = body.faces[inwards][:, ::-1]
        surface = body.surface()
        if surface.solids.count == 1 and not len(surface.boundary_half_edges):
            return body


# ---------------------------------------------------------------------------- by brute force


def convex_pair(one: Mesh, other: Mesh) -> tuple[bool, bool, bool]:
    """Flags: two convex bodies cross, the first lies in the second, the second lies in the first.

    By linear programming: the radius of the largest ball in both.
    """
    planes = []
    for body in (one, other):
        a, b, c = body.points[body.faces].transpose(1, 0, 2)
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        planes.append((normal, np.einsum("ij,ij->i", normal, a)))
    (n, at), (m, there) = planes
    rows = np.vstack([np.column_stack([x, np.ones(len(x))]) for x in (n, m)])
    found = linprog([0, 0, 0, -1], rows, np.concatenate([at, there]), bounds=[(None, None)] * 4)
    common = -found.fun > 1e-9
    first = bool((one.points @ m.T - there < 1e-9).all())
    second = bool((other.points @ n.T - at < 1e-9).all())
    return common and first == second, common and first, common and second


def winding(points: Floats, surface: Floats) -> Floats:
    """Winding numbers of a closed surface, corners (n, 3, 3), about points (m, 3): solid angles over 4π."""
    a, b, c = (surface[None, :, k] - points[:, None] for k in range(3))
    la, lb, lc = (np.linalg.norm(x, axis=2) for x in (a, b, c))
    top = np.einsum("ijk,ijk->ij", a, np.cross(b, c))
    dots = [np.einsum("ijk,ijk->ij", x, y) for x, y in ((a, b), (b, c), (c, a))]
    angle = 2 * np.arctan2(top, la * lb * lc + dots[0] * lc + dots[1] * la + dots[2] * lb)
    return np.asarray(angle.sum(axis=1) / (4 * np.pi), np.float64)


def nesting(surfaces: Sequence[Floats], points_on_each: int = 60) -> tuple[list[int], set[tuple[int, int]]]:
    """Depths and crossing pairs, by random points on every face; points on another surface tell nothing."""
    rng = np.random.default_rng(0)
    inside, crossing = np.zeros((len(surfaces),) * 2, bool), set()
    for i, j in permutations(range(len(surfaces)), 2):
        weights = rng.dirichlet((0.7, 0.7, 0.7), (len(surfaces[i]), points_on_each))
        points = np.einsum("fwk,fkx->fwx", weights, surfaces[i]).reshape(-1, 3)
        found = winding(points, surfaces[j])
        clear = np.abs(found - np.round(found)) < 1e-3
        sides = np.abs(np.round(found[clear])) > 0.5
        inside[i, j] = sides.any()
        if (sides.any() and not sides.all()) or not len(sides):
            crossing.add((min(i, j), max(i, j)))
    for i, j in crossing:
        inside[i, j] = inside[j, i] = False
    return inside.sum(axis=1).tolist(), crossing

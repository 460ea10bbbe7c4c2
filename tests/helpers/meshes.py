"""Small meshes built in code, and the operations under which curvatures keep or change in a known way."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from curvcli.mesh.surface import Surface
from curvcli.samples import get

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


class Mesh(NamedTuple):
    """points (V, 3) and faces (F, 3)."""

    points: Floats
    faces: Ints

    def surface(self, orient: str = "file") -> Surface:
        return Surface(self.points, self.faces, orient=orient)  # type: ignore[arg-type]

    def moved(self, points: Floats) -> Mesh:
        return Mesh(np.ascontiguousarray(points), self.faces)

    def with_faces(self, faces: object) -> Mesh:
        return Mesh(self.points, np.array(faces, np.int32).reshape(-1, 3))

    def write(self, path: Path) -> Path:
        """As an OBJ file, every digit of every coordinate."""
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in self.points.tolist()]
        lines += [f"f {a} {b} {c}" for a, b, c in (self.faces + 1).tolist()]
        path.write_text("\n".join(lines) + "\n")
        return path


def mesh(points: object, faces: object) -> Mesh:
    return Mesh(np.array(points, np.float64).reshape(-1, 3), np.array(faces, np.int32).reshape(-1, 3))


def tetrahedron() -> Mesh:
    """Corner at the origin, legs of different lengths; wound counterclockwise seen from outside."""
    return mesh([[0, 0, 0], [2, 0, 0], [0, 3, 0], [0, 0, 5]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def grid(n: int = 4, seed: int = 0) -> Mesh:
    """A bumpy square of 2 n² triangles over integer points, moved by less than a quarter."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0), indexing="ij")
    points = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)
    corner = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    a, b, c, d = (part.ravel() for part in (corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]))
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return mesh(points + rng.uniform(-0.24, 0.24, points.shape), faces)


def of_sample(name: str, **parameters: int | float | bool) -> Mesh:
    made = get(name)(**parameters)
    return Mesh(made.points, made.faces)


def torus() -> Mesh:
    return of_sample("irregular_torus", size=100)


def icosphere() -> Mesh:
    return of_sample("icosphere", size=42)


def ellipsoid() -> Mesh:
    return of_sample("irregular_ellipsoid", size=40)


def mobius() -> Mesh:
    return of_sample("mobius", size=60)


def klein_bottle() -> Mesh:
    return of_sample("klein_bottle", size=100)


def cap() -> Mesh:
    """A piece of a sphere, jittered off it."""
    made = of_sample("hemisphere", size=40)
    return made.moved(made.points + np.random.default_rng(1).uniform(-0.03, 0.03, made.points.shape))


def pinched() -> Mesh:
    """Two bodies that share one vertex."""
    one = tetrahedron()
    return joined(one, one.moved(-one.points + [0.0, 0.0, 0.0]), shared=[(0, 0)])


def book(pages: int = 3) -> Mesh:
    """Triangles that share one edge."""
    angle = 2 * np.pi * (np.arange(pages) + 0.1) / pages
    tips = np.stack([np.cos(angle), np.sin(angle), 0.3 * angle], axis=1)
    return mesh(np.vstack([[[0, 0, 0], [0, 0, 1]], tips]), [[0, 1, 2 + page] for page in range(pages)])


def two_bodies() -> Mesh:
    """A torus and, apart from it, an ellipsoid."""
    other = ellipsoid()
    return joined(torus(), other.moved(other.points + 4.0))


def soup() -> Mesh:
    """Triangles that share no vertex."""
    rng = np.random.default_rng(2)
    return mesh(rng.uniform(-1, 1, (15, 3)), np.arange(15).reshape(5, 3))


def shell(half: int = 0) -> Mesh:
    """A body whose faces from the given one on are wound the other way."""
    body = ellipsoid()
    faces = body.faces.copy()
    faces[half:] = faces[half:, ::-1]
    return body.with_faces(faces)


def with_flat_face() -> Mesh:
    """A grid, and a face of no area on one of its edges: three different corners on one line."""
    base = grid()
    points = np.vstack([base.points, (base.points[0] + base.points[1]) / 2])
    points[[0, 1, -1], 0] = [0.0, 1.0, 0.5]
    points[[0, 1, -1], 1:] = [0.0, 0.0]
    return mesh(points, np.vstack([base.faces, [[0, 1, len(points) - 1]]]))


def fan(degree: int, rise: float = 0.5) -> Mesh:
    """An apex inside with the given number of faces round it."""
    angle = 2 * np.pi * np.arange(degree) / degree
    rim = np.stack([np.cos(angle), np.sin(angle), rise * np.cos(3 * angle)], axis=1)
    around = 1 + np.arange(degree)
    return mesh(np.vstack([[[0, 0, 0]], rim]), np.stack([np.zeros(degree, int), around, np.roll(around, -1)], 1))


ZOO: dict[str, Callable[[], Mesh]] = {
    "tetrahedron": tetrahedron,
    "grid": grid,
    "torus": torus,
    "ellipsoid": ellipsoid,
    "cap": cap,
    "mobius": mobius,
    "klein_bottle": klein_bottle,
    "pinched": pinched,
    "book": book,
    "two_bodies": two_bodies,
    "soup": soup,
    "inconsistent": lambda: shell(20),
    "with_flat_face": with_flat_face,
}
"""Every kind of surface once: closed, open, one-sided, non-manifold, in pieces, badly wound, degenerate."""


@cache
def zoo(name: str) -> Mesh:
    made = ZOO[name]()
    made.points.setflags(write=False)
    made.faces.setflags(write=False)
    return made


# ---------------------------------------------------------------------------- operations


def joined(one: Mesh, other: Mesh, shared: list[tuple[int, int]] | None = None) -> Mesh:
    """Both meshes in one, the second's vertices after the first's; `shared` pairs become one vertex."""
    n = len(one.points)
    new = np.full(len(other.points), -1)
    for here, there in shared or []:
        new[there] = here
    fresh = new < 0
    new[fresh] = n + np.arange(np.count_nonzero(fresh))
    return mesh(np.vstack([one.points, other.points[fresh]]), np.vstack([one.faces, new[other.faces]]))


def reversed_faces(given: Mesh) -> Mesh:
    return Mesh(given.points, np.ascontiguousarray(given.faces[:, ::-1]))


def relabelled(given: Mesh, order: NDArray[np.integer]) -> Mesh:
    """The mesh whose vertex i is the given one's vertex order[i]."""
    new = np.empty(len(order), np.int32)
    new[order] = np.arange(len(order))
    return Mesh(given.points[order], new[given.faces])


def quantised(given: Mesh, bits: int = 20) -> Mesh:
    """Coordinates rounded to multiples of 2 to the power -bits, so that they may be shifted exactly."""
    return given.moved(np.round(given.points * 2.0**bits) / 2.0**bits)


def rotation(seed: int = 3) -> Floats:
    """A rotation that mixes all axes."""
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    return np.asarray(q if np.linalg.det(q) > 0 else -q)

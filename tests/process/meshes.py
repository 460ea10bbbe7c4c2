"""Meshes written to files: samples of any size, and the worst that a file may hold."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from curvcli.output.meshes.write import write_mesh
from curvcli.samples import get
from tests.helpers import meshes
from tests.helpers.meshes import Mesh, fan, icosphere, joined, mesh


def write(name: str, size: int, path: Path) -> Path:
    made = get(name)(size=size)
    with open(path, "wb") as stream:
        write_mesh(stream, path.suffix, made.points, made.faces)
    return path


def scaled(exponent: int) -> Mesh:
    """A sphere in units of a power of two, which costs no digit while its coordinates are normal numbers."""
    return icosphere().moved(np.ldexp(icosphere().points, exponent))


def shifted(offset: float, size: float = 1.0) -> Mesh:
    return icosphere().moved(icosphere().points * size + offset)


def seam() -> Mesh:
    """A torus cut along a curve: its vertices are there twice."""
    base = meshes.torus()
    faces = base.faces.copy()
    ours = np.zeros(len(base.points), bool)
    ours[:10] = True
    faces[1::2] = np.where(ours[faces[1::2]], faces[1::2] + len(base.points), faces[1::2])
    return mesh(np.vstack([base.points, base.points[:10]]), faces)


def cut_apart() -> Mesh:
    """A sphere whose faces share no vertex, as they do in STL."""
    base = icosphere()
    return mesh(base.points[base.faces], np.arange(3 * len(base.faces)))


def strip(points: ArrayLike) -> Mesh:
    """Faces over each three successive points."""
    found = np.array(points, np.float64)
    first = np.arange(len(found) - 2)
    return mesh(found, np.stack([first, first + 1, first + 2], 1))


def needles() -> Mesh:
    """A body of faces without area, without height and 300 powers of ten long."""
    points = [[0, 0, 0], [1, 0, 0], [0.5, 1e-17, 0], [0.5, -1e-160, 0], [0.5, 1e-300, 1]]
    return mesh(points, [[0, 1, 2], [1, 0, 3], [0, 2, 4], [1, 4, 2], [0, 4, 3], [1, 3, 4]])


def long_needle() -> Mesh:
    points = [[0, 0, 0], [1e150, 0, 0], [0.5e150, 1e-150, 0], [0.5e150, 0, 1e150]]
    return mesh(points, [[0, 1, 2], [1, 0, 3], [0, 2, 3], [2, 1, 3]])


def speck() -> Mesh:
    """A sphere, and beside it one so small that all its vertices are one."""
    base = icosphere()
    return joined(base, base.moved(base.points * 1e-200 + 3.0))


def with_loose_vertices() -> Mesh:
    base = icosphere()
    loose = np.array([[np.nan, 0, 0], [1e308, 0, 0], [0, 0, 0]])
    return mesh(np.vstack([base.points, loose]), base.faces)


def repeated(times: int, turned: bool = False) -> Mesh:
    base = icosphere()
    again = np.tile(base.faces[:, ::-1] if turned else base.faces, (times - 1, 1))
    return base.with_faces(np.vstack([base.faces, again]))


HOSTILE: dict[str, Callable[[], Mesh]] = {
    **{f"2^{exponent}": partial(scaled, exponent) for exponent in (332, 498, 664, 1000, 1022)},
    **{f"2^{exponent}": partial(scaled, exponent) for exponent in (-332, -498, -664, -1000, -1060)},
    "offset 1e12, size 1e-3": lambda: shifted(1e12, 1e-3),
    "offset 1e300, size 1e290": lambda: shifted(1e300, 1e290),
    "one triangle": lambda: strip([[0, 0, 0], [1, 0, 0], [0, 1, 0]]),
    "one triangle on a line": lambda: strip([[0, 0, 0], [1, 0, 0], [2, 0, 0]]),
    "one triangle at a point": lambda: strip([[1, 1, 1]] * 3),
    "all on a line": lambda: strip([[k, k, k] for k in range(12)]),
    "all at a point": lambda: strip([[0, 0, 0]] * 12),
    "all at a far point": lambda: strip([[1e300, -1e300, 1e300]] * 12),
    "two triangles back to back": lambda: mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 1]]),
    "two spheres in one place": lambda: joined(icosphere(), icosphere()),
    "every face twice": lambda: repeated(2),
    "every face from both sides": lambda: repeated(2, turned=True),
    "a face with one corner thrice": lambda: icosphere().with_faces(np.vstack([icosphere().faces, [[7, 7, 7]]])),
    "loose vertices": with_loose_vertices,
    "needles": needles,
    "a long needle": long_needle,
    "a speck": speck,
    "seam": seam,
    "cut apart": cut_apart,
    "a fan of 3000": lambda: fan(3000),
    "3000 pages": lambda: meshes.book(3000),
    "a body in a fan of needles": lambda: fan(2000, rise=1e-12),
    **{name: made for name, made in meshes.ZOO.items() if name not in ("grid", "torus", "ellipsoid")},
}
"""What a curvature program meets at the ends of the range, without area, without thickness, twice, or torn."""

"""Surfaces for tests of readers, a value per vertex and a label per polygon, and comparisons with the right table."""

from __future__ import annotations

import io
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

from curvcli import analyze
from curvcli.errors import InputError
from curvcli.loading.read import read_mesh_file
from curvcli.mesh.file import MeshFile
from curvcli.mesh.polygons import from_file
from curvcli.mesh.surface import Surface
from curvcli.mesh.welding import welded
from tests.helpers.meshes import of_sample

Polygons = tuple[tuple[int, ...], ...]


class Shape(NamedTuple):
    """points (V, 3) float64; polygons: corners of each; value (V,) floats; part (P,) integers 0, 1, 2."""

    points: NDArray[np.float64]
    polygons: Polygons

    @property
    def value(self) -> NDArray[np.float64]:
        """A number per vertex that fits float32, in no order."""
        return (np.arange(len(self.points)) * 37 % 101) / 8.0

    @property
    def part(self) -> NDArray[np.int32]:
        """A label per polygon."""
        return (
            np.arange(len(self.polygons)) * 2 // len(self.polygons) + (np.arange(len(self.polygons)) % 7 == 3)
        ).astype(np.int32)

    @property
    def corners(self) -> NDArray[np.int32]:
        """Corners of all polygons, concatenated."""
        return np.array([corner for polygon in self.polygons for corner in polygon], np.int32)

    @property
    def sizes(self) -> NDArray[np.int32]:
        """Number of corners of each polygon."""
        return np.array([len(polygon) for polygon in self.polygons], np.int32)

    @property
    def triangles(self) -> NDArray[np.int32]:
        """(F, 3) the polygons as fans from their first corners: all of them are convex."""
        return np.array([(p[0], p[k], p[k + 1]) for p in self.polygons for k in range(1, len(p) - 1)], np.int32)

    def halved(self) -> Shape:
        """The same surface in triangles, for formats without polygons."""
        return Shape(self.points, tuple(tuple(row) for row in self.triangles.tolist()))

    def single(self) -> Shape:
        """Positions rounded to float32, which a file of floats gives back to the last digit."""
        return Shape(self.points.astype(np.float32).astype(np.float64), self.polygons)

    def short(self) -> Shape:
        """Positions in multiples of 1/16: five digits are exact, for programs that write few."""
        return Shape(np.round(self.points * 16) / 16, self.polygons)

    def surface(self, weld: str = "none") -> Surface:
        """The surface as curvcli has it from arrays, its vertices merged by the rule `weld`."""
        sizes = None if (self.sizes == 3).all() else self.sizes
        file = MeshFile("arrays", np.ascontiguousarray(self.points.T), self.corners, sizes)
        return from_file(file if weld == "none" else welded(file, weld))


@cache
def sphere() -> Shape:
    """An icosphere with its rows shuffled; vertex 5 is used by no face, vertex 17 is the double of vertex 40.

    Half of the faces round the position of 40 use the row 17. A reader that merges, drops or sorts rows changes the
    table; one that reads right finds the surface cut open there.
    """
    ball = of_sample("icosphere", size=162)
    rng = np.random.default_rng(11)
    n = len(ball.points) + 2
    row = rng.permutation([k for k in range(n) if k not in (5, 17)])
    twin = int(np.flatnonzero(row == 40)[0])
    points = np.empty((n, 3))
    points[row] = ball.points * [1.0, 1.25, 0.75] + [0.1, -0.2, 0.3]
    points[5], points[17] = (3.0, -2.0, 1.0), points[row[twin]]
    faces = row[ball.faces[rng.permutation(len(ball.faces))]]
    star = np.flatnonzero((faces == 40).any(axis=1))
    some = faces[star[: len(star) // 2]]
    faces[star[: len(star) // 2]] = np.where(some == 40, 17, some)
    return Shape(points, tuple(tuple(face) for face in faces.tolist()))


@cache
def moebius() -> Shape:
    """A Möbius strip of triangles and one quadrilateral, which is plane and lies amid the list of faces."""
    n = 12
    angle = 2 * np.pi * np.arange(n) / n
    middle = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1) * 2
    across = np.stack([np.cos(angle / 2) * np.cos(angle), np.cos(angle / 2) * np.sin(angle), np.sin(angle / 2)], axis=1)
    points = np.concatenate([middle - across / 2, middle + across / 2])
    points[n + 5] = points[n + 4] + points[5] - points[4]
    polygons: list[tuple[int, ...]] = []
    for k in range(n):
        a, b, c, d = k, k + 1, n + k + 1, n + k
        if k == n - 1:
            b, c = n, 0
        polygons += [(a, b, c, d)] if k == 4 else [(a, b, c), (a, c, d)]
    return Shape(points, tuple(polygons))


SHAPES = {"sphere": sphere, "moebius": moebius}


def assert_reads(
    source: Path | bytes, shape: Shape, *, weld: str = "auto", merged: str = "none", table: bool = True, **options: Any
) -> MeshFile:
    """Compare what curvcli reads with a shape: rows, polygons and the whole vertex table, to the last digit.

    weld: the option for reading. merged: the rule by which the vertices of the shape are merged for the comparison.
    table: compare the vertex tables too, which follow from the rest, and are the larger part of the time.
    Returns the content of the file, for comparison of properties and labels.
    """
    given = io.BytesIO(source) if isinstance(source, bytes) else source
    file = read_mesh_file(given, weld=weld, **options)
    assert_same(from_file(file), shape.surface(merged), table=table)
    return file


def assert_same(surface: Surface, expected: Surface, *, table: bool = True) -> None:
    """Compare two surfaces: rows, faces, polygons and the whole vertex table, to the last digit."""
    np.testing.assert_array_equal(surface.points, expected.points)
    np.testing.assert_array_equal(surface.faces, expected.faces)
    np.testing.assert_array_equal(surface.polygon is None, expected.polygon is None)
    if surface.polygon is not None:
        np.testing.assert_array_equal(surface.polygon, expected.polygon)
    if not table:
        return
    got, want = analyze(surface).vertices, analyze(expected).vertices
    assert list(got) == list(want)
    for name in want:
        np.testing.assert_array_equal(np.asarray(got[name]), np.asarray(want[name]), err_msg=name)


def is_refused(data: bytes, **options: Any) -> bool:
    """Test whether a file is refused, with an InputError of one printable line; any other exception passes through."""
    try:
        from_file(read_mesh_file(io.BytesIO(data), **options))
    except InputError as error:
        line = str(error)
        assert line.isprintable(), line
        assert len(line) < 600, line
        return True
    return False


def assert_refused(data: bytes, match: str = "", **options: Any) -> None:
    """Check that a file is refused with one line that contains the pattern."""
    assert is_refused(data, **options)
    with pytest.raises(InputError, match=match):
        from_file(read_mesh_file(io.BytesIO(data), **options))


def read_cuts(data: bytes, **options: Any) -> list[int]:
    """Lengths at which a truncated file is read all the same: those that cut off nothing but white space, as a rule."""
    return [cut for cut in range(len(data)) if not is_refused(data[:cut], **options)]

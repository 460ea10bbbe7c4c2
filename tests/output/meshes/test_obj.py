"""OBJ read back line by line and by trimesh."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
import trimesh

from curvcli.output.meshes.obj import write_obj

POINTS = np.array([[0, 1e-300, -0.0], [1, 1e308, 5e-324], [0, 1 / 3, 12345678901234567890]])
FACES = np.array([[0, 1, 2], [2, 1, 0]])


def written(*arguments: Any, **options: Any) -> str:
    stream = io.BytesIO()
    write_obj(stream, *arguments, **options)
    return stream.getvalue().decode()


def read(text: str) -> tuple[list[list[float]], list[list[int]]]:
    words = [line.split(" ") for line in text.splitlines() if not line.startswith("#")]
    assert {line[0] for line in words} <= {"v", "f"}
    vertices = [[float(word) for word in line[1:]] for line in words if line[0] == "v"]
    return vertices, [[int(word) for word in line[1:]] for line in words if line[0] == "f"]


def test_positions_and_faces_read_back() -> None:
    text = written(POINTS, FACES, comments=["two\nlines"])
    assert text.startswith("# two lines\nv 0.0 1e-300 -0.0\n")
    vertices, faces = read(text)
    np.testing.assert_array_equal(np.array(vertices).view(np.uint64), POINTS.view(np.uint64))
    assert faces == [[1, 2, 3], [3, 2, 1]]


def test_every_colour_reads_back() -> None:
    colors = np.stack([np.arange(256), np.arange(256)[::-1], np.full(256, 7)], axis=1).astype(np.uint8)
    vertices, _ = read(written(np.zeros((256, 3)), FACES, vertex_colors=colors))
    shares = np.array(vertices)[:, 3:]
    assert shares.min() == 0
    assert shares.max() == 1
    np.testing.assert_array_equal(np.rint(shares * 255), colors)


@pytest.mark.parametrize("polygons", [[[0, 1, 2], [2, 1, 0, 1], [0, 2]], [[0, 1, 2, 1]] * 3, [[0], [1, 2, 0]], []])
def test_polygons_stay_polygons(polygons: list[list[int]]) -> None:
    corners = np.array([corner for polygon in polygons for corner in polygon], np.int32)
    sizes = np.array([len(polygon) for polygon in polygons], np.int32)
    text = written(POINTS, FACES, polygons=(corners, sizes))
    assert read(text)[1] == [[corner + 1 for corner in polygon] for polygon in polygons]
    assert text.endswith("\n")
    assert "\n\n" not in text


def test_blocks_leave_no_seam() -> None:
    rng = np.random.default_rng(5)
    points = rng.standard_normal((70_000, 3))
    sizes = rng.integers(3, 6, 60_000)
    corners = rng.integers(0, len(points), sizes.sum())
    vertices, faces = read(written(points, FACES, polygons=(corners, sizes)))
    np.testing.assert_array_equal(vertices, points)
    assert faces == [(part + 1).tolist() for part in np.split(corners, np.cumsum(sizes)[:-1])]


def test_a_polygon_longer_than_a_block() -> None:
    corners = np.arange(150_000) % 3
    assert read(written(POINTS, FACES, polygons=(corners, np.array([150_000]))))[1] == [(corners + 1).tolist()]


def test_trimesh_reads_the_same_surface() -> None:
    text = written(POINTS[:, :2] @ [[1, 0, 1], [0, 0, 0]], FACES, vertex_colors=np.full((3, 3), 255, np.uint8))
    mesh = trimesh.load_mesh(io.BytesIO(text.encode()), file_type="obj", process=False)
    np.testing.assert_array_equal(mesh.faces, FACES)
    assert mesh.visual.vertex_colors.tolist() == [[255, 255, 255, 255]] * 3

"""STL in both forms, read back by trimesh and word by word."""

from __future__ import annotations

import io

import numpy as np
import pytest
import trimesh

from curvcli.errors import OutputError
from curvcli.output.meshes.stl import write_stl, write_stl_text

POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0.5]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def test_binary_reads_back() -> None:
    stream = io.BytesIO()
    assert write_stl(stream, POINTS, FACES) == ()
    assert len(stream.getvalue()) == 84 + 50 * len(FACES)
    assert not stream.getvalue().startswith(b"solid")
    stream.seek(0)
    mesh = trimesh.load_mesh(stream, file_type="stl", process=False)
    np.testing.assert_array_equal(mesh.triangles, POINTS[FACES])
    np.testing.assert_array_equal(mesh.face_normals[:2], [[0, 0, -1], [0, -1, 0]])


def test_what_float32_rounds_is_counted() -> None:
    points = POINTS.copy()
    points[1, 0] = 0.1
    points[3, 1] = 1e-300
    (notice,) = write_stl(io.BytesIO(), points, FACES)
    assert (notice.code, notice.count) == ("stl_float32", 2)


def test_what_float32_cannot_hold_is_refused() -> None:
    with pytest.raises(OutputError, match=r"float32.*1e\+39"):
        write_stl(io.BytesIO(), POINTS * 1e39, FACES)


@pytest.mark.parametrize("scale", [1.0, 1e-300, 1e300, 1 / 3])
def test_text_reads_back(scale: float) -> None:
    stream = io.BytesIO()
    write_stl_text(stream, POINTS * scale, FACES)
    lines = stream.getvalue().decode().split("\n")
    assert lines[0] == "solid curvcli"
    assert lines[-2:] == ["endsolid curvcli", ""]
    faces = np.reshape(lines[1:-2], (len(FACES), 7))
    assert (faces[:, [1, 5, 6]] == ["outer loop", "endloop", "endfacet"]).all()
    corners = [
        [[float(word) for word in line.removeprefix("vertex ").split(" ")] for line in face[2:5]] for face in faces
    ]
    np.testing.assert_array_equal(corners, (POINTS * scale)[FACES])
    normals = [[float(word) for word in line.removeprefix("facet normal ").split(" ")] for line in faces[:, 0]]
    np.testing.assert_allclose(normals[:2], [[0, 0, -1], [0, -1, 0]], atol=0)
    np.testing.assert_allclose(normals[2], np.array([1, 1, 2]) / np.sqrt(6), rtol=4e-16)


def test_a_triangle_without_area_has_no_normal() -> None:
    stream = io.BytesIO()
    write_stl_text(stream, POINTS, np.array([[0, 1, 0], [2, 2, 2]]))
    assert stream.getvalue().count(b"facet normal 0.0 0.0 0.0\n") == 2


def test_a_mesh_without_triangles_is_written() -> None:
    binary, text = io.BytesIO(), io.BytesIO()
    assert write_stl(binary, POINTS, np.zeros((0, 3), np.int32)) == ()
    write_stl_text(text, POINTS, np.zeros((0, 3), np.int32))
    assert len(binary.getvalue()) == 84
    assert text.getvalue() == b"solid curvcli\nendsolid curvcli\n"

"""PLY read back by a reader of the tests' own and by trimesh."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
import trimesh

from curvcli.mesh.file import Labels
from curvcli.output.meshes.ply import write_ply

TYPES = {
    "char": "i1",
    "uchar": "u1",
    "short": "i2",
    "ushort": "u2",
    "int": "i4",
    "uint": "u4",
    "float": "f4",
    "double": "f8",
}
POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1 / 3, 0], [0, 0, 1e-300]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def read(data: bytes) -> tuple[list[str], dict[str, Any], dict[str, list[Any]]]:
    """Comments, vertex columns and face columns of a binary PLY, row by row and without any cleverness."""
    head, _, body = data.partition(b"end_header\n")
    lines = head.decode("utf-8").splitlines()
    assert lines[:2] == ["ply", "format binary_little_endian 1.0"]
    comments = [line.removeprefix("comment ") for line in lines if line.startswith("comment ")]
    elements: list[tuple[str, int, list[list[str]]]] = []
    for words in map(str.split, lines[2:]):
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            elements[-1][2].append(words[1:])
    stream = io.BytesIO(body)

    def scalar(kind: str) -> Any:
        dtype = np.dtype("<" + TYPES[kind])
        return np.frombuffer(stream.read(dtype.itemsize), dtype)[0]

    tables: dict[str, dict[str, list[Any]]] = {}
    for name, count, properties in elements:
        table = tables[name] = {prop[-1]: [] for prop in properties}
        for _ in range(count):
            for prop in properties:
                value = [int(scalar(prop[2])) for _ in range(scalar(prop[1]))] if prop[0] == "list" else scalar(prop[0])
                table[prop[-1]].append(value)
    assert stream.read() == b""
    return comments, tables["vertex"], tables["face"]


def written(*arguments: Any, **options: Any) -> bytes:
    stream = io.BytesIO()
    write_ply(stream, *arguments, **options)
    return stream.getvalue()


def test_every_column_reads_back() -> None:
    properties: dict[str, Any] = {
        "K": np.array([0.1, np.nan, -0.0, 5e-324]),
        "degree": np.array([3, 3, 3, 3]),
        "large": np.array([0, 1, 2, 2**40]),
        "welded_to": np.ma.array([5, 0, 0, 0], mask=[False, True, True, True]),
        "closed": np.array([True, False, True, True]),
        "quality": np.array([0.5, 0.25, 0, 1], np.float32),
        "flags": np.array([1, 2, 3, 4], ">u2"),
        "status": Labels(np.array([0, 1, -1, 1], np.int32), ("interior", "on the\nboundary")),
    }
    colors = np.arange(12, dtype=np.uint8).reshape(4, 3)
    data = written(
        POINTS, FACES, vertex_colors=colors, vertex_properties=properties, comments=["unit: mm", "two\nlines"]
    )
    comments, vertices, faces = read(data)
    assert comments == ["unit: mm", "two lines", "status: 0 interior, 1 on the boundary, 255 none"]
    assert list(vertices) == ["x", "y", "z", "red", "green", "blue", *properties]
    np.testing.assert_array_equal(np.stack([vertices[axis] for axis in "xyz"], axis=1), POINTS)
    np.testing.assert_array_equal(np.stack([vertices[name] for name in ("red", "green", "blue")], axis=1), colors)
    np.testing.assert_array_equal(np.array(vertices["K"]).view(np.uint64), properties["K"].view(np.uint64))
    assert vertices["degree"] == [3, 3, 3, 3]
    assert vertices["large"] == [0, 1, 2, 2**40]
    np.testing.assert_array_equal(vertices["welded_to"], [5, np.nan, np.nan, np.nan])
    assert vertices["closed"] == [1, 0, 1, 1]
    assert vertices["quality"] == [0.5, 0.25, 0, 1]
    assert vertices["flags"] == [1, 2, 3, 4]
    assert vertices["status"] == [0, 1, 255, 1]
    assert faces == {"vertex_indices": FACES.tolist()}
    header = data.partition(b"end_header")[0].decode()
    for line in (
        "double K",
        "int degree",
        "double large",
        "uchar closed",
        "float quality",
        "ushort flags",
        "uchar status",
    ):
        assert f"property {line}\n" in header


def test_trimesh_reads_the_same_surface() -> None:
    colors = np.arange(12, dtype=np.uint8).reshape(4, 3)
    data = written(POINTS, FACES, vertex_colors=colors, vertex_properties={"K": POINTS[:, 1], "degree": np.full(4, 3)})
    mesh = trimesh.load_mesh(io.BytesIO(data), file_type="ply", process=False)
    np.testing.assert_array_equal(mesh.vertices, POINTS)
    np.testing.assert_array_equal(mesh.faces, FACES)
    np.testing.assert_array_equal(mesh.visual.vertex_colors[:, :3], colors)
    np.testing.assert_array_equal(mesh.metadata["_ply_raw"]["vertex"]["data"]["K"].ravel(), POINTS[:, 1])


@pytest.mark.parametrize("name", ["x", "red"])
def test_two_properties_of_one_name_are_refused(name: str) -> None:
    with pytest.raises(ValueError, match=name):
        written(POINTS, FACES, vertex_colors=np.zeros((4, 3), np.uint8), vertex_properties={name: np.zeros(4)})


def test_any_word_is_a_name() -> None:
    columns = {name: np.arange(4) for name in ["f0", "f1", "corner_list", "#", "vertex"]}
    _, vertices, faces = read(written(POINTS, FACES, vertex_properties=columns, face_properties=columns))
    assert all(vertices[name] == faces[name] == [0, 1, 2, 3] for name in columns)


@pytest.mark.parametrize(
    "polygons", [[[0, 1, 2]] * 3, [[0, 1, 2, 3]] * 2, [[0, 1, 2], [3, 2, 1, 0], [1, 2], [], [0, 2, 3]], []]
)
def test_polygons_stay_polygons(polygons: list[list[int]]) -> None:
    corners = np.array([corner for polygon in polygons for corner in polygon], np.int32)
    sizes = np.array([len(polygon) for polygon in polygons], np.int32)
    region = np.arange(len(polygons)) * 0.5
    data = written(POINTS, FACES, polygons=(corners, sizes), face_properties={"region": region})
    _, _, faces = read(data)
    assert faces["vertex_indices"] == polygons
    assert faces["region"] == region.tolist()


@pytest.mark.parametrize("largest", [255, 256, 70_000])
def test_polygons_of_many_corners(largest: int) -> None:
    polygons = [[0, 1, 2], list(range(largest)), [2, 1, 0]]
    points = np.zeros((largest, 3))
    corners, sizes = np.concatenate(polygons), np.array([3, largest, 3])
    data = written(points, FACES, polygons=(corners, sizes))
    assert read(data)[2]["vertex_indices"] == polygons
    assert (b"property list uint int" in data) == (largest > 255)


def test_blocks_leave_no_seam() -> None:
    rng = np.random.default_rng(3)
    sizes = rng.integers(3, 6, 150_000)
    corners = rng.integers(0, 70_000, sizes.sum())
    points = rng.standard_normal((70_000, 3))
    data = written(points, FACES, polygons=(corners, sizes), vertex_properties={"K": points[:, 0]})
    body = data.partition(b"end_header\n")[2]
    rows = np.frombuffer(body, "<f8", 4 * len(points)).reshape(-1, 4)
    np.testing.assert_array_equal(rows, np.column_stack([points, points[:, 0]]))
    expected = b"".join(
        bytes([len(part)]) + part.astype("<i4").tobytes() for part in np.split(corners, np.cumsum(sizes)[:-1])
    )
    assert body[rows.nbytes :] == expected


def test_many_labels_become_int() -> None:
    names = tuple(f"name {k}" for k in range(300))
    data = written(POINTS, FACES, face_properties={"region": Labels(np.array([0, 299, -1, 5], np.int32), names)})
    comments, _, faces = read(data)
    assert faces["region"] == [0, 299, -1, 5]
    assert comments[0].endswith("255 name 255, and 44 more, -1 none")


def test_foreign_names_stay_one_word() -> None:
    data = written(POINTS, FACES, vertex_properties={"my prop é": np.zeros(4)}, comments=["naïve"])
    comments, vertices, _ = read(data)
    assert comments == ["na\\xefve"]
    assert list(vertices)[3:] == ["my_prop_é"]

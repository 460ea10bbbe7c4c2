"""OFF in every dialect: rows in file order, properties of vertices and faces, and refusals that name the line."""

from __future__ import annotations

import io
import struct
import time
from collections.abc import Callable
from pathlib import Path

import meshio
import numpy as np
import pytest
import trimesh

from curvcli.loading.formats.off import text as off_text
from curvcli.loading.read import read_mesh_file
from curvcli.mesh.file import MeshFile
from tests.helpers.every_format import (
    SHAPES,
    Shape,
    assert_reads,
    assert_refused,
    is_refused,
    moebius,
    read_cuts,
    sphere,
)

SQUARE = "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n"


def read(content: str | bytes, **options: object) -> MeshFile:
    data = content.encode() if isinstance(content, str) else content
    return read_mesh_file(io.BytesIO(data), **{"input_format": "off", **options})  # type: ignore[arg-type]


def off(shape: Shape, blank: str = " ", end: str = "\n", counts: str = "{V} {F} {E}", word: str = "OFF") -> bytes:
    numbers = counts.format(V=len(shape.points), F=len(shape.polygons), E=0)
    lines = [*([word] if word else []), numbers]
    lines += [blank.join(map(repr, row)) for row in shape.points.tolist()]
    lines += [blank.join(map(str, (len(row), *row))) for row in shape.polygons]
    return (end.join(lines) + end).encode()


def with_comments(shape: Shape) -> bytes:
    lines = off(shape).decode().splitlines()
    return ("# 3 4\n\n" + "\n# 5 6 7\n\n".join(f"{line} # {k} # 2" for k, line in enumerate(lines))).encode()


def on_one_line(shape: Shape) -> bytes:
    return b" ".join(off(shape).split())


def four_a_line(shape: Shape) -> bytes:
    words = off(shape).decode().split()
    return "\n".join(" ".join(words[k : k + 4]) for k in range(0, len(words), 4)).encode()


def binary(shape: Shape, colours: bool = False) -> bytes:
    data = b"OFF BINARY\n" + struct.pack(">3i", len(shape.points), len(shape.polygons), 0)
    data += shape.points.astype(">f4").tobytes()
    for k, row in enumerate(shape.polygons):
        shade = (k / 128, 0.5, 0.25, 1.0) if colours and k % 3 else ()
        data += struct.pack(f">{len(row) + 2}i{len(shade)}f", len(row), *row, len(shade), *shade)
    return data


DIALECTS: dict[str, Callable[[Shape], bytes]] = {
    "tidy": off,
    "tabs": lambda shape: off(shape, blank="\t"),
    "wide": lambda shape: off(shape, blank="  ", end=" \n"),
    "windows": lambda shape: off(shape, end="\r\n"),
    "old mac": lambda shape: off(shape, end="\r"),
    "empty lines": lambda shape: off(shape, end="\n \n\n"),
    "counts right behind the word": lambda shape: off(shape).replace(b"OFF\n", b"OFF", 1),
    "counts on the first line": lambda shape: off(shape).replace(b"OFF\n", b"OFF ", 1),
    "no number of edges": lambda shape: off(shape, counts="{V} {F}"),
    "a count per line": lambda shape: off(shape, counts="{V}\n{F}\n{E}"),
    "no first word": lambda shape: off(shape, word=""),
    "byte-order mark": lambda shape: b"\xef\xbb\xbf" + off(shape),
    "no last line end": lambda shape: off(shape).rstrip(),
    "comments": with_comments,
    "on one line": on_one_line,
    "four a line": four_a_line,
}


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("dialect", DIALECTS)
def test_every_dialect_gives_the_same_table(dialect: str, shape: str) -> None:
    meant = SHAPES[shape]()
    mesh = assert_reads(DIALECTS[dialect](meant), meant, input_format="off")
    assert not mesh.notices
    assert not mesh.vertex_properties
    assert not mesh.polygon_properties


def test_the_fast_reader_reads_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """Texts of any size are read by polars, and tidied only where they must be."""
    monkeypatch.setattr("curvcli.loading.text.SMALL", 0)
    monkeypatch.setattr(off_text, "_BLOCK", 100)
    for shape in (sphere(), moebius()):
        for write in DIALECTS.values():
            assert_reads(write(shape), shape, input_format="off")


@pytest.mark.parametrize("colours", [False, True])
def test_binary_files(colours: bool) -> None:
    for shape in (sphere().single(), moebius().single()):
        mesh = assert_reads(binary(shape, colours), shape)
        assert ("red" in mesh.polygon_properties) == colours
        if colours:
            red = mesh.polygon_properties["red"]
            assert np.isnan(red[0])
            assert red[4] == 4 / 128


def test_files_of_other_programs(tmp_path: Path) -> None:
    pymeshlab = pytest.importorskip("pymeshlab")
    shape = sphere().short()
    trimesh.Trimesh(shape.points, shape.polygons, process=False).export(tmp_path / "trimesh.off")
    meshio.Mesh(shape.points, [("triangle", np.array(shape.polygons))]).write(tmp_path / "meshio.off")
    for name in ("trimesh", "meshio"):
        assert_reads(tmp_path / f"{name}.off", shape)
    meshes = pymeshlab.MeshSet()
    colours = np.round(np.random.default_rng(3).random((len(shape.points), 4)) * 255) / 255
    shades = np.round(np.random.default_rng(4).random((len(shape.polygons), 4)) * 255) / 255
    meshes.add_mesh(pymeshlab.Mesh(shape.points, shape.triangles, v_color_matrix=colours, f_color_matrix=shades))
    meshes.save_current_mesh(str(tmp_path / "lab.off"))
    mesh = assert_reads(tmp_path / "lab.off", shape)
    kept = [mesh.vertex_properties[name] for name in ("red", "green", "blue", "alpha")]
    np.testing.assert_array_equal(np.array(kept).T, np.rint(colours * 255))
    normal = np.array([mesh.vertex_properties[name] for name in ("nx", "ny", "nz")]).T
    np.testing.assert_allclose(normal, meshes.current_mesh().vertex_normal_matrix(), rtol=1e-4, atol=1e-4)
    kept = [mesh.polygon_properties[name] for name in ("red", "green", "blue")]
    np.testing.assert_array_equal(np.array(kept).T, np.rint(shades * 255)[:, :3])


@pytest.mark.parametrize(
    ("word", "row", "properties"),
    [
        ("COFF", "9 8 7", {"red": 9, "green": 8, "blue": 7}),
        ("COFF", "9 8 7 255", {"red": 9, "green": 8, "blue": 7, "alpha": 255}),
        ("COFF", ".5 .25 0 1", {"red": 0.5, "green": 0.25, "blue": 0, "alpha": 1}),
        ("NOFF", "0 0 2", {"nx": 0, "ny": 0, "nz": 2}),
        ("CNOFF", "0 0 1 9 8 7 6", {"nx": 0, "ny": 0, "nz": 1, "red": 9, "alpha": 6}),
        ("NCOFF", "9 8 7 6 0 0 1", {"nx": 0, "ny": 0, "nz": 1, "red": 9, "alpha": 6}),
        ("STOFF", ".5 .75", {"s": 0.5, "t": 0.75}),
        ("STCNOFF", "0 0 1 9 8 7 6 .5 .75", {"nz": 1, "blue": 7, "s": 0.5, "t": 0.75}),
    ],
)
def test_data_of_vertices(word: str, row: str, properties: dict[str, float]) -> None:
    mesh = read(f"{word}\n4 1 0\n" + SQUARE.replace("\n", f" {row}\n") + "4 0 1 2 3\n", input_format=None)
    assert mesh.xyz[2].tolist() == [0, 0, 0, 0.5]
    for name, value in properties.items():
        assert (mesh.vertex_properties[name] == value).all()
    assert len(mesh.vertex_properties) == len(row.split())
    whole = {name: values.dtype for name, values in mesh.vertex_properties.items() if values.max() > 1 and name != "nz"}
    assert set(whole.values()) <= {np.dtype(np.uint8)}


def test_colours_of_faces_in_all_forms() -> None:
    faces = "3 0 1 2\n3 0 2 3 7\n3 0 1 3 10 20 30\n3 1 2 3 10 20 30 40\n4 0 1 2 3 .5 .25 0\n4 0 1 2 3 .5 .25 0 1\n"
    mesh = read("OFF\n4 6 0\n" + SQUARE + faces)
    assert mesh.sizes is not None
    assert mesh.sizes.tolist() == [3, 3, 3, 3, 4, 4]
    assert mesh.polygon_properties["color_index"].tolist() == [-1, 7, -1, -1, -1, -1]
    assert mesh.polygon_properties["color_index"].dtype == np.int32
    np.testing.assert_array_equal(mesh.polygon_properties["red"], [np.nan, np.nan, 10, 10, 0.5, 0.5])
    np.testing.assert_array_equal(mesh.polygon_properties["alpha"], [np.nan] * 3 + [40, np.nan, 1])
    even = read("OFF\n4 2 0\n" + SQUARE + "3 0 1 2 255 0 9\n3 0 2 3 0 255 9\n")
    assert even.polygon_properties["red"].dtype == np.uint8
    assert even.polygon_properties["red"].tolist() == [255, 0]


def test_short_faces_and_further_numbers_are_counted() -> None:
    mesh = read("OFF\n4 4 0\n" + SQUARE.replace("\n", " 1\n") + "3 0 1 2\n2 0 1\n3 0 2 3 1 2\n0\n")
    assert {notice.code: notice.count for notice in mesh.notices} == {"extra_values": 1, "short_faces": 2}
    codes = [notice.code for notice in mesh.notices]
    assert codes.count("extra_values") == 2
    assert mesh.corners.tolist() == [0, 1, 2, 0, 2, 3]
    trailing = read("OFF\n4 1 0\n" + SQUARE + "3 0 1 2\n3 0 2 3\n")
    assert [(notice.code, notice.count) for notice in trailing.notices] == [("trailing_data", 1)]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("4OFF\n4 1 0\n" + SQUARE + "3 0 1 2\n", "homogeneous positions of four numbers"),
        ("nOFF\n3\n4 1 0\n" + SQUARE + "3 0 1 2\n", "positions of any dimension"),
        ("OFF\n4 1 0\n" + SQUARE + "3 0 1 4\n", "line 7: vertex index 4 found, 0 to 3 expected"),
        ("OFF\n4 1 0\n" + SQUARE + "3 0 1 -1\n", "line 7: vertex index -1 found"),
        ("OFF\n4 1 0\n" + SQUARE + "3 0 1 1.5\n", "line 7: vertex index 1.5 found"),
        ("OFF\n4 1 0\n" + SQUARE + "3 0 1 99999999999\n", "line 7: vertex index 99999999999 found"),
        ("OFF\n4 1 0\n" + SQUARE + "# a\n\n3 0 1\n", "line 9: a face of 3 corners found, with 2 numbers"),
        ("OFF\n4 1 0\n" + SQUARE + "x 0 1 2\n", "line 7: `x` found, a number expected"),
        ("OFF\n4 1 0\n" + SQUARE.replace("1 1 0", "1 y 0") + "3 0 1 2\n", "line 5: `y` found"),
        (
            "OFF\n4 1 0\n" + SQUARE.replace("1 1 0", "1 1") + "3 0 1 2\n",
            "line 5: vertex of 2 numbers found, 3 as before",
        ),
        ("OFF\n5 1 0\n" + SQUARE + "3 0 1 2\n", "announced"),
        ("OFF\n5 1 0\n" + SQUARE + "3 0 1 2\n3 0 2 3\n", "line 7: vertex of 4 numbers found, 3 as before expected"),
        ("OFF\n3 2 0\n" + SQUARE + "3 0 1 2\n3 0 2 1\n", "line 6: a face of 0 corners found, and data after"),
        ("OFF\n4 2 0\n" + SQUARE + "3 0 1 2\n", "4 vertices and 2 faces announced"),
        ("OFF\n4 0 0\n" + SQUARE, "no faces"),
        ("OFF\n0 1 0\n3 0 1 2\n", "but no vertex"),
        ("OFF\n99999999999 1 0\n", "more than the"),
        ("OFF\n4 99999999999999 0\n" + SQUARE, "more than the"),
        ("OFF\n4 x 0\n", "line 2: `x` found, the number of faces expected"),
        ("OFF\n4", "the data end before the numbers"),
        ("OFF", "the data end before the numbers"),
        ("COFF\n4 1 0\n" + SQUARE + "3 0 1 2\n", "vertex of 3 numbers found, 7 expected"),
        ("CCOFF\n4 1 0\n" + SQUARE + "3 0 1 2\n", "at most once"),
        ("OFF BINARY\n", "the data end before"),
    ],
)
def test_refusals(content: str, message: str) -> None:
    assert_refused(content.encode(), message, input_format="off")


def test_truncated_files_are_refused() -> None:
    shape = Shape(
        np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]), ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))
    )
    text = off(shape)
    assert read_cuts(text, input_format="off") == [len(text) - 1]
    data = binary(shape)
    assert read_cuts(data, input_format="off") == []


def test_damaged_bytes_never_break() -> None:
    text = off(Shape(moebius().points[:6], ((0, 1, 2), (0, 2, 3, 4), (3, 4, 5))))
    for at in range(len(text)):
        for byte in b"9- x\n\0\xff":
            is_refused(text[:at] + bytes([byte]) + text[at + 1 :], input_format="off")
    data = binary(Shape(moebius().points[:6], ((0, 1, 2), (0, 2, 3, 4), (3, 4, 5))))
    for at in range(11, len(data)):
        for byte in (0, 1, 3, 127, 128, 255):
            is_refused(data[:at] + bytes([byte]) + data[at + 1 :], input_format="off")


def test_content_decides() -> None:
    mesh = read(off(sphere()), input_format="ply")
    assert mesh.format == "off"
    assert [notice.code for notice in mesh.notices] == ["wrong_suffix"]


@pytest.mark.slow
def test_time_is_linear() -> None:
    """Many comments, many empty lines, faces of one row: twice the bytes cost at most about twice the time."""

    def seconds(data: bytes) -> float:
        begin = time.process_time()
        is_refused(data, input_format="off")
        return time.process_time() - begin

    for piece in (b"# x\n", b"\n", b" ", b"0 ", b"3 0 1 2\n", b"OFF "):
        once, twice = (seconds(b"OFF\n4 1 0\n" + SQUARE.encode() + piece * count) for count in (200_000, 400_000))
        assert twice < 4 * once + 0.5, piece

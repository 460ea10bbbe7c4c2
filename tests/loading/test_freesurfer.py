"""FreeSurfer surfaces: the same table in every dialect, by any name, and refusals of damaged files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from curvcli.errors import InputError
from curvcli.loading.read import read_mesh_file
from tests.helpers.cli.program import curvcli
from tests.helpers.cortex import FOOTER, by_nibabel, quadrangles, text, triangles
from tests.helpers.every_format import SHAPES, Shape, assert_reads, assert_refused, is_refused, read_cuts

FORMAT = {"input_format": "freesurfer"}
SQUARE = Shape(np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0.25]]), ((0, 1, 2), (0, 2, 3)))


@pytest.mark.parametrize("name", SHAPES)
def test_every_dialect_gives_the_same_table(name: str, tmp_path: Path) -> None:
    nibabel = pytest.importorskip("nibabel", reason="nibabel writes the files of this test")
    shape = SHAPES[name]().halved().single()
    for comment in (b"created by a test\n\n", b"\n\n", b"one line end\n", b"created by CR and LF\r\n\r\n"):
        assert_reads(triangles(shape, comment), shape, **FORMAT)
    assert_reads(text(shape), shape, **FORMAT)
    for footer in (None, FOOTER, FOOTER | {"head": [20]}):
        by_nibabel(tmp_path / "lh.white", shape, footer)
        mesh = assert_reads(tmp_path / "lh.white", shape)
        assert not mesh.notices
        points, faces = nibabel.freesurfer.read_geometry(tmp_path / "lh.white")
        np.testing.assert_array_equal(mesh.xyz.T, points)
        np.testing.assert_array_equal(mesh.corners.reshape(-1, 3), faces)


def test_quadrangles_are_polygons() -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0.25], [2, 1, 0.25]])
    quads = np.array([[0, 1, 2, 3], [1, 4, 5, 2]])
    shape = Shape(points, tuple(map(tuple, quads.tolist())))
    for old in (False, True):
        data = quadrangles(points, quads, old=old)
        assert_reads(data, shape, **FORMAT)
        assert read_cuts(data, **FORMAT) == []


@pytest.mark.parametrize(
    "name", ["lh.white", "RH.Pial", "lh.sphere.reg", "rh.white.preaparc", "bert.inflated", "x", "a.b"]
)
def test_any_name_will_do(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(triangles(SQUARE))
    mesh = read_mesh_file(tmp_path / name)
    assert (mesh.format, mesh.polygons, mesh.notices) == ("freesurfer", 2, ())


def test_surfaces_of_one_subject_have_stems_of_their_own(tmp_path: Path) -> None:
    for name in ("lh.white", "lh.pial"):
        (tmp_path / name).write_bytes(triangles(SQUARE))
    paths = [str(tmp_path / name) for name in ("lh.white", "lh.pial")]
    assert curvcli("analyze", *paths, "-q", "-o", str(tmp_path / "{stem}.csv")).code == 0
    assert (tmp_path / "lh.white.csv").is_file()
    assert (tmp_path / "lh.pial.csv").is_file()


def test_every_truncation_is_refused(tmp_path: Path) -> None:
    by_nibabel(tmp_path / "lh.white", SQUARE, FOOTER)
    whole = (tmp_path / "lh.white").read_bytes()
    data = triangles(SQUARE)
    assert read_cuts(data, **FORMAT) == []
    # A cut within the geometry of the volume loses none of the surface.
    assert read_cuts(whole, **FORMAT) == list(range(whole.index(b"\0\0\0\2\0\0\0\0\0\0\0\x14"), len(whole)))
    assert [cut for cut in read_cuts(text(SQUARE), **FORMAT) if cut < len(text(SQUARE)) - 2] == []


@pytest.mark.parametrize("vertices", [-1, 1, 10**9, -10])
def test_wrong_counts_of_vertices_are_refused(vertices: int, tmp_path: Path) -> None:
    by_nibabel(tmp_path / "lh.white", SQUARE, FOOTER)
    for data in (triangles(SQUARE), (tmp_path / "lh.white").read_bytes()):
        at = data.index(b"\n\n") + 2
        count = np.array([len(SQUARE.points) + vertices], ">i4").tobytes()
        assert is_refused(data[:at] + count + data[at + 4 :], **FORMAT)


def test_wrong_counts_of_faces_are_refused_or_counted(tmp_path: Path) -> None:
    by_nibabel(tmp_path / "lh.white", SQUARE, FOOTER)
    for data in (triangles(SQUARE), (tmp_path / "lh.white").read_bytes()):
        at = data.index(b"\n\n") + 6
        for faces in (3, 10**9, -1, 0):
            assert is_refused(data[:at] + np.array([faces], ">i4").tobytes() + data[at + 4 :], **FORMAT)
        (tmp_path / "lh.few").write_bytes(data[:at] + b"\0\0\0\1" + data[at + 4 :])
        assert [notice.code for notice in read_mesh_file(tmp_path / "lh.few").notices] == ["trailing_data"]


def test_an_index_out_of_range_names_its_face() -> None:
    wrong = Shape(SQUARE.points, ((0, 1, 2), (0, 2, 4)))
    assert_refused(triangles(wrong), "face 1: vertex index 4 found, 0 to 3 expected", **FORMAT)
    assert_refused(text(wrong), "face 1: vertex index 4 found", **FORMAT)
    assert_refused(text(SQUARE).replace(b"0.25", b"west"), "line 6: `west` found, a number expected", **FORMAT)
    assert_refused(text(SQUARE).replace(b"0.25  0", b"0.25"), "line 6: 3 words found", **FORMAT)


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("lh.thickness", b"\xff\xff\xff\0\0\0\4\0\0\0\2\0\0\0\1" + bytes(16), "values of 4 vertices found"),
        ("lh.aparc.annot", b"\0\0\0\4" + bytes(36), "--regions"),
        ("lh.cortex.label", b"#!ascii label\n1\n0 0 0 0 0\n", "--regions"),
        ("lh.other", b"something else", "ff ff fe"),
        ("scan.asc", b"0.1 0.2 0.3\n0.1 0.2 0.4\n", "#!ascii"),
    ],
)
def test_files_beside_a_surface_are_refused(name: str, data: bytes, words: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(data)
    with pytest.raises(InputError, match=words):
        read_mesh_file(tmp_path / name)


def test_max_faces_is_a_limit() -> None:
    assert_refused(triangles(SQUARE), "--max-faces", max_faces=1, **FORMAT)
    assert_refused(text(SQUARE), "--max-faces", max_faces=1, **FORMAT)

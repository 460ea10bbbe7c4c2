"""OFF, datafiles of the Evolver, GLB and lines of JSON are read back: rows, polygons, colours, columns."""

from __future__ import annotations

import io
import json
import subprocess
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
import trimesh

import curvcli
from curvcli.loading.read import read_mesh_file
from curvcli.loading.tables import read_stored_table
from curvcli.output.meshes import text
from curvcli.output.meshes.fe import write_fe
from curvcli.output.meshes.off import write_off
from tests.helpers.every_format import SHAPES, Shape, assert_reads, moebius, sphere
from tests.helpers.meshes import of_sample
from tests.properties.test_evolver import PROGRAM


def analysed(shape: Shape, tmp_path: Path, passes: str = "core") -> curvcli.Analysis:
    """An analysis of the shape from a file, so that its polygons are known."""
    write_mesh(tmp_path / "in.off", shape)
    return curvcli.analyze(tmp_path / "in.off", passes)


def write_mesh(path: Path, shape: Shape) -> None:
    with path.open("wb") as stream:
        write_off(stream, shape.points, shape.triangles, polygons=(shape.corners, shape.sizes))


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("suffix", ["off", "fe"])
def test_what_is_written_is_read_back(suffix: str, shape: str, tmp_path: Path) -> None:
    meant = SHAPES[shape]()
    analysis = analysed(meant, tmp_path)
    analysis.write(tmp_path / f"out.{suffix}")
    file = assert_reads(tmp_path / f"out.{suffix}", meant)
    if suffix == "off":
        assert [file.vertex_properties[name].dtype for name in ("red", "green", "blue", "alpha")] == [np.uint8] * 4
    else:
        (name,) = file.vertex_properties
        np.testing.assert_array_equal(file.vertex_properties[name], np.asarray(analysis.vertices[name]))


def test_blocks_of_any_length_give_the_same_bytes(monkeypatch: pytest.MonkeyPatch) -> None:
    def written() -> list[bytes]:
        streams = [io.BytesIO(), io.BytesIO()]
        shape = moebius()
        polygons = (shape.corners, shape.sizes)
        write_off(streams[0], shape.points, shape.triangles, polygons=polygons)
        write_fe(streams[1], shape.points, shape.triangles, polygons=polygons)
        return [stream.getvalue() for stream in streams]

    whole = written()
    for module in ("off", "fe"):
        monkeypatch.setattr(f"curvcli.output.meshes.{module}.ROWS_AT_A_TIME", 7)
    monkeypatch.setattr(text, "ROWS_AT_A_TIME", 7)
    assert written() == whole


def test_colours_of_faces_stay(tmp_path: Path) -> None:
    (tmp_path / "in.off").write_text("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 1\n3 0 1 2 255 0 9\n3 0 2 3 1 2 3\n")
    curvcli.analyze(tmp_path / "in.off").write(tmp_path / "out.off")
    red = read_mesh_file(tmp_path / "out.off").polygon_properties["red"]
    assert red.tolist() == [255, 1]


def test_other_programs_read_off(tmp_path: Path) -> None:
    shape = sphere()
    analysed(shape, tmp_path).write(tmp_path / "out.off")
    for mesh in (
        trimesh.load_mesh(tmp_path / "out.off", process=False),
        trimesh.load_mesh(tmp_path / "in.off", process=False),
    ):
        np.testing.assert_array_equal(mesh.vertices, shape.points)
        np.testing.assert_array_equal(mesh.faces, shape.triangles)
    np.testing.assert_array_equal(meshio.read(tmp_path / "in.off").points, shape.points)
    pymeshlab = pytest.importorskip("pymeshlab")
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(tmp_path / "out.off"))
    colours = meshes.current_mesh().vertex_color_matrix()
    file = read_mesh_file(tmp_path / "out.off")
    np.testing.assert_allclose(colours[:, 0] * 255, file.vertex_properties["red"], atol=1e-3)


def test_names_and_flaws_that_the_evolver_cannot_hold(tmp_path: Path) -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [np.nan, 0, 0]])
    faces = np.array([[0, 1, 2], [0, 1, 1]])
    stream = io.BytesIO()
    values = np.array([1.5, np.nan, 2, 3])
    notices = write_fe(stream, points, faces, vertex_properties={"K": values}, active="K")
    assert {notice.code for notice in notices} == {"renamed_properties", "repeated_corner_faces", "positions_at_origin"}
    file = read_mesh_file(io.BytesIO(stream.getvalue()))
    np.testing.assert_array_equal(file.vertex_properties["column_K"], values)
    assert file.corners.tolist() == [0, 1, 2]


def test_closed_components_are_bodies(tmp_path: Path) -> None:
    ball = of_sample("icosphere", size=42)
    half = len(ball.faces)
    faces = np.concatenate([ball.faces, ball.faces + 42, ball.faces[:-1] + 84])
    stream = io.BytesIO()
    write_fe(stream, np.concatenate([ball.points, ball.points + 3, ball.points + 6]), faces)
    labels = read_mesh_file(io.BytesIO(stream.getvalue())).polygon_labels["objects"]
    assert labels.names == ("1", "2")
    assert labels.codes.tolist() == [0] * half + [1] * half + [-1] * (half - 1)


@pytest.mark.skipif(PROGRAM is None, reason="the Surface Evolver is not installed; Debian's package is evolver-nox")
def test_the_evolver_reads_its_datafile(tmp_path: Path) -> None:
    points, faces = of_sample("icosphere", size=42)[:2]
    analysis = curvcli.analyze((points, faces), ["h_signed", "A_vec"])
    analysis.write(tmp_path / "a.fe")
    commands = 'print total_area\nprint body[1].volume\nprint vertex[5].h_signed\ndump "b.dmp"\nq\nq\n'
    ended = subprocess.run(
        [str(PROGRAM), "a.fe"], input=commands, cwd=tmp_path, capture_output=True, text=True, timeout=60
    )
    printed = [float(line) for line in ended.stdout.splitlines() if line.strip().replace(".", "", 1).isdigit()]
    expected = [analysis.totals["area"], analysis.totals["volume"], analysis.vertices["h_signed"][4]]
    np.testing.assert_allclose(printed, expected, rtol=1e-13)
    np.testing.assert_allclose(read_mesh_file(tmp_path / "b.dmp").xyz.T, points, rtol=1e-13)


def rows_of(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def test_lines_of_json_are_the_table(tmp_path: Path) -> None:
    analysis = analysed(sphere(), tmp_path)
    analysis.write(tmp_path / "out.jsonl")
    analysis.write(tmp_path / "out.csv")
    rows = rows_of(tmp_path / "out.jsonl")
    assert len(rows) == len(sphere().points)
    assert rows[5]["status"] == "unreferenced"
    assert rows[5]["K"] is None
    one, other = (read_stored_table(str(tmp_path / f"out.{suffix}")) for suffix in ("jsonl", "csv"))
    assert list(one) == list(other)
    for name, values in other.items():
        np.testing.assert_array_equal(one[name], values)
    np.testing.assert_array_equal([row["x"] for row in rows], sphere().points[:, 0])


def test_stored_lines_of_json_that_do_not_fit_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.jsonl"
    for content, message in (
        ("[1]\n", "no JSON object"),
        ('{"vertex":0}\n{"other":1}\n', "other keys"),
        ('{"x":0}\n', "no column `vertex`"),
        ('{"vertex":0,"x":1}\n{"vertex":1,"x":', "cannot be read as a table"),
    ):
        path.write_text(content)
        with pytest.raises(curvcli.errors.InputError, match=message):
            read_stored_table(str(path))

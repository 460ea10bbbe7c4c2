"""Meshes that we write, as other programs read them: VTK, meshio, MeshLab and trimesh."""

from __future__ import annotations

import io
import json
import struct
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
import trimesh

import curvcli
from curvcli.api import Analysis
from curvcli.errors import OutputError
from curvcli.mesh.file import Labels
from curvcli.output.appearance import Appearance
from curvcli.output.meshes.glb import write_glb
from curvcli.output.meshes.vtk import write_vtk
from curvcli.output.tables.columns import vertex_properties
from curvcli.output.write import write_outputs
from tests.helpers.meshes import of_sample

QUADS = """v 0 0 0
v 1 0 0
v 1 1 0.1
v 0 1 0
v 2 0 0
v 2 1 0
v 3 0.5 1
v 9 9 9
f 1 2 3 4
f 2 5 6 3
f 5 7 6
"""


@pytest.fixture
def quads(tmp_path: Path) -> Analysis:
    """Two quadrilaterals, a triangle, and a vertex that no face uses."""
    path = tmp_path / "quads.obj"
    path.write_text(QUADS)
    return curvcli.analyze(path, ["core", "dir_1"])


def written(analysis: Analysis, path: Path, **appearance: Any) -> str:
    write_outputs(analysis, [str(path)], appearance=Appearance(**appearance))
    return str(path)


def colors(path: str) -> Any:
    """(V, 3) red, green and blue of a PLY file."""
    file = curvcli.load(path).file
    assert file is not None
    return np.stack([file.vertex_properties[name].astype(int) for name in ("red", "green", "blue")], axis=1)


def same_columns(analysis: Analysis, found: Any) -> None:
    """Every column under its name, float64 and the same bits, null as NaN."""
    for name, column in vertex_properties(analysis).items():
        values = np.asarray(found[name])
        if isinstance(column, Labels):
            np.testing.assert_array_equal(values, column.codes)
        else:
            expected = np.ma.filled(np.ma.asarray(column).astype(float), np.nan)
            np.testing.assert_array_equal(values.astype(float), expected, err_msg=name)
            assert column.dtype.kind != "f" or values.dtype == np.float64


@pytest.mark.parametrize("suffix", [".vtp", ".vtu"])
def test_vtk_reads_every_column_in_full(quads: Analysis, tmp_path: Path, suffix: str) -> None:
    import pyvista

    mesh = pyvista.read(written(quads, tmp_path / f"x{suffix}", color_by=("h",)))
    assert type(mesh).__name__ == {".vtp": "PolyData", ".vtu": "UnstructuredGrid"}[suffix]
    assert mesh.points.dtype == np.float64
    np.testing.assert_array_equal(mesh.points, quads.surface.points)
    assert [mesh.get_cell(k).point_ids for k in range(mesh.n_cells)] == [[0, 1, 2, 3], [1, 4, 5, 2], [4, 6, 5]]
    same_columns(quads, mesh.point_data)
    np.testing.assert_array_equal(mesh.point_data["H_vec"], quads.vertices["H_vec"])
    assert mesh.point_data["RGB"].shape == (8, 3)
    assert mesh.point_data["RGB"].dtype == np.uint8
    assert mesh.point_data.active_scalars_name == "h"


def test_meshio_reads_the_grid_too(quads: Analysis, tmp_path: Path) -> None:
    path = written(quads, tmp_path / "x.vtu")
    mesh = meshio.read(path)
    np.testing.assert_array_equal(mesh.points, quads.surface.points)
    assert {block.type: len(block.data) for block in mesh.cells} == {"quad": 2, "triangle": 1}
    same_columns(quads, mesh.point_data)
    head = Path(path).read_bytes()[:600]
    assert b"H = k1 + k2" in head
    assert b"status: 0 interior, 1 boundary" in head


def test_vtk_labels_flags_and_hostile_comments_are_written_so_that_they_are_read(tmp_path: Path) -> None:
    import pyvista

    stream = io.BytesIO()
    labels = Labels(np.array([1, -1, 0], np.int32), ("a--b", "ü → <x>"))
    write_vtk(
        stream,
        ".vtp",
        np.eye(3),
        np.array([[0, 1, 2]]),
        vertex_properties={"flag": np.array([True, False, True]), "big": np.arange(3, dtype=">i8")},
        face_properties={"part": Labels(np.array([1], np.int32), labels.names)},
        comments=["---->", "two\nlines\udcff"],
    )
    path = tmp_path / "x.vtp"
    path.write_bytes(stream.getvalue())
    mesh = pyvista.read(path)
    assert mesh.point_data["flag"].tolist() == [1, 0, 1]
    assert mesh.point_data["big"].tolist() == [0, 1, 2]
    assert mesh.cell_data["part"].tolist() == [1]


def test_meshlab_reads_colours_and_quality_on_request(quads: Analysis, tmp_path: Path) -> None:
    pymeshlab = pytest.importorskip("pymeshlab", reason="pymeshlab is not installed")
    for quality in (False, True):
        path = written(quads, tmp_path / f"{quality}.ply", color_by=("K_density",), quality=quality)
        meshes = pymeshlab.MeshSet()
        meshes.load_new_mesh(path)
        mesh = meshes.current_mesh()
        assert mesh.vertex_number() == 8
        assert mesh.face_number() == 5  # MeshLab cuts quadrilaterals into triangles
        assert mesh.has_vertex_color()
        assert mesh.has_vertex_scalar() is quality
        np.testing.assert_allclose(mesh.vertex_color_matrix()[:, :3] * 255, colors(path), atol=1e-6)
    np.testing.assert_array_equal(mesh.vertex_scalar_array(), quads.vertices["K_density"])


def test_vtk_reads_the_colours_of_ply(quads: Analysis, tmp_path: Path) -> None:
    import pyvista

    mesh = pyvista.read(written(quads, tmp_path / "x.ply"))
    assert (mesh.n_points, mesh.n_cells) == (8, 3)
    assert mesh.point_data["RGB"].dtype == np.uint8


def test_gltf_has_the_colours_of_the_screen_in_linear_light(quads: Analysis, tmp_path: Path) -> None:
    path = written(quads, tmp_path / "x.glb", color_by=("A",))
    mesh = trimesh.load(path, force="mesh", process=False)
    np.testing.assert_array_equal(mesh.vertices, quads.surface.points.astype(np.float32))
    np.testing.assert_array_equal(mesh.faces, quads.surface.faces)
    screen = colors(written(quads, tmp_path / "x.ply", color_by=("A",)))
    light = mesh.visual.vertex_colors[:, :3] / 255
    seen = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    np.testing.assert_allclose(seen, screen / 255, atol=0.03)
    assert (mesh.visual.vertex_colors[:, 3] == 255).all()


def test_gltf_keeps_the_shape_far_from_the_origin() -> None:
    mesh = of_sample("torus", size=200)
    stream = io.BytesIO()
    (notice,) = write_glb(stream, mesh.points + 1e7, mesh.faces)
    assert (notice.code, notice.count) == ("glb_float32", len(mesh.points))
    content = stream.getvalue()
    (length,) = struct.unpack("<I", content[12:16])
    tree = json.loads(content[20 : 20 + length])
    assert {accessor["componentType"] for accessor in tree["accessors"]} == {5125, 5126}
    stream.seek(0)
    scene = trimesh.load_scene(stream, file_type="glb", process=False)
    (geometry,) = scene.geometry.values()
    middle = scene.graph["surface"][0][:3, 3]
    np.testing.assert_allclose(geometry.vertices + middle - 1e7, mesh.points, atol=1e-6)


@pytest.mark.parametrize("size", [1e39, 1e-39])
def test_gltf_refuses_what_float32_cannot_hold(size: float) -> None:
    mesh = of_sample("torus", size=100)
    with pytest.raises(OutputError, match=r"glTF has float32 only.*write \.ply"):
        write_glb(io.BytesIO(), mesh.points * size, mesh.faces)

"""VTK files that curvcli writes: read back by curvcli with the same rows, columns, labels and unit, without VTK."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import curvcli
from curvcli.mesh.file import Labels, MeshFile
from curvcli.mesh.polygons import from_file
from curvcli.output.tables.columns import vertex_properties
from tests.helpers.every_format import SHAPES, Shape, assert_same
from tests.helpers.vtk_files import data_set

NAMES = ("inner, 1 ring", "Zürich -- <x>", "3", "a\nb")


def labelled(shape: Shape) -> MeshFile:
    """The shape with labels of vertices and polygons, some without, and properties of either."""
    part = shape.part.copy()
    part[0] = -1
    at_points = (np.arange(len(shape.points)) % 5 - 1).astype(np.int32)
    return MeshFile(
        "arrays",
        np.ascontiguousarray(shape.points.T),
        shape.corners,
        None if (shape.sizes == 3).all() else shape.sizes,
        vertex_properties={"value": shape.value, "count": np.arange(len(shape.points), dtype=np.uint16)},
        polygon_properties={"area class": shape.part.astype(np.int64)},
        polygon_labels={"groups": Labels(part, NAMES)},
        vertex_labels={"zone": Labels(at_points, NAMES)},
        unit="mm",
    )


@pytest.mark.parametrize("suffix", ["vtp", "vtu"])
@pytest.mark.parametrize("name", SHAPES)
def test_what_is_written_is_read_back(name: str, suffix: str, tmp_path: Path) -> None:
    file = labelled(SHAPES[name]())
    analysis = curvcli.analyze(from_file(file))
    analysis.write(tmp_path / f"a.{suffix}")
    surface = curvcli.load(tmp_path / f"a.{suffix}")
    assert_same(surface, analysis.surface, table=False)
    back = surface.file
    assert back is not None
    assert back.unit == "mm"
    assert back.notices == ()
    for element in ("vertex", "polygon"):
        given, found = (getattr(one, f"{element}_properties") for one in (file, back))
        for key, values in given.items():
            np.testing.assert_array_equal(found[key], values)
            assert found[key].dtype == values.dtype
        given, found = (getattr(one, f"{element}_labels") for one in (file, back))
        for key, labels in given.items():
            assert found[key].names == labels.names
            np.testing.assert_array_equal(found[key].codes, labels.codes)
    for key, column in vertex_properties(analysis).items():
        if isinstance(column, Labels):
            np.testing.assert_array_equal(back.vertex_labels[key].codes, column.codes)
        else:
            expected = np.ma.filled(np.ma.asarray(column).astype(float), np.nan)
            np.testing.assert_array_equal(back.vertex_properties[key].astype(float), expected)
    assert not [key for key in back.vertex_properties if key.startswith("H_vec") and key[-2:] not in ("_x", "_y", "_z")]
    again = curvcli.analyze(surface, regions="groups").report()["regions"]
    assert [region["name"] for region in again] == [
        NAMES[k] for k in sorted({*file.polygon_labels["groups"].codes} - {-1})
    ]


def test_other_programs_read_the_same_labels_as_codes(tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    analysis = curvcli.analyze(from_file(labelled(SHAPES["moebius"]())), "topology")
    for suffix in ("vtp", "vtu"):
        analysis.write(tmp_path / f"a.{suffix}")
        mesh = pyvista.read(tmp_path / f"a.{suffix}")
        np.testing.assert_array_equal(
            mesh.cell_data["groups"], labelled(SHAPES["moebius"]()).polygon_labels["groups"].codes
        )
        assert mesh.n_points == analysis.surface.n_vertices


def test_a_unit_in_a_field_of_another_program(tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    mesh = pyvista.wrap(data_set(SHAPES["moebius"](), "polydata"))
    mesh.field_data["unit"] = np.array(["nm"])
    for name in ("a.vtp", "a.vtk"):
        mesh.save(tmp_path / name)
        assert curvcli.analyze(tmp_path / name, "topology").conventions.unit == "nm"


@pytest.mark.slow
def test_neither_writing_nor_reading_imports_vtk(tmp_path: Path) -> None:
    program = (
        "import sys, curvcli\n"
        "a = curvcli.analyze(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))\n"
        "for name in ('a.vtp', 'a.vtu'):\n"
        "    a.write(name)\n"
        "    assert curvcli.load(name).n_faces == 1\n"
        "assert not {'vtkmodules', 'pyvista', 'matplotlib'} & sys.modules.keys()\n"
    )
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr

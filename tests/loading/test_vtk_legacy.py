"""Legacy VTK files, written by VTK and by hand: the same table to the last digit, arrays as properties and labels."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest

from curvcli.loading.read import read_mesh_file
from tests.helpers.every_format import SHAPES, assert_reads, assert_refused, is_refused
from tests.helpers.vtk_files import LEGACY, data_set, write_legacy
from tests.loading.vtk_arrays import assert_arrays, of_meshio

HEAD = b"# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET POLYDATA\n"
BODY = b"POINTS 4 float\n0 0 0 1 0 0\n1 1 0 0 1 0.5\n"


@pytest.mark.parametrize("kind", ["polydata", "grid"])
@pytest.mark.parametrize("dialect", LEGACY)
def test_every_dialect_is_read_to_the_last_digit(dialect: str, kind: str, tmp_path: Path) -> None:
    for name, make in SHAPES.items():
        for single in (False, True):
            shape = make().single() if single else make()
            if dialect.startswith("ASCII"):
                shape = shape.short()  # VTK writes few digits
            path = write_legacy(data_set(shape, kind, single=single), dialect, tmp_path / f"{name}.vtk")
            assert_arrays(assert_reads(path, shape, table="51" in dialect and not single), shape)


@pytest.mark.parametrize("form", ["vtk42", "vtk51"])
@pytest.mark.parametrize("binary", [True, False])
def test_what_meshio_writes_is_read_to_the_last_digit(form: str, binary: bool, tmp_path: Path) -> None:
    for make in SHAPES.values():
        shape = make()
        of_meshio(shape).write(tmp_path / "a.vtk", file_format=form, binary=binary)
        file = assert_reads(tmp_path / "a.vtk", shape, table=False)
        np.testing.assert_array_equal(file.vertex_properties["value"], shape.value)
        np.testing.assert_array_equal(file.polygon_properties["part"], shape.part)


def test_the_files_that_pyvista_ships() -> None:
    """Surfaces with the counts of VTK; volumes and grids are refused."""
    pyvista = pytest.importorskip("pyvista")
    from pyvista import examples

    shipped = sorted(Path(examples.__file__).parent.glob("*.vtk"))
    assert shipped
    for path in shipped:
        mesh = pyvista.read(path)
        if isinstance(mesh, pyvista.PolyData):
            file = read_mesh_file(path, texture=True)
            assert (file.xyz.shape[1], file.polygons) == (mesh.n_points, mesh.n_cells)
            np.testing.assert_array_equal(file.xyz.T, mesh.points)
            np.testing.assert_array_equal(file.corners.reshape(-1, 3), mesh.regular_faces)
        else:
            assert_refused(path.read_bytes(), "no faces, but|DATASET")


def test_texture_coordinates_are_those_of_the_corners() -> None:
    values = b"POINT_DATA 4\nTEXTURE_COORDINATES t 2 float\n0 0 1 0 1 1 0 1\n"
    file = read_mesh_file(io.BytesIO(HEAD + BODY + b"POLYGONS 1 5\n4 0 1 2 3\n" + values), texture=True)
    assert file.corner_texture is not None
    assert file.corner_texture.tolist() == [[0, 1, 1, 0], [0, 0, 1, 1]]


def test_strips_lines_and_values_of_cells_keep_their_order() -> None:
    text = BODY + (
        b"VERTICES 1 2\n1 3\nLINES 1 4\n3 0 1 2\nPOLYGONS 1 5\n4 0 1 2 3\nTRIANGLE_STRIPS 1 5\n4 0 1 3 2\n"
        b"CELL_DATA 4\nSCALARS part int\nLOOKUP_TABLE default\n10 20 30 40\n"
        b"POINT_DATA 4\nNORMALS n float\n" + b"0 0 1 " * 4 + b"\n"
    )
    file = read_mesh_file(io.BytesIO(HEAD + text), normals="file")
    assert file.sizes is not None
    assert file.sizes.tolist() == [4, 3, 3]
    assert file.corners.tolist() == [0, 1, 2, 3, 0, 1, 3, 3, 1, 2]
    assert file.polygon_properties["part"].tolist() == [30, 40, 40]
    assert [line.tolist() for line in file.polylines] == [[0, 1, 2]]
    assert [(notice.code, notice.count) for notice in file.notices] == [("other_cells", 1)]
    assert file.vertex_normals is not None
    np.testing.assert_array_equal(file.vertex_normals[2], [1, 1, 1, 1])


def test_grids_have_pixels_and_strips_among_their_cells() -> None:
    cells = b"CELLS 4 17\n4 0 1 3 2\n4 0 1 3 2\n3 0 1 2\n2 0 1\nCELL_TYPES 4\n8 6 5 3\nCELL_DATA 4\nSCALARS a int 1\n"
    text = HEAD.replace(b"POLYDATA", b"UNSTRUCTURED_GRID") + BODY + cells + b"LOOKUP_TABLE default\n1 2 3 4\n"
    file = read_mesh_file(io.BytesIO(text))
    assert file.sizes is not None
    assert file.sizes.tolist() == [4, 3, 3, 3]
    assert file.corners.tolist() == [0, 1, 2, 3, 0, 1, 3, 3, 1, 2, 0, 1, 2]
    assert file.polygon_properties["a"].tolist() == [1, 2, 2, 3]


def test_mixed_lengths_and_every_kind_of_attribute() -> None:
    text = BODY + (
        b"POLYGONS 2 9\n4 0 1 2 3\n3 0 1 2\nMETADATA\nINFORMATION 0\n\nPOINT_DATA 4\n"
        b"SCALARS s%20t double 2\nLOOKUP_TABLE mine\n1 2 3 4 5 6 7 8\nLOOKUP_TABLE mine 2\n0 0 0 1 1 1 1 1\n"
        b"COLOR_SCALARS c 3\n" + b"0.5 0 1 " * 4 + b"\nTEXTURE_COORDINATES t 2 float\n" + b"0 1 " * 4 + b"\n"
        b"TENSORS e float\n" + b"1 2 3 4 5 6 7 8 9 " * 4 + b"\nFIELD f 2\nw 1 4 string\na%20b\nc\na%20b\nd\n"
        b"n 1 4 unsigned_long\n1 2 3 4000000000\n"
    )
    file = read_mesh_file(io.BytesIO(HEAD + text))
    names = list(file.vertex_properties)
    assert names[:4] == ["s t_0", "s t_1", "c_x", "c_y"]
    assert file.vertex_properties["n"].tolist() == [1, 2, 3, 4_000_000_000]
    assert file.vertex_labels["w"].names == ("a b", "c", "d")


@pytest.mark.parametrize(
    ("damage", "match"),
    [
        ((b"POINTS 4", b"POINTS 400000000000"), "announced"),
        ((b"POINTS 4", b"POINTS 5"), "number"),
        ((b"POLYGONS 1 5", b"POLYGONS 2 5"), "POLYGONS"),
        ((b"POLYGONS 1 5", b"POLYGONS 1 6"), "number"),
        ((b"4 0 1 2 3", b"4 0 1 2 4"), "vertex index 4"),
        ((b"4 0 1 2 3", b"4 0 1 2 -1"), "vertex index -1"),
        ((b"4 0 1 2 3", b"9 0 1 2 3"), "POLYGONS"),
        ((b"float", b"string"), "type `string`"),
        ((b"POLYDATA", b"STRUCTURED_GRID"), "extract_surface"),
        ((b"ASCII", b"TEXT"), "ASCII or BINARY"),
        ((b"POLYGONS", b"POLYGON"), "POLYGON"),
        ((b"0.5", b"nan"), "not finite|finite"),
        ((b"0.5", b"x"), "`x`"),
    ],
)
def test_what_does_not_fit_is_refused(damage: tuple[bytes, bytes], match: str) -> None:
    good = HEAD + BODY + b"POLYGONS 1 5\n4 0 1 2 3\n"
    assert not is_refused(good)
    assert_refused(good.replace(*damage), match)

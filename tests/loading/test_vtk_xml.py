"""VTK XML in every dialect, written by VTK: the same table to the last digit, arrays as properties and labels."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest

from curvcli.loading.read import read_mesh_file
from tests.helpers.every_format import SHAPES, assert_reads, assert_refused
from tests.helpers.vtk_files import XML, data_set, write_xml
from tests.loading.vtk_arrays import assert_arrays, of_meshio

KINDS = {"vtp": "polydata", "vtu": "grid"}


@pytest.mark.parametrize("suffix", KINDS)
@pytest.mark.parametrize("dialect", XML)
def test_every_dialect_is_read_to_the_last_digit(dialect: str, suffix: str, tmp_path: Path) -> None:
    for name, make in SHAPES.items():
        for single in (False, True):
            shape = make().single() if single else make()
            if dialect.startswith("Ascii") and single:
                shape = shape.short()  # decimal digits are read as doubles
            path = write_xml(data_set(shape, KINDS[suffix], single=single), dialect, tmp_path / f"{name}.{suffix}")
            assert_arrays(assert_reads(path, shape, table="ZLib" in dialect and not single), shape)


@pytest.mark.parametrize(("binary", "compression"), [(False, None), (True, None), (True, "zlib"), (True, "lzma")])
def test_what_meshio_writes_is_read_to_the_last_digit(binary: bool, compression: str | None, tmp_path: Path) -> None:
    for make in SHAPES.values():
        shape = make() if binary else make().short()  # meshio writes 12 digits
        of_meshio(shape).write(tmp_path / "a.vtu", binary=binary, compression=compression)
        file = assert_reads(tmp_path / "a.vtu", shape, table=False)
        np.testing.assert_array_equal(file.vertex_properties["value"], shape.value)
        np.testing.assert_array_equal(file.polygon_properties["part"], shape.part)


def test_pieces_follow_each_other_and_empty_ones_count_for_nothing() -> None:
    """Arrays that every piece has are kept; the others are named."""
    piece = """<Piece NumberOfPoints="3" NumberOfPolys="1"><PointData>
<DataArray type="Int8" Name="a" format="ascii">{a}</DataArray>{more}</PointData><Points>
<DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 {z} 1 0 {z} 0 1 {z}</DataArray></Points><Polys>
<DataArray type="UInt16" Name="connectivity" format="ascii">0 1 2</DataArray>
<DataArray type="UInt16" Name="offsets" format="ascii">3</DataArray></Polys></Piece>"""
    more = '<DataArray type="Int8" Name="b" format="ascii">1 2 3</DataArray>'
    pieces = (
        piece.format(a="1 2 3", z=0, more=more) + '<Piece NumberOfPoints="0"/>' + piece.format(a="4 5 6", z=1, more="")
    )
    text = f'<VTKFile type="PolyData"><PolyData>{pieces}</PolyData></VTKFile>'
    file = read_mesh_file(io.BytesIO(text.encode()))
    assert file.corners.tolist() == [0, 1, 2, 3, 4, 5]
    assert file.xyz[2].tolist() == [0, 0, 0, 1, 1, 1]
    assert {name: column.tolist() for name, column in file.vertex_properties.items()} == {"a": [1, 2, 3, 4, 5, 6]}
    assert [(notice.code, notice.count) for notice in file.notices] == [("ignored_arrays", 1)]
    beyond = text.replace(
        '0 1 2</DataArray>\n<DataArray type="UInt16" Name="offsets"',
        '0 1 3</DataArray>\n<DataArray type="UInt16" Name="offsets"',
    )
    assert_refused(beyond.encode(), "piece 0: polygon 0: vertex index 3")

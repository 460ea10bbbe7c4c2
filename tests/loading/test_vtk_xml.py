"""VTK XML in every dialect, written by VTK: the same table to the last digit, arrays as properties and labels."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from curvcli.mesh.file import MeshFile
from tests.helpers.every_format import SHAPES, Shape, assert_reads
from tests.helpers.vtk_files import WORDS, XML, data_set, write_xml

KINDS = {"vtp": "polydata", "vtu": "grid"}


def assert_arrays(file: MeshFile, shape: Shape) -> None:
    """Compare the arrays of points and cells, and the words of cells."""
    assert list(file.vertex_properties) == ["value", "shift_x", "shift_y", "shift_z"]
    np.testing.assert_array_equal(file.vertex_properties["value"], shape.value)
    shift = [file.vertex_properties[f"shift_{axis}"] for axis in "xyz"]
    np.testing.assert_allclose(np.array(shift).T, shape.points.astype(np.float32), rtol=1e-6, atol=1e-9)
    assert list(file.polygon_properties) == ["part"]
    np.testing.assert_array_equal(file.polygon_properties["part"], shape.part)
    words = file.polygon_labels["word"]
    assert [words.names[code] for code in words.codes] == [WORDS[part] for part in shape.part]


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

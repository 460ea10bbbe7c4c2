"""VTK XML in every dialect, written by VTK: the same table to the last digit, arrays as properties and labels."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.helpers.every_format import SHAPES, assert_reads
from tests.helpers.vtk_files import XML, data_set, write_xml
from tests.loading.vtk_arrays import assert_arrays

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

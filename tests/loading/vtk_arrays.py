"""Comparison of the arrays of a file of VTK with those of the shape from which VTK wrote it."""

from __future__ import annotations

import numpy as np

from curvcli.mesh.file import MeshFile
from tests.helpers.every_format import Shape
from tests.helpers.vtk_files import WORDS


def assert_arrays(file: MeshFile, shape: Shape) -> None:
    """Compare the arrays of points and cells, and the words of cells."""
    assert set(file.vertex_properties) == {"value", "shift_x", "shift_y", "shift_z"}
    np.testing.assert_array_equal(file.vertex_properties["value"], shape.value)
    shift = [file.vertex_properties[f"shift_{axis}"] for axis in "xyz"]
    np.testing.assert_allclose(np.array(shift).T, shape.points.astype(np.float32), rtol=1e-6, atol=1e-6)
    assert list(file.polygon_properties) == ["part"]
    np.testing.assert_array_equal(file.polygon_properties["part"], shape.part)
    words = file.polygon_labels["word"]
    assert [words.names[code] for code in words.codes] == [WORDS[part] for part in shape.part]

"""Comparison of the arrays of a file of VTK with those of the shape from which VTK wrote it."""

from __future__ import annotations

from typing import Any

import meshio  # type: ignore[import-untyped]
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


def of_meshio(shape: Shape) -> meshio.Mesh:
    """A block per run of polygons of one size, and a line, which is no face."""
    blocks: list[tuple[str, list[Any]]] = []
    for polygon in shape.polygons:
        kind = "triangle" if len(polygon) == 3 else "quad"
        if not blocks or blocks[-1][0] != kind:
            blocks.append((kind, []))
        blocks[-1][1].append(polygon)
    ends = np.cumsum([len(rows) for _, rows in blocks])
    part = [*np.split(shape.part, ends[:-1]), np.array([9])]
    cells = [*((kind, np.array(rows)) for kind, rows in blocks), ("line", np.array([[0, 1]]))]
    return meshio.Mesh(shape.points, cells, point_data={"value": shape.value}, cell_data={"part": part})

"""Files written by VTK itself, in every dialect of its XML and legacy formats."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.helpers.every_format import Shape


def _core() -> Any:
    return pytest.importorskip("vtkmodules.vtkCommonCore", reason="VTK is not installed: `pip install pyvista`")


def data_set(shape: Shape, kind: str, *, single: bool = False, arrays: bool = True) -> Any:
    """The shape as `polydata` or `grid` of VTK, positions in float32 or float64.

    arrays: with `value` and the vector `shift` per point, `part` and the words `word` per cell.
    """
    core = _core()
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkUnstructuredGrid

    points = core.vtkPoints()
    points.SetData(numpy_to_vtk(shape.points.astype(np.float32 if single else np.float64), deep=True))
    ends = np.concatenate(([0], np.cumsum(shape.sizes))).astype(np.int64)
    cells = vtkCellArray()
    deep = [numpy_to_vtkIdTypeArray(array, deep=True) for array in (ends, shape.corners.astype(np.int64))]
    cells.SetData(*deep)
    if kind == "polydata":
        data = vtkPolyData()
        data.SetPolys(cells)
    else:
        data = vtkUnstructuredGrid()
        kinds = np.where(shape.sizes == 3, 5, np.where(shape.sizes == 4, 9, 7)).astype(np.uint8)
        data.SetCells(numpy_to_vtk(kinds, deep=True), cells)
    data.SetPoints(points)
    if arrays:
        _add(data.GetPointData(), {"value": shape.value, "shift": shape.points.astype(np.float32)})
        _add(data.GetCellData(), {"part": shape.part})
        words = core.vtkStringArray()
        words.SetName("word")
        for part in shape.part.tolist():
            words.InsertNextValue(WORDS[part])
        data.GetCellData().AddArray(words)
    return data


WORDS = ("inner ring", "Zürich", "3")


def _add(target: Any, arrays: Mapping[str, Any]) -> None:
    from vtkmodules.util.numpy_support import numpy_to_vtk

    for name, values in arrays.items():
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        target.AddArray(array)


XML = [
    "Ascii-Little-32-None",
    *(
        f"{mode}-{header}-{compressor}"
        for mode in ("Binary", "Appended", "Raw")
        for header in ("Little-32", "Big-64")
        for compressor in ("None", "ZLib", "LZ4", "LZMA")
    ),
    "Raw-Big-32-None",
    "Raw-Little-64-None",
]
"""Dialects of VTK XML: where the arrays are, byte order, type of headers, compressor."""


def write_xml(data: Any, dialect: str, path: Path) -> Path:
    """Write with VTK's XML writer."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

    mode, order, header, compressor = dialect.split("-")
    writer = vtkXMLPolyDataWriter() if data.GetClassName() == "vtkPolyData" else vtkXMLUnstructuredGridWriter()
    writer.SetInputData(data)
    writer.SetFileName(str(path))
    getattr(writer, f"SetDataModeTo{'Appended' if mode == 'Raw' else mode}")()
    writer.SetEncodeAppendedData(mode != "Raw")
    getattr(writer, f"SetByteOrderTo{order}Endian")()
    getattr(writer, f"SetHeaderTypeToUInt{header}")()
    getattr(writer, f"SetCompressorTypeTo{compressor}")()
    writer.SetBlockSize(1024)  # several blocks per array
    assert writer.Write() == 1
    return path


LEGACY = [f"{mode}-{version}" for mode in ("ASCII", "Binary") for version in (42, 51)]
"""Dialects of the legacy format: text or big-endian bytes, versions 4.2 and 5.1."""


def write_legacy(data: Any, dialect: str, path: Path) -> Path:
    """Write with VTK's legacy writer."""
    from vtkmodules.vtkIOLegacy import vtkPolyDataWriter, vtkUnstructuredGridWriter

    mode, version = dialect.split("-")
    writer = vtkPolyDataWriter() if data.GetClassName() == "vtkPolyData" else vtkUnstructuredGridWriter()
    writer.SetInputData(data)
    writer.SetFileName(str(path))
    getattr(writer, f"SetFileTypeTo{mode}")()
    writer.SetFileVersion(int(version))
    assert writer.Write() == 1
    return path

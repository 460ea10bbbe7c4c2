"""VTK XML writer, .vtp and .vtu: every column as an array, faces as loaded, written by VTK in memory."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any, BinaryIO, Unpack

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError, Notice
from ...mesh.file import Labels
from ...support.words import escape_text
from ..tables.write import Column
from .attributes import MeshAttributes, Polygons
from .names import fitting, respelt, xml_attribute, xml_name
from .ply import meaning

_TRIANGLE, _POLYGON, _QUAD = 5, 7, 9
_COLORS = "RGB"
_MOST = 8192


def write_vtk(
    stream: BinaryIO,
    suffix: str,
    points: NDArray[np.float64],
    faces: NDArray[np.integer[Any]],
    **attributes: Unpack[MeshAttributes],
) -> tuple[Notice, ...]:
    """Write points (V, 3) and faces (F, 3) as `.vtp` (polygons) or `.vtu` (unstructured grid), positions in float64.

    Of the parts everything but triangles. Properties become arrays of points and cells under their names; three that
    end in _x, _y, _z also become a vector array. Labels are codes, -1 for none, with their meaning in the comments
    of the XML, since other readers refuse files with field arrays of text. The colours are the array RGB. A name that
    is invalid in XML or taken is spelt in another way, and the notice of that is returned.
    Errors: InputError for too many properties: VTK's time grows with their square.
    """
    count = len(attributes.get("vertex_properties") or ()) + len(attributes.get("face_properties") or ())
    if count > _MOST:
        raise InputError(
            f"{count:,} properties are too many for {suffix}, at most {_MOST:,} expected",
            hint="write .ply, which has no limit",
        )
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

    data, arrays = _mesh(suffix, faces, attributes.get("polygons"))
    comments = [escape_text(" ".join(comment.split())) for comment in attributes.get("comments", ())]
    at = vtkPoints()
    at.SetData(_array(points, arrays))
    data.SetPoints(at)
    colors, active = attributes.get("vertex_colors"), attributes.get("active")
    own = (_COLORS,) if colors is not None else ()
    spellings: list[dict[str, str]] = []
    for key, target, taken in (
        ("vertex_properties", data.GetPointData(), own),
        ("face_properties", data.GetCellData(), ()),
    ):
        given: Mapping[str, Column] = attributes.get(key) or {}  # type: ignore[assignment]
        spellings.append(fitting(given, xml_name, taken))
        properties = {spellings[-1][name]: column for name, column in given.items()}
        for name, column in properties.items():
            _add(target, name, _values(name, column, comments), arrays)
        for stem in _vectors(properties, taken):
            components = [np.asarray(properties[f"{stem}_{axis}"], np.float64) for axis in "xyz"]
            _add(target, stem, np.stack(components, axis=1), arrays)
    if colors is not None:
        _add(data.GetPointData(), _COLORS, colors, arrays)
    if active is not None:
        data.GetPointData().SetActiveScalars(xml_attribute(spellings[0].get(active, active)))
    writer = vtkXMLPolyDataWriter() if suffix == ".vtp" else vtkXMLUnstructuredGridWriter()
    writer.SetInputData(data)
    writer.SetWriteToOutputString(True)
    # No compression: digits of curvatures hardly shrink, and zlib takes longer than all the rest.
    writer.SetCompressorTypeToNone()
    writer.SetHeaderTypeToUInt64()
    writer.SetDataModeToAppended()
    # As text (base64) if meshio reads the format too, since it mistakes one raw array for another.
    writer.SetEncodeAppendedData(suffix == ".vtu")
    writer.Write()
    output: Any = writer.GetOutputString()  # bytes if the data are
    content = memoryview(output if isinstance(output, bytes) else output.encode("ascii"))
    # After the first line, of the root or above it; offsets in the file count from the data, not from here.
    start = bytes(content[:1000]).index(b"\n") + 1
    stream.write(content[:start])
    stream.write(_comment(comments))
    stream.write(content[start:])
    return respelt(*spellings)


def _mesh(suffix: str, faces: NDArray[np.integer[Any]], polygons: Polygons | None) -> tuple[Any, list[Any]]:
    """Data set of VTK with the faces, and the arrays that must live as long as it."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkUnstructuredGrid

    corners, sizes = polygons if polygons is not None else (faces.reshape(-1), np.full(len(faces), 3))
    offsets = np.zeros(len(sizes) + 1, np.int64)
    np.cumsum(sizes, out=offsets[1:])
    flat = np.ascontiguousarray(corners.reshape(-1), np.int64)
    cells = vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(offsets), numpy_to_vtkIdTypeArray(flat))
    if suffix == ".vtp":
        data = vtkPolyData()
        data.SetPolys(cells)
        return data, [offsets, flat]
    kinds = np.select([sizes == 3, sizes == 4], [_TRIANGLE, _QUAD], _POLYGON).astype(np.uint8)
    grid = vtkUnstructuredGrid()
    grid.SetCells(numpy_to_vtk(kinds), cells)
    return grid, [offsets, flat, kinds]


def _values(name: str, column: Column, comments: list[str]) -> NDArray[Any]:
    """Column as an array of one of VTK's types; the meaning of codes is added to the comments."""
    if isinstance(column, Labels):
        comments.append(meaning(name, column, -1))
        return column.codes.astype(np.int32 if len(column.names) > 127 else np.int8)
    if isinstance(column, np.ma.MaskedArray):
        return np.where(np.ma.getmaskarray(column), np.nan, np.ma.getdata(column)).astype(np.float64)
    if column.dtype == np.bool_:
        return column.view(np.uint8)
    return column


def _vectors(properties: Mapping[str, Column], taken: Collection[str]) -> list[str]:
    """Stems of three float columns that are the components of a vector, if the name is free."""
    stems = [name[:-2] for name in properties if name.endswith("_x")]
    free = [stem for stem in stems if stem and stem not in properties and stem not in taken]
    return [stem for stem in free if all(_is_float(properties.get(f"{stem}_{axis}")) for axis in "xyz")]


def _is_float(column: Column | None) -> bool:
    return isinstance(column, np.ndarray) and column.dtype.kind == "f"


def _array(values: NDArray[Any], arrays: list[Any]) -> Any:
    """VTK array over the memory of a numpy array, which is kept alive."""
    from vtkmodules.util.numpy_support import numpy_to_vtk

    values = np.ascontiguousarray(values.astype(values.dtype.newbyteorder("="), copy=False))
    arrays.append(values)
    return numpy_to_vtk(values)


def _add(target: Any, name: str, values: NDArray[Any], arrays: list[Any]) -> None:
    array = _array(values, arrays)
    array.SetName(xml_attribute(name))  # VTK writes names into the XML as they are
    target.AddArray(array)


def _comment(lines: list[str]) -> bytes:
    """XML comment; two hyphens may not meet in it."""
    text = "\n".join(lines)
    while "--" in text:
        text = text.replace("--", "- -")
    return f"<!--\n{text}\n-->\n".encode(errors="backslashreplace")

"""VTK XML writer, .vtp and .vtu: every column as an array, faces as loaded, arrays appended without compression."""

from __future__ import annotations

import binascii
import json
from collections.abc import Collection, Iterable, Mapping
from typing import Any, BinaryIO, Unpack

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError, Notice
from ...mesh.file import Labels
from ...support.words import escape_text
from ..tables.write import Column
from .attributes import MeshAttributes
from .names import fitting, respelt, xml_attribute, xml_name
from .ply import meaning

_TRIANGLE, _POLYGON, _QUAD = 5, 7, 9
_COLORS = "RGB"
_MOST = 8192
_TYPES = {
    "i1": "Int8",
    "u1": "UInt8",
    "i2": "Int16",
    "u2": "UInt16",
    "i4": "Int32",
    "u4": "UInt32",
    "i8": "Int64",
    "u8": "UInt64",
    "f4": "Float32",
    "f8": "Float64",
}
_PIECE = 3 << 20  # bytes, a multiple of 3, as base64 needs


def write_vtk(
    stream: BinaryIO,
    suffix: str,
    points: NDArray[np.float64],
    faces: NDArray[np.integer[Any]],
    **attributes: Unpack[MeshAttributes],
) -> tuple[Notice, ...]:
    """Write points (V, 3) and faces (F, 3) as `.vtp` (polygons) or `.vtu` (unstructured grid), positions in float64.

    Of the attributes everything but triangles. Properties become arrays of points and cells under their names; three
    that end in _x, _y, _z also become a vector array. Labels are codes, -1 for none, with their words in the comments
    of the XML, since other readers refuse files with arrays of text; our reader takes them from there. The colours are
    the array RGB. A name that is invalid in XML or taken is spelt in another way, and the notice of that is returned.
    Errors: InputError for too many properties: the time of VTK's reader grows with their square.
    """
    count = len(attributes.get("vertex_properties") or ()) + len(attributes.get("face_properties") or ())
    if count > _MOST:
        raise InputError(
            f"{count:,} properties are too many for {suffix}, at most {_MOST:,} expected",
            hint="write .ply, which has no limit",
        )
    comments = [escape_text(" ".join(comment.split())) for comment in attributes.get("comments", ())]
    colors, active = attributes.get("vertex_colors"), attributes.get("active")
    own = (_COLORS,) if colors is not None else ()
    spellings: list[dict[str, str]] = []
    sections: list[_Arrays] = []
    labels: dict[str, Any] = {}
    for key, element, taken in (("vertex_properties", "points", own), ("face_properties", "cells", ())):
        given: Mapping[str, Column] = attributes.get(key) or {}  # type: ignore[assignment]
        spellings.append(fitting(given, xml_name, taken))
        properties = {spellings[-1][name]: column for name, column in given.items()}
        arrays = {name: _values(name, column, comments) for name, column in properties.items()}
        for stem in _vectors(properties, taken):
            arrays[stem] = np.stack([np.asarray(properties[f"{stem}_{axis}"], np.float64) for axis in "xyz"], axis=1)
        names = {name: column.names for name, column in properties.items() if isinstance(column, Labels)}
        labels |= {element: names} if names else {}
        sections.append(arrays)
    if colors is not None:
        sections[0][_COLORS] = colors
    if labels:
        comments.append("labels: " + json.dumps(labels).replace("--", "-\\u002d"))
    _File(stream, base64=suffix == ".vtu").write(
        "PolyData" if suffix == ".vtp" else "UnstructuredGrid",
        points,
        attributes.get("polygons") or (faces.reshape(-1), np.full(len(faces), 3)),
        sections,
        comments,
        None if active is None else spellings[0].get(active, active),
    )
    return respelt(*spellings)


_Arrays = dict[str, NDArray[Any]]


class _File:
    """A file being written: the heads of all arrays, then their bytes.

    base64: encode the bytes as text, since meshio, which reads grids, mistakes one raw array for another.
    """

    def __init__(self, stream: BinaryIO, base64: bool) -> None:
        self.stream, self.base64 = stream, base64
        self.arrays: list[NDArray[Any]] = []
        self.offset = 0

    def write(
        self,
        kind: str,
        points: NDArray[np.float64],
        polygons: tuple[NDArray[Any], NDArray[Any]],
        sections: list[_Arrays],
        comments: list[str],
        active: str | None,
    ) -> None:
        """Write everything."""
        corners, sizes = polygons
        cells = {"connectivity": corners.astype(np.int64, copy=False), "offsets": np.cumsum(sizes, dtype=np.int64)}
        if kind == "PolyData":
            counts, name = f'NumberOfPolys="{len(sizes)}"', "Polys"
        else:
            counts, name = f'NumberOfCells="{len(sizes)}"', "Cells"
            cells["types"] = np.select([sizes == 3, sizes == 4], [_TRIANGLE, _QUAD], _POLYGON).astype(np.uint8)
        scalars = "" if active is None else f' Scalars="{xml_attribute(active)}"'
        lines = [
            f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64">',
            _comment(comments),
            f"  <{kind}>",
            f'    <Piece NumberOfPoints="{len(points)}" {counts}>',
            *self._section(f"PointData{scalars}", sections[0]),
            *self._section("CellData", sections[1]),
            *self._section("Points", {"Points": points}),
            *self._section(name, cells),
            "    </Piece>",
            f"  </{kind}>",
            f'  <AppendedData encoding="{"base64" if self.base64 else "raw"}">',
            "   _",
        ]
        self.stream.write("\n".join(lines).encode("utf-8", "backslashreplace"))
        for array in self.arrays:
            self._append(array)
        self.stream.write(b"\n  </AppendedData>\n</VTKFile>\n")

    def _section(self, head: str, arrays: _Arrays) -> Iterable[str]:
        yield f"      <{head}>"
        for name, values in arrays.items():
            array = np.ascontiguousarray(values.astype(values.dtype.newbyteorder("<"), copy=False))
            width = f' NumberOfComponents="{array.shape[1]}"' if array.ndim > 1 else ""
            kind = f'type="{_TYPES[array.dtype.str[1:]]}" Name="{xml_attribute(name)}"{width}'
            yield f'        <DataArray {kind} format="appended" offset="{self.offset}"/>'
            self.arrays.append(array)
            size = 8 + array.nbytes
            self.offset += 4 * -(-size // 3) if self.base64 else size
        yield f"      </{head.partition(' ')[0]}>"

    def _append(self, array: NDArray[Any]) -> None:
        size = array.nbytes.to_bytes(8, "little")
        data = array.reshape(-1).view(np.uint8).data if array.size else memoryview(b"")
        if not self.base64:
            self.stream.write(size)
            self.stream.write(data)
            return
        # The first byte of the data completes the nine bytes of three groups.
        self.stream.write(binascii.b2a_base64(size + data[:1], newline=False))
        for begin in range(1, len(data), _PIECE):
            self.stream.write(binascii.b2a_base64(data[begin : begin + _PIECE], newline=False))


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


def _comment(lines: list[str]) -> str:
    """XML comment; two hyphens may not meet in it."""
    return "\n".join(["<!--", *(line.replace("--", "- -").replace("--", "- -") for line in lines), "-->"])

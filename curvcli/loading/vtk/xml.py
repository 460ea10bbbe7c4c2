"""VTK XML files of polygonal data (.vtp) and unstructured grids (.vtu)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...mesh.file import MeshFile
from ..content import free_inflation
from ..pieces import Pieces
from ..registry import ParserOptions
from .attributes import Attribute
from .cells import NONE, CellLists, of_lists, of_types
from .dataset import DataSet, VtkPiece, mesh_file
from .decode import Decoder, inflater
from .document import Document, XmlElement, parse_document
from .meanings import Meanings

_KINDS = {"vtp": "PolyData", "vtu": "UnstructuredGrid"}
_LISTS = ("Verts", "Lines", "Polys", "Strips")
_BEHIND_UNDERSCORE = re.compile(rb"\s*_")


def parse_xml(pieces: Pieces, options: ParserOptions, format: str) -> MeshFile:
    """Parse a VTK XML file.

    Pieces are put one after the other. Appended and inline arrays, text, base64 and raw bytes, compressed or not, in
    either byte order.
    Errors: InputError with the array and the piece.
    """
    data = pieces.rest()
    document = parse_document(data)
    root = document.root
    if root.name != "VTKFile":
        raise InputError(f"root element `{root.name[:40]}` found, VTKFile expected")
    kind = root.attributes.get("type", "")
    if kind != _KINDS[format]:
        raise InputError(f"type `{kind[:40]}` found, {_KINDS[format]} expected", hint=_way_out(kind))
    decoder = _decoder(data, document, options)
    body = next(root.all(kind), None)
    if body is None:
        raise InputError(f"no element {kind} found", hint="the file was cut off")
    given = list(body.all("Piece"))
    read = [_piece(piece, k if len(given) > 1 else None, decoder, format) for k, piece in enumerate(given)]
    read = [piece for piece in read if len(piece.points) or piece.faces.cells] or read[:1]
    if not read:
        raise InputError("no faces: no element Piece found")
    meanings = Meanings.of_comments(document.comments)
    meanings.unit = _unit([*root.all("FieldData"), *body.all("FieldData")], decoder) or meanings.unit
    return mesh_file(DataSet(read, meanings), format, options)


def _way_out(kind: str) -> str:
    if kind.startswith("P") and kind != "PolyData":
        return "it names other files, which are never opened: give those files"
    return """`python -c "import pyvista; pyvista.read('IN').extract_surface().save('OUT.vtp')"` extracts a surface"""


def _unit(fields: list[XmlElement], decoder: Decoder) -> str | None:
    """The only text of a field `unit` or `units`."""
    for array in (array for element in fields for array in element.arrays()):
        kind, name, count = (array.attributes.get(key, "") for key in ("type", "Name", "NumberOfTuples"))
        if kind == "String" and name.lower() in ("unit", "units") and count in ("", "1"):
            return decoder.words(array, 1)[0].strip() or None
    return None


def _decoder(data: bytes, document: Document, options: ParserOptions) -> Decoder:
    attributes = document.root.attributes
    orders = {"LittleEndian": "<", "BigEndian": ">"}
    order = attributes.get("byte_order", "LittleEndian")
    header = attributes.get("header_type", "UInt32")
    if order not in orders:
        raise InputError(f"byte order `{order[:40]}` found, {' or '.join(orders)} expected")
    if header not in ("UInt32", "UInt64"):
        raise InputError(f"header type `{header[:40]}` found, UInt32 or UInt64 expected")
    appended, encoding = -1, "base64"
    if document.data is not None:
        encoding = document.data.attributes.get("encoding", "base64")
        begin = _BEHIND_UNDERSCORE.match(data, document.appended)
        if encoding not in ("raw", "base64") or begin is None:
            raise InputError("appended data without `_` or encoding raw or base64", place=f"byte {document.appended}")
        appended = begin.end()
    compressor = attributes.get("compressor", "")
    return Decoder(
        data,
        orders[order],
        np.dtype(f"{orders[order]}u{int(header[4:]) // 8}"),
        inflater(compressor) if compressor else None,
        appended,
        encoding == "base64",
        free_inflation(len(data)) if options.max_bytes is None else options.max_bytes,
    )


def _piece(piece: XmlElement, number: int | None, decoder: Decoder, format: str) -> VtkPiece:
    place = "" if number is None else f"piece {number}: "
    try:
        points = _count(piece, "NumberOfPoints")
        xyz = _points(piece, points, decoder)
        if format == "vtp":
            lists = [_cells(piece, name, _count(piece, f"NumberOf{name}"), decoder) for name in _LISTS]
            faces = of_lists(lists, points)
        else:
            cells = _cells(piece, "Cells", _count(piece, "NumberOfCells"), decoder)
            kinds = _array(piece, "Cells", "types", cells.count, decoder) if cells.count else np.empty(0, np.uint8)
            faces = of_types(cells, kinds, points)
        return VtkPiece(
            xyz,
            faces,
            list(_attributes(piece, "PointData", points, decoder)),
            list(_attributes(piece, "CellData", faces.cells, decoder)),
        )
    except InputError as error:
        error.place = f"{place}{error.place or ''}" or None
        raise


def _count(piece: XmlElement, name: str) -> int:
    text = piece.attributes.get(name, "0").strip()
    if not (text.isascii() and text.isdigit() and len(text) < 19):
        raise InputError(f"{name} `{text[:40]}` found, a whole number expected")
    return int(text)


def _points(piece: XmlElement, count: int, decoder: Decoder) -> NDArray[Any]:
    arrays = [array for points in piece.all("Points") for array in points.arrays()]
    if len(arrays) != 1:
        if not count:
            return np.empty((0, 3))
        raise InputError(f"{len(arrays)} arrays of points found, one expected")
    if arrays[0].attributes.get("NumberOfComponents", "1") != "3":
        raise InputError("points without three components found")
    return decoder.numbers(arrays[0], 3 * count, kept=False).reshape(-1, 3)


def _array(piece: XmlElement, section: str, name: str, count: int, decoder: Decoder) -> NDArray[Any]:
    """The array of integers of this name."""
    for element in piece.all(section):
        for array in element.arrays():
            if array.attributes.get("Name") == name:
                values = decoder.numbers(array, count, kept=array.attributes.get("type") == "Int32")
                if values.dtype.kind == "f":
                    raise InputError(f"array `{name}` of {section} holds fractions, integers expected")
                return values
    raise InputError(f"no array `{name}` of {section} found", hint="the file was cut off")


def _cells(piece: XmlElement, section: str, count: int, decoder: Decoder) -> CellLists:
    if not count:
        return NONE
    ends = _array(piece, section, "offsets", count, decoder)
    corners = int(ends[-1])
    if corners < 0:
        raise InputError(f"offset {corners} found, a positive number expected", place=section)
    return CellLists.of_ends(_array(piece, section, "connectivity", corners, decoder), ends, section)


def _attributes(piece: XmlElement, section: str, count: int, decoder: Decoder) -> Iterator[Attribute]:
    names = set()
    for element in piece.all(section):
        roles = {element.attributes.get("Normals"): "normals", element.attributes.get("TCoords"): "texture"}
        for place, array in enumerate(element.arrays()):
            name = array.attributes.get("Name") or f"{section}_{place}"
            if name in names:
                raise InputError(f"array `{name[:80]}` of {section} found twice, one expected")
            names.add(name)
            if array.attributes.get("type") == "String":
                yield Attribute(name, decoder.words(array, count))
                continue
            width = _width(array)
            values = decoder.numbers(array, count * width)
            components = tuple(array.attributes.get(f"ComponentName{k}", "") for k in range(width)) if width > 1 else ()
            yield Attribute(name, values.reshape(-1, width) if width > 1 else values, roles.get(name, ""), components)


def _width(array: XmlElement) -> int:
    text = array.attributes.get("NumberOfComponents", "1").strip()
    if not (text.isascii() and text.isdigit() and 0 < len(text) < 5 and int(text)):
        raise InputError(f"NumberOfComponents `{text[:40]}` found, a number from 1 expected")
    return int(text)

"""Legacy VTK files: polygonal data and unstructured grids, versions 1 to 5.1, text and binary."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError, Notice
from ...mesh.file import MeshFile
from ...support.words import escape_text
from ..pieces import Pieces
from ..registry import ParserOptions
from .attributes import Attribute
from .cells import NONE, STRAIGHT, CellLists, of_lists, of_types
from .cursor import Cursor
from .dataset import DataSet, VtkPiece, mesh_file
from .fields import read_attributes
from .meanings import Meanings

HEAD = re.compile(rb"#\s*vtk\s+DataFile\s+Version\s+(\d+)\.(\d+)[^\r\n]*(?:\r\n|\n|\r)", re.IGNORECASE)
_TITLE = re.compile(rb"[^\r\n]*(?:\r\n|\n|\r)")
_LISTS = ("VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS")
_SECTIONS = "POINTS, cells, POINT_DATA or CELL_DATA"


def parse_legacy(pieces: Pieces, options: ParserOptions) -> MeshFile:
    """Parse a legacy VTK file.

    Errors: InputError with the line, or the byte of a binary file.
    """
    data = pieces.rest()
    head = HEAD.match(data)
    title = _TITLE.match(data, head.end()) if head else None
    if head is None or title is None:
        raise InputError("no first line `# vtk DataFile Version` and title found", place="line 1")
    form = Cursor(data, title.end(), text=True)
    tokens = form.line()
    if not tokens or (mode := tokens[0].upper()) not in ("ASCII", "BINARY"):
        raise InputError(f"`{' '.join(tokens)[:40]}` found, ASCII or BINARY expected", place="line 3")
    cursor = Cursor(data, form.at, text=mode == "ASCII")
    tokens = cursor.line()
    fields: list[Attribute] = []
    while tokens and tokens[0].upper() == "FIELD":
        fields += read_attributes(cursor, tokens, None)
        tokens = cursor.line()
    kind = tokens[1].upper() if len(tokens) > 1 and tokens[0].upper() == "DATASET" else ""
    if kind not in ("POLYDATA", "UNSTRUCTURED_GRID"):
        raise InputError(
            f"`{' '.join(tokens)[:40]}` found, DATASET POLYDATA or UNSTRUCTURED_GRID expected",
            place=cursor.place,
            hint=STRAIGHT,
        )
    return _Legacy(cursor, kind, with_offsets=int(head[1]) >= 5, fields=fields).mesh_file(options)


class _Legacy:
    """Sections read so far."""

    def __init__(self, cursor: Cursor, kind: str, with_offsets: bool, fields: list[Attribute]) -> None:
        self.cursor, self.kind, self.with_offsets, self.fields = cursor, kind, with_offsets, fields
        self.points: NDArray[Any] | None = None
        self.lists: dict[str, CellLists] = {}
        self.types: NDArray[Any] | None = None
        self.arrays: dict[str, list[Attribute]] = {"POINT_DATA": [], "CELL_DATA": []}
        self.counts: dict[str, int] = {}
        self.notices: list[Notice] = []

    def mesh_file(self, options: ParserOptions) -> MeshFile:
        """Read all sections."""
        section = ""
        while tokens := self.cursor.line():
            keyword = tokens[0].upper()
            if keyword in self.arrays:
                section = keyword
                self.counts[section] = _number(tokens, 1, self.cursor)
            elif keyword == "METADATA":
                self.cursor.skip_paragraph()
            elif section or keyword == "FIELD":
                count = self.counts.get(section)
                kept = read_attributes(self.cursor, tokens, count)
                (self.arrays[section] if section else self.fields).extend(kept)
            else:
                self._geometry(keyword, tokens)
        if self.points is None:
            raise InputError("no POINTS found", place=self.cursor.place)
        points = len(self.points)
        if self.kind == "POLYDATA":
            faces = of_lists([self.lists.get(name, NONE) for name in _LISTS], points)
        else:
            cells = self.lists.get("CELLS", NONE)
            types = self.types if self.types is not None else np.empty(0, np.int32)
            if len(types) != cells.count:
                raise InputError(f"{cells.count} cells and {len(types)} types of cells found", place="CELL_TYPES")
            faces = of_types(cells, types, points)
        for section, expected in (("POINT_DATA", points), ("CELL_DATA", faces.cells)):
            if self.counts.get(section, expected) != expected:
                raise InputError(f"{self.counts[section]} announced, {expected} expected", place=section)
        piece = VtkPiece(self.points, faces, _distinct(self.arrays["POINT_DATA"]), _distinct(self.arrays["CELL_DATA"]))
        return mesh_file(DataSet([piece], Meanings(unit=_unit(self.fields)), self.notices), "vtk", options)

    def _geometry(self, keyword: str, tokens: list[str]) -> None:
        cursor = self.cursor
        if keyword == "POINTS":
            if self.points is not None:
                raise InputError("a second POINTS found, one expected", place=cursor.place)
            if len(tokens) < 3:
                raise InputError("POINTS without a number and a type found", place=cursor.place)
            self.points = cursor.numbers(tokens[2], 3 * _number(tokens, 1, cursor), kept=False).reshape(-1, 3)
        elif keyword == "CELL_TYPES":
            self.types = cursor.numbers("int", _number(tokens, 1, cursor))
        elif keyword in (_LISTS if self.kind == "POLYDATA" else ("CELLS",)):
            if keyword in self.lists:
                raise InputError(f"a second {keyword} found, one expected", place=cursor.place)
            first, second = _number(tokens, 1, cursor), _number(tokens, 2, cursor)
            read = self._by_offsets if self.with_offsets else self._by_lengths
            self.lists[keyword] = read(first, second, keyword)
        else:
            raise InputError(f"`{escape_text(keyword)[:40]}` found, {_SECTIONS} expected", place=cursor.place)

    def _by_offsets(self, offsets: int, corners: int, keyword: str) -> CellLists:
        """Cells of version 5: their offsets, one more than cells, then all corners."""
        if not offsets:
            return NONE
        ends = self._array("OFFSETS", offsets)
        if int(ends[0]) != 0:
            raise InputError(f"first offset {int(ends[0])} found, 0 expected", place=keyword)
        return CellLists.of_ends(self._array("CONNECTIVITY", corners), ends[1:], keyword)

    def _array(self, name: str, count: int) -> NDArray[Any]:
        tokens = self.cursor.line()
        if len(tokens) < 2 or tokens[0].upper() != name:
            line = " ".join(tokens)[:40]
            raise InputError(f"`{escape_text(line)}` found, {name} and a type expected", place=self.cursor.place)
        values = self.cursor.numbers(tokens[1], count, kept=False)
        if values.dtype.kind == "f":
            raise InputError(
                f"{name} of type {tokens[1][:40]} found, an integer type expected", place=self.cursor.place
            )
        return values

    def _by_lengths(self, cells: int, size: int, keyword: str) -> CellLists:
        """Cells of versions up to 4: the number of corners of each, then its corners."""
        return CellLists.of_lengths(self.cursor.numbers("int", size, kept=False), keyword, cells)


def _number(tokens: list[str], place: int, cursor: Cursor) -> int:
    if len(tokens) <= place or not (tokens[place].isascii() and tokens[place].isdigit() and len(tokens[place]) < 19):
        line = escape_text(" ".join(tokens)[:60])
        raise InputError(f"`{line}` found, whole numbers expected behind the keyword", place=cursor.place)
    return int(tokens[place])


def _distinct(attributes: list[Attribute]) -> list[Attribute]:
    """The attributes, the last of each name, as VTK takes them."""
    return list({attribute.name: attribute for attribute in attributes}.values())


def _unit(fields: list[Attribute]) -> str | None:
    """The only text of a field `unit` or `units` of the whole file."""
    for field in fields:
        if field.name.lower() in ("unit", "units") and not field.layout and len(field.values) == 1:
            return (field.values[0] or "").strip() or None
    return None

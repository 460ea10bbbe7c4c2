"""FreeSurfer's files beside a surface: annotations (.annot), labels (.label) and values of vertices (curv)."""

from __future__ import annotations

import re
import struct

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...mesh.file import Labels
from ...support.words import escape_text, number_of
from ..text import decode, drop_empty_lines, plain_lines, read_tokens, tidy
from .base import LabelFile

NEW_VALUES = b"\xff\xff\xff"
LABEL_SIGN = re.compile(rb"#!ascii *label")
_ENTRY = 5


class _BigEndian:
    """Big-endian integers and texts, read one after the other. Errors: InputError at the end of the data."""

    def __init__(self, data: bytes) -> None:
        self.data, self.place = data, 0

    def take(self, count: int) -> NDArray[np.int32]:
        return np.frombuffer(self._bytes(4 * count), ">i4").astype(np.int32)

    def one(self) -> int:
        return int(self.take(1)[0])

    def text(self) -> str:
        return escape_text(decode(self._bytes(self.one()).rstrip(b"\0")))

    def _bytes(self, count: int) -> bytes:
        if count < 0 or count > len(self.data) - self.place:
            problem = f"{number_of(count, 'byte')} expected, {len(self.data) - self.place} found"
            raise InputError(problem, place=f"byte {self.place}", hint="the file is cut off, or is no annotation")
        self.place += count
        return self.data[self.place - count : self.place]


def read_annotation(data: bytes) -> LabelFile:
    """Read a colour per vertex, and the table that gives each colour its name (old and new form).

    A colour that is not in the table, and 0, is no label. Without a table the colour is the name, in hexadecimal.
    Errors: InputError for data that end early, and for a table of another form.
    """
    file = _BigEndian(data)
    pairs = file.take(2 * max(file.one(), 0)).reshape(-1, 2)
    pairs = pairs[np.argsort(pairs[:, 0], kind="stable")]
    wrong = np.flatnonzero(pairs[:, 0] != np.arange(len(pairs)))
    if len(wrong):
        raise InputError(f"no label of vertex {wrong[0]}, or two, found; one for each of {len(pairs)} expected")
    color = pairs[:, 1]
    entries = _table(file) if file.place < len(data) and file.one() else {}
    if not entries:
        entries = {
            int(value): f"#{value & 255:02x}{value >> 8 & 255:02x}{value >> 16 & 255:02x}" for value in np.unique(color)
        }
        entries.pop(0, None)
    known = np.array(list(entries), np.int64)
    order = np.argsort(known)
    place = np.searchsorted(known, color, sorter=order) if len(known) else np.zeros(len(color), np.int64)
    codes = np.full(len(color), -1, np.int32)
    if len(known):
        candidate = order[np.minimum(place, len(known) - 1)]
        inside = (known[candidate] == color) & (color != 0)
        codes[inside] = candidate[inside]
    colors = np.stack([known & 255, known >> 8 & 255, known >> 16 & 255], axis=1).astype(np.uint8)
    return LabelFile(Labels(codes, tuple(entries.values()), colors), "vertex")


def _table(file: _BigEndian) -> dict[int, str]:
    """Names by colour (red + 256 green + 65536 blue), in the order of the table; the first of two with one colour."""
    count = file.one()
    new = count < 0
    if new:
        if count != -2:
            raise InputError(f"a colour table of version {-count} found, 2 expected", place=f"byte {file.place - 4}")
        file.one()
    file.text()
    entries: dict[int, str] = {}
    for _ in range(file.one() if new else count):
        if new:
            file.one()
        name = file.text()
        red, green, blue, _transparency = (int(part) for part in file.take(_ENTRY - 1))
        entries.setdefault(
            red + 256 * green + 65536 * blue, name or f"#{red & 255:02x}{green & 255:02x}{blue & 255:02x}"
        )
    return entries


def read_label(data: bytes, name: str) -> LabelFile:
    """Read the vertices of one region: a comment, their number, then rows `vertex x y z value`. name: of the region.

    Errors: InputError with the line of a wrong number, or for missing rows.
    """
    body, line = drop_empty_lines(tidy(plain_lines(data)))
    rows = body.split(b"\n")[:-1]
    begin = 1 if rows and rows[0].startswith(b"#") else 0
    count = rows[begin] if begin < len(rows) else b""
    if not count.isdigit() or len(rows) - begin - 1 < int(count[:12]):
        problem = (
            f"`{escape_text(decode(count))[:40]}` found, a number of rows not above {max(len(rows) - begin - 1, 0)}"
        )
        raise InputError(f"{problem} expected", place=f"line {begin + 1}")
    rows = rows[begin + 1 : begin + 1 + int(count)]
    if len({row.count(b" ") for row in rows}) > 1:
        short = min(range(len(rows)), key=lambda k: rows[k].count(b" "))
        raise InputError("a row with fewer words than others", place=f"line {line[begin + 1 + short] + 1}")
    firsts = [row.partition(b" ")[0] for row in rows]
    numbers, known = read_tokens(b"\n".join([*firsts, b""]), np.int32) if rows else (np.empty(0, np.int32), np.ones(0))
    wrong = np.flatnonzero(~known.astype(np.bool_))
    if len(wrong):
        word = escape_text(decode(firsts[wrong[0]]))[:40]
        raise InputError(f"`{word}` found, a vertex expected", place=f"line {line[begin + 1 + wrong[0]] + 1}")
    return LabelFile(Labels(np.zeros(len(rows), np.int32), (name,)), "vertex", numbers.astype(np.int64))


def read_values(data: bytes) -> LabelFile:
    """Read a value per vertex, such as lh.thickness: floats, or hundredths as int16 in old files.

    Errors: InputError for data of another size than they announce.
    """
    if data.startswith(NEW_VALUES):
        if len(data) < 15:
            raise InputError(f"{number_of(len(data), 'byte')} found, at least 15 expected")
        vertices, _, each = struct.unpack(">3i", data[3:15])
        begin, kind = 15, ">f4"
        if each != 1:
            raise InputError(f"{each} values per vertex found, one expected", place="byte 11")
    else:
        vertices, begin, kind, each = int.from_bytes(data[:3], "big"), 6, ">i2", 1
    size = int(kind[2:])
    if vertices < 0 or len(data) != begin + vertices * size:
        announced = f"{number_of(vertices, 'value')} announced, room for {max(len(data) - begin, 0) // size} found"
        raise InputError(announced, hint="it is no file of values of FreeSurfer, or is cut off")
    values = np.frombuffer(data, kind, vertices, begin).astype(np.float64)
    return LabelFile(values / 100 if size == 2 else values, "vertex")

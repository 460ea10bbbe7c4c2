"""Reader of legacy VTK files: lines of keywords, and numbers as text or as big-endian bytes between them."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...support.words import number_of
from ..text import BLANK, NEWLINE, decode
from .decode import numbers_of_text

TYPES = {
    "unsigned_char": "u1",
    "char": "i1",
    "signed_char": "i1",
    "unsigned_short": "u2",
    "short": "i2",
    "unsigned_int": "u4",
    "int": "i4",
    "unsigned_long": "u8",
    "long": "i8",
    "unsigned_long_long": "u8",
    "long_long": "i8",
    "float": "f4",
    "double": "f8",
    "vtkidtype": "i4",
    "vtktypeint8": "i1",
    "vtktypeuint8": "u1",
    "vtktypeint16": "i2",
    "vtktypeuint16": "u2",
    "vtktypeint32": "i4",
    "vtktypeuint32": "u4",
    "vtktypeint64": "i8",
    "vtktypeuint64": "u8",
    "vtktypefloat32": "f4",
    "vtktypefloat64": "f8",
}
_BLOCK = 1 << 22
_LINE = re.compile(rb"[ \t\r\n\0]*([^\r\n]*)(?:\r\n|\n|\r|$)")
_WORD = re.compile(rb"[ \t\r\n]*([^ \t\r\n]+)")
_PARAGRAPH = re.compile(rb"\n[ \t\r]*\n")
_CUT = "the file was cut off"


class Cursor:
    """A position in the data. text: numbers are text."""

    def __init__(self, data: bytes, at: int, text: bool) -> None:
        self.data, self.at, self.text = data, at, text

    @property
    def place(self) -> str:
        """The position for messages."""
        return self._place(self.at)

    def _place(self, at: int) -> str:
        return f"line {self.data.count(NEWLINE, 0, at) + 1}" if self.text else f"byte {at}"

    def line(self) -> list[str]:
        """The words of the next line that is not empty; none at the end."""
        while self.at < len(self.data):
            match = _LINE.match(self.data, self.at)
            assert match is not None
            if tokens := match[1].split():
                self.at = match.end()
                return [decode(token) for token in tokens]
            if match.end() == self.at:
                break
            self.at = match.end()
        return []

    def peek(self) -> str:
        """The next word in capitals."""
        match = _WORD.match(self.data, self.at)
        return decode(match[1][:40]).upper() if match else ""

    def skip_paragraph(self) -> None:
        """Skip lines until an empty one, as metadata end."""
        match = _PARAGRAPH.search(self.data, self.at)
        self.at = match.end() if match else len(self.data)

    def numbers(self, kind: str, count: int, *, kept: bool = True) -> NDArray[Any]:
        """The next numbers. kept: in memory of their own, not that of the file.

        Errors: InputError for an unknown type, or fewer of them.
        """
        name = kind.lower()
        if name == "bit":
            if self.text:
                return self._tokens(np.dtype("u1"), count)
            return np.unpackbits(np.frombuffer(self._take(-(-count // 8)), np.uint8), count=count)
        if name not in TYPES:
            raise InputError(f"type `{kind[:40]}` found, a number type of VTK expected", place=self.place)
        dtype = np.dtype(TYPES[name])
        if self.text:
            return self._tokens(np.dtype("i8") if name == "vtkidtype" else dtype, count)
        values = np.frombuffer(self._take(count * dtype.itemsize), dtype.newbyteorder(">"))
        return values.astype(dtype) if kept else values

    def words(self, count: int) -> list[str]:
        """The next texts: one per line, percent-encoded, or with their lengths before them."""
        from urllib.parse import unquote

        if count > len(self.data) - self.at:
            raise self._short(count, "text")
        if not self.text:
            return [decode(bytes(self._take(self._length()))) for _ in range(count)]
        texts = []
        for _ in range(count):
            end = self.data.find(b"\n", self.at)
            end = len(self.data) if end < 0 else end
            texts.append(unquote(decode(self.data[self.at : end]).strip()))
            self.at = min(end + 1, len(self.data))
        return texts

    def _length(self) -> int:
        """The length of a text: the two highest bits of its first byte tell the number of bytes of the length."""
        first = self._take(1)[0]
        size = {3: 1, 2: 2, 1: 4, 0: 8}[first >> 6]
        rest = self._take(size - 1)
        return int.from_bytes(bytes([first & 63]) + bytes(rest), "big")

    def _take(self, count: int) -> memoryview:
        if count > len(self.data) - self.at:
            raise self._short(count, "byte")
        self.at += count
        return memoryview(self.data)[self.at - count : self.at]

    def _short(self, count: int, what: str) -> InputError:
        left = len(self.data) - self.at
        return InputError(
            f"{number_of(count, what)} announced, {number_of(left, 'byte')} left", place=self.place, hint=_CUT
        )

    def _tokens(self, dtype: np.dtype[Any], count: int) -> NDArray[Any]:
        if 2 * count - 1 > len(self.data) - self.at:
            raise self._short(count, "number")
        begin = self.at
        self.at = self._end_of_tokens(count)
        try:
            return numbers_of_text(self.data[begin : self.at], dtype, count)
        except InputError as error:
            error.place = self._place(begin)
            raise

    def _end_of_tokens(self, count: int) -> int:
        """Position behind the next `count` tokens, or the end of the data."""
        if not count:
            return self.at
        before = True  # white space
        begin, size = self.at, 16 * count + 64
        while begin < len(self.data):
            size = min(size, _BLOCK, len(self.data) - begin)
            blank = np.frombuffer(self.data, np.uint8, size, begin) <= BLANK
            starts = ~blank
            starts[1:] &= blank[:-1]
            starts[0] &= before
            inside = int(np.count_nonzero(starts))
            if inside >= count:
                last = int(np.flatnonzero(starts)[count - 1])
                match = _WORD.match(self.data, begin + last)
                assert match is not None
                return match.end()
            count -= inside
            before = bool(blank[-1])
            begin, size = begin + size, 2 * size
        return len(self.data)

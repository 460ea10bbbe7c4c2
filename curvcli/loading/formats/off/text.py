"""The rows of vertices and faces of an OFF text: one line each, or numbers that run on over lines."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError
from ....support.words import number_of, pluralize
from ...text import NEWLINE, Untidy, drop_empty_lines, read_columns, read_tokens, separates, tidy
from .content import Content
from .keyword import Keyword

_BLANK = re.compile(rb"\s*")
_WIDEST = 64
_AHEAD = 1 << 16
_BLOCK = 1 << 23


def read_text(text: bytes, begin: int, keyword: Keyword, vertices: int, faces: int) -> Content:
    """Read the rows that begin at a place of a text.

    Errors: InputError with the line of a malformed row.
    """
    blank = _BLANK.match(text, begin)
    assert blank is not None
    before = text.count(b"\n", 0, blank.end())
    body = text[blank.end() :]
    head = body[:_AHEAD]
    if b" \n" in head or b"  " in head:  # five times faster than tidying
        body = body.replace(b" \n", b"\n").replace(b"  ", b" ")
    try:
        return _Reader(body, before, None, keyword).read(vertices, faces)
    except Untidy:
        body, numbers = drop_empty_lines(tidy(body))
        return _Reader(body, before, numbers, keyword).read(vertices, faces)


def _behind_lines(text: bytes, count: int, begin: int = 0) -> int | None:
    """The place behind so many lines; None for fewer lines."""
    letters = np.frombuffer(text, np.uint8)
    for at in range(begin, len(text), _BLOCK) if count else ():
        ends = letters[at : at + _BLOCK] == NEWLINE
        inside = int(np.count_nonzero(ends))
        if count <= inside:
            return at + int(np.flatnonzero(ends)[count - 1]) + 1
        count -= inside
    return None if count else begin


@dataclass(frozen=True)
class _Reader:
    """Lines of a body. before: number of lines before it. numbers: former number of each line, if it was tidied."""

    body: bytes
    before: int
    numbers: NDArray[np.int64] | None
    keyword: Keyword

    def place(self, line: int) -> str:
        return f"line {self.before + 1 + int(line if self.numbers is None else self.numbers[line])}"

    def read(self, vertices: int, faces: int) -> Content:
        middle = _behind_lines(self.body, vertices)
        end = None if middle is None else _behind_lines(self.body, faces, middle)
        if end is None:
            if self.numbers is None:
                raise Untidy
            return self._run_on(vertices, faces)
        columns = self._vertices(self.body[:middle], vertices)
        rows = self.body[middle:end]
        rest = self.body[end:].strip()
        left = sum(1 for line in rest.split(b"\n") if line.strip()) if rest else 0
        trailing = (left, pluralize(left, "[line|lines] after the announced faces, ignored"))
        even = self._even(rows, faces) if faces else (0, np.empty(0, np.int32), 0, np.empty(0))
        sizes, corners, extra, colours = even or self._uneven(rows, vertices)
        return Content(columns, sizes, corners, extra, colours, lambda row: self.place(vertices + row), trailing)

    def _vertices(self, rows: bytes, count: int) -> list[NDArray[Any]]:
        if not count:
            return [np.empty(0)] * 3
        width = len(rows[: rows.index(b"\n")].split())
        columns = read_columns(rows, width, np.float64) if 3 <= width <= _WIDEST else None
        if columns is None:
            numbers, ends = self._numbers(rows, 0)
            widths = np.diff(ends, prepend=0)
            wrong = np.flatnonzero(widths != width)
            row = int(wrong[0]) if len(wrong) else 0
            if len(wrong) or not 3 <= width <= _WIDEST:
                expected = f"{width} as before" if len(wrong) and width >= 3 else "3 or more"
                problem = f"vertex of {number_of(int(widths[row]), 'number')} found, {expected} expected"
                raise InputError(problem, place=self.place(row))
            columns = list(np.ascontiguousarray(numbers.reshape(count, width).T))
        if self.keyword.columns(width) is None:
            problem = f"vertex of {number_of(width, 'number')} found, {self.keyword.most} expected"
            raise InputError(problem, place=self.place(0), hint=f"`{self.keyword.word}` announces them")
        return columns

    def _even(self, rows: bytes, count: int) -> tuple[int, NDArray[Any], int, NDArray[Any]] | None:
        """Faces with as many corners and numbers of colour as the first; None if any differs."""
        tokens = rows[: rows.index(b"\n")].split()
        if not tokens or not tokens[0].isdigit() or not int(tokens[0]) < len(tokens) <= _WIDEST:
            return None
        size, extra = int(tokens[0]), len(tokens) - 1 - int(tokens[0])
        columns = read_columns(rows, len(tokens), np.float64 if extra else np.int32)
        if columns is None or not (columns[0] == size).all():
            return None
        corners = np.empty((count, size), np.float64 if extra else np.int32)
        for k in range(size):
            corners[:, k] = columns[1 + k]
        colours = np.stack(columns[1 + size :], axis=1).reshape(-1) if extra else np.empty(0)
        return size, corners.reshape(-1), extra, colours

    def _uneven(self, rows: bytes, first: int) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any], NDArray[Any]]:
        """Faces of any size."""
        numbers, ends = self._numbers(rows, first)
        at = np.concatenate(([0], ends[:-1]))
        room = ends - at - 1
        length = np.append(numbers, -1.0)[at]
        wrong = np.flatnonzero(~((length >= 0) & (length % 1 == 0) & (length <= room)))
        if len(wrong):
            row = int(wrong[0])
            problem = f"a face of {length[row]:g} corners found, with {number_of(max(int(room[row]), 0), 'number')}"
            raise InputError(problem, place=self.place(first + row))
        sizes = length.astype(np.int64)
        corner = np.zeros(len(numbers) + 1, np.int8)
        corner[at + 1] += 1
        corner[at + 1 + sizes] -= 1
        is_corner = np.cumsum(corner[:-1], dtype=np.int8).view(np.bool_)
        is_colour = ~is_corner
        is_colour[at] = False
        return sizes, numbers[is_corner], room - sizes, numbers[is_colour]

    def _numbers(self, rows: bytes, first: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """All numbers of some lines, and the number of them up to the end of each line."""
        if self.numbers is None:
            raise Untidy
        numbers, known = read_tokens(rows, np.float64)
        text = np.frombuffer(rows, np.uint8)
        separators = np.flatnonzero(separates(text))
        ends = np.flatnonzero(text[separators] == NEWLINE) + 1
        if not known.all():
            wrong = int(np.flatnonzero(~known)[0])
            begin = int(separators[wrong - 1]) + 1 if wrong else 0
            token = rows[begin : int(separators[wrong])][:40].decode("utf-8", "backslashreplace")
            row = int(np.searchsorted(ends, wrong, side="right"))
            raise InputError(f"`{token}` found, a number expected", place=self.place(first + row))
        return np.asarray(numbers, np.float64), ends

    def _run_on(self, vertices: int, faces: int) -> Content:
        """Numbers without regard to lines; faces have no colours then."""
        if not self.body.strip():
            raise InputError(f"{number_of(vertices, 'vertex', 'vertices')} announced, the data end before them")
        numbers, ends = self._numbers(self.body, 0)
        lines = len(ends)
        problem = f"{number_of(vertices, 'vertex', 'vertices')} and {number_of(faces, 'face')} announced"
        short = InputError(f"{problem}, {number_of(lines, 'line')} of numbers found")
        width = self.keyword.most
        if vertices * width > len(numbers):
            raise short
        columns = list(np.ascontiguousarray(numbers[: vertices * width].reshape(vertices, width).T))
        values = numbers[vertices * width :]
        sizes = np.empty(faces, np.int64)
        corner = np.ones(len(values), np.bool_)
        at, rest = 0, values.tolist()
        for row in range(faces):
            size = rest[at] if at < len(rest) else -1.0
            if not (0 <= size <= len(rest) - at - 1 and size % 1 == 0):
                raise short
            corner[at] = False
            sizes[row] = size
            at += 1 + int(size)
        left = len(rest) - at
        trailing = (left, pluralize(left, "[number|numbers] after the announced faces, ignored"))
        corners = values[:at][corner[:at]]
        return Content(columns, sizes, corners, 0, np.empty(0), lambda row: f"face {row}", trailing)

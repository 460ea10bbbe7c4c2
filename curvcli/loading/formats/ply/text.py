"""The rows of the elements of an ASCII PLY file: one line each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, Notice
from ....support.words import number_of, pluralize
from ...text import (
    NEWLINE,
    Untidy,
    drop_empty_lines,
    line_starts,
    plain_lines,
    read_columns,
    read_tokens,
    separates,
    tidy,
)
from .header import CORNERS, TOO_SMALL, Header, PlyElement, PlyProperty
from .rows import ElementColumns, empty_columns


def read_text_rows(text: bytes, header: Header, notices: list[Notice]) -> dict[str, ElementColumns]:
    """Read the columns of all elements from the text behind the header.

    Errors: InputError with the line of a malformed row.
    """
    for element in header.elements:
        if element.count * max(2 * len(element.properties), 1) - 1 > len(text):
            raise InputError(
                f"{number_of(element.count, 'row')} announced, more than the {len(text)} bytes that follow can hold",
                place=element.name,
            )
    body = plain_lines(text)
    try:
        return _read(body, header, notices, None)
    except Untidy:
        notices.clear()
        body, numbers = drop_empty_lines(tidy(body))
        return _read(body, header, notices, numbers)


@dataclass(frozen=True)
class _TextRows:
    """The lines of one element: their text, the element, and the number (from 0) of its first line."""

    text: bytes
    element: PlyElement
    header_lines: int
    first: int
    numbers: NDArray[np.int64] | None

    def place(self, row: int) -> str:
        line = self.first + row
        return f"line {self.header_lines + 1 + int(line if self.numbers is None else self.numbers[line])}"


def _read(
    body: bytes, header: Header, notices: list[Notice], numbers: NDArray[np.int64] | None
) -> dict[str, ElementColumns]:
    starts = line_starts(np.frombuffer(body, np.uint8))
    line, content = 0, {}
    for element in header.elements:
        if line + element.count > len(starts) - 1:
            if numbers is None:
                raise Untidy
            raise InputError(
                f"{number_of(element.count, 'row')} announced, {len(starts) - 1 - line} found", place=element.name
            )
        rows = _TextRows(body[starts[line] : starts[line + element.count]], element, header.lines, line, numbers)
        if element.count and element.properties:
            content[element.name] = _same_layout(rows) or _any_layout(rows, notices)
            line += element.count
        else:
            content[element.name] = empty_columns(element)
    if rest := body[starts[line] :].strip():
        count = sum(1 for text in rest.split(b"\n") if text.strip())
        message = pluralize(count, "[line|lines] after the announced elements, ignored")
        notices.append(Notice("trailing_data", count, message, TOO_SMALL))
    return content


def _same_layout(rows: _TextRows) -> ElementColumns | None:
    """Read rows with lists as long as in the first row; None if their lengths differ."""
    tokens = rows.text[: rows.text.index(b"\n")].split()
    layout, at = [], 0
    for p in rows.element.properties:
        length = 1
        if p.length is not None:
            if at >= len(tokens) or not tokens[at].isdigit():
                return None
            length = int(tokens[at])
            at += 1
        layout.append((at, length))
        at += length
    if at != len(tokens) or at > 64:
        return None
    whole = all(p.type.kind != "f" for p in rows.element.properties)
    columns = read_columns(rows.text, at, np.int32 if whole else np.float64)
    if columns is None:
        return None
    read = ElementColumns()
    for p, (at, length) in zip(rows.element.properties, layout, strict=True):
        if p.length is None:
            read.scalars[p.name] = _typed(columns[at], p)
            continue
        if not (columns[at - 1] == length).all():
            return None
        items = np.stack(columns[at : at + length], axis=1) if length else np.empty((rows.element.count, 0))
        read.lists[p.name] = (np.broadcast_to(np.int64(length), rows.element.count), _typed(items.reshape(-1), p))
    return read


def _any_layout(rows: _TextRows, notices: list[Notice]) -> ElementColumns:
    """Read rows of any length."""
    numbers, known = read_tokens(rows.text, np.float64)
    text = np.frombuffer(rows.text, np.uint8)
    separators = np.flatnonzero(separates(text))
    ends = np.flatnonzero(text[separators] == NEWLINE) + 1
    if rows.numbers is None and (len(separators) != len(numbers) or not known.all()):
        raise Untidy
    if not known.all():
        wrong = int(np.flatnonzero(~known)[0])
        row = int(np.searchsorted(ends, wrong, side="right"))
        begin = int(separators[wrong - 1]) + 1 if wrong else 0
        token = rows.text[begin : int(separators[wrong])][:40].decode("utf-8", "backslashreplace")
        raise InputError(f"`{token}` found, a number expected", place=rows.place(row))
    at = np.concatenate(([0], ends[:-1]))
    read = ElementColumns()
    padded = np.append(numbers, 0.0)
    for p in rows.element.properties:
        if p.length is None:
            _require(rows, at < ends)
            read.scalars[p.name] = _typed(padded[at], p)
            at = at + 1
            continue
        _require(rows, at < ends)
        length = padded[at]
        wrong_length = np.flatnonzero(~((length >= 0) & (length == np.floor(length))))
        if len(wrong_length):
            row = int(wrong_length[0])
            raise InputError(f"list length {length[row]:g} found, a whole number expected", place=rows.place(row))
        _require(rows, at + 1 + length <= ends)
        count = length.astype(np.int64)
        inside = np.arange(int(count.sum())) + np.repeat(at + 1 - (np.cumsum(count) - count), count)
        read.lists[p.name] = (count, _typed(numbers[inside], p))
        at = at + 1 + count
    extra = np.flatnonzero(at < ends)
    if len(extra):
        _refuse_wrong_lengths(rows, read, extra)
        rest = f"of element `{rows.element.name}` with more values than announced, which are ignored"
        hint = f"the header lacks a property, or the file is damaged; the first is {rows.place(int(extra[0]))}"
        message = f"{pluralize(len(extra), '[row|rows]')} {rest}"
        notices.append(Notice("extra_values", len(extra), message, hint, tuple(extra[:5].tolist())))
    return read


def _refuse_wrong_lengths(rows: _TextRows, read: ElementColumns, extra: NDArray[np.intp]) -> None:
    """Refuse a face of fewer than 3 corners in a row with more values: the length of its list is wrong."""
    if rows.element.name != "face":
        return
    for p in rows.element.properties:
        if p.name in CORNERS and p.length is not None:
            lengths = read.lists[p.name][0]
            wrong = extra[lengths[extra] < 3]
            if len(wrong):
                row = int(wrong[0])
                problem = f"list length {int(lengths[row])} found in a row with more values"
                hint = "a list length, or the count of an element in the header, is wrong"
                raise InputError(problem, place=rows.place(row), hint=hint)


def _require(rows: _TextRows, enough: NDArray[np.bool_]) -> None:
    if not enough.all():
        row = int(np.flatnonzero(~enough)[0])
        if rows.numbers is None:
            raise Untidy
        raise InputError(f"too few values in a row of element `{rows.element.name}`", place=rows.place(row))


def _typed(values: NDArray[Any], p: PlyProperty) -> NDArray[Any]:
    """Convert whole numbers to the announced type if they fit; fractions stay doubles."""
    if p.type.kind == "f":
        return values.astype(np.float64, copy=False)
    with np.errstate(invalid="ignore"):
        typed = values.astype(p.native, copy=False)
    return typed if (typed == values).all() else values

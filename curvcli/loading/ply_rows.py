"""The rows of one PLY element, from binary data or from text, column by column."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..plurals import number_of
from .ply_header import Element, Property


@dataclass
class Columns:
    """scalars by name; lists by name as (length of each row, all items one after the other)."""

    scalars: dict[str, NDArray[Any]] = field(default_factory=dict)
    lists: dict[str, tuple[NDArray[np.int64], NDArray[Any]]] = field(default_factory=dict)


def read_binary_rows(data: bytes, offset: int, element: Element) -> tuple[Columns, int]:
    """The columns of an element that begins at `offset`, and where the next element begins.

    Errors: InputError where the data end early or a list length is negative.
    """
    if element.least_bytes * element.count > len(data) - offset:
        room = (len(data) - offset) // element.least_bytes
        raise InputError(
            f"{number_of(element.count, 'row')} announced, room for at most {room} found", place=element.name
        )
    if not element.count or not element.properties:
        return empty_columns(element), offset
    if all(p.length is None for p in element.properties):
        rows = np.frombuffer(data, _row_type(element, []), element.count, offset)
        return _columns(element, rows), offset + rows.nbytes
    lengths = _lengths_at(data, offset, element, 0)
    kind = _row_type(element, lengths)
    rows = np.frombuffer(data, kind, min(element.count, (len(data) - offset) // kind.itemsize), offset)
    same = np.ones(len(rows), np.bool_)
    for k, p in enumerate(element.properties):
        if p.length is not None:
            same &= rows[f"n{k}"] == rows[f"n{k}"][0] if len(rows) else True
    if len(rows) == element.count and same.all():
        return _columns(element, rows), offset + rows.nbytes
    return _read_mixed(data, offset, element)


def empty_columns(element: Element) -> Columns:
    """The columns of an element without rows."""
    none = np.empty(0, np.int64)
    return Columns(
        {p.name: np.empty(0, p.type) for p in element.properties if p.length is None},
        {p.name: (none, np.empty(0, p.type)) for p in element.properties if p.length is not None},
    )


def _row_type(element: Element, lengths: list[int]) -> np.dtype[Any]:
    """A row whose lists have the given lengths; fields by number, as names in the file may repeat."""
    fields: list[Any] = []
    remaining = iter(lengths)
    for k, p in enumerate(element.properties):
        if p.length is not None:
            fields.append((f"n{k}", p.length))
            fields.append((f"v{k}", p.type, (next(remaining),)))
        else:
            fields.append((f"v{k}", p.type))
    return np.dtype(fields)


def _columns(element: Element, rows: NDArray[Any]) -> Columns:
    columns = Columns()
    for k, p in enumerate(element.properties):
        if p.length is None:
            columns.scalars[p.name] = rows[f"v{k}"]
        else:
            items = rows[f"v{k}"]
            columns.lists[p.name] = (np.broadcast_to(np.int64(items.shape[1]), len(rows)), items.reshape(-1))
    return columns


def _lengths_at(data: bytes, offset: int, element: Element, row: int) -> list[int]:
    """The list lengths of the row that begins at `offset`."""
    lengths = []
    for p in element.properties:
        if p.length is None:
            offset += p.type.itemsize
            continue
        length = _length(data, offset, p, element, row)
        lengths.append(length)
        offset += p.length.itemsize + length * p.type.itemsize
    if offset > len(data):
        raise InputError("the data end inside a row", place=f"{element.name} {row}")
    return lengths


def _length(data: bytes, offset: int, p: Property, element: Element, row: int) -> int:
    assert p.length is not None
    end = offset + p.length.itemsize
    if end > len(data):
        raise InputError("the data end inside a row", place=f"{element.name} {row}")
    length = int(_reader(data, p)(offset))
    if length < 0:
        raise InputError(f"list length {length} found, 0 or more expected", place=f"{element.name} {row}")
    return length


def _read_mixed(data: bytes, offset: int, element: Element) -> tuple[Columns, int]:
    """Rows whose lists differ in length: each row's place is known only from the row before, so this is the one walk
    from row to row; what it finds is then gathered at once."""
    properties = element.properties
    lists = [k for k, p in enumerate(properties) if p.length is not None]
    begins: list[list[int]] = [[] for _ in lists]
    counts: list[list[int]] = [[] for _ in lists]
    row_starts: list[int] = []
    # bytes before each list's length, counted from the end of the list before it
    before, gap = [], 0
    for p in properties:
        if p.length is None:
            gap += p.type.itemsize
        else:
            before.append(gap)
            gap = 0
    after, size = gap, len(data)
    readers = [_reader(data, properties[k]) for k in lists]
    widths = [(properties[k].length.itemsize, properties[k].type.itemsize) for k in lists]  # type: ignore[union-attr]
    steps = list(zip(before, readers, widths, begins, counts, strict=True))
    for row in range(element.count):
        row_starts.append(offset)
        for gap, read, (head, item), begin, count in steps:
            offset += gap
            if offset + head > size:
                raise InputError("the data end inside a row", place=f"{element.name} {row}")
            length = read(offset)
            if length < 0:
                raise InputError(f"list length {length} found, 0 or more expected", place=f"{element.name} {row}")
            offset += head
            begin.append(offset)
            count.append(length)
            offset += length * item
        offset += after
    if offset > size:
        row = int(np.searchsorted(row_starts, size))
        raise InputError("the data end inside a row", place=f"{element.name} {max(row - 1, 0)}")
    return _gather(data, element, np.array(row_starts), begins, counts), offset


def _reader(data: bytes, p: Property) -> Any:
    assert p.length is not None
    if p.length.itemsize == 1 and p.length.kind == "u":
        return data.__getitem__
    size, signed, order = p.length.itemsize, p.length.kind == "i", "big" if p.length.str[0] == ">" else "little"
    return lambda at: int.from_bytes(data[at : at + size], order, signed=signed)  # type: ignore[arg-type]


def _gather(
    data: bytes, element: Element, starts: NDArray[np.int64], begins: list[list[int]], counts: list[list[int]]
) -> Columns:
    columns = Columns()
    at, k = starts, 0
    for p in element.properties:
        if p.length is None:
            columns.scalars[p.name] = _items(data, at, p)
            at = at + p.type.itemsize
            continue
        begin, length = np.array(begins[k]), np.array(counts[k])
        total = int(length.sum())
        within = np.arange(total) - np.repeat(np.cumsum(length) - length, length)
        columns.lists[p.name] = (length, _items(data, np.repeat(begin, length) + within * p.type.itemsize, p))
        at, k = begin + length * p.type.itemsize, k + 1
    return columns


def _items(data: bytes, at: NDArray[np.int64], p: Property) -> NDArray[Any]:
    """The items that begin at the given bytes."""
    width = p.type.itemsize
    windows = np.lib.stride_tricks.sliding_window_view(np.frombuffer(data, np.uint8), width)
    return np.ascontiguousarray(windows[at]).view(p.type).reshape(-1)

"""Columns of one PLY element, and the reader of its binary rows."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError
from ....support.blocks import slices
from ....support.words import number_of
from ...pieces import Pieces
from .header import PlyElement, PlyProperty


@dataclass
class ElementColumns:
    """Scalars by name; lists by name as (length of each row, all items concatenated).

    xyz: (3, rows) float64, the scalars x, y, z read as positions.
    """

    scalars: dict[str, NDArray[Any]] = field(default_factory=dict)
    lists: dict[str, tuple[NDArray[np.int64], NDArray[Any]]] = field(default_factory=dict)
    xyz: NDArray[np.float64] | None = None


def read_binary_rows(pieces: Pieces, element: PlyElement) -> ElementColumns:
    """Read the columns of an element; takes exactly its bytes.

    Errors: InputError where the data end early or a list length is negative.
    """
    if element.least_bytes * element.count > pieces.left:
        room = pieces.left // element.least_bytes
        raise InputError(
            f"{number_of(element.count, 'row')} announced, room for at most {room} found", place=element.name
        )
    if not element.count or not element.properties:
        return empty_columns(element)
    lengths = _first_lengths(pieces.ahead(), element) or _first_lengths(pieces.whole(), element)
    if lengths is None or (kind := _row_type(element, lengths)).itemsize * element.count > pieces.left:
        return _read_mixed(pieces, element, 0)
    columns = _room(element, lengths)
    for block in slices(element.count, max(pieces.longest // kind.itemsize, 1)):
        piece = pieces.take(kind.itemsize * (block.stop - block.start))
        rows = np.frombuffer(piece, kind)
        if not all((rows[f"n{k}"] == length).all() for k, length in enumerate(lengths) if length is not None):
            pieces.back(piece)
            return _joined(columns, block.start, _read_mixed(pieces, element, block.start))
        for k, p in enumerate(element.properties):
            if p.length is None:
                columns.scalars[p.name][block] = rows[f"v{k}"]
            else:
                columns.lists[p.name][1].reshape(element.count, -1)[block] = rows[f"v{k}"]
    return columns


def empty_columns(element: PlyElement) -> ElementColumns:
    """The columns of an element without rows."""
    none = np.empty(0, np.int64)
    return ElementColumns(
        {p.name: np.empty(0, p.native) for p in element.properties if p.length is None},
        {p.name: (none, np.empty(0, p.native)) for p in element.properties if p.length is not None},
    )


def _first_lengths(data: bytes, element: PlyElement) -> list[int | None] | None:
    """The lengths of the lists of the first row, None for scalars; None if the data end within that row."""
    lengths: list[int | None] = []
    offset = 0
    for p in element.properties:
        length = None
        if p.length is not None:
            if offset + p.length.itemsize > len(data) or (length := _reader(data, p)(offset)) < 0:
                return None
            offset += p.length.itemsize
        offset += p.type.itemsize * (1 if length is None else length)
        lengths.append(length)
    return lengths if offset <= len(data) else None


def _row_type(element: PlyElement, lengths: list[int | None]) -> np.dtype[Any]:
    """The dtype of a row with lists of the given lengths; fields by number, since names in the file are arbitrary."""
    fields: list[Any] = []
    for k, (p, length) in enumerate(zip(element.properties, lengths, strict=True)):
        if length is None:
            fields.append((f"v{k}", p.type))
        else:
            fields += [(f"n{k}", p.length), (f"v{k}", p.type, (length,))]
    return np.dtype(fields)


def _room(element: PlyElement, lengths: list[int | None]) -> ElementColumns:
    """Empty columns for rows with lists of the given lengths."""
    columns = ElementColumns()
    for p, length in zip(element.properties, lengths, strict=True):
        if length is None:
            columns.scalars[p.name] = np.empty(element.count, p.native)
        else:
            items = np.empty(element.count * length, p.native)
            columns.lists[p.name] = np.broadcast_to(np.int64(length), element.count), items
    if element.name == "vertex" and columns.scalars.keys() >= {"x", "y", "z"}:
        columns.xyz = np.empty((3, element.count))
        columns.scalars.update(zip("xyz", columns.xyz, strict=True))
    return columns


def _joined(begin: ElementColumns, rows: int, rest: ElementColumns) -> ElementColumns:
    """Join the first rows of some columns with the remaining rows."""
    joined = ElementColumns(
        {name: np.concatenate((begin.scalars[name][:rows], rest.scalars[name])) for name in rest.scalars}
    )
    for name, (lengths, items) in rest.lists.items():
        before = begin.lists[name][0][:rows]
        kept = begin.lists[name][1][: int(before.sum())]
        joined.lists[name] = np.concatenate((before, lengths)), np.concatenate((kept, items))
    return joined


def _read_mixed(pieces: Pieces, element: PlyElement, first: int) -> ElementColumns:
    """Read the rows from `first` on, with lists of different lengths.

    The offset of a row depends on the row before, so a Python loop finds the offsets; all values are then gathered at
    once.
    """
    data, offset = pieces.whole(), 0
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
    for row in range(first, element.count):
        row_starts.append(offset)
        for gap, read, (head, item), begin, count in steps:
            offset += gap
            if offset + head > size:
                raise _cut_off(element, first, row_starts, size)
            length = read(offset)
            if length < 0:
                raise InputError(f"list length {length} found, 0 or more expected", place=f"{element.name} {row}")
            offset += head
            begin.append(offset)
            count.append(length)
            offset += length * item
        offset += after
    if offset > size:
        raise _cut_off(element, first, row_starts, size)
    pieces.take(offset)
    return _gather(data, element, np.array(row_starts, np.int64), begins, counts)


def _cut_off(element: PlyElement, first: int, row_starts: list[int], size: int) -> InputError:
    row = first + int(np.searchsorted(row_starts, size, side="right")) - 1
    return InputError("the data end inside a row", place=f"{element.name} {row}")


def _reader(data: bytes, p: PlyProperty) -> Any:
    assert p.length is not None
    if p.length.itemsize == 1 and p.length.kind == "u":
        return data.__getitem__
    size, signed, order = p.length.itemsize, p.length.kind == "i", "big" if p.length.str[0] == ">" else "little"
    return lambda at: int.from_bytes(data[at : at + size], order, signed=signed)  # type: ignore[arg-type]


def _gather(
    data: bytes, element: PlyElement, starts: NDArray[np.int64], begins: list[list[int]], counts: list[list[int]]
) -> ElementColumns:
    columns = ElementColumns()
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


def _items(data: bytes, at: NDArray[np.int64], p: PlyProperty) -> NDArray[Any]:
    """The items that begin at the given bytes."""
    width = p.type.itemsize
    windows = np.lib.stride_tricks.sliding_window_view(np.frombuffer(data, np.uint8), width)
    return np.ascontiguousarray(windows[at]).view(p.type).reshape(-1).astype(p.native, copy=False)

"""Nodes and elements of Gmsh versions 2.0 to 2.2: one row each."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError
from .elements import ElementBlocks, Elements, nodes_of
from .source import MshSection

_FIRST_ROWS = 64


def read_nodes(section: MshSection, modern: bool) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Tags (V,) and positions (V, 3)."""
    count = _announced(section)
    return section.rows(count, 3)


def read_elements(section: MshSection, modern: bool, physical: Mapping[tuple[int, int], int]) -> Elements:
    """All elements: number, type, number of tags, tags, nodes in text; grouped by type in binary files."""
    count, blocks = _announced(section), ElementBlocks()
    if section.values is not None:
        values = section.integers(section.left)
        at = 0
        while count:
            at, rows = _run(values, at, count, blocks)
            count -= rows
        section.at = section.end - (len(values) - at)
        return blocks.elements()
    while count > 0:
        kind, rows, tags = section.integers(3).tolist()
        if rows < 1 or tags < 0:
            raise InputError(f"block of {rows} elements with {tags} tags found", place="$Elements")
        table = section.integers(rows * (1 + tags + nodes_of(kind))).reshape(rows, -1)
        _add(blocks, kind, table[:, 1:], tags)
        count -= rows
    if count:
        raise InputError(f"{-count} elements more than announced found", place="$Elements")
    return blocks.elements()


def _announced(section: MshSection) -> int:
    """The count in the first line, which is text in binary files too."""
    if section.values is not None:
        return int(section.integers(1)[0])
    end = section.data.find(b"\n", section.at, section.at + 64)
    text = section.data[section.at : max(end, section.at)].strip()
    if end < 0 or not text.isdigit():
        raise InputError("a count expected in the first line", place=f"${section.name}")
    section.at = end + 1
    return int(text)


def _run(values: NDArray[np.int64], at: int, most: int, blocks: ElementBlocks) -> tuple[int, int]:
    """Add the rows from `at` on that have the type and the number of tags of the first; where they end, and how many.

    The rows looked at double in number, so that the work is proportional to the rows.
    """
    if at + 3 > len(values):
        raise InputError(f"{most} elements announced that are missing", place="$Elements", hint="the file was cut off")
    kind, tags = int(values[at + 1]), int(values[at + 2])
    if not 0 <= tags <= 1000:
        raise InputError(f"element with {tags} tags found", place="$Elements")
    width = 3 + tags + nodes_of(kind)
    rows, size = 0, _FIRST_ROWS
    while rows < most:
        take = min(size, most - rows, (len(values) - at) // width - rows)
        if take <= 0:
            break
        table = values[at + rows * width : at + (rows + take) * width].reshape(take, width)
        other = np.flatnonzero((table[:, 1] != kind) | (table[:, 2] != tags))
        if len(other):
            rows += int(other[0])
            break
        rows, size = rows + take, 2 * size
    if not rows:
        raise InputError(f"{most} elements announced that are missing", place="$Elements", hint="the file was cut off")
    table = values[at : at + rows * width].reshape(rows, width)
    _add(blocks, kind, table[:, 3:], tags)
    return at + rows * width, rows


def _add(blocks: ElementBlocks, kind: int, table: NDArray[np.int64], tags: int) -> None:
    none = np.zeros(len(table), np.int64)
    groups = table[:, 0] if tags else none
    blocks.add(kind, table[:, tags:], groups, table[:, 1] if tags > 1 else none)

"""Lines of numbers written by polars, for text formats of meshes: no quotes, no header and no Python loop."""

from __future__ import annotations

import io
from collections.abc import Mapping
from itertools import repeat
from typing import Any, BinaryIO

import numpy as np
import polars as pl
from numpy.typing import NDArray

from ...support.forks import threads_lost

ROWS_AT_A_TIME = 65536
_BATCH = 8192


def write_lines(stream: BinaryIO, columns: Mapping[str, pl.Series | str], end: str = "\n") -> None:
    """Write the columns side by side, separated by a blank; null leaves an empty place, the blank stays. A word stands
    for a column of it."""
    stream.write(lines(columns, end))


def lines(columns: Mapping[str, pl.Series | str], end: str = "\n") -> bytes:
    """Lines of `write_lines` as bytes, with the shortest text that reads back to the same double."""
    if threads_lost():
        return joined(columns, " ", end)
    text = io.BytesIO()
    frame = pl.select([(pl.lit(c) if isinstance(c, str) else c).alias(name) for name, c in columns.items()])
    frame.write_csv(
        text, include_header=False, separator=" ", line_terminator=end, quote_style="never", batch_size=_BATCH
    )
    return text.getvalue()


def joined(columns: Mapping[str, pl.Series | str], separator: str, end: str) -> bytes:
    """Same text without the threads of polars: columns of words and numbers side by side."""
    cells = [repeat(c) if isinstance(c, str) else _words(c) for c in columns.values()]
    return "".join([separator.join(row) + end for row in zip(*cells, strict=False)]).encode()


def _words(column: pl.Series) -> list[str]:
    return ["" if word is None else word for word in column.cast(pl.String).to_list()]


def without(text: bytes, first: bytes, second: bytes) -> NDArray[np.uint8]:
    """Text without every `first` that stands right before a `second`, both single bytes."""
    data = np.frombuffer(text, np.uint8)
    keep = np.ones(len(data), np.bool_)
    keep[:-1] = (data[:-1] != first[0]) | (data[1:] != second[0])
    return data[keep]


def numbers(values: NDArray[Any]) -> pl.Series:
    """Values for polars, in native order and contiguous; NaN stays."""
    return pl.Series(np.ascontiguousarray(values))


def write_rows(
    stream: BinaryIO,
    heads: NDArray[np.integer[Any]],
    corners: NDArray[np.integer[Any]],
    sizes: NDArray[np.integer[Any]],
    tails: NDArray[np.integer[Any]] | None = None,
) -> None:
    """Write a line for each polygon: its head, its corners, and the numbers behind them.

    heads (P,), corners concatenated, sizes (P,), tails (P, k).
    """
    behind = 0 if tails is None else tails.shape[1]
    ends = np.cumsum(sizes.astype(np.int64) + 1 + behind)
    begins = ends - sizes - 1 - behind
    values = np.empty(int(ends[-1]) if len(ends) else 0, np.int64)
    is_corner = np.ones(len(values), np.bool_)
    values[begins], is_corner[begins] = heads, False
    for k in range(behind):
        at = ends - behind + k
        values[at], is_corner[at] = tails[:, k] if tails is not None else 0, False
    values[is_corner] = corners
    last = np.zeros(len(values), np.bool_)
    last[ends - 1] = True
    for start in range(0, len(values), ROWS_AT_A_TIME):
        rows = slice(start, start + ROWS_AT_A_TIME)
        text = np.frombuffer(lines({"value": numbers(values[rows])}), np.uint8).copy()
        breaks = np.flatnonzero(text == ord("\n"))
        text[breaks[~last[rows]]] = ord(" ")
        stream.write(text.data)

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

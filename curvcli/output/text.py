"""Lines of numbers at the speed of polars: the text formats of meshes need no quotes, no header and no loop."""

from __future__ import annotations

import io
from collections.abc import Mapping
from typing import Any, BinaryIO

import numpy as np
import polars as pl
from numpy.typing import NDArray

ROWS_AT_A_TIME = 65536
_BATCH = 8192


def write_lines(stream: BinaryIO, columns: Mapping[str, pl.Series | pl.Expr], end: str = "\n") -> None:
    """The columns side by side with a blank between them; null leaves its place empty, the blank stays."""
    stream.write(lines(columns, end))


def lines(columns: Mapping[str, pl.Series | pl.Expr], end: str = "\n") -> bytes:
    """What `write_lines` writes, as bytes. The shortest text that reads back to the same double."""
    text = io.BytesIO()
    frame = pl.select([column.alias(name) for name, column in columns.items()])
    frame.write_csv(
        text, include_header=False, separator=" ", line_terminator=end, quote_style="never", batch_size=_BATCH
    )
    return text.getvalue()


def without(text: bytes, first: bytes, second: bytes) -> NDArray[np.uint8]:
    """The text less every `first` that stands right before a `second`, both single bytes."""
    data = np.frombuffer(text, np.uint8)
    keep = np.ones(len(data), np.bool_)
    keep[:-1] = (data[:-1] != first[0]) | (data[1:] != second[0])
    return data[keep]


def numbers(values: NDArray[Any]) -> pl.Series:
    """The values for polars, in native order and contiguous; not-a-number stays one."""
    return pl.Series(np.ascontiguousarray(values))

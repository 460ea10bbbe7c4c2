"""Wavefront OBJ writer: positions that read back to the same doubles, colours behind them, faces as loaded."""

from __future__ import annotations

from typing import Any, BinaryIO, Unpack

import numpy as np
import polars as pl
from numpy.typing import NDArray

from ...support.blocks import slices
from ...support.words import escape_text
from .attributes import MeshAttributes
from .text import ROWS_AT_A_TIME, lines, numbers, without, write_lines

# k / 255 at four digits: enough to read back as the same byte.
_SHARES = np.round(np.arange(256) / 255, 4)


def write_obj(
    stream: BinaryIO, points: NDArray[np.float64], faces: NDArray[np.integer[Any]], **attributes: Unpack[MeshAttributes]
) -> None:
    """Write `v x y z` or `v x y z r g b` with colours from 0 to 1, then `f` records counted from 1.

    points (V, 3), faces (F, 3). Of the parts, polygons, colours and comments: OBJ has no other properties.
    """
    colors, polygons = attributes.get("vertex_colors"), attributes.get("polygons")
    for comment in attributes.get("comments", ()):
        stream.write(f"# {escape_text(' '.join(comment.split()))}\n".encode())
    for rows in slices(len(points), ROWS_AT_A_TIME):
        columns: dict[str, pl.Series | str] = {axis: numbers(points[rows, k]) for k, axis in enumerate("xyz")}
        if colors is not None:
            columns |= {name: numbers(_SHARES[colors[rows, k]]) for k, name in enumerate("rgb")}
        write_lines(stream, {"v": "v", **columns})
    if polygons is None:
        for rows in slices(len(faces), ROWS_AT_A_TIME):
            part = faces[rows].astype(np.int64) + 1
            write_lines(stream, {"f": "f", **{name: numbers(part[:, k]) for k, name in enumerate("abc")}})
    else:
        _write_polygons(stream, *polygons)


def _write_polygons(stream: BinaryIO, corners: NDArray[np.integer[Any]], sizes: NDArray[np.integer[Any]]) -> None:
    """Write one line per corner with `f` before the first of each polygon, then remove each line end before a blank."""
    starts = np.zeros(len(corners), np.bool_)
    starts[(np.cumsum(sizes) - sizes)[sizes > 0]] = True
    for rows in slices(len(corners), ROWS_AT_A_TIME):
        letter = numbers(starts[rows]).replace_strict([True, False], ["f", None], return_dtype=pl.String)
        text = lines({"f": letter, "corner": numbers(corners[rows].astype(np.int64) + 1)})
        # The line end of a block's last corner may be removed too: it is written before the next block instead.
        body = without(text[:-1], b"\n", b" ")
        if rows.start and starts[rows.start]:
            stream.write(b"\n")
        stream.write(body.data)
    if len(corners):
        stream.write(b"\n")

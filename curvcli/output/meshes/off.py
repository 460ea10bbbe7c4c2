"""OFF writer: positions that read back to the same doubles, colours behind them, faces as loaded."""

from __future__ import annotations

from typing import Any, BinaryIO, Unpack

import numpy as np
import polars as pl
from numpy.typing import NDArray

from ...support.blocks import slices
from ...support.words import escape_text
from .attributes import MeshAttributes
from .text import ROWS_AT_A_TIME, numbers, write_lines, write_rows

_CHANNELS = ("red", "green", "blue")


def write_off(
    stream: BinaryIO, points: NDArray[np.float64], faces: NDArray[np.integer[Any]], **attributes: Unpack[MeshAttributes]
) -> None:
    """Write `OFF`, or `COFF` with red, green, blue and alpha from 0 to 255 behind each position.

    points (V, 3), faces (F, 3). Of the attributes, polygons, colours, comments, and bytes red, green, blue of faces.
    """
    colors, polygons = attributes.get("vertex_colors"), attributes.get("polygons")
    count = len(faces) if polygons is None else len(polygons[1])
    stream.write(b"OFF\n" if colors is None else b"COFF\n")
    for comment in attributes.get("comments", ()):
        stream.write(f"# {escape_text(' '.join(comment.split()))}\n".encode())
    stream.write(f"{len(points)} {count} 0\n".encode())
    for rows in slices(len(points), ROWS_AT_A_TIME):
        columns: dict[str, pl.Series | str] = {axis: numbers(points[rows, k]) for k, axis in enumerate("xyz")}
        if colors is not None:
            columns |= {name: numbers(colors[rows, k]) for k, name in enumerate("rgb")} | {"a": "255"}
        write_lines(stream, columns)
    given = attributes.get("face_properties") or {}
    shades = [np.asarray(given[name]) for name in _CHANNELS if name in given]
    if len(shades) < 3 or any(shade.dtype != np.uint8 or len(shade) != count for shade in shades):
        shades = []
    corners, sizes = polygons or (faces.reshape(-1), np.full(len(faces), 3))
    write_rows(stream, sizes, corners, sizes, np.stack(shades, axis=1) if shades else None)

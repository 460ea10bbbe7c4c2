"""STL writers, binary and text: triangles without shared vertices."""

from __future__ import annotations

from typing import Any, BinaryIO

import numpy as np
import polars as pl
from numpy.typing import NDArray

from ...errors import Notice, OutputError
from ...support.blocks import slices
from ...support.words import pluralize
from .text import ROWS_AT_A_TIME, lines, numbers, without

_HEADER = b"binary STL written by curvcli".ljust(80, b" ")
_RECORD = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def write_stl(stream: BinaryIO, points: NDArray[np.float64], faces: NDArray[np.integer[Any]]) -> tuple[Notice, ...]:
    """Write triangles as binary STL, which has float32 only; the notice counts the rounded positions.

    points (V, 3), faces (F, 3). A triangle without area has the normal 0 0 0.
    Errors: OutputError for a coordinate beyond float32, or more than 2³² - 1 triangles.
    """
    if len(faces) >= 2**32:
        raise OutputError(f"STL is limited to 2³² - 1 triangles, this mesh has {len(faces)}; write .ply")
    referenced = np.zeros(len(points), np.bool_)
    referenced[faces] = True
    used = points[referenced]
    with np.errstate(over="ignore", under="ignore"):
        kept = used.astype(np.float32)
    large = ~np.isfinite(kept) & np.isfinite(used)
    if large.any():
        raise OutputError(f"STL has float32 only, and the coordinate {used[large][0]:g} is beyond it; write .ply")
    stream.write(_HEADER + np.uint32(len(faces)).astype("<u4").tobytes())
    for rows in slices(len(faces), ROWS_AT_A_TIME):
        corners = points[faces[rows]]
        records = np.zeros(len(corners), _RECORD)
        records["normal"] = _normals(corners)
        with np.errstate(under="ignore"):
            records["corners"] = corners
        stream.write(records.data)
    rounded = int((kept != used).any(axis=1).sum())
    if not rounded:
        return ()
    message = pluralize(rounded, "[position|positions] rounded to float32, the only precision binary STL has")
    return (Notice("stl_float32", rounded, message, hint="write .ply or .obj to keep every digit"),)


def write_stl_text(stream: BinaryIO, points: NDArray[np.float64], faces: NDArray[np.integer[Any]]) -> None:
    """Write triangles as ASCII STL with the shortest text of each double; points (V, 3), faces (F, 3)."""
    stream.write(b"solid curvcli\n")
    for rows in slices(len(faces), ROWS_AT_A_TIME):
        corners = points[faces[rows]]
        columns: dict[str, pl.Series | str] = {"facet": "facet normal"}
        columns |= {f"n{k}": numbers(column) for k, column in enumerate(_normals(corners).T)}
        columns["loop"] = "\nouter loop"
        for corner in range(3):
            columns[f"vertex{corner}"] = "\nvertex"
            columns |= {f"{corner}{k}": numbers(corners[:, corner, k]) for k in range(3)}
        text = lines(columns, end="\nendloop\nendfacet\n")
        stream.write(without(text, b" ", b"\n").data)
    stream.write(b"endsolid curvcli\n")


def _normals(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Unit normals by the right-hand rule at any scale, 0 0 0 for degenerate triangles; corners (n, 3, 3)."""
    sides = corners[:, 1:] - corners[:, :1]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore", under="ignore"):
        sides /= np.abs(sides).max(axis=(1, 2), keepdims=True)
        across = np.cross(sides[:, 0], sides[:, 1])
        across /= np.linalg.norm(across, axis=1, keepdims=True)
    return np.where(np.isfinite(across), across, 0.0)

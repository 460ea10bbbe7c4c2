"""Normals of an OBJ file: `vn` records and the corners that refer to them."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError
from ...text import pick_lines, read_records
from .lines import ObjLines

_VN = ord("v") + 256 * ord("n")
# Corners: v/vt/vn and v//vn keep the last number, v and v/vt have none.
_WITHOUT = re.compile(rb"(?<=[ \t])[-+]?\d+(?:/[-+]?\d*)?/?(?=[ \t\r\n])")
_BEFORE = re.compile(rb"(?<=[ \t])[-+]?\d+/[-+]?\d*/(?=[-+\d])")


def corner_normals(
    lines: ObjLines, is_f: NDArray[np.bool_], corners: NDArray[np.int32], vertices: int
) -> NDArray[np.float64] | None:
    """(3, V) sums of the unit normals at the corners of each vertex, NaN without any; None without `vn` records.

    corners: the vertex of every corner of every face. Errors: InputError for an index out of range.
    """
    is_vn = lines.kind == _VN
    if not is_vn.any():
        return None
    records = lines.records(is_vn, np.float64, "a number")
    sizes = np.broadcast_to(np.asarray(records.sizes), int(np.count_nonzero(is_vn)))
    short = np.flatnonzero(sizes < 3)
    if len(short):
        place = lines.place(int(np.flatnonzero(is_vn)[short[0]]))
        raise InputError(f"`vn` record with {sizes[short[0]]} numbers, 3 expected", place=place)
    start = np.cumsum(sizes) - sizes
    values = records.flat()
    normals = np.array([values[start + k] for k in range(3)], np.float64)
    length = np.sqrt((normals * normals).sum(axis=0))
    normals = np.divide(normals, length, where=length > 0, out=np.zeros_like(normals))
    each, face = _indices(lines, is_f)
    defined = np.cumsum(is_vn)[np.flatnonzero(is_f)[face]]
    index = np.where(each < 0, each + defined, each - 1)
    wrong = np.flatnonzero((each != 0) & ((index < 0) | (index >= len(sizes))))
    if len(wrong):
        place = lines.place(int(np.flatnonzero(is_f)[face[wrong[0]]]))
        raise InputError(f"normal index {each[wrong[0]]} found, 1 to {len(sizes)} expected", place=place)
    known = each != 0
    at = corners[known]
    total = np.array([np.bincount(at, row[index[known]], minlength=vertices) for row in normals])
    total[:, np.bincount(at, minlength=vertices) == 0] = np.nan
    return total


def _indices(lines: ObjLines, is_f: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The index of the normal at every corner of every face, 0 for none, and the face of each corner."""
    text = pick_lines(lines.data, lines.starts, is_f)
    records = read_records(_BEFORE.sub(b"", _WITHOUT.sub(b"0", text)), np.int32)
    faces = int(np.count_nonzero(is_f))
    return records.flat().astype(np.int64), np.repeat(np.arange(faces), records.sizes)

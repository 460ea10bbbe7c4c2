"""Texture coordinates of an OBJ file: `vt` records and the corners that refer to them."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError
from ...text import pick_lines, read_records
from .lines import ObjLines

_VT = ord("v") + 256 * ord("t")
# Corners: v/vt and v/vt/vn keep the second number, v and v//vn have none.
_WITH = re.compile(rb"(?<=[ \t])[-+]?\d+/([-+]?\d+)(?:/[-+]?\d*)?(?=[ \t\r\n])")
_WITHOUT = re.compile(rb"(?<=[ \t])[-+]?\d+(?://[-+]?\d*|/)?(?=[ \t\r\n])")


def corner_texture(lines: ObjLines, is_f: NDArray[np.bool_]) -> NDArray[np.float64] | None:
    """(2, C) texture coordinates u and v of every corner of every face, NaN for none; None without `vt` records.

    A third coordinate is ignored, a missing second one is 0. Errors: InputError for an index out of range.
    """
    is_vt = lines.kind == _VT
    if not is_vt.any():
        return None
    records = lines.records(is_vt, np.float64, "a number")
    count = int(np.count_nonzero(is_vt))
    sizes = np.broadcast_to(np.asarray(records.sizes), count)
    empty = np.flatnonzero(sizes < 1)
    if len(empty):
        place = lines.place(int(np.flatnonzero(is_vt)[empty[0]]))
        raise InputError("`vt` record without a number, 1 to 3 expected", place=place)
    start, values = np.cumsum(sizes) - sizes, records.flat()
    u = values[start]
    v = np.where(sizes > 1, values[np.minimum(start + 1, len(values) - 1)], 0.0)
    index, face = _indices(lines, is_f)
    defined = np.cumsum(is_vt)[np.flatnonzero(is_f)[face]]
    place_of = np.where(index < 0, index + defined, index - 1)
    wrong = np.flatnonzero((index != 0) & ((place_of < 0) | (place_of >= count)))
    if len(wrong):
        place = lines.place(int(np.flatnonzero(is_f)[face[wrong[0]]]))
        raise InputError(f"texture index {index[wrong[0]]} found, 1 to {count} expected", place=place)
    known = index != 0
    return np.where(known, np.stack([u, v])[:, np.where(known, place_of, 0)], np.nan)


def _indices(lines: ObjLines, is_f: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The index of the texture coordinates at every corner of every face, 0 for none, and the face of each corner."""
    # Corners with a texture index are bracketed first, to tell them from corners without one.
    text = _WITH.sub(rb"<\1>", pick_lines(lines.data, lines.starts, is_f))
    text = _WITHOUT.sub(b"0", text).replace(b"<", b"").replace(b">", b"")
    records = read_records(text, np.int32)
    faces = int(np.count_nonzero(is_f))
    return records.flat().astype(np.int64), np.repeat(np.arange(faces), records.sizes)

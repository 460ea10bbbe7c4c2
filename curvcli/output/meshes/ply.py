"""Binary PLY writer: float64 positions, every column as a property, faces as loaded."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, BinaryIO, Unpack

import numpy as np
from numpy.typing import NDArray

from ...errors import Notice
from ...mesh.file import Labels
from ...support.words import escape_text
from ..tables.write import Column
from .attributes import MeshAttributes
from .names import fitting, one_word, respelt

_ROWS_AT_A_TIME = 16384  # a block of this size fits in the cache
_NAMES_TOLD = 256
_CORNERS = "vertex_indices"
_SCALARS = {
    "i1": "char",
    "u1": "uchar",
    "i2": "short",
    "u2": "ushort",
    "i4": "int",
    "u4": "uint",
    "f4": "float",
    "f8": "double",
}


def write_ply(
    stream: BinaryIO, points: NDArray[np.float64], faces: NDArray[np.integer[Any]], **attributes: Unpack[MeshAttributes]
) -> tuple[Notice, ...]:
    """Write points (V, 3) and faces (F, 3) as binary little-endian PLY with `double` positions, in bounded memory.

    Of the parts, polygons, colours, properties and comments. Properties keep their type; masked integers become double.
    Labels become uchar or int codes; comments list their meaning. Names are words in UTF-8; an invalid or taken name is
    spelt in another way, and the notice of that is returned.
    """
    vertices: dict[str, NDArray[Any]] = {axis: points[:, k] for k, axis in enumerate("xyz")}
    if (colors := attributes.get("vertex_colors")) is not None:
        vertices |= {name: colors[:, k] for k, name in enumerate(("red", "green", "blue"))}
    comments = [escape_text(" ".join(comment.split())) for comment in attributes.get("comments", ())]
    of_vertices, of_faces = attributes.get("vertex_properties") or {}, attributes.get("face_properties") or {}
    if clash := vertices.keys() & of_vertices.keys():
        raise ValueError(f"two vertex properties named {', '.join(sorted(clash))}")
    spellings = fitting(of_vertices, one_word, vertices), fitting(of_faces, one_word, (_CORNERS,))
    vertices |= _scalars(of_vertices, spellings[0], comments)
    per_face = _scalars(of_faces, spellings[1], comments)
    corners, sizes = attributes.get("polygons") or (faces.reshape(-1), None)
    if sizes is not None and len(sizes) and sizes.min() == sizes.max() > 0:
        corners, sizes = corners.reshape(-1, int(sizes[0])), None
    elif sizes is None:
        corners = corners.reshape(-1, 3)
    widest = corners.shape[1] if sizes is None else int(sizes.max(initial=0))
    count = "<u1" if widest <= 255 else "<u4"

    header = ["ply", "format binary_little_endian 1.0", *(f"comment {_ascii(line)}" for line in comments)]
    header.append(f"element vertex {len(points)}")
    header += [f"property {_SCALARS[column.dtype.str[1:]]} {name}" for name, column in vertices.items()]
    header.append(f"element face {len(corners) if sizes is None else len(sizes)}")
    header.append(f"property list {_SCALARS[count[1:]]} int {_CORNERS}")
    header += [f"property {_SCALARS[column.dtype.str[1:]]} {name}" for name, column in per_face.items()]
    stream.write(("\n".join([*header, "end_header"]) + "\n").encode("utf-8", "backslashreplace"))

    for block in _records(vertices, len(points)):
        stream.write(block.data)
    blocks = _even(corners, count, per_face) if sizes is None else _mixed(corners, sizes, count, per_face)
    for rows in blocks:
        stream.write(rows.data)
    return respelt(*spellings)


def _ascii(line: str) -> str:
    return line.encode("ascii", "backslashreplace").decode("ascii")


def _records(columns: Mapping[str, NDArray[Any]], length: int) -> Iterator[NDArray[Any]]:
    """Rows of the columns side by side, a block at a time."""
    # Fields are numbered: not every name is a valid name of a field.
    fields = [(str(place), column.dtype) for place, column in enumerate(columns.values())]
    block = np.empty(min(length, _ROWS_AT_A_TIME), fields)
    for start in range(0, length, _ROWS_AT_A_TIME):
        rows = block[: min(_ROWS_AT_A_TIME, length - start)]
        for (name, _), column in zip(fields, columns.values(), strict=True):
            rows[name] = column[start : start + len(rows)]
        yield rows


def _even(
    corners: NDArray[np.integer[Any]], count: str, properties: Mapping[str, NDArray[Any]]
) -> Iterator[NDArray[Any]]:
    """The face rows when all polygons have the same number of corners; corners (P, n)."""
    fields = [(str(place), column.dtype) for place, column in enumerate(properties.values())]
    sides = corners.shape[1]
    record = np.dtype([("corner count", count), ("corner list", "<i4", (sides,)), *fields])
    step = max(1, _ROWS_AT_A_TIME // max(1, sides // 4))
    for start in range(0, len(corners), step):
        part = corners[start : start + step]
        rows = np.empty(len(part), record)
        rows["corner count"] = sides
        rows["corner list"] = part
        for (name, _), column in zip(fields, properties.values(), strict=True):
            rows[name] = column[start : start + len(part)]
        yield rows


def _mixed(
    corners: NDArray[np.integer[Any]],
    sizes: NDArray[np.integer[Any]],
    count: str,
    properties: Mapping[str, NDArray[Any]],
) -> Iterator[NDArray[Any]]:
    """Rows of faces for polygons of several sizes: each size is made apart, then put in its places."""
    fixed = np.dtype(count).itemsize + sum(column.dtype.itemsize for column in properties.values())
    first = np.zeros(len(sizes) + 1, np.int64)
    np.cumsum(sizes, out=first[1:])
    start = 0
    while start < len(sizes):
        # Blocks end after so many corners: one huge polygon among many small ones costs only itself.
        stop = int(np.searchsorted(first, first[start] + 4 * _ROWS_AT_A_TIME, side="right")) - 1
        stop = min(max(stop, start + 1), start + _ROWS_AT_A_TIME)
        block = sizes[start:stop]
        place = np.zeros(len(block) + 1, np.int64)
        np.cumsum(fixed + 4 * block.astype(np.int64), out=place[1:])
        out = np.empty(place[-1], np.uint8)
        for size in np.unique(block):
            which = np.flatnonzero(block == size)
            at = first[start + which][:, None] + np.arange(size)
            chosen = {name: column[start + which] for name, column in properties.items()}
            for rows in _even(corners[at], count, chosen):
                out[place[which][:, None] + np.arange(rows.dtype.itemsize)] = rows.view(np.uint8).reshape(
                    len(which), -1
                )
        yield out
        start = stop


def _scalars(
    columns: Mapping[str, Column], spelling: Mapping[str, str], comments: list[str]
) -> dict[str, NDArray[Any]]:
    """Columns in the scalar types of PLY, little-endian; the meaning of label codes is added to the comments."""
    return {spelling[name]: _scalar(spelling[name], column, comments) for name, column in columns.items()}


def _scalar(name: str, column: Column, comments: list[str]) -> NDArray[Any]:
    if isinstance(column, Labels):
        return _codes(name, column, comments)
    if isinstance(column, np.ma.MaskedArray):
        return np.where(np.ma.getmaskarray(column), np.nan, np.ma.getdata(column)).astype("<f8", copy=False)
    if column.dtype == np.bool_:
        return column.view(np.uint8)
    if column.dtype.kind in "iu" and column.dtype.itemsize == 8:
        # PLY has no 64-bit integers.
        limits = np.iinfo(np.int32)
        fits = not len(column) or (limits.min <= column.min() and column.max() <= limits.max)
        return column.astype("<i4" if fits else "<f8")
    return column.astype(column.dtype.newbyteorder("<"), copy=False)


def _codes(name: str, labels: Labels, comments: list[str]) -> NDArray[Any]:
    few = len(labels.names) <= 255
    comments.append(meaning(name, labels, 255 if few else -1))
    if not few:
        return labels.codes.astype("<i4", copy=False)
    return np.where(labels.codes < 0, np.uint8(255), labels.codes.astype(np.uint8))


def meaning(name: str, labels: Labels, none: int) -> str:
    """One line with the meaning of the codes of a column; none: the code of no label."""
    meanings = [f"{code} {' '.join(label.split())}" for code, label in enumerate(labels.names[:_NAMES_TOLD])]
    if len(labels.names) > _NAMES_TOLD:
        meanings.append(f"and {len(labels.names) - _NAMES_TOLD} more")
    if (labels.codes < 0).any():
        meanings.append(f"{none} none")
    return escape_text(f"{name}: " + ", ".join(meanings))

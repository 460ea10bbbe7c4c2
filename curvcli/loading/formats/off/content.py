"""Numbers of an OFF file before they are checked, and the mesh that they make."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, Notice
from ....mesh.file import MeshFile
from ....support.words import number_of
from .keyword import Keyword

_COLOURS = {1: ("color_index",), 3: ("red", "green", "blue"), 4: ("red", "green", "blue", "alpha")}
_CHANNELS = ("red", "green", "blue", "alpha")


@dataclass(frozen=True)
class Content:
    """Columns of vertices, the corners of all polygons, and the numbers behind the corners.

    columns: (V,) each, the first three of positions. sizes: corners of each polygon, an int for all or (P,).
    extra: numbers behind the corners of each polygon, an int for all or (P,). colours: all of these, concatenated.
    place: of the polygon of a row in the file. trailing: lines or bytes behind the last polygon.
    """

    columns: list[NDArray[Any]]
    sizes: int | NDArray[np.int64]
    corners: NDArray[Any]
    extra: int | NDArray[np.int64]
    colours: NDArray[Any]
    place: Callable[[int], str]
    trailing: tuple[int, str] = (0, "")


def make_mesh(keyword: Keyword, content: Content, faces: int) -> MeshFile:
    """Check all indices, name the properties, and drop faces with fewer than three corners.

    Errors: InputError for an index out of range, or for rows shifted by a wrong number of vertices.
    """
    columns, notices = content.columns, list[Notice]()
    sizes = np.broadcast_to(np.asarray(content.sizes, np.int64), faces)
    extra = np.broadcast_to(np.asarray(content.extra, np.int64), faces)
    named = keyword.columns(len(columns)) or {}
    if more := len(columns) - 3 - len(named):
        message = f"vertices with {number_of(more, 'number')} each that the first word does not announce, ignored"
        hint = "the first word COFF announces colours, NOFF normals"
        notices.append(Notice("extra_values", len(columns[0]), message, hint))
    _refuse_shifted(content, sizes, len(columns[0]))
    corners = _checked(content, sizes, len(columns[0]))
    properties = _face_colours(content.colours, extra, notices, content.place)
    if content.trailing[0]:
        count, message = content.trailing
        hint = "if a count at the start is too small, elements are missing"
        notices.append(Notice("trailing_data", count, message, hint))
    if isinstance(content.sizes, int) and content.sizes == 3 and faces:
        kept = None
    else:
        short = np.flatnonzero(sizes < 3)
        if len(short):
            hint = f"the first is in {content.place(int(short[0]))}"
            notices.append(Notice.at("short_faces", short, "[face|faces] with fewer than 3 corners, dropped", hint))
            keep = sizes >= 3
            corners, sizes = corners[np.repeat(keep, sizes)], sizes[keep]
            properties = {name: values[keep] for name, values in properties.items()}
        if not len(sizes):
            raise InputError("no faces", hint="a surface needs at least one face of three corners")
        kept = None if (sizes == 3).all() else sizes.astype(np.int32)
    return MeshFile(
        "off",
        np.ascontiguousarray(np.stack(columns[:3], dtype=np.float64)),
        corners,
        kept,
        vertex_properties=_of_vertices(columns, named),
        polygon_properties=properties,
        notices=tuple(notices),
    )


def _of_vertices(columns: list[NDArray[Any]], named: dict[str, int]) -> dict[str, NDArray[np.generic]]:
    colour = [columns[at] for name, at in named.items() if name in _CHANNELS]
    kind = np.uint8 if colour and _are_bytes(colour) else np.float64
    return {name: columns[at].astype(kind if name in _CHANNELS else np.float64) for name, at in named.items()}


def _are_bytes(colour: list[NDArray[Any]]) -> bool:
    """Test for whole numbers from 0 to 255, some above 1: others are shares of light."""
    return (
        all(bool(((channel >= 0) & (channel <= 255) & (channel % 1 == 0)).all()) for channel in colour)
        and max(float(channel.max(initial=0)) for channel in colour) > 1
    )


def _face_colours(
    colours: NDArray[Any], extra: NDArray[np.int64], notices: list[Notice], place: Callable[[int], str]
) -> dict[str, NDArray[np.generic]]:
    """Properties of faces from the numbers behind their corners: one index, or three or four of a colour."""
    if not len(colours):
        return {}
    begin = np.cumsum(extra) - extra
    channels: dict[str, NDArray[np.float64]] = {}
    for count, names in _COLOURS.items():
        rows = np.flatnonzero(extra == count)
        for k, name in enumerate(names if len(rows) else ()):
            channels.setdefault(name, np.full(len(extra), np.nan))[rows] = colours[begin[rows] + k]
    unknown = np.flatnonzero(~np.isin(extra, (0, *_COLOURS)))
    if len(unknown):
        message = "[face|faces] with numbers behind the corners that are no colour, ignored"
        hint = f"a colour has 1, 3 or 4 numbers; the first is in {place(int(unknown[0]))}"
        notices.append(Notice.at("extra_values", unknown, message, hint))
    properties: dict[str, NDArray[np.generic]] = {}
    if (index := channels.pop("color_index", None)) is not None:
        whole = bool(np.isnan(index).sum() == np.count_nonzero(extra != 1)) and bool(
            (np.nan_to_num(index) % 1 == 0).all()
        )
        fits_int32 = whole and bool((np.abs(np.nan_to_num(index)) < 2**31).all())
        properties["color_index"] = np.where(np.isnan(index), -1, index).astype(np.int32) if fits_int32 else index
    kind = np.uint8 if channels and _are_bytes(list(channels.values())) else np.float64
    return properties | {name: values.astype(kind) for name, values in channels.items()}


def _refuse_shifted(content: Content, sizes: NDArray[np.int64], vertices: int) -> None:
    """Refuse faces that begin with a row of a vertex: the announced number of vertices is too small."""
    if content.trailing[0] and len(sizes) and sizes[0] < 3:
        hint = f"the number of vertices, {vertices}, is too small, or the file is damaged"
        problem = f"a face of {number_of(int(sizes[0]), 'corner')} found, and data after the last face"
        raise InputError(problem, place=content.place(0), hint=hint)


def _checked(content: Content, sizes: NDArray[np.int64], vertices: int) -> NDArray[np.int32]:
    """Check that all corners are whole numbers in range."""
    corners = content.corners
    if corners.dtype.kind == "f":
        wrong = ~((corners >= 0) & (corners < vertices) & (corners % 1 == 0))
    else:
        if not len(corners) or (int(corners.min()) >= 0 and int(corners.max()) < vertices):
            return np.ascontiguousarray(corners, np.int32)
        wrong = (corners < 0) | (corners >= vertices)
    if wrong.any():
        first = int(np.flatnonzero(wrong)[0])
        row = int(np.searchsorted(np.cumsum(sizes), first, side="right"))
        expected = f"0 to {vertices - 1} expected" if vertices else "but no vertex"
        raise InputError(f"vertex index {corners[first]:.17g} found, {expected}", place=content.place(row))
    return np.ascontiguousarray(corners, np.int32)

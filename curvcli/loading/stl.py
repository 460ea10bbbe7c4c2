"""STL, binary and ASCII: triangles as three corners each, welded by exact equality of their positions."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, Notice
from .limits import check_faces
from .model import MeshFile
from .text import Untidy, line_starts, pick_lines, plain_lines, read_records, tidy
from .weld import weld_exact

_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_HEADER = 84
_KEYWORD = re.compile(rb"\s*\b(endsolid|facet|outer|vertex|endloop|endfacet)\b")
ASCII_SIGN = re.compile(rb"(?:\xef\xbb\xbf)?\s*solid\b", re.IGNORECASE)


def parse_stl(data: bytes, *, weld: bool = True, max_faces: int | None = None) -> MeshFile:
    """The content of an STL file: one vertex per distinct position in order of first appearance, or one per corner.

    Positions are exactly those of the file (float32 in binary files); normals and attributes are ignored.
    Errors: InputError where data are missing or a facet has not three vertices.
    """
    as_text = is_ascii_stl(data)
    xyz, notices = _read_ascii(data, max_faces) if as_text else _read_binary(data, max_faces)
    if not xyz.shape[1]:
        hint = "a surface needs at least one facet"
        if as_text and b"\0" in data:
            hint = (
                "it begins with `solid` as text does, and as binary STL its counter asks for "
                f"{announced_size(data)} bytes, not {len(data)}"
            )
        raise InputError("no faces", hint=hint)
    if weld:
        first, corners = weld_exact(xyz)
        xyz = xyz[:, first]
    else:
        corners = np.arange(xyz.shape[1], dtype=np.int32)
    return MeshFile("stl", np.ascontiguousarray(xyz, np.float64), corners, notices=notices)


def announced_size(data: bytes) -> int:
    """The size of a binary STL file with the number of facets that the counter holds."""
    return _HEADER + 50 * int.from_bytes(data[80:_HEADER], "little")


def is_ascii_stl(data: bytes) -> bool:
    """Whether the content is ASCII STL; a size that fits the counter decides for binary, whatever the header says."""
    if len(data) >= _HEADER and len(data) == announced_size(data):
        return False
    return bool(ASCII_SIGN.match(data))


def _read_binary(data: bytes, max_faces: int | None) -> tuple[NDArray[np.float32], tuple[Notice, ...]]:
    if len(data) < _HEADER:
        raise InputError(f"{len(data)} bytes found, at least {_HEADER} expected, or text that begins with `solid`")
    count = (announced_size(data) - _HEADER) // 50
    missing = announced_size(data) - len(data)
    if missing > 0:
        raise InputError(
            f"{count} facets announced, room for {(len(data) - _HEADER) // 50} found: {missing} bytes are missing",
            place="byte 80",
        )
    check_faces(count, max_faces)
    facets = np.frombuffer(data, _FACET, count, _HEADER)
    xyz = np.empty((3, 3 * count), np.float32)
    for k in range(3):
        xyz[k].reshape(-1, 3)[:] = facets["corners"][:, :, k]
    trailing = Notice("trailing_data", -missing, "bytes after the announced facets are ignored")
    return xyz, (trailing,) if missing < 0 else ()


def _read_ascii(data: bytes, max_faces: int | None) -> tuple[NDArray[np.float64], tuple[Notice, ...]]:
    text = tidy(plain_lines(data))
    try:
        return _read_lines(text, max_faces)
    except Untidy:
        # Several keywords share a line: give each its own, which costs the line numbers of the file.
        return _read_lines(re.sub(_KEYWORD, rb"\n\1", text.lower()).lstrip(b"\n"), max_faces, place="statement")


def _read_lines(
    data: bytes, max_faces: int | None, place: str = "line"
) -> tuple[NDArray[np.float64], tuple[Notice, ...]]:
    text = np.frombuffer(data, np.uint8)
    starts = line_starts(text)
    first = text[starts[:-1]] | 32
    is_facet, is_vertex = first == ord("f"), first == ord("v")
    facets, vertices = np.flatnonzero(is_facet), np.flatnonzero(is_vertex)
    check_faces(len(facets), max_faces)
    if place == "line" and len(re.findall(rb"vertex", data, re.IGNORECASE)) > len(vertices):
        raise Untidy
    if not len(facets):
        return np.empty((3, 0)), ()
    per_facet = np.diff(np.searchsorted(vertices, facets), append=len(vertices))
    wrong = np.flatnonzero(per_facet != 3)
    if len(wrong) or vertices[0] < facets[0]:
        at = int(facets[wrong[0]]) if len(wrong) else int(vertices[0])
        found = f"facet with {per_facet[wrong[0]]} vertices" if len(wrong) else "vertex outside a facet"
        raise InputError(f"{found} found, 3 per facet expected", place=f"{place} {at + 1}")
    try:
        records = read_records(pick_lines(data, starts, is_vertex), np.float64)
    except Untidy as untidy:
        token, line = untidy.token.decode("utf-8", "backslashreplace"), int(vertices[untidy.row])
        raise InputError(f"`{token}` found, a number expected", place=f"{place} {line + 1}") from None
    sizes = np.broadcast_to(records.sizes, len(vertices))
    if (sizes != 3).any():
        row = int(np.flatnonzero(sizes != 3)[0])
        raise InputError(
            f"vertex with {sizes[row]} numbers found, 3 expected", place=f"{place} {int(vertices[row]) + 1}"
        )
    solids = np.count_nonzero(first == ord("s"))
    notices = (Notice("several_solids", int(solids), "solids are read as one surface"),) if solids > 1 else ()
    return np.ascontiguousarray(records.flat().reshape(-1, 3).T), notices

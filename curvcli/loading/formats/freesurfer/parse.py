"""Binary FreeSurfer surfaces: triangles, or quadrangles of old files, in big-endian numbers."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, Notice
from ....mesh.file import MeshFile
from ....support.blocks import slices
from ....support.words import number_of, pluralize
from ...corners import checked_corners
from ...limits import check_faces
from ...pieces import Pieces
from . import OLD_QUADS, QUADS, TRIANGLES, is_overlay

_MAGIC = 3
_BLANKS = re.compile(rb"[ \t\r\n]*")
# Behind the faces: the geometry of the volume, then command lines, as FreeSurfer and nibabel write them.
_FOOTER = re.compile(rb"(?:\0\0\0\x02\0\0\0[\0\x01])?(?:\0\0\0\x14valid\b|\0\0\0\x03\0\0\0\0|\Z)")
_SHIFTED = re.compile(rb".{0,12}?valid *=", re.DOTALL)


def parse_binary(pieces: Pieces, *, max_faces: int | None = None) -> MeshFile:
    """Parse a binary FreeSurfer surface: vertices and polygons in file order, coordinates as they stand in the file.

    The geometry of the volume (`cras` and others) is not applied: FreeSurfer's own tools do not move vertices either.
    Errors: InputError where data are missing or the content is none of these surfaces.
    """
    start = pieces.ahead()
    if start.startswith(TRIANGLES):
        return _triangles(pieces, start, max_faces)
    if is_overlay(start, pieces.size):
        raise InputError(
            f"values of {number_of(int.from_bytes(start[3:7], 'big'), 'vertex', 'vertices')} found, a surface expected",
            hint="give the surface, such as lh.white; `--regions` takes files of labels",
        )
    if start.startswith((QUADS, OLD_QUADS)):
        return _quadrangles(pieces, max_faces)
    raise InputError(
        "neither the first bytes ff ff fe of a FreeSurfer surface nor the first line `#!ascii` of its text found",
        hint="labels such as .annot go to `--regions`",
    )


def _triangles(pieces: Pieces, start: bytes, max_faces: int | None) -> MeshFile:
    line = start.find(b"\n", _MAGIC)
    if line < 0:
        raise InputError("no end of the comment found behind the first three bytes", place=f"byte {_MAGIC}")
    blanks = _BLANKS.match(start, line)
    assert blanks is not None
    pieces.take(blanks.end())
    vertices, faces = _counts(pieces, 4, blanks.end())
    check_faces(max(faces, 0), max_faces)
    _require_room(pieces.left, vertices, faces, 12, 12, "triangle", blanks.end())
    xyz = _positions(pieces, vertices, ">f4")
    corners = np.empty(3 * faces, np.int32)
    for block in slices(len(corners), pieces.longest // 4 or 1):
        corners[block] = np.frombuffer(pieces.take(4 * (block.stop - block.start)), ">i4")
    return _mesh(pieces, xyz, checked_corners(corners, 3, "face", vertices), None)


def _quadrangles(pieces: Pieces, max_faces: int | None) -> MeshFile:
    old = bytes(pieces.take(_MAGIC)) == OLD_QUADS
    vertices, faces = _counts(pieces, 3, _MAGIC)
    check_faces(faces, max_faces)
    _require_room(pieces.left, vertices, faces, 6 if old else 12, 12, "quadrangle", _MAGIC)
    xyz = _positions(pieces, vertices, ">i2" if old else ">f4")
    if old:
        xyz /= 100.0
    corners = np.empty(4 * faces, np.int32)
    for block in slices(len(corners), pieces.longest // 3 or 1):
        digits = np.frombuffer(pieces.take(3 * (block.stop - block.start)), np.uint8).reshape(-1, 3)
        corners[block] = digits @ np.array([65536, 256, 1], np.int32)
    return _mesh(pieces, xyz, checked_corners(corners, 4, "face", vertices), np.full(faces, 4, np.int32))


def _counts(pieces: Pieces, width: int, place: int) -> tuple[int, int]:
    """The numbers of vertices and faces, integers of so many bytes."""
    if pieces.left < 2 * width:
        raise InputError("the data end before the numbers of vertices and faces", place=f"byte {place}")
    data = bytes(pieces.take(2 * width))
    vertices, faces = (int.from_bytes(part, "big", signed=width == 4) for part in (data[:width], data[width:]))
    if vertices < 0 or faces < 0:
        raise InputError(
            f"{vertices} vertices and {faces} faces announced, none negative expected", place=f"byte {place}"
        )
    if not faces:
        raise InputError("no faces", hint="a surface needs at least one face")
    return vertices, faces


def _require_room(room: int, vertices: int, faces: int, of_vertex: int, of_face: int, name: str, place: int) -> None:
    missing = of_vertex * vertices + of_face * faces - room
    if missing > 0:
        announced = f"{number_of(vertices, 'vertex', 'vertices')} and {number_of(faces, name)} announced"
        raise InputError(
            f"{announced}, but {number_of(missing, 'byte')} {pluralize(missing, '[is|are]')} missing",
            place=f"byte {place}",
        )


def _positions(pieces: Pieces, vertices: int, kind: str) -> NDArray[np.float64]:
    size = 3 * np.dtype(kind).itemsize
    xyz = np.empty((3, vertices))
    for block in slices(vertices, pieces.longest // size or 1):
        xyz[:, block] = np.frombuffer(pieces.take(size * (block.stop - block.start)), kind).reshape(-1, 3).T
    return xyz


def _mesh(
    pieces: Pieces, xyz: NDArray[np.float64], corners: NDArray[np.int32], sizes: NDArray[np.int32] | None
) -> MeshFile:
    notices: tuple[Notice, ...] = ()
    behind = pieces.ahead()
    if _SHIFTED.match(behind) and not _FOOTER.match(behind):
        raise InputError(
            "the geometry of the volume begins amid the faces", hint="the numbers of vertices and faces are too large"
        )
    if not _FOOTER.match(behind):
        message = pluralize(pieces.left, "[byte|bytes] after the announced faces, ignored")
        hint = "if the number of faces in the header is too small, faces are missing"
        notices = (Notice("trailing_data", pieces.left, message, hint),)
    return MeshFile("freesurfer", xyz, corners, sizes, notices=notices)

"""The rows of a binary OFF file: big-endian, 4 bytes per number."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError
from ....support.words import number_of, pluralize
from ...limits import check_faces
from ...pieces import Pieces
from .content import Content
from .keyword import Keyword


def read_binary(pieces: Pieces, keyword: Keyword, max_faces: int | None) -> tuple[Content, int]:
    """Read counts, vertices and faces; also returns the number of faces.

    A face is its number of corners, the corners, its number of colour components, and these as floats.
    Errors: InputError where the data end early, or with the face of a wrong length.
    """
    if pieces.left < 12:
        raise InputError("the data end before the numbers of vertices, faces and edges")
    vertices, faces, _ = np.frombuffer(pieces.take(12), ">i4").tolist()
    width, left = keyword.most, pieces.left // 4
    if min(vertices, faces) < 0 or vertices * width + 2 * faces > left:
        announced = f"{number_of(vertices, 'vertex', 'vertices')} and {number_of(faces, 'face')} announced"
        raise InputError(f"{announced}, more than the {pieces.left} bytes that follow can hold")
    check_faces(faces, max_faces)
    data = pieces.rest()
    numbers = np.frombuffer(data, ">u4", len(data) // 4)
    with np.errstate(invalid="ignore"):
        rows = numbers[: vertices * width].view(">f4").reshape(vertices, width).astype(np.float64)
    columns = list(np.ascontiguousarray(rows.T))
    body = numbers[vertices * width :]
    sizes, extra = _even(body, faces) or _uneven(body, faces)
    per_face = np.broadcast_to(np.asarray(sizes, np.int64), faces), np.broadcast_to(np.asarray(extra, np.int64), faces)
    corner, colour = _masks(*per_face)
    used = body[: len(corner)]
    left = len(data) - 4 * (vertices * width + len(corner))
    trailing = (left, pluralize(left, "[byte|bytes] after the announced faces, ignored"))
    corners = used[corner].view(">i4").astype(np.int32)
    with np.errstate(invalid="ignore"):
        colours = used[colour].view(">f4").astype(np.float64)
    return Content(columns, sizes, corners, extra, colours, lambda row: f"face {row}", trailing), faces


def _even(body: NDArray[np.uint32], faces: int) -> tuple[int, int] | None:
    """Corners and components of all faces if these are those of the first; None otherwise."""
    if not faces:
        return 0, 0
    size = int(body[0])
    extra = int(body[1 + size]) if 1 + size < len(body) else len(body)
    step = 2 + size + extra
    if step * faces > len(body):
        return None
    rows = body[: step * faces].reshape(faces, step)
    return (size, extra) if (rows[:, 0] == size).all() and (rows[:, 1 + size] == extra).all() else None


def _uneven(body: NDArray[np.uint32], faces: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Corners and components of each face. A Python loop, because the place of a face depends on the face before."""
    numbers, at, sizes, extra = body.tolist(), 0, [0] * faces, [0] * faces
    for row in range(faces):
        size = numbers[at] if at < len(numbers) else len(numbers)
        after = at + 1 + size
        count = numbers[after] if after < len(numbers) else len(numbers)
        at = after + 1 + count
        if at > len(numbers):
            raise InputError(f"the data end inside a face of {number_of(size, 'corner')}", place=f"face {row}")
        sizes[row], extra[row] = size, count
    return np.array(sizes, np.int64), np.array(extra, np.int64)


def _masks(sizes: NDArray[np.int64], extra: NDArray[np.int64]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Masks of the words of the faces that are corners, and that are components of colours."""
    step = sizes + extra + 2
    begin = np.cumsum(step) - step
    kind = np.ones(int(step.sum()), np.bool_)
    kind[begin] = False
    kind[begin + 1 + sizes] = False
    behind = np.arange(len(kind)) - np.repeat(begin + 1 + sizes, step)
    return kind & (behind < 0), kind & (behind > 0)

"""Text of a FreeSurfer surface: counts, then rows of coordinates and of corners, each with a flag."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, Notice
from ....mesh.file import MeshFile
from ....support.words import number_of, pluralize
from ...corners import checked_corners
from ...limits import check_faces
from ...text import drop_empty_lines, line_starts, plain_lines, read_tokens, tidy

_PER_ROW = 4


def parse_text(data: bytes, *, max_faces: int | None = None) -> MeshFile:
    """Parse `#!ascii`, `V F`, V rows `x y z flag` and F rows `a b c flag`; the flags (ripped) are ignored.

    Errors: InputError with the line of a wrong number, or where rows are missing.
    """
    body, line = drop_empty_lines(tidy(plain_lines(data)))
    starts = line_starts(np.frombuffer(body, np.uint8))
    counts = body[starts[1] : starts[2]].split() if len(starts) > 2 else []
    try:
        vertices, faces = (int(count) for count in counts)
    except ValueError:
        raise InputError("the numbers of vertices and faces expected", place="line 2") from None
    check_faces(faces, max_faces)
    rows = len(starts) - 3
    if vertices < 0 or faces < 1 or rows < vertices + faces:
        announced = f"{number_of(vertices, 'vertex', 'vertices')} and {number_of(faces, 'triangle')} announced"
        raise InputError(f"{announced}, {number_of(rows, 'row')} found", place="line 2")
    ends = starts[2], starts[2 + vertices], starts[2 + vertices + faces]
    xyz = _rows(body[ends[0] : ends[1]], np.float64, line[2:])
    corners = _rows(body[ends[1] : ends[2]], np.int32, line[2 + vertices :])
    rest = rows - vertices - faces
    notices: tuple[Notice, ...] = ()
    if rest:
        message = pluralize(rest, "[line|lines] after the announced rows, ignored")
        hint = "if the number of faces in line 2 is too small, faces are missing"
        notices = (Notice("trailing_data", rest, message, hint),)
    flat = checked_corners(corners.reshape(-1), 3, "face", vertices)
    return MeshFile("freesurfer", np.ascontiguousarray(xyz.T, np.float64), flat, notices=notices)


def _rows(text: bytes, dtype: type[np.generic], line: NDArray[np.int64]) -> NDArray[np.generic]:
    """(rows, 3) the first three numbers of each row of four."""
    if not text:
        return np.empty((0, 3), dtype)
    numbers, known = read_tokens(text, dtype)
    blanks = np.frombuffer(text, np.uint8)
    ends = np.flatnonzero(blanks == ord("\n"))
    of_row = np.diff(np.cumsum((blanks == ord(" ")) | (blanks == ord("\n")))[ends], prepend=0)
    wrong = np.flatnonzero(of_row != _PER_ROW)
    if len(wrong):
        problem = f"{number_of(int(of_row[wrong[0]]), 'word')} found, three numbers and a flag expected"
        raise InputError(problem, place=f"line {line[wrong[0]] + 1}")
    wrong = np.flatnonzero(~known)
    if len(wrong):
        row = int(wrong[0]) // _PER_ROW
        word = text.split(b"\n", row + 1)[row].split(b" ")[wrong[0] % _PER_ROW][:40].decode("utf-8", "backslashreplace")
        raise InputError(f"`{word}` found, a number expected", place=f"line {line[row] + 1}")
    return numbers.reshape(-1, _PER_ROW)[:, :3]

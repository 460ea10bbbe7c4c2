"""OFF: vertices and polygons in file order, with the properties of both."""

from __future__ import annotations

import re

from ....errors import InputError
from ....mesh.file import MeshFile
from ....support.words import number_of
from ...limits import check_faces
from ...pieces import Pieces
from ...text import plain_lines
from .binary import read_binary
from .content import make_mesh
from .keyword import SIGN, parse_keyword
from .text import read_text

_BINARY = re.compile(rb"[ \t]+BINARY[ \t]*(?:\r\n|\n|\r)")
_TOKEN = re.compile(rb"\S+")
_COMMENT = re.compile(rb"#[^\n]*")
_ROOM = 1 << 16
_COUNT = re.compile(rb"\+?\d{1,18}")


def parse_off(pieces: Pieces, *, max_faces: int | None = None) -> MeshFile:
    """Parse an OFF file.

    Faces have any number of corners. Behind its corners a face may have an index of a colour map, or a colour of 3 or 4
    numbers; the letters before OFF name the values of vertices. The first word may be missing.
    Errors: InputError with the line of a malformed row.
    """
    sign = SIGN.match(pieces.ahead())
    keyword = parse_keyword(sign[1].decode() if sign else "")
    if sign and (mark := _BINARY.match(pieces.ahead(), sign.end())):
        pieces.take(mark.end())
        content, faces = read_binary(pieces, keyword, max_faces)
        return make_mesh(keyword, content, faces)
    text = plain_lines(pieces.rest())
    vertices, faces, body = 0, 0, -1
    if (last := text.rfind(b"#")) >= 0:
        head, behind = _COMMENT.sub(b"", text[:last]), text.index(b"\n", last)
        vertices, faces, body = _counts(head + text[behind : behind + _ROOM])
        body += behind - len(head)
        if body < behind:  # comments between the rows
            text, body = b"".join((head, text[behind:])), -1
    if body < 0:
        vertices, faces, body = _counts(text)
    check_faces(faces, max_faces)
    # A position has at least three numbers, a face its count, each with a blank or a line end.
    if 6 * vertices + 2 * faces > len(text) - body + 1:
        announced = f"{number_of(vertices, 'vertex', 'vertices')} and {number_of(faces, 'face')} announced"
        raise InputError(f"{announced}, more than the {len(text) - body} bytes that follow can hold")
    return make_mesh(keyword, read_text(text, body, keyword, vertices, faces), faces)


def _counts(text: bytes) -> tuple[int, int, int]:
    """The numbers of vertices and faces, and the place behind them and the number of edges, which may be missing."""
    sign = SIGN.match(text)
    begin = sign.end() if sign else 0
    counts: list[int] = []
    lines: list[int] = []
    at, line = begin, text.count(b"\n", 0, begin)
    end = begin
    for token in _TOKEN.finditer(text, begin):
        line += text.count(b"\n", at, token.start())
        at = token.start()
        if len(counts) == 2 and lines[0] == lines[1] < line:
            break
        if not _COUNT.fullmatch(token[0]):
            spelling = token[0][:40].decode("utf-8", "backslashreplace")
            expected = "`OFF`, or the" if not begin and not counts else "the"
            problem = f"`{spelling}` found, {expected} number of {('vertices', 'faces', 'edges')[len(counts)]} expected"
            raise InputError(problem, place=f"line {line + 1}")
        counts.append(int(token[0]))
        lines.append(line)
        end = token.end()
        if len(counts) == 3:
            break
    if len(counts) < 2:
        raise InputError("the data end before the numbers of vertices and faces")
    return counts[0], counts[1], end

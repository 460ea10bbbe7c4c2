"""STL, binary and ASCII: triangles as three corners each, welded by exact equality of their positions."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, Notice
from ....mesh.file import Labels, MeshFile
from ....mesh.welding import weld_exact
from ....support.blocks import slices
from ....support.words import number_of, pluralize
from ...limits import check_faces
from ...pieces import Pieces
from ...text import BLANK, NEWLINE, Untidy, line_starts, pick_lines, plain_lines, read_records, tidy, without_comments
from .sign import ASCII_SIGN, HEADER, announced_size, has_room
from .solids import TextFacets, label_solids
from .tokens import read_ascii_tokens

_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_TEXT = "it is text, and text that is STL begins with `solid`"
# A name may hold any word, but no facet.
_SHARED = re.compile(
    rb"(?!(?:end)?solid\b).* facet(?: |$)|(?:end)?solid\b.* facet (?:normal|outer)(?: |$)", re.IGNORECASE
)
_VERTEX_BEHIND = re.compile(rb"(?im)^(?!(?:end)?solid\b).* vertex\b")
# The least lengths of a line with a facet behind other words, and behind a facet.
_FACET_BEHIND = len(b"solid facet outer")
_FULL_FACET = len(b"facet outer loop vertex 0 0 0 vertex 0 0 0 vertex 0 0 0 endloop endfacet facet") - 1


def parse_stl(pieces: Pieces, *, weld: bool = True, max_faces: int | None = None) -> MeshFile:
    """Parse an STL file: one vertex per distinct position in order of first appearance, or one per corner.

    Positions are exactly those of the file (float32 in binary files); normals and attributes are ignored.
    Errors: InputError where data are missing or a facet has not three vertices.
    """
    xyz: NDArray[np.float32] | NDArray[np.float64]
    labels: dict[str, Labels] = {}
    hint = "a surface needs at least one facet"
    # Text never announces fewer facets than it has room for: letters in the counter give large numbers.
    if not has_room(pieces.ahead(), pieces.size) and ASCII_SIGN.match(pieces.whole()):
        data = pieces.rest()
        if b"\0" in data:
            hint = (
                "it begins with `solid` as text does, and as binary STL its counter asks for "
                f"{announced_size(data)} bytes, not {len(data)}"
            )
        xyz, notices, solids = _read_ascii(data, max_faces)
        labels["solids"] = solids
    else:
        xyz, notices = _read_binary(pieces, max_faces)
    if not xyz.shape[1]:
        raise InputError("no faces", hint=hint)
    if weld:
        first, corners = weld_exact(xyz)
        xyz = xyz[:, first]
    else:
        corners = np.arange(xyz.shape[1], dtype=np.int32)
    return MeshFile("stl", np.ascontiguousarray(xyz, np.float64), corners, polygon_labels=labels, notices=notices)


def _read_binary(pieces: Pieces, max_faces: int | None) -> tuple[NDArray[np.float32], tuple[Notice, ...]]:
    size = pieces.left
    if size < HEADER:
        raise InputError(
            f"{number_of(size, 'byte')} found, at least {HEADER} expected, or text that begins with `solid`"
        )
    header = pieces.take(HEADER)
    count = (announced_size(header) - HEADER) // 50
    missing = announced_size(header) - size
    if missing > 0:
        raise InputError(
            f"{number_of(count, 'facet')} announced, room for {(size - HEADER) // 50} found: "
            f"{number_of(missing, 'byte')} {pluralize(missing, '[is|are]')} missing",
            place="byte 80",
            hint=None if b"\0" in bytes(header) + pieces.whole() else _TEXT,
        )
    check_faces(count, max_faces)
    xyz = np.empty((3, 3 * count), np.float32)
    for block in slices(count, max(pieces.longest // _FACET.itemsize, 1)):
        facets = np.frombuffer(pieces.take(_FACET.itemsize * (block.stop - block.start)), _FACET)
        for k in range(3):
            xyz[k].reshape(-1, 3)[block] = facets["corners"][:, :, k]
    message = pluralize(-missing, "[byte|bytes] after the announced facets, ignored")
    trailing = Notice("trailing_data", -missing, message, "if the count at byte 80 is too small, facets are missing")
    return xyz, (trailing,) if missing < 0 else ()


def _read_ascii(data: bytes, max_faces: int | None) -> TextFacets:
    text = tidy(plain_lines(data))
    if b"#" in text:
        text = tidy(without_comments(text, but_in=b"sS"))  # the name of a solid
    problem = None
    try:
        facets = _read_lines(text, max_faces)
    except Untidy:
        pass
    except InputError as error:
        if b"\0" in data:
            raise  # binary data among the text: tokens would pass over them
        problem = error
    else:
        if all(notice.code != "unknown_statements" for notice in facets.notices):
            return facets
        # Lines that begin with no keyword may continue a statement.
        try:
            others = read_ascii_tokens(text, max_faces)
        except InputError:
            return facets
        known = all(notice.code != "unknown_statements" for notice in others.notices)
        return others if known and others.xyz.shape == facets.xyz.shape else facets
    try:
        return read_ascii_tokens(text, max_faces)
    except InputError as error:
        # With one line per vertex, the wrong number of vertices is a better message than the first wrong token.
        raise (error if problem is None or _VERTEX_BEHIND.search(text) else problem) from None


def _share_lines(data: bytes, starts: NDArray[np.int64], first: NDArray[np.integer]) -> bool:
    """Test whether a facet begins behind another statement on its line; only long enough lines are tested."""
    room = np.full(256, _FACET_BEHIND)
    room[list(b"fvoe")] = _FULL_FACET, len(data) + 1, len(b"outer loop"), len(b"endfacet")
    lengths = np.diff(starts) - 1
    for line in np.flatnonzero(lengths > room[first]).tolist():
        if _SHARED.match(data, int(starts[line]), int(starts[line + 1]) - 1):
            return True
    return False


def _read_lines(data: bytes, max_faces: int | None) -> TextFacets:
    starts = line_starts(np.frombuffer(data, np.uint8))
    first = np.frombuffer(data, np.uint8)[starts[:-1]] | 32  # lower case
    if _share_lines(data, starts, first):
        raise Untidy
    facets, vertices = np.flatnonzero(first == ord("f")), np.flatnonzero(first == ord("v"))
    check_faces(len(facets), max_faces)
    if not len(facets):
        raise Untidy
    _check_keywords(data, starts, facets, b"facet")
    _check_keywords(data, starts, vertices, b"vertex")
    _check_facets(facets, vertices)
    statements = first[(first != NEWLINE | 32) & (first != ord("s"))]
    if statements[-1] != ord("e"):
        raise InputError("the data end inside a facet; `endfacet` expected", place=f"line {len(first)}")
    try:
        records = read_records(pick_lines(data, starts, first == ord("v")), np.float64)
    except Untidy as untidy:
        token, line = untidy.token.decode("utf-8", "backslashreplace"), int(vertices[untidy.row])
        raise InputError(f"`{token}` found, a number expected", place=f"line {line + 1}") from None
    sizes = np.broadcast_to(records.sizes, len(vertices))
    if (sizes != 3).any():
        row = int(np.flatnonzero(sizes != 3)[0])
        place = f"line {int(vertices[row]) + 1}"
        raise InputError(f"vertex with {number_of(int(sizes[row]), 'number')} found, 3 expected", place=place)
    notices = []
    solids = int(np.count_nonzero(first == ord("s")))
    if solids > 1:
        hint = "`components` of the report keeps apart those that do not touch"
        notices.append(Notice("several_solids", solids, "solids, read as one surface", hint))
    if not re.search(rb"(?:^|\n)endsolid[^\n]*\n*\Z", data[-65536:], re.IGNORECASE):
        hint = "if it was cut off, faces are missing"
        notices.append(Notice("missing_endsolid", 1, "text that ends without `endsolid`", hint))
    known = np.frombuffer(b"fove*s" + bytes([NEWLINE | 32]), np.uint8)
    unknown = np.flatnonzero(~np.isin(first, known))
    if len(unknown):
        message = pluralize(len(unknown), "[statement|statements] that STL does not know, ignored")
        notices.append(Notice("unknown_statements", len(unknown), message, f"the first is in line {unknown[0] + 1}"))
    lines = np.flatnonzero(first == ord("s")).tolist()
    names = [data[starts[line] : starts[line + 1]].partition(b" ")[2] for line in lines]
    labels = label_solids(np.searchsorted(facets, lines).tolist(), names, len(facets))
    return TextFacets(np.ascontiguousarray(records.flat().reshape(-1, 3).T), tuple(notices), labels)


def _check_keywords(data: bytes, starts: NDArray[np.int64], lines: NDArray[np.intp], word: bytes) -> None:
    """Refuse lines that begin like a keyword but differ from it."""
    letters = np.frombuffer(data, np.uint8)
    wrong = np.zeros(len(lines), np.bool_)
    for k, letter in enumerate(word + b" "):
        at = letters.take(starts[lines] + k, mode="clip")
        wrong |= (at | 32) != letter if letter != BLANK else (at != BLANK) & (at != NEWLINE)
    if wrong.any():
        line = int(lines[np.flatnonzero(wrong)[0]])
        token = data[starts[line] : starts[line + 1]].split()[0][:40].decode("utf-8", "backslashreplace")
        raise InputError(f"`{token}` found, `{word.decode()}` expected", place=f"line {line + 1}")


def _check_facets(facets: NDArray[np.intp], vertices: NDArray[np.intp]) -> None:
    """Refuse facets without exactly three vertices."""
    if len(vertices) and vertices[0] < facets[0]:
        raise InputError("vertex outside a facet found", place=f"line {int(vertices[0]) + 1}")
    per_facet = np.diff(np.searchsorted(vertices, facets), append=len(vertices))
    wrong = np.flatnonzero(per_facet != 3)
    if len(wrong):
        count = int(per_facet[wrong[0]])
        place = f"line {int(facets[wrong[0]]) + 1}"
        raise InputError(f"facet with {number_of(count, 'vertex', 'vertices')} found, 3 expected", place=place)

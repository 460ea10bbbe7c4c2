"""STL, text or binary: triangles that share no vertices."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...registry import InputFormat, ParserOptions, register
from .sign import ASCII_SIGN, has_room, is_binary_stl

if TYPE_CHECKING:
    from ....mesh.file import MeshFile
    from ...pieces import Pieces


def has_sign(pieces: Pieces) -> bool:
    """Test for the length that the counter of binary STL gives, or for `solid` at the start and a facet."""
    start = pieces.ahead()
    if is_binary_stl(start, pieces.size):
        return True
    return bool(ASCII_SIGN.match(start)) and (b"facet" in start.lower() or has_room(start, pieces.size))


def any_start(start: bytes, size: int, promised: bool) -> bool:
    """Test for binary STL, whose first 80 bytes are free."""
    return is_binary_stl(start, size) or (promised and has_room(start, size))


def _parse(pieces: Pieces, options: ParserOptions) -> MeshFile:
    from .parse import parse_stl

    return parse_stl(pieces, weld=options.merge, max_faces=options.max_faces)


register(
    InputFormat(
        name="stl",
        parse=_parse,
        has_sign=has_sign,
        any_start=any_start,
        separate_corners=True,
        encodings="text, binary",
        rows="one per distinct position, in order of first appearance",
        digits="float32 in binary files, doubles in text",
        labels="`solid` of text, as `solids`",
        polygons="triangles only",
    )
)

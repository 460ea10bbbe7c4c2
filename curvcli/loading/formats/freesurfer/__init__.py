"""FreeSurfer surfaces, such as lh.white and rh.pial: binary triangles, old quadrangles, or text (.asc)."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ...registry import InputFormat, ParserOptions, register

if TYPE_CHECKING:
    from ....mesh.file import MeshFile
    from ...pieces import Pieces

TRIANGLES, QUADS, OLD_QUADS = b"\xff\xff\xfe", b"\xff\xff\xfd", b"\xff\xff\xff"
TEXT = re.compile(rb"#!ascii(?! *label)[^\r\n]*[\r\n]")


def has_sign(pieces: Pieces) -> bool:
    """Test for the first three bytes of a surface, or the first line `#!ascii` of its text."""
    start = pieces.ahead()
    if start.startswith(OLD_QUADS):
        return not is_overlay(start, pieces.size)
    return start.startswith((TRIANGLES, QUADS)) or bool(TEXT.match(start))


def is_overlay(start: bytes, size: int) -> bool:
    """Test for values of vertices, such as lh.curv: they begin as old quadrangles do, with one float per vertex."""
    vertices = int.from_bytes(start[3:7], "big")
    return start.startswith(OLD_QUADS) and len(start) >= 15 and size == 15 + 4 * vertices


def _parse(pieces: Pieces, options: ParserOptions) -> MeshFile:
    if TEXT.match(pieces.ahead()):
        from .text import parse_text

        return parse_text(pieces.rest(), max_faces=options.max_faces)
    from .parse import parse_binary

    return parse_binary(pieces, max_faces=options.max_faces)


register(
    InputFormat(
        name="freesurfer",
        full_name="FreeSurfer",
        parse=_parse,
        has_sign=has_sign,
        suffixes=("white", "pial", "inflated", "sphere", "orig", "smoothwm", "asc"),
        starts=("lh.", "rh."),
        encodings="binary, text (`.asc`)",
        digits="float32; hundredths in old files of quadrangles; doubles in text",
        polygons="triangles; quadrangles of old files, triangulated",
    )
)

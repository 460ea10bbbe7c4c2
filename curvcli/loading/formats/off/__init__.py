"""OFF of Geomview, text or binary, with normals, colours and texture coordinates of vertices and colours of faces."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...registry import InputFormat, ParserOptions, register
from .keyword import SIGN

if TYPE_CHECKING:
    from ....mesh.file import MeshFile
    from ...pieces import Pieces


def has_sign(pieces: Pieces) -> bool:
    """Test for a first word such as OFF, COFF or STOFF, behind comments."""
    return bool(SIGN.match(pieces.ahead()))


def _parse(pieces: Pieces, options: ParserOptions) -> MeshFile:
    from .parse import parse_off

    return parse_off(pieces, max_faces=options.max_faces)


register(
    InputFormat(
        name="off",
        parse=_parse,
        has_sign=has_sign,
        encodings="text, big-endian binary",
        rows="vertices",
        digits="doubles in text, float32 in binary files",
        keeps="normals, colours and texture coordinates of vertices, colours of faces",
        labels="`color_index` of faces",
    )
)

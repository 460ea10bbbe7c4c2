"""PLY: elements of vertices, faces and triangle strips, with properties of any name."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ...registry import InputFormat, ParserOptions, register

if TYPE_CHECKING:
    from ....mesh.file import MeshFile
    from ...pieces import Pieces

_SIGN = re.compile(rb"(?:\xef\xbb\xbf)?ply[ \t]*[\r\n]")


def has_sign(pieces: Pieces) -> bool:
    """Test for a first line `ply`."""
    return bool(_SIGN.match(pieces.ahead()))


def _parse(pieces: Pieces, options: ParserOptions) -> MeshFile:
    from .parse import parse_ply

    return parse_ply(pieces, max_faces=options.max_faces)


register(
    InputFormat(
        name="ply",
        parse=_parse,
        has_sign=has_sign,
        encodings="text, binary of either byte order",
        rows="`vertex` elements",
        digits="of the declared type",
        keeps="scalar properties of vertices and faces",
        labels="integer face properties",
        polygons="triangulated; `tristrips` too",
    )
)

"""GIFTI (.surf.gii): XML with one array of positions and one of triangles, read by nibabel."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ...registry import InputFormat, ParserOptions, register

if TYPE_CHECKING:
    from ....mesh.file import MeshFile
    from ...pieces import Pieces

_SIGN = re.compile(rb"(?:\xef\xbb\xbf)?\s*<.*?<GIFTI\b|\s*<GIFTI\b", re.DOTALL)


def has_sign(pieces: Pieces) -> bool:
    """Test for XML with the element GIFTI near its start."""
    return bool(_SIGN.match(pieces.ahead()[:4096]))


def _parse(pieces: Pieces, options: ParserOptions) -> MeshFile:
    from .parse import parse_gifti

    return parse_gifti(pieces.rest(), max_faces=options.max_faces)


register(
    InputFormat(
        name="gii",
        full_name="GIFTI",
        parse=_parse,
        has_sign=has_sign,
        encodings="ASCII, base64, base64 of zlib data, of either byte order",
        rows="positions (`NIFTI_INTENT_POINTSET`)",
        digits="of the declared type, mostly float32",
        keeps="arrays of vertices",
        labels="arrays of labels with their table",
        polygons="triangles only",
        library="nibabel",
        extra="cortex",
    )
)

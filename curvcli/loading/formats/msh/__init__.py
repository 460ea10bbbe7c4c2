"""Gmsh meshes: versions 2, 4.0 and 4.1, text and binary of either byte order."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ...registry import InputFormat, ParserOptions, register

if TYPE_CHECKING:
    from ....mesh.file import MeshFile
    from ...pieces import Pieces

_SIGN = re.compile(rb"\s*\$(?:MeshFormat|Comments?|PhysicalNames|NOD)\b")


def has_sign(pieces: Pieces) -> bool:
    """Test for a section `$MeshFormat` at the start, or behind comments."""
    start = pieces.ahead()
    return bool(_SIGN.match(start)) and (b"$MeshFormat" in start or b"$NOD" in start)


def _parse(pieces: Pieces, options: ParserOptions) -> MeshFile:
    from .parse import parse_msh

    return parse_msh(pieces.rest(), options)


register(
    InputFormat(
        name="msh",
        parse=_parse,
        has_sign=has_sign,
        encodings="text, binary of either byte order, versions 2 to 4.1",
        rows="nodes",
        keeps="`entity` of each face",
        labels="physical groups as `groups`",
        polygons="triangles and quadrilaterals; quadrilaterals triangulated",
        curves="lines",
    )
)

"""Datafiles and dumps of the Surface Evolver: vertices, edges, facets as oriented lists of edges, and bodies."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ...registry import InputFormat, ParserOptions, register

if TYPE_CHECKING:
    from ....mesh.file import MeshFile
    from ...pieces import Pieces

# The list of vertices begins with a row of a number and a coordinate; other formats have the number of vertices there.
_SIGN = re.compile(
    rb"(?:^|[\r\n])[ \t]*+vertices[ \t]*+:?[ \t]*+(?:/[/*][^\r\n]*+)?[\r\n]"
    rb"\s*+(?:/[/*][^\r\n]*+\s*+)*+\d+[ \t]+[-+.\d]",
    re.IGNORECASE,
)


def has_sign(pieces: Pieces) -> bool:
    """Test for a line `vertices` before a numbered row, near the start."""
    return bool(_SIGN.search(pieces.ahead()))


def _parse(pieces: Pieces, options: ParserOptions) -> MeshFile:
    from .parse import parse_fe

    return parse_fe(pieces, max_faces=options.max_faces)


register(
    InputFormat(
        name="fe",
        full_name="Surface Evolver",
        parse=_parse,
        has_sign=has_sign,
        suffixes=("fe", "dmp"),
        rows="vertices",
        keeps="declared scalar attributes of vertices and facets, `color` of facets",
        labels="bodies as `groups` and `objects`, colours as `materials`",
    )
)

"""Wavefront OBJ: `v`, `f` and `l` records, with groups, objects, materials, normals and texture coordinates."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ...registry import InputFormat, ParserOptions, register

if TYPE_CHECKING:
    from ....mesh.file import MeshFile
    from ...pieces import Pieces

_V_LINE = re.compile(rb"(?:^|[\r\n])[ \t]*v[ \t]+[-+.\d]\S*[ \t]+[-+.\d]")


def has_sign(pieces: Pieces) -> bool:
    """Test for a `v` record near the start and an `f` record anywhere."""
    if not _V_LINE.search(pieces.ahead()):
        return False
    data = pieces.whole()
    return b"\nf " in data or b"\rf " in data or b"\nf\t" in data


def _parse(pieces: Pieces, options: ParserOptions) -> MeshFile:
    from .parse import parse_obj

    data = pieces.rest()
    return parse_obj(data, max_faces=options.max_faces, normals=options.normals, texture=options.texture)


register(
    InputFormat(
        name="obj",
        parse=_parse,
        has_sign=has_sign,
        weak_sign=True,
        rows="`v` records",
        keeps="vertex colours",
        labels="`g`, `o`, `usemtl`",
        curves="`l` records, for `curvcli curves`; those that share ends are one curve",
    )
)

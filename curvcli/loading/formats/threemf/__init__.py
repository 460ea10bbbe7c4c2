"""3MF: a package of XML with the objects of a print, their placement, materials and unit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...registry import InputFormat, ParserOptions, register

if TYPE_CHECKING:
    from ....mesh.file import MeshFile
    from ...pieces import Pieces

_ZIP = b"PK\x03\x04"


def has_sign(pieces: Pieces) -> bool:
    """Test for a ZIP archive that names a model of 3MF."""
    return pieces.ahead()[:4] == _ZIP and b"3dmodel.model" in pieces.whole().lower()


def any_start(start: bytes, size: int, promised: bool) -> bool:
    """Test for a ZIP archive of 3MF."""
    return start[:4] == _ZIP and (promised or b"3D/" in start)


def _parse(pieces: Pieces, options: ParserOptions) -> MeshFile:
    from .parse import parse_3mf

    return parse_3mf(pieces, max_faces=options.max_faces)


register(
    InputFormat(
        name="3mf",
        parse=_parse,
        has_sign=has_sign,
        any_start=any_start,
        encodings="XML in a ZIP archive",
        rows="vertices of each item of the build, in its order",
        digits="doubles, then the transforms of items",
        keeps="the unit",
        labels="items as `groups` and `objects`, `materials`",
        polygons="triangles only",
    )
)

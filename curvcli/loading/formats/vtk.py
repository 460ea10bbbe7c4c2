"""Legacy VTK files."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ..registry import InputFormat, ParserOptions, register

if TYPE_CHECKING:
    from ...mesh.file import MeshFile
    from ..pieces import Pieces

_SIGN = re.compile(rb"#\s*vtk\s+DataFile\s+Version", re.IGNORECASE)


def has_sign(pieces: Pieces) -> bool:
    """Test for the first line `# vtk DataFile Version`."""
    return bool(_SIGN.match(pieces.ahead()))


def _parse(pieces: Pieces, options: ParserOptions) -> MeshFile:
    from ..vtk.legacy import parse_legacy

    return parse_legacy(pieces, options)


register(
    InputFormat(
        name="vtk",
        parse=_parse,
        has_sign=has_sign,
        encodings="text, big-endian binary, versions 1 to 5.1",
        rows="points",
        digits="of the declared type; doubles in text",
        keeps="arrays of points and cells",
        labels="arrays of points and cells, numbers or words",
        polygons="triangulated; strips and pixels too",
        curves="lines",
    )
)

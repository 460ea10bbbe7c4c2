"""VTK XML polygonal data."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..registry import InputFormat, ParserOptions, register

if TYPE_CHECKING:
    from ...mesh.file import MeshFile
    from ..pieces import Pieces


def has_sign(pieces: Pieces) -> bool:
    """Test for a root element VTKFile with the type PolyData."""
    from ..vtk.sign import dataset_type

    return dataset_type(pieces) == "PolyData"


def _parse(pieces: Pieces, options: ParserOptions) -> MeshFile:
    from ..vtk.xml import parse_xml

    return parse_xml(pieces, options, "vtp")


register(
    InputFormat(
        name="vtp",
        parse=_parse,
        has_sign=has_sign,
        encodings="XML with text, base64 or raw arrays, of either byte order, compressed or not",
        rows="points",
        digits="of the declared type; doubles in text",
        keeps="arrays of points and cells",
        labels="arrays of points and cells, numbers or words",
        polygons="triangulated; strips too",
        curves="lines",
    )
)

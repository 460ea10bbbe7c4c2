"""VTK polygons and unstructured grid with every column as an array."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, BinaryIO

from ..registry import MeshFormat, mesh_color, register

if TYPE_CHECKING:
    from ...errors import Notice


def write_to(suffix: str, stream: BinaryIO, points: Any, faces: Any, **attributes: Any) -> tuple[Notice, ...]:
    """Write everything."""
    from ..meshes.vtk import write_vtk

    return write_vtk(stream, suffix, points, faces, **attributes)


for place, (suffix, kind) in enumerate(((".vtp", "polygons"), (".vtu", "unstructured grid")), 3):
    register(
        MeshFormat(
            suffix=suffix,
            description=f"mesh with every column as an array, VTK {kind}",
            place=place,
            write=partial(write_to, suffix),
            shows=mesh_color,
            properties=True,
            labels=True,
        )
    )

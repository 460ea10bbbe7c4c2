"""Datafile of the Surface Evolver with one column as an attribute of vertices."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, BinaryIO

from ..registry import MeshFormat, mesh_color, register

if TYPE_CHECKING:
    from ...errors import Notice


def write(stream: BinaryIO, points: Any, faces: Any, **attributes: Any) -> tuple[Notice, ...]:
    """Write vertices, edges, facets, a body for each closed component, and the column of --color-by."""
    from ..meshes.fe import write_fe

    return write_fe(stream, points, faces, **attributes)


register(
    MeshFormat(
        suffix=".fe",
        description="mesh with the column of --color-by as an attribute, Surface Evolver",
        place=7,
        write=write,
        shows=mesh_color,
        properties=True,
    )
)

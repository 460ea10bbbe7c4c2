"""Wavefront OBJ with colours of vertices."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, BinaryIO

from ..registry import MeshFormat, mesh_color, register

if TYPE_CHECKING:
    from ...errors import Notice


def write(stream: BinaryIO, points: Any, faces: Any, **attributes: Any) -> tuple[Notice, ...]:
    """Write the mesh, its colours and comments."""
    from ..meshes.obj import write_obj

    write_obj(stream, points, faces, **attributes)
    return ()


register(
    MeshFormat(suffix=".obj", description="mesh with vertex colours, text", place=2, write=write, shows=mesh_color)
)

"""Binary glTF with colours of vertices."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, BinaryIO

from ..registry import MeshFormat, mesh_color, register

if TYPE_CHECKING:
    from ...errors import Notice


def write(stream: BinaryIO, points: Any, faces: Any, **attributes: Any) -> tuple[Notice, ...]:
    """Write the triangles and their colours."""
    from ..meshes.glb import write_glb

    triangles = attributes.get("triangles")
    return write_glb(stream, points, faces if triangles is None else triangles, attributes.get("vertex_colors"))


register(
    MeshFormat(
        suffix=".glb",
        description="mesh with vertex colours, binary glTF, float32",
        place=5,
        write=write,
        shows=mesh_color,
    )
)

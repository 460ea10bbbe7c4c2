"""OFF with colours of vertices and of the input's faces."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, BinaryIO

from ..registry import MeshFormat, mesh_color, register

if TYPE_CHECKING:
    from ...errors import Notice


def write(stream: BinaryIO, points: Any, faces: Any, **attributes: Any) -> tuple[Notice, ...]:
    """Write the mesh, its colours and comments."""
    from ..meshes.off import write_off

    write_off(stream, points, faces, **attributes)
    return ()


register(
    MeshFormat(suffix=".off", description="mesh with vertex colours, text", place=6, write=write, shows=mesh_color)
)

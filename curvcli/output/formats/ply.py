"""Binary PLY with every column as a property."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, BinaryIO

from ..registry import MeshFormat, mesh_color, register

if TYPE_CHECKING:
    from ...errors import Notice


def write(stream: BinaryIO, points: Any, faces: Any, **attributes: Any) -> tuple[Notice, ...]:
    """Write everything."""
    from ..meshes.ply import write_ply

    return write_ply(stream, points, faces, **attributes)


register(
    MeshFormat(
        suffix=".ply",
        description="mesh with every column as a property, binary",
        place=1,
        write=write,
        shows=mesh_color,
        properties=True,
        quality=True,
    )
)

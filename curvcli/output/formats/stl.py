"""Binary STL, of samples only."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, BinaryIO

from ..registry import MeshFormat, register

if TYPE_CHECKING:
    from ...errors import Notice


def write(stream: BinaryIO, points: Any, faces: Any, **attributes: Any) -> tuple[Notice, ...]:
    """Write the triangles alone."""
    from ..meshes.stl import write_stl

    return write_stl(stream, points, faces)


register(MeshFormat(suffix=".stl", description="triangles, binary, float32", place=1, write=write, kind="triangles"))

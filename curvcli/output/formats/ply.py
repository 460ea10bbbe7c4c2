"""Binary PLY with every column as a property."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, BinaryIO

from ..registry import MeshFormat, register

if TYPE_CHECKING:
    from ...errors import Notice
    from ..appearance import Appearance


def shows(appearance: Appearance, chosen: list[str]) -> list[str]:
    """The column of the colours, if there is one."""
    from ..coloring import coloring

    name = coloring(appearance, chosen)
    return [] if name is None else [name]


def write(stream: BinaryIO, points: Any, faces: Any, **parts: Any) -> tuple[Notice, ...]:
    """Write everything."""
    from ..meshes.ply import write_ply

    return write_ply(stream, points, faces, **parts)


register(
    MeshFormat(
        suffix=".ply",
        description="mesh with every column as a property, binary",
        place=1,
        write=write,
        shows=shows,
        properties=True,
        quality=True,
    )
)

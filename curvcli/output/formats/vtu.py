"""VTK unstructured grid with every column as an array."""

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


def require() -> None:
    """Errors: MissingExtraError without VTK."""
    from ..pictures.framing import require_vtk

    require_vtk()


def write(stream: BinaryIO, points: Any, faces: Any, **parts: Any) -> tuple[Notice, ...]:
    """Write everything."""
    from ..meshes.vtk import write_vtk

    return write_vtk(stream, ".vtu", points, faces, **parts)


register(
    MeshFormat(
        suffix=".vtu",
        description="mesh with every column as an array, VTK unstructured grid",
        place=4,
        write=write,
        shows=shows,
        require=require,
        properties=True,
    )
)

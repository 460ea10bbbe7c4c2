"""Entrance through trimesh: its loader calls the parsers of curvcli, registered there, or its own."""

from __future__ import annotations

import io
from functools import partial
from typing import TYPE_CHECKING, Any

from ..errors import InputError
from .pieces import Pieces
from .registry import InputFormat, ParserOptions

if TYPE_CHECKING:
    from ..mesh.file import MeshFile


class MeshStream(io.RawIOBase):
    """The bytes of a mesh for a loader. It has no name, so trimesh can resolve no reference to another file."""

    def __init__(self, pieces: Pieces, options: ParserOptions) -> None:
        self.pieces, self.options = pieces, options

    def read(self, size: int = -1) -> bytes:
        """The next `size` bytes, or all."""
        return self.pieces.rest() if size < 0 else bytes(self.pieces.take(min(size, self.pieces.left)))


def load_through_trimesh(pieces: Pieces, format: InputFormat, options: ParserOptions) -> MeshFile:
    """The content of a mesh, by the parser of its format, or by trimesh's own loader for a format without one.

    A parser of ours is registered under a name of its own: other users of trimesh in this process keep their loaders.
    Errors: those of the parser; InputError for what trimesh's own loader cannot read.
    """
    import numpy as np
    from trimesh.exchange.load import load_scene, mesh_loaders

    from ..mesh.file import MeshFile

    parse, stream = format.parse, MeshStream(pieces, options)
    if parse is not None:
        mesh_loaders.setdefault(f"curvcli-{format.name}", partial(_parsed, parse))
        scene = load_scene(stream, file_type=f"curvcli-{format.name}", process=False)
        (mesh,) = scene.geometry.values()
        content: MeshFile = mesh.metadata.pop("curvcli")
        return content
    try:
        mesh = load_scene(stream, file_type=format.name, process=False).to_mesh()
        points, corners = np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.int32)
    except (MemoryError, InputError):
        raise
    except Exception as error:
        raise InputError(f"cannot be read as {format.title}: {type(error).__name__}: {error}") from None
    if not len(corners):
        raise InputError("no faces", hint="a surface needs at least one face")
    return MeshFile(format.name, np.ascontiguousarray(points.T), corners.reshape(-1))


def _parsed(parse: Any, file_obj: MeshStream, **_: Any) -> dict[str, Any]:
    """A trimesh loader: the arguments of a Trimesh without faces, and the content of the file under its metadata.

    trimesh would turn corners into int64 and rows into columns; the surface is made from the content instead.
    """
    import numpy as np

    nothing = np.empty((0, 3))
    metadata = {"curvcli": parse(file_obj.pieces, file_obj.options)}
    return {"vertices": nothing, "faces": nothing.astype(np.int64), "metadata": metadata}

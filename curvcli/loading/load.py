"""Surface from a path, a stream, a mesh of another library, a pair of arrays or another Surface."""

from __future__ import annotations

import os
from typing import Any, BinaryIO, Literal

from ..errors import UsageError
from ..mesh.polygons import from_file
from ..mesh.surface import Orient, Surface
from .library_meshes import mesh_file_of
from .objects import is_stream, refusal


def load(
    source: str | os.PathLike[str] | BinaryIO | Any,
    *,
    weld: str | float = "auto",
    orient: Orient = "file",
    input_format: str | None = None,
    max_faces: int | None = None,
    max_bytes: int | None = None,
    normals: Literal["mesh", "file"] = "mesh",
    texture: bool = False,
) -> Surface:
    """Read a mesh file as the surface it describes: rows in file order, seams never cut, nothing repaired.

    source: a path or a binary stream; also a mesh of trimesh, pyvista, meshio, open3d, pymeshlab or nibabel, whose data
    become properties, or a pair (points, faces), which keep what they are: the options of files do not apply.
    weld: `auto` (by exact position where the format cuts surfaces, as STL and GLB do, otherwise not at all), `none`,
    `exact`, or a tolerance relative to the diagonal of the bounding box. orient: `outward` turns closed patches
    that are inside out. normals: `file` also reads normals, texture texture coordinates, where the format has records
    of them, as OBJ does; those of a PLY file are among its properties.
    Errors: InputError, one line with file, place, expectation and way out; TypeError for any
    other object.
    """
    from .read import read_mesh_file

    if not (isinstance(source, str | bytes | os.PathLike) or is_stream(source)):
        return as_surface(source, orient=orient, weld=weld, normals=normals)
    file = read_mesh_file(
        source,
        input_format=input_format,
        weld=weld,
        max_faces=max_faces,
        max_bytes=max_bytes,
        normals=normals,
        texture=texture,
    )
    return from_file(file, orient)


def as_surface(
    given: Any,
    *,
    orient: Orient | None = None,
    weld: str | float = "auto",
    normals: Literal["mesh", "file"] = "mesh",
) -> Surface:
    """Convert a Surface, a path, a mesh of another library or a pair (points, faces) of arrays to a Surface.

    orient: None keeps the choice of a Surface and is `file` otherwise. weld: for files only.
    Errors: InputError for a mesh that is no surface; UsageError for `weld` without a file; TypeError for any other
    object.
    """
    if isinstance(given, Surface):
        _check_weld(weld, given.file.weld if given.file is not None else "none")
        if orient in (None, given.orient):
            return given
        return Surface(
            given.points,
            given.faces,
            orient=orient or "file",
            polygon=given.polygon,
            file=given.file,
            notices=given.notices,
        )
    orient = orient or "file"
    if isinstance(given, str | os.PathLike) or is_stream(given):
        return load(given, orient=orient, weld=weld, normals=normals)
    if not isinstance(given, tuple | list | dict) and (file := mesh_file_of(given)) is not None:
        _check_weld(weld, "none")
        return from_file(file, orient)
    if hasattr(given, "vertices") and hasattr(given, "faces") and not isinstance(given, type):
        given = given.vertices, given.faces
    if isinstance(given, tuple | list) and len(given) == 2 and not any(isinstance(part, str) for part in given):
        _check_weld(weld, "none")
        return Surface(*given, orient=orient)
    raise refusal(given)


def _check_weld(weld: str | float, merged: str) -> None:
    """Raise UsageError for `weld` without a file: only the reader of a file merges vertices."""
    if str(weld) not in ("auto", merged):
        raise UsageError(f"weld is {str(weld)!r}, but vertices are merged when a file is read; `curvcli.load` does it")

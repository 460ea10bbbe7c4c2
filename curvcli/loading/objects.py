"""Python objects passed as meshes: streams, and errors for unsupported types."""

from __future__ import annotations

import io
from typing import Any

ACCEPTED = "a Surface, a path, a binary stream, a trimesh.Trimesh or (points, faces)"


def is_stream(given: Any) -> bool:
    """Test for an open binary stream; a class or a mesh with a method `read` is none."""
    return callable(getattr(given, "read", None)) and callable(getattr(given, "seekable", None)) and not _is_text(given)


def refusal(given: Any, accepted: str = ACCEPTED, passing: str = "pass") -> TypeError:
    """The error for an object of an unsupported type: its type, the accepted types, and an expression to pass instead.

    passing: the words before an expression for a mesh.
    """
    kind = type(given)
    if isinstance(given, type):
        name = f"the class {given.__name__}"
    else:
        name = kind.__name__ if kind.__module__ == "builtins" else f"{kind.__module__.split('.')[0]}.{kind.__name__}"
    hint = _instead(given, passing)
    return TypeError(f"expected {accepted}, not {name}{f'; {hint}' if hint else ''}")


def _is_text(given: Any) -> bool:
    return isinstance(given, io.TextIOBase) or isinstance(getattr(given, "encoding", None), str)


def _instead(given: Any, passing: str) -> str:
    """An expression to pass instead of an object of a known library."""
    if isinstance(given, type):
        return "pass an object of it"
    if _is_text(given):
        return "open the file with mode 'rb'"
    if isinstance(given, bytes | bytearray | memoryview):
        return "pass io.BytesIO(data)"
    kinds = (
        (("points", "regular_faces"), "(mesh.points, mesh.regular_faces) of mesh.triangulate()"),
        (("points", "extract_surface"), "(mesh.points, mesh.regular_faces) of mesh.extract_surface().triangulate()"),
        (("points", "cells_dict"), "(mesh.points, mesh.cells_dict['triangle'])"),
        (("combine", "keys"), "(mesh.points, mesh.regular_faces) of blocks.combine().extract_surface().triangulate()"),
        (("vertices", "triangles"), "(numpy.asarray(mesh.vertices), numpy.asarray(mesh.triangles))"),
        (("vertices", "cells"), "(mesh.vertices, mesh.cells)"),
        (("vertex_matrix", "face_matrix"), "(mesh.vertex_matrix(), mesh.face_matrix())"),
        (("geometry", "to_mesh"), "scene.to_mesh()"),
        (("agg_data", "darrays"), "image.agg_data()"),
    )
    for names, instead in kinds:
        if all(hasattr(given, name) for name in names):
            return f"{passing} {instead}"
    return ""

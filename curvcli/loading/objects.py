"""Python objects passed as meshes: streams, and errors for unsupported types."""

from __future__ import annotations

import io
from typing import Any

ACCEPTED = (
    "a Surface, a path, a binary stream, a mesh of trimesh, pyvista, meshio, open3d or nibabel, or (points, faces)"
)


def is_stream(given: Any) -> bool:
    """Test for an open binary stream; a class or a mesh with a method `read` is none."""
    return callable(getattr(given, "read", None)) and callable(getattr(given, "seekable", None)) and not _is_text(given)


def refusal(given: Any) -> TypeError:
    """The error for an object of an unsupported type: its type, the accepted types, and what to pass instead."""
    kind = type(given)
    if isinstance(given, type):
        name = f"the class {given.__name__}"
    else:
        name = kind.__name__ if kind.__module__ == "builtins" else f"{kind.__module__.split('.')[0]}.{kind.__name__}"
    hint = _instead(given)
    return TypeError(f"expected {ACCEPTED}, not {name}{f'; {hint}' if hint else ''}")


def _is_text(given: Any) -> bool:
    return isinstance(given, io.TextIOBase) or isinstance(getattr(given, "encoding", None), str)


def _instead(given: Any) -> str:
    """An expression to pass instead of an object of a known library."""
    if isinstance(given, type):
        return "pass an object of it"
    if _is_text(given):
        return "open the file with mode 'rb'"
    if isinstance(given, bytes | bytearray | memoryview):
        return "pass io.BytesIO(data)"
    kinds = (
        (("points", "extract_surface"), "mesh.extract_surface()"),
        (("combine", "keys"), "blocks.combine().extract_surface()"),
        (("geometry", "to_mesh"), "scene.to_mesh()"),
        (("current_mesh", "mesh_number"), "meshes.current_mesh()"),
    )
    for names, instead in kinds:
        if all(hasattr(given, name) for name in names):
            return f"pass {instead}"
    return ""

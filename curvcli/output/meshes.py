"""Meshes by suffix, and what of the input's own properties stands beside ours."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ..errors import Notice
from ..plurals import agree
from .obj import write_obj
from .ply import Polygons, write_ply
from .stl import write_stl
from .tables import Column

_POSITION = ("x", "y", "z")
# A viewer blends alpha with whatever colours it finds, so it belongs to the colours it came with.
_COLOR = ("red", "green", "blue", "alpha")


def write_mesh(
    stream: BinaryIO,
    suffix: str,
    points: NDArray[np.float64],
    faces: NDArray[np.integer[Any]],
    *,
    polygons: Polygons | None = None,
    vertex_colors: NDArray[np.uint8] | None = None,
    vertex_properties: Mapping[str, Column] | None = None,
    face_properties: Mapping[str, Column] | None = None,
    comments: Iterable[str] = (),
    triangles: NDArray[np.integer[Any]] | None = None,
    active: str | None = None,
) -> tuple[Notice, ...]:
    """Write a mesh in the format of the suffix, each with what it can hold: PLY and VTK everything, others colours.

    points (V, 3); faces (F, 3), or instead of them polygons: (corner indices one after the other, corners of each).
    triangles: (F, 3) for what holds nothing else, where they are not the faces. active: the property that `.vtp` and
    `.vtu` are coloured by. `.stl` holds the triangles alone. Returns what was lost without being asked.
    """
    if suffix == ".ply":
        write_ply(
            stream,
            points,
            faces,
            polygons=polygons,
            vertex_colors=vertex_colors,
            vertex_properties=vertex_properties,
            face_properties=face_properties,
            comments=comments,
        )
        return ()
    if suffix == ".obj":
        write_obj(stream, points, faces, polygons=polygons, vertex_colors=vertex_colors, comments=comments)
        return ()
    if suffix in (".vtp", ".vtu"):
        from .vtk import write_vtk

        write_vtk(
            stream,
            suffix,
            points,
            faces,
            polygons=polygons,
            vertex_colors=vertex_colors,
            vertex_properties=vertex_properties,
            face_properties=face_properties,
            comments=comments,
            active=active,
        )
        return ()
    if suffix == ".glb":
        from .glb import write_glb

        return write_glb(stream, points, faces if triangles is None else triangles, vertex_colors)
    if suffix == ".stl":
        return write_stl(stream, points, faces)
    raise ValueError(f"{suffix}: no mesh is written with this suffix")


def beside_input(
    ours: Mapping[str, Column], inputs: Mapping[str, Column], *, colored: bool = False
) -> tuple[dict[str, Column], tuple[Notice, ...]]:
    """The input's own properties followed by ours; where names meet, the input's becomes `input_NAME`.

    colored: our own colours are written too, so that the input's red, green, blue and alpha are renamed.
    """
    taken = {*ours, *_POSITION, *(_COLOR if colored else ())}
    merged: dict[str, Column] = {}
    renamed = []
    for name, column in inputs.items():
        free = name
        while free in taken or free in merged or (free != name and free in inputs):
            free = f"input_{free}"
        if free != name:
            renamed.append(f"{name} -> {free}")
        merged[free] = column
    merged |= ours
    if not renamed:
        return merged, ()
    message = agree(len(renamed), "[property|properties] of the input with a name that is taken: ") + ", ".join(renamed)
    return merged, (Notice("renamed_properties", len(renamed), message, "the values are kept under the new names"),)

"""Parts of a mesh beside its points and faces, for the writers of all formats."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, TypedDict

import numpy as np
from numpy.typing import NDArray

from ..tables.write import Column

# Corner indices of all polygons, concatenated, and the number of corners of each.
Polygons = tuple[NDArray[np.integer[Any]], NDArray[np.integer[Any]]]


class MeshAttributes(TypedDict, total=False):
    """Keywords of every writer; each format writes those that it has.

    polygons: the faces of the file, instead of the triangles. vertex_colors: (V, 3) red, green, blue.
    vertex_properties, face_properties: one value per vertex, per face or polygon; NaN is null. comments: lines.
    triangles: (F, 3) for formats of triangles only, where they are not the faces. active: the property that viewers
    colour by first.
    """

    polygons: Polygons | None
    vertex_colors: NDArray[np.uint8] | None
    vertex_properties: Mapping[str, Column] | None
    face_properties: Mapping[str, Column] | None
    comments: Iterable[str]
    triangles: NDArray[np.integer[Any]] | None
    active: str | None

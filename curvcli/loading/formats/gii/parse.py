"""GIFTI surfaces: positions, triangles, and further arrays of vertices."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, Notice
from ....mesh.file import Labels, MeshFile
from ....support.words import number_of, pluralize
from ...corners import checked_corners
from .image import LABELS, POSITIONS, TRIANGLES, DataArray, read_image


def parse_gifti(data: bytes, *, max_faces: int | None = None) -> MeshFile:
    """Parse a GIFTI surface: coordinates as they stand in the file; matrices are counted, and not applied.

    Further arrays with a value per vertex become properties or labels of vertices.
    Errors: those of `read_image`; InputError without one array of positions and one of triangles.
    """
    image = read_image(data, max_faces)
    points = _single(image.arrays, POSITIONS, "positions", "fiu")
    triangles = _single(image.arrays, TRIANGLES, "triangles", "iu")
    if not len(triangles.values):
        raise InputError("no faces", hint="a surface needs at least one triangle")
    corners = checked_corners(triangles.values.reshape(-1), 3, "face", len(points.values))
    properties: dict[str, NDArray[np.generic]] = {}
    labels: dict[str, Labels] = {}
    others = [array for array in image.arrays if array not in (points, triangles)]
    fitting = [array for array in others if array.values.ndim and len(array.values) == len(points.values)]
    for array in fitting:
        for name, column in _columns(array):
            free = _free(name, {*properties, *labels})
            if array.intent == LABELS and column.dtype.kind in "iu":
                labels[free] = image.labels(array)
            else:
                properties[free] = column
    notices = []
    if points.transformed:
        hint = "coordinates stay in the space of the file"
        notices.append(Notice("transform_ignored", 1, "matrix of a coordinate system, not applied", hint))
    if ignored := len(others) - len(fitting):
        message = pluralize(ignored, "[array|arrays] without one value per vertex, ignored")
        notices.append(Notice("ignored_arrays", ignored, message, "they belong to another surface"))
    xyz = np.ascontiguousarray(points.values.T, np.float64)
    return MeshFile("gii", xyz, corners, vertex_properties=properties, vertex_labels=labels, notices=tuple(notices))


def _single(arrays: tuple[DataArray, ...], intent: int, name: str, kinds: str) -> DataArray:
    """The only array of an intent, in rows of three."""
    indices = [place for place, array in enumerate(arrays) if array.intent == intent]
    if len(indices) != 1:
        hint = "files of values and labels lie beside a surface, such as lh.surf.gii" if not indices else None
        raise InputError(f"{number_of(len(indices), 'array')} of {name} found, one expected", hint=hint)
    array = arrays[indices[0]]
    if array.values.ndim != 2 or array.values.shape[1] != 3 or array.values.dtype.kind not in kinds:
        layout = f"{array.values.dtype.name} in the shape {array.values.shape} found"
        raise InputError(f"{name}: {layout}, rows of three expected", place=f"data array {indices[0]}")
    return array


def _columns(array: DataArray) -> list[tuple[str, NDArray[Any]]]:
    """Values of vertices by name; a vector by component."""
    values = array.values
    values = np.ascontiguousarray(values.astype(values.dtype.newbyteorder("="), copy=False))
    if values.ndim == 1:
        return [(array.name, values)]
    flat = values.reshape(len(values), -1)
    ends = "xyz" if flat.shape[1] == 3 else range(flat.shape[1])
    return [(f"{array.name}_{end}", np.ascontiguousarray(flat[:, k])) for k, end in enumerate(ends)]


def _free(name: str, taken: set[str]) -> str:
    """The name, with a number behind it if it is taken."""
    free, number = name, 1
    while free in taken:
        number += 1
        free = f"{name}_{number}"
    return free

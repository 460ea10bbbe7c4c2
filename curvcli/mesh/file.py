"""Content of a mesh file: positions, polygons, labels and properties in file order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from ..errors import Notice


@dataclass(frozen=True)
class Labels:
    """One label per polygon or vertex, such as an OBJ group: `codes` indexes `names`, -1 for no label.

    colors: (n, 3) uint8 of the names, None without.
    """

    codes: NDArray[np.int32]
    names: tuple[str, ...]
    colors: NDArray[np.uint8] | None = None

    def words(self) -> NDArray[Any]:
        """The label of every element, None for no label."""
        return np.array([*self.names, None], object)[self.codes]


class Polylines(Sequence[NDArray[np.int32]]):
    """Vertex indices of polyline records, concatenated; a sequence of records.

    vertex: (n,). start: (m + 1,) the first entry of each record.
    """

    def __init__(self, vertex: NDArray[np.int32], start: NDArray[np.int64]) -> None:
        self.vertex, self.start = vertex, start

    @overload
    def __getitem__(self, index: int) -> NDArray[np.int32]: ...

    @overload
    def __getitem__(self, index: slice) -> list[NDArray[np.int32]]: ...

    def __getitem__(self, index: int | slice) -> NDArray[np.int32] | list[NDArray[np.int32]]:
        if isinstance(index, slice):
            return [self[record_number] for record_number in range(*index.indices(len(self)))]
        record = range(len(self))[index]
        return self.vertex[self.start[record] : self.start[record + 1]]

    def __len__(self) -> int:
        return len(self.start) - 1


NO_POLYLINES = Polylines(np.empty(0, np.int32), np.zeros(1, np.int64))


@dataclass(frozen=True)
class MeshFile:
    """The content of one mesh file.

    format: the name of its format, `arrays` without a file.
    xyz: (3, V) float64, C-contiguous, one row per coordinate; vertex order is the file's.
    corners: int32, the corner indices (from 0) of all polygons, concatenated.
    sizes: (P,) int32, corners per polygon, or None when every polygon is a triangle (corners is then 3 P long).
    vertex_properties, polygon_properties: further per-element scalars of a PLY file by name, in file order.
    polygon_labels: `groups`, `objects`, `materials` of an OBJ file, `solids` of an STL file.
    vertex_labels: labels of vertices by name, such as those of a GIFTI file.
    polylines: vertex indices of each OBJ `l` record.
    welded_to: (V,) the row with the values of a merged row, -1 for a row that keeps its own; None without welding.
    path, sha256: the source (`-` for a stream) and the hash of its bytes, None for arrays made in memory.
    weld: the rule that merged vertices: `none`, `exact` or a tolerance.
    corner_normals: (3, V) sums of an OBJ file's unit normals over the corners at each vertex, on request.
    corner_texture: (2, C) texture coordinates of the corners of an OBJ file, NaN where it gives none, on request.
    unit: name of the unit of length that the file gives.
    notices: warnings about accepted content.
    """

    format: str
    xyz: NDArray[np.float64]
    corners: NDArray[np.int32]
    sizes: NDArray[np.int32] | None = None
    vertex_properties: dict[str, NDArray[np.generic]] = field(default_factory=dict)
    polygon_properties: dict[str, NDArray[np.generic]] = field(default_factory=dict)
    polygon_labels: dict[str, Labels] = field(default_factory=dict)
    vertex_labels: dict[str, Labels] = field(default_factory=dict)
    polylines: Polylines = NO_POLYLINES
    welded_to: NDArray[np.int32] | None = None
    path: str | None = None
    sha256: str | None = None
    weld: str = "none"
    corner_normals: NDArray[np.float64] | None = None
    corner_texture: NDArray[np.float64] | None = None
    unit: str | None = None
    notices: tuple[Notice, ...] = ()

    @property
    def vertex_normals(self) -> NDArray[np.float64] | None:
        """(3, V) the file's normals at its vertices, of any length; NaN where it gives none, None if it has none."""
        if self.corner_normals is not None:
            return self.corner_normals
        axes = [self.vertex_properties.get(name) for name in ("nx", "ny", "nz")]
        return None if any(axis is None for axis in axes) else np.array(axes, np.float64)

    @property
    def polygons(self) -> int:
        """Number of polygons in the file."""
        return len(self.corners) // 3 if self.sizes is None else len(self.sizes)

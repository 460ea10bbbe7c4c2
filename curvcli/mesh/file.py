"""What a mesh file says, before anything is interpreted: positions, polygons, labels and properties in file order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import overload

import numpy as np
from numpy.typing import NDArray

from ..errors import Notice


@dataclass(frozen=True)
class Labels:
    """One label per polygon, such as the OBJ group it stands in: `codes` indexes `names`, -1 where there is none."""

    codes: NDArray[np.int32]
    names: tuple[str, ...]


class Polylines(Sequence[NDArray[np.int32]]):
    """Vertex indices of all records one after the other, read as a sequence of records.

    vertex: (n,). start: (m + 1,) where each record begins.
    """

    def __init__(self, vertex: NDArray[np.int32], start: NDArray[np.int64]) -> None:
        self.vertex, self.start = vertex, start

    @overload
    def __getitem__(self, index: int) -> NDArray[np.int32]: ...

    @overload
    def __getitem__(self, index: slice) -> list[NDArray[np.int32]]: ...

    def __getitem__(self, index: int | slice) -> NDArray[np.int32] | list[NDArray[np.int32]]:
        if isinstance(index, slice):
            return [self[one] for one in range(*index.indices(len(self)))]
        record = range(len(self))[index]
        return self.vertex[self.start[record] : self.start[record + 1]]

    def __len__(self) -> int:
        return len(self.start) - 1


NO_POLYLINES = Polylines(np.empty(0, np.int32), np.zeros(1, np.int64))


@dataclass(frozen=True)
class MeshFile:
    """The content of one mesh file.

    xyz: (3, V) float64, C-contiguous, one row per coordinate; vertex order is the file's.
    corners: int32, the corner indices (from 0) of all polygons one after the other.
    sizes: (P,) int32, corners per polygon, or None when every polygon is a triangle (corners is then 3 P long).
    vertex_properties, polygon_properties: further per-element scalars of a PLY file by name, in file order.
    polygon_labels: `groups`, `objects`, `materials` of an OBJ file, where it has any.
    polylines: vertex indices of each OBJ `l` record.
    welded_to: (V,) the row that holds the values of a merged row, -1 for one that holds its own; None without welding.
    path, sha256: where the bytes came from (`-` for a stream) and their hash, None for arrays made in memory.
    weld: how vertices were merged: `none`, `exact` or a tolerance.
    corner_normals: (3, V) sums of the unit normals that an OBJ file gives at the corners there, if they were asked for.
    corner_texture: (2, C) texture coordinates of the corners of an OBJ file, NaN where it gives none, if asked for.
    notices: what was accepted but should be said.
    """

    format: str
    xyz: NDArray[np.float64]
    corners: NDArray[np.int32]
    sizes: NDArray[np.int32] | None = None
    vertex_properties: dict[str, NDArray[np.generic]] = field(default_factory=dict)
    polygon_properties: dict[str, NDArray[np.generic]] = field(default_factory=dict)
    polygon_labels: dict[str, Labels] = field(default_factory=dict)
    polylines: Polylines = NO_POLYLINES
    welded_to: NDArray[np.int32] | None = None
    path: str | None = None
    sha256: str | None = None
    weld: str = "none"
    corner_normals: NDArray[np.float64] | None = None
    corner_texture: NDArray[np.float64] | None = None
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

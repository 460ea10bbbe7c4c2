"""Data sets of VTK as the content of a mesh file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError, Notice
from ...mesh.file import NO_POLYLINES, Labels, MeshFile, Polylines
from ...support.words import pluralize
from ..limits import check_faces
from ..registry import ParserOptions
from .attributes import Attribute, concatenate_attributes, labels, properties
from .cell_types import count_of
from .cells import STRAIGHT, CellFaces, concatenate_faces
from .meanings import Meanings


@dataclass(frozen=True)
class VtkPiece:
    """Points (V, 3) and faces, with the values of points and of all cells."""

    points: NDArray[Any]
    faces: CellFaces
    of_points: Sequence[Attribute] = ()
    of_cells: Sequence[Attribute] = ()


@dataclass
class DataSet:
    """Consecutive pieces. meanings: words of the codes of arrays of integers, and the unit of length."""

    pieces: list[VtkPiece]
    meanings: Meanings = field(default_factory=Meanings)
    notices: list[Notice] = field(default_factory=list)


def mesh_file(data: DataSet, format: str, options: ParserOptions) -> MeshFile:
    """The content of a mesh file with these pieces.

    Cells that are neither faces nor lines are counted in a notice. Arrays of numbers become properties, those of words,
    or of codes with known names, labels. On request, normals and texture coordinates are those of the file.
    Errors: InputError without a face or line.
    """
    notices, points = data.notices, [piece.points for piece in data.pieces]
    faces = concatenate_faces([piece.faces for piece in data.pieces], [len(piece) for piece in points])
    check_faces(len(faces.sizes), options.max_faces)
    others = ", ".join(count_of(number, name) for name, number in faces.others.items())
    if not len(faces.sizes) and not faces.lines.count:
        hint = STRAIGHT if others else "a surface needs at least one triangle or polygon"
        raise InputError(f"no faces{f', but {others}' if others else ''}", hint=hint)
    if others:
        total = sum(faces.others.values())
        message = f"{pluralize(total, '[cell that is no face|cells that are no faces]')}, ignored: {others}"
        notices.append(Notice("other_cells", total, message, "a surface has triangles and polygons only"))
    of_points = concatenate_attributes([piece.of_points for piece in data.pieces], notices)
    of_cells = concatenate_attributes([piece.of_cells for piece in data.pieces], notices)
    at_points = labels(of_points, data.meanings.points)
    corners, sizes, cell = _without_short(faces, notices)
    named = labels(of_cells, data.meanings.cells)
    columns = properties([attribute for attribute in of_cells if attribute.name not in named])
    uv = _with_role(of_points, "texture", 2) if options.texture else None
    xyz = np.empty((3, sum(len(piece) for piece in points)))
    for axis in range(3):
        np.concatenate([piece[:, axis] for piece in points], out=xyz[axis], casting="unsafe")
    return MeshFile(
        format,
        xyz,
        corners,
        None if (sizes == 3).all() else sizes.astype(np.int32),
        vertex_properties=properties([attribute for attribute in of_points if attribute.name not in at_points]),
        polygon_properties={name: column if cell is None else column[cell] for name, column in columns.items()},
        polygon_labels={
            name: label if cell is None else Labels(label.codes[cell], label.names) for name, label in named.items()
        },
        vertex_labels=at_points,
        polylines=_polylines(faces),
        corner_normals=_with_role(of_points, "normals", 3) if options.normals else None,
        corner_texture=uv if uv is None else np.ascontiguousarray(uv[:, corners]),
        unit=data.meanings.unit,
        notices=tuple(notices),
    )


def _without_short(
    faces: CellFaces, notices: list[Notice]
) -> tuple[NDArray[np.int32], NDArray[Any], NDArray[Any] | None]:
    """Corners, sizes and cells of the faces with three corners or more."""
    short = np.flatnonzero(faces.sizes < 3)
    if not len(short):
        return faces.corners, faces.sizes, faces.cell
    hint = "[it has|they have] no area; `curvcli check` refuses such files without --allow no-degenerate"
    notices.append(Notice.at("short_faces", short, "[face|faces] with fewer than 3 corners, dropped", hint))
    keep = faces.sizes >= 3
    cell = np.flatnonzero(keep) if faces.cell is None else faces.cell[keep]
    return faces.corners[np.repeat(keep, faces.sizes)], faces.sizes[keep], cell


def _polylines(faces: CellFaces) -> Polylines:
    if not faces.lines.count:
        return NO_POLYLINES
    start = np.concatenate(([0], np.cumsum(faces.lines.sizes, dtype=np.int64)))
    return Polylines(faces.lines.corners.astype(np.int32, copy=False), start)


def _with_role(attributes: Sequence[Attribute], role: str, width: int) -> NDArray[np.float64] | None:
    """(width, V) the values of the array with a role."""
    for attribute in attributes:
        if attribute.role == role and attribute.layout >= width:
            return np.ascontiguousarray(np.asarray(attribute.values)[:, :width].T, np.float64)
    return None

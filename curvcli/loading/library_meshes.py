"""Meshes of other libraries as the content of a mesh file, by the names of their attributes; none is imported."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, Notice
from ..mesh.file import MeshFile

_STRAIGHT = {"vertex": 1, "line": 3, "polyline": 4, "triangle": 5, "polygon": 7, "pixel": 8, "quad": 9, "tetra": 10}
_STRAIGHT |= {"voxel": 11, "hexahedron": 12, "wedge": 13, "pyramid": 14, "polyhedron": 42}
_CURVED_LINE, _CURVED_FACE, _SOLID = 21, 22, 24


def mesh_file_of(given: Any) -> MeshFile | None:
    """The content of a mesh of meshio, pyvista, trimesh, open3d, pymeshlab or nibabel; None for any other object.

    Rows keep their order. Data of points and cells become properties and labels, as those of a file.
    Errors: InputError for a mesh without faces or with data of another length.
    """
    if isinstance(given, type):
        return None
    for names, convert in _KINDS:
        if all(hasattr(given, name) for name in names):
            return convert(given)
    return None


def _of_grid(given: Any) -> MeshFile:
    """An unstructured grid of pyvista."""
    from .vtk.cells import CellLists, of_types

    points = _points(given.points)
    offsets = given.cell_offsets if hasattr(given, "cell_offsets") else given.offset
    cells = CellLists.of_ends(np.asarray(given.cell_connectivity), np.asarray(offsets)[1:], "cells")
    faces = of_types(cells, np.asarray(given.celltypes), len(points))
    return _mesh_file(points, faces, given.point_data, given.cell_data)


def _of_polydata(given: Any) -> MeshFile:
    """Polygonal data of pyvista."""
    from .vtk.cells import CellLists, of_lists

    points = _points(given.points)
    lists = [CellLists.of_lengths(np.asarray(flat), "cells") for flat in (given.verts, given.lines, given.faces)]
    strips = CellLists.of_lengths(np.asarray(given.strips), "strips")
    return _mesh_file(points, of_lists([*lists, strips], len(points)), given.point_data, given.cell_data)


def _of_blocks(given: Any) -> MeshFile:
    """A mesh of meshio."""
    from .vtk.cells import CellLists, of_types

    points = _points(given.points)
    corners, sizes, kinds = [np.empty(0, np.int64)], [np.empty(0, np.int64)], [np.empty(0, np.uint8)]
    for block in given.cells:
        rows = [np.asarray(row).reshape(-1) for row in block.data]
        kind = _kind(block.type)
        if kind == _STRAIGHT["polyhedron"]:  # whose rows are lists of faces
            rows = [np.empty(0, np.int64)] * len(block.data)
        corners += [np.asarray(block.data).reshape(-1)] if isinstance(block.data, np.ndarray) else rows
        sizes.append(np.array([len(row) for row in rows], np.int64))
        kinds.append(np.full(len(rows), kind, np.uint8))
    cells = CellLists(np.concatenate(corners), np.concatenate(sizes))
    data = {name: np.concatenate([np.asarray(part) for part in blocks]) for name, blocks in given.cell_data.items()}
    numbers, names = data.get("gmsh:physical"), getattr(given, "field_data", None) or {}
    if numbers is not None and "groups" not in data:
        groups = {int(entry[0]): name for name, entry in names.items() if len(entry) == 2 and int(entry[1]) == 2}
        data["groups"] = np.array([groups.get(number, str(number)) for number in numbers.tolist()])
    return _mesh_file(points, of_types(cells, np.concatenate(kinds), len(points)), given.point_data, data)


def _kind(name: str) -> int:
    """Type of VTK for a type of meshio."""
    shape = name.lower().removeprefix("vtk_lagrange_")
    if name in _STRAIGHT:
        return _STRAIGHT[name]
    if shape.startswith("polygon"):
        return _STRAIGHT["polygon"]
    for start, kind in (("line", _CURVED_LINE), ("curve", _CURVED_LINE), ("tri", _CURVED_FACE), ("quad", _CURVED_FACE)):
        if shape.startswith(start):
            return kind
    return _SOLID


def _of_attributes(given: Any) -> MeshFile | None:
    """A mesh of trimesh; None if it has no attributes: its points and faces are then taken as arrays."""
    of_vertices = dict(getattr(given, "vertex_attributes", None) or {})
    of_faces = dict(getattr(given, "face_attributes", None) or {})
    if not of_vertices and not of_faces:
        return None
    return _of_triangles(given.vertices, given.faces, of_vertices, of_faces)


def _of_triangles(points: Any, faces: Any, of_points: Any = None, of_faces: Any = None) -> MeshFile:
    from .vtk.cells import NONE as NO_CELLS
    from .vtk.cells import CellLists, of_lists

    corners = np.asarray(faces)
    if corners.ndim != 2 or corners.dtype.kind not in "iu":
        raise InputError(f"faces have shape {corners.shape} and type {corners.dtype}, expected integers (F, 3)")
    points = _points(points)
    cells = CellLists(corners.reshape(-1), np.full(len(corners), corners.shape[1]))
    lists = of_lists([NO_CELLS, NO_CELLS, cells, NO_CELLS], len(points))
    return _mesh_file(points, lists, of_points or {}, of_faces or {})


def _of_image(given: Any) -> MeshFile:
    """An image of nibabel: through the bytes of its file, for which there is one parser."""
    from .formats.gii.parse import parse_gifti

    return parse_gifti(given.to_xml())


def _points(points: Any) -> NDArray[Any]:
    array = np.asarray(points)
    if array.ndim != 2 or array.shape[1] not in (2, 3) or array.dtype.kind not in "fiu":
        raise InputError(f"points have shape {array.shape} and type {array.dtype}, expected numbers of shape (V, 3)")
    return array if array.shape[1] == 3 else np.column_stack((array, np.zeros(len(array))))


def _mesh_file(points: NDArray[Any], faces: Any, of_points: Any, of_cells: Any) -> MeshFile:
    from .registry import ParserOptions
    from .vtk.attributes import Attribute, ignored
    from .vtk.dataset import DataSet, VtkPiece, mesh_file

    notices: list[Notice] = []

    def attributes(data: Mapping[str, Any], count: int) -> Iterable[Attribute]:
        roles = {getattr(data, f"active_{key}_name", None): key for key in ("normals", "texture_coordinates")}
        for name, given in data.items():
            values = np.asarray(given)
            if values.ndim == 0 or len(values) != count:
                raise InputError(f"data `{name}` of shape {values.shape}, {count} rows expected")
            if values.dtype.kind in "OSU":
                yield Attribute(name, [str(value) for value in values.reshape(count, -1)[:, 0]] if values.size else [])
            elif values.dtype.kind in "fiub":
                flat = values if values.ndim == 1 else values.reshape(count, -1)
                yield Attribute(name, flat.copy(), roles.get(name, "").removesuffix("_coordinates"))
            else:
                notices.extend(ignored([name], f"of type {values.dtype}", "numbers or words are kept"))

    piece = VtkPiece(points, faces, list(attributes(of_points, len(points))), list(attributes(of_cells, faces.cells)))
    return mesh_file(DataSet([piece], notices=notices), "arrays", ParserOptions(normals=True, texture=True))


_Convert = Callable[[Any], MeshFile | None]

_KINDS: tuple[tuple[tuple[str, ...], _Convert], ...] = (
    (("points", "celltypes", "cell_connectivity"), _of_grid),
    (("points", "verts", "lines", "faces", "strips"), _of_polydata),
    (("points", "cells", "cells_dict", "cell_data"), _of_blocks),
    (("vertices", "faces"), _of_attributes),
    (("vertices", "triangles"), lambda mesh: _of_triangles(mesh.vertices, mesh.triangles)),
    (("vertex_matrix", "face_matrix"), lambda mesh: _of_triangles(mesh.vertex_matrix(), mesh.face_matrix())),
    (("darrays", "agg_data", "to_xml"), _of_image),
    (("vertices", "cells"), lambda mesh: _of_triangles(mesh.vertices, mesh.cells)),
)

"""Texture map: the texture coordinates of a file as a map of its surface into the plane."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, Notice
from ..mesh.file import MeshFile
from ..mesh.orientation import same_direction
from ..mesh.surface import Surface
from ..mesh.topology import next_corner
from ..support.arrays import Floats, Index
from .maps import SurfaceMap

# Names of the texture coordinates of vertices in various programs.
_PROPERTIES = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"), ("texture_s", "texture_t"))


class TextureMap(SurfaceMap):
    """Map f of a surface to its texture coordinates (u, v), linear on faces.

    The surface is cut open at a seam: corners of one vertex with different coordinates. f is continuous on the
    surface that is cut along its seams, and E(f), the sum over faces, is its energy there; no face is missing, and
    nothing is added for a seam. The vertices along it are boundary vertices of the cut surface.
    surface: with a file that has texture coordinates at every corner (`load(..., texture=True)` for an OBJ file).
    vertex: (n,) vertex of the surface at each vertex of the cut surface, ascending. seams: edges that are cut.
    Errors: InputError where there are none, or some corner has none.
    """

    image_name = "texture coordinates"

    def __init__(self, surface: Surface) -> None:
        uv = _coordinates(surface)
        self.vertex, faces = _cut(surface.faces, uv)
        image = np.zeros((len(self.vertex), 3))
        image[faces.ravel(), :2] = uv.reshape(2, -1).T
        source = Surface(
            surface.points[self.vertex],
            faces,
            orient=surface.orient,
            polygon=surface.polygon,
            file=surface.file,
            notices=surface.notices,
        )
        super().__init__(source, image)
        self.source_vertices = surface.n_vertices
        self.seams = _seams(surface, faces)

    @cached_property
    def notices(self) -> list[Notice]:
        """Notices of the map, and the number of edges that are seams."""
        message = "[edge|edges] along which the texture is cut; vertices there count as boundary"
        hint = "the energy is that of the surface cut open: the sum over its faces"
        seams = Notice.of("texture_seams", (), message, hint, self.seams or 0)
        notices = super().notices
        return [seams, *notices] if seams.count else notices

    @cached_property
    def harmonic(self) -> tuple[float, int | None, float]:
        """Largest residual, its vertex in the file, and the bound on its rounding."""
        residual, vertex, bound = super().harmonic
        return residual, None if vertex is None else int(self.vertex[vertex]), bound

    def vertex_table(self) -> dict[str, NDArray[Any]]:
        """One row per vertex and place in the texture: the vertex of the file, then as of every map."""
        return super().vertex_table() | {"vertex": self.vertex.astype(np.int32)}


def _coordinates(surface: Surface) -> Floats:
    """(2, F, 3) coordinates at the corners of the faces."""
    file = surface.file
    path = file.path if file is not None else None
    coordinates = (
        None if file is None else _of_corners(file, surface) if file.corner_texture is not None else _of_file(file)
    )
    if coordinates is None:
        hint = "expected `vt` records in an OBJ file, or vertex properties s and t, or u and v, in a PLY file"
        raise InputError("has no texture coordinates", path=path, hint=hint)
    uv = coordinates if coordinates.ndim == 3 else coordinates[:, surface.faces]
    bad = np.flatnonzero(~np.isfinite(uv).all(axis=(0, 2)))
    if len(bad):
        problem = f"{len(bad)} of {surface.n_faces} faces have a corner without texture coordinates, expected none"
        raise InputError(
            problem, path=path, place=f"face {bad[0]}", hint="map the whole surface, or remove these faces"
        )
    return uv + 0.0


def _of_file(file: MeshFile) -> Floats | None:
    """(2, V) coordinates among the properties of vertices."""
    for names in _PROPERTIES:
        if all(name in file.vertex_properties for name in names):
            return np.array([file.vertex_properties[name] for name in names], np.float64)
    return None


def _of_corners(file: MeshFile, surface: Surface) -> Floats:
    """(2, F, 3) those of the corners of the polygon that each face was cut from."""
    assert file.corner_texture is not None
    if surface.polygon is None:
        return file.corner_texture.reshape(2, -1, 3)
    sizes = np.full(file.polygons, 3) if file.sizes is None else file.sizes
    rows = surface.n_vertices
    key = np.repeat(np.arange(len(sizes)), sizes) * rows + file.corners
    order = np.argsort(key, kind="stable")
    wanted = surface.polygon.astype(np.int64)[:, None] * rows + surface.faces
    return file.corner_texture[:, order[np.searchsorted(key[order], wanted)]]


def _cut(faces: Index, uv: Floats) -> tuple[NDArray[np.int64], Index]:
    """Vertex of each pair of vertex and texture coordinates, and the faces in terms of these pairs."""
    corner = faces.ravel().astype(np.int64)
    u, v = uv.reshape(2, -1)
    order = np.lexsort([v, u, corner])
    new = np.ones(len(order), bool)
    new[1:] = np.logical_or.reduce([side[order][1:] != side[order][:-1] for side in (corner, u, v)])
    number = np.empty(len(order), np.int32)
    number[order] = np.cumsum(new) - 1
    return corner[order[new]], number.reshape(-1, 3)


def _seams(surface: Surface, faces: Index) -> int:
    """Number of edges whose two faces have different texture coordinates at its ends."""
    half_edge, twin = surface.edges.pairs
    same = same_direction(surface.faces, half_edge, twin)
    ends = [faces.ravel()[side] for side in (half_edge, next_corner(half_edge), twin, next_corner(twin))]
    tail, head = np.where(same, ends[2], ends[3]), np.where(same, ends[3], ends[2])
    return int(np.count_nonzero((ends[0] != tail) | (ends[1] != head)))

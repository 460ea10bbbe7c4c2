"""Triangulation of polygons: a fan from the first corner if convex, else ear clipping."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, Notice
from .arrays import freeze
from .ears import EFFORT_PER_CORNER, clip_ears
from .file import MeshFile
from .surface import Orient, Surface
from .triangles import cross, dot

_RESERVE = 500_000_000
"""Largest effort for intricate polygons of one file, beyond the usual one (a few seconds)."""


def triangulate(mesh: MeshFile) -> tuple[NDArray[np.int32], NDArray[np.int32] | None, tuple[Notice, ...]]:
    """Triangulate a mesh: triangles (F, 3), the polygon of each (F,) or None if all are triangles, and notices.

    A polygon of k corners becomes k - 2 consecutive triangles with its winding and its border. Convexity is tested in
    the plane of its area vector (Newell), independently of its size and position.
    """
    if mesh.sizes is None:
        return mesh.corners.reshape(-1, 3), None, ()
    sizes = mesh.sizes
    ends = np.cumsum(sizes, dtype=np.int64)
    begins = ends - sizes
    triangles = np.maximum(sizes - 2, 0)
    offset = np.cumsum(triangles, dtype=np.int64) - triangles
    faces = np.empty((int(triangles.sum()), 3), np.int32)
    concave: list[int] = []
    for size in np.unique(sizes[sizes >= 3]).tolist():
        which = np.flatnonzero(sizes == size)
        rows = mesh.corners[begins[which][:, None] + np.arange(size)]
        fan = np.empty((len(which), size - 2, 3), np.int32)
        fan[:, :, 0] = rows[:, :1]
        fan[:, :, 1] = rows[:, 1:-1]
        fan[:, :, 2] = rows[:, 2:]
        faces[offset[which][:, None] + np.arange(size - 2)] = fan
        if size > 3:
            concave += which[~_is_convex(mesh.xyz[:, rows])].tolist()
    crossed, reserve = [], _RESERVE
    for p in concave:
        corners = mesh.corners[begins[p] : ends[p]]
        usual = EFFORT_PER_CORNER * len(corners)
        cut, simple, effort = clip_ears(_in_plane(mesh.xyz[:, corners]), usual + reserve)
        reserve -= max(0, effort - usual)
        faces[offset[p] : offset[p] + triangles[p]] = corners[cut]
        if not simple:
            crossed.append(p)
    return faces, np.repeat(np.arange(len(sizes), dtype=np.int32), triangles), _notices(sizes, len(concave), crossed)


def _notices(sizes: NDArray[np.int32], concave: int, crossed: list[int]) -> tuple[Notice, ...]:
    many = np.flatnonzero(sizes > 3)
    if not len(many):
        return ()
    notices = [
        Notice.at(
            "polygons_triangulated",
            many,
            f"[polygon|polygons] of more than 3 corners, triangulated; {concave} not convex",
            "curvatures depend on the diagonals where a polygon is not flat: triangulate to choose them",
        )
    ]
    if crossed:
        notices.append(
            Notice.at(
                "polygons_not_simple",
                crossed,
                "[polygon that crosses itself, lies|polygons that cross themselves, lie] in no plane or "
                "[is|are] too intricate; [its|their] triangles may overlap",
                "triangulate where the mesh is made; --table faces=PATH shows the triangles of each polygon",
            )
        )
    return tuple(notices)


def _from_first(p: NDArray[np.float64]) -> NDArray[np.float64]:
    """Polygons p (3, n, k) seen from their first corner, each scaled to size 1."""
    with np.errstate(invalid="ignore", over="ignore"):
        d = p - p[:, :, :1]
        size = np.abs(d).max(axis=(0, 2))
        return np.asarray(d / np.where(size > 0, size, 1.0)[:, None])


def _area_vectors(d: NDArray[np.float64]) -> NDArray[np.float64]:
    """Twice the area vectors (3, n) of polygons seen from their first corner."""
    return np.asarray(np.array(cross(d[:, :, 1:-1], d[:, :, 2:])).sum(-1))


def _is_convex(p: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(n,) flags: no corner, and no triangle of the fan, turns against the area vector of its polygon.

    p: (3, n, k). Corners that are not finite count as convex; the surface refuses them later.
    """
    d = _from_first(p)
    with np.errstate(invalid="ignore", over="ignore"):
        normal = _area_vectors(d)[:, :, None]
        step = np.roll(d, -1, 2) - d
        turn = dot(cross(step, np.roll(step, -1, 2)), normal)
        fan = dot(cross(d[:, :, 1:-1], d[:, :, 2:]), normal)
        return np.asarray((turn >= 0).all(1) & (fan >= 0).all(1) | ~np.isfinite(d).all((0, 2)))


def _in_plane(p: NDArray[np.float64]) -> NDArray[np.float64]:
    """Coordinates (2, k) of a polygon p (3, k) in the plane of its area vector, counter-clockwise."""
    d = _from_first(p[:, None, :])
    normal = _area_vectors(d)[:, 0]
    length = float(np.linalg.norm(normal))
    if not length > 0:
        return d[:2, 0]
    normal = normal / length
    u = np.zeros(3)
    u[np.argmin(np.abs(normal))] = 1.0
    u -= normal * (normal @ u)
    return np.stack([u, np.cross(normal, u)]) @ d[:, 0]


def from_file(file: MeshFile, orient: Orient = "file") -> Surface:
    """The surface of a mesh file, its polygons triangulated.

    Errors: InputError for a file without faces, or for coordinates of faces that are not finite.
    """
    try:
        faces, polygon, notices = triangulate(file)
        for array in (file.xyz, faces):
            freeze(array)
        if not len(faces) and file.polylines:
            raise InputError("no faces, only `l` polylines", hint="`curvcli curves` measures polylines")
        return Surface(file.xyz.T, faces, orient=orient, polygon=polygon, file=file, notices=(*file.notices, *notices))
    except InputError as error:
        error.path = error.path or file.path
        raise

"""Star sums of all vertices, in one blocked sweep over the faces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import cycle

import numpy as np
from numpy.typing import NDArray

from ...mesh.surface import Surface
from ...mesh.topology import faces_at
from ...mesh.triangles import Triangles, cross, triangles
from ...support.arrays import Floats, Index, Mask, Sign
from ...support.blocks import ENTRIES, background_thread, for_each, slices

# Stars with more faces are summed pairwise.
LARGE_STAR = 32


@dataclass(frozen=True)
class StarSums:
    """Sums at vertices and values at faces from one sweep, in the unit of computation.

    angle_sum: (V,). area: (V,) of the star. vector, curvature: (3, V) vector area and curvature vector. extent: (V,)
    sum of the extents of the faces, for bounds of rounding. face_area: (F,). degenerate_face: (F,) faces without area.
    coincident: (V,) at a corner of a face without an angle there.
    """

    angle_sum: Floats
    area: Floats
    vector: Floats
    curvature: Floats
    extent: Floats
    face_area: Floats
    degenerate_face: Mask
    coincident: Mask


def star_sums(surface: Surface) -> StarSums:
    """Angle sums, areas, vector areas, curvature vectors and extents of all stars in one blocked sweep.

    The faces of a star have the sign in its vector area that orients the star (`Surface.corner_sign`). The curvature
    vector is minus the gradient of the star's area; the gradient of a triangle's area with respect to a corner is half
    the opposite edge turned within its plane, ½ ν × d.
    """
    sums = _sweep(surface.xyz, surface.faces, surface.corner_sign)
    _resum_large_stars(surface, sums.angle_sum, sums.area, *sums.vector, *sums.curvature)
    return sums


def _sweep(xyz: Floats, faces: Index, sign: Sign | None) -> StarSums:
    n, n_faces = xyz.shape[1], len(faces)
    angle, area, extents = np.empty(n), np.empty(n), np.empty(n)
    vector, curvature = np.empty((3, n)), np.empty((3, n))
    # Touched for the first time in order and by two threads, memory costs less than where the sums happen to fall.
    for_each([angle, area, extents, *vector, *curvature], lambda row: row.fill(0))
    face_area = np.empty(n_faces)
    degenerate, coincident = np.zeros(n_faces, bool), np.zeros(n, bool)

    def add_angles(corners: NDArray[np.intp], angles: Callable[[], list[Floats]]) -> None:
        for corner, each in zip(corners, angles(), strict=True):
            np.add.at(angle, corner, each)

    waiting = None
    # The thread's results have memory of their own, two blocks in turn: memory that the thread allocates itself is
    # returned to the system with every block.
    rooms = cycle(np.empty((2, 3, min(ENTRIES, n_faces))))
    # Arc tangents take nearly half of the sweep. A second thread computes those of a block beside the rest of it: core
    # takes 0.47 s instead of 0.50 s at 1,000,000 vertices, medians of 5 in turn on two idle cores.
    with background_thread(n_faces > ENTRIES) as begun:
        for block in slices(n_faces):
            t = triangles(xyz, faces[block])
            angles = begun(partial(t.angles, next(rooms)))
            sixth, extent = t.twice_area / 6, t.extent()
            face_area[block] = t.twice_area / 2
            for corner in t.corners:
                np.add.at(area, corner, sixth)
                np.add.at(extents, corner, extent)
            if t.degenerate is not None:
                degenerate[block] = t.degenerate
                _mark_coincident(coincident, t)
            at_0, at_2 = _gradient_terms(t)
            for k in range(3):
                third = t.normal[k] / 6
                for j, corner in enumerate(t.corners):
                    np.add.at(vector[k], corner, third if sign is None else third * sign[block, j])
                np.subtract.at(curvature[k], t.corners[0], at_0[k])
                np.add.at(curvature[k], t.corners[1], at_0[k] + at_2[k])
                np.subtract.at(curvature[k], t.corners[2], at_2[k])
            if waiting is not None:
                add_angles(*waiting)
            waiting = t.corners, angles
        if waiting is not None:
            add_angles(*waiting)
    return StarSums(angle, area, vector, curvature, extents, face_area, degenerate, coincident)


def _gradient_terms(t: Triangles) -> tuple[list[Floats], list[Floats]]:
    """Gradients of the areas with respect to corners 0 and 2; that of corner 1 is minus their sum."""
    half_over = np.divide(0.5, t.twice_area, where=t.twice_area > 0, out=np.zeros_like(t.twice_area))
    half_normal = [component * half_over for component in t.normal]
    return cross(half_normal, t.v), cross(half_normal, t.u)


def _resum_large_stars(surface: Surface, *sums: Floats) -> None:
    """Sum large stars again pairwise: a running sum of thousands of faces would lose the last digits.

    sums: rows of angles, areas, vector areas and curvature vectors.
    """
    large = surface.corner_count > LARGE_STAR
    if not large.any():
        return
    chosen = faces_at(surface.faces, large)
    vertices, terms = [], []
    for block in slices(len(chosen)):
        face = surface.faces[chosen[block]]
        sign = None if surface.corner_sign is None else surface.corner_sign[chosen[block]]
        t = triangles(surface.xyz, face)
        at_0, at_2 = _gradient_terms(t)
        curvatures = [-x for x in at_0], [x + y for x, y in zip(at_0, at_2, strict=True)], [-x for x in at_2]
        for k, corner in enumerate(t.corners):
            kept = large[corner]
            thirds = [x / 6 if sign is None else x / 6 * sign[:, k] for x in t.normal]
            rows = [t.angle(k), t.twice_area / 6, *thirds, *curvatures[k]]
            vertices.append(corner[kept])
            terms.append(np.stack(rows)[:, kept])
    vertex, each = np.concatenate(vertices), np.concatenate(terms, axis=1)
    order = np.argsort(vertex, kind="stable")
    start = np.flatnonzero(np.diff(vertex[order], prepend=-1))
    for row, term in zip(sums, each, strict=True):
        row[vertex[order[start]]] = np.add.reduceat(term[order], start)


def _mark_coincident(coincident: Mask, t: Triangles) -> None:
    """Mark corners that coincide with another corner of their face: their angle is undefined."""
    for k, corner in enumerate(t.corners):
        coincident[corner[t.no_angle(k)]] = True

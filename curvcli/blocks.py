"""Sweeps over the faces in cache-sized blocks: the one place where geometry is gathered and scattered.

Coordinates are kept apart so that every operand is contiguous, a block's temporaries stay in the second-level cache,
and `np.add.at` scatters; this is several times faster than the same formulas on whole arrays.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .compensated import cross_of_edges
from .slices import ENTRIES, slices
from .threads import another_thread, for_each
from .topology import Index, Mask, faces_at

if TYPE_CHECKING:
    from .orientation import Sign
    from .surface import Surface

Floats = NDArray[np.float64]
Vector = Sequence[Floats] | Floats

EPSILON = float(np.finfo(np.float64).eps)

# A vector area below this part of the area, or a scalar product below this part of |a||b|, is rounding alone.
LOST = 1e-12

# Stars of more faces are summed in pairs.
LARGE_STAR = 32

# Below this ratio of twice the area to the longest edge squared, the cross product is worth its compensated form.
_THIN = 1 / 16

# Below this a square has lost digits to underflow.
_SMALL_SQUARE = 2.0**-960
# Areas below this count as none: their inverse would leave the range of doubles.
NO_AREA = 2.0**-1000


def cross(a: Vector, b: Vector) -> list[Floats]:
    """a × b of vectors given by their components."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a: Vector, b: Vector) -> Floats:
    """a · b of vectors given by their components."""
    product: Floats = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return product


def span(xyz: Vector, a: NDArray[np.integer], b: NDArray[np.integer]) -> list[Floats]:
    """The vectors from points a to points b; xyz: one row per coordinate, a, b: indices, fastest as intp."""
    return [x.take(b) - x.take(a) for x in xyz]


@dataclass(frozen=True)
class Triangles:
    """The geometry of some faces.

    corners: (3, n) their vertices, see `by_corner`.
    u, v, w: edge vectors from corner 0 to 1, 1 to 2 and 0 to 2. normal: u × w. twice_area: its length.
    cosines: for each corner the dot product of the two edges that leave it. half_squares: their sum, ½ Σ|e|².
    degenerate: |u × w| ≤ 4 ε · (longest edge)², None where no face is.
    """

    corners: NDArray[np.intp]
    u: Vector
    v: Vector
    w: Vector
    normal: Vector
    twice_area: Floats
    cosines: tuple[Floats, Floats, Floats]
    half_squares: Floats
    degenerate: Mask | None

    def no_angle(self, corner: int) -> Mask:
        """Faces that have no angle at a corner: it lies on another one, or the product of its edges is lost."""
        return np.maximum(np.abs(self.cosines[corner]), self.twice_area) < _SMALL_SQUARE

    def angle(self, corner: int, out: Floats | None = None) -> Floats:
        """The angle at a corner."""
        angle: Floats = np.arctan2(self.twice_area, self.cosines[corner], out=out)
        return angle

    def angles(self, room: Floats) -> list[Floats]:
        """The angle at each corner; room: (3, n or more) where they are put."""
        n = len(self.twice_area)
        return [self.angle(corner, row[:n]) for corner, row in enumerate(room)]

    def extent(self) -> Floats:
        """√(¾ Σ|e|²): no less than half the perimeter, nor more than 1.23 times that, for the root of one sum."""
        extent: Floats = np.sqrt(1.5 * self.half_squares)
        return extent


def by_corner(faces: Index) -> NDArray[np.intp]:
    """(3, n) the corners of some faces, one contiguous row for each, in the type that numpy gathers and scatters by."""
    return np.array(faces.T, np.intp, order="C")


def triangles(xyz: NDArray[np.float64], faces: Index) -> Triangles:
    """Edge vectors, normals and dot products of the given faces, to the last digits also where they are thin."""
    corners = by_corner(faces)
    p, q, r = ([x.take(corner) for x in xyz] for corner in corners)
    u, w = [b - a for a, b in zip(p, q, strict=True)], [c - a for a, c in zip(p, r, strict=True)]
    v = [c - b for b, c in zip(q, r, strict=True)]
    normal = cross(u, w)
    square = dot(normal, normal)
    cosines = dot(u, w), -dot(u, v), dot(w, v)
    # |u|² = cos₀ + cos₁ and so on: the longest is the sum without the smallest.
    half_squares = cosines[0] + cosines[1] + cosines[2]
    longest = half_squares - np.minimum(np.minimum(cosines[0], cosines[1]), cosines[2])
    thin = np.flatnonzero(square <= (_THIN * longest) ** 2 + _SMALL_SQUARE)
    degenerate, twice_area = None, np.sqrt(square)
    if len(thin):
        exact = cross_of_edges(*([x[thin] for x in corner] for corner in (p, q, r)))
        area, sides = _length(exact), [[x[thin] for x in side] for side in (u, v, w)]
        # Where two corners coincide, rounding would leave the face an area, and the corners an angle.
        none = np.logical_or.reduce([area < NO_AREA, *(~np.any(side, axis=0) for side in sides)])
        area[none] = 0.0
        for component, better in zip(normal, exact, strict=True):
            component[thin] = np.where(none, 0.0, better)
        twice_area[thin] = area
        lengths = [dot(edge, edge) for edge in sides]
        longest = np.maximum(np.maximum(lengths[0], lengths[1]), lengths[2])
        small = (area <= np.maximum(4 * EPSILON * longest, NO_AREA)) | (longest < _SMALL_SQUARE)
        if small.any():
            degenerate = np.zeros(len(faces), bool)
            degenerate[thin[small]] = True
    return Triangles(corners, u, v, w, normal, twice_area, cosines, half_squares, degenerate)


def _length(vector: Vector) -> Floats:
    """|v|, also where its square is lost to underflow."""
    square = dot(vector, vector)
    length: Floats = np.sqrt(square)
    tiny = np.flatnonzero(square < _SMALL_SQUARE)
    if len(tiny):
        length[tiny] = np.hypot(np.hypot(vector[0][tiny], vector[1][tiny]), vector[2][tiny])
    return length


def triple_products(surface: Surface, label: Index) -> Floats:
    """(F,) six times the volume that each face, as the file winds it, spans with the base point of its group.

    label: group of each face; the base is the first corner of the group's first face. The sum over a closed group does
    not depend on it, but its rounding does. Integer corners give integers, whose sums are exact; sixths are not.
    """
    product, base = np.empty(surface.n_faces), _bases(surface, label)
    for block in slices(surface.n_faces):
        t = triangles(surface.xyz, surface.faces[block])
        # With the normal of the face: the product of two corners would have the error of their lengths, not of areas.
        product[block] = dot(_from_base(surface, base, label[block], t), t.normal)
    return product


def volume_errors(surface: Surface, label: Index, chosen: NDArray[np.integer]) -> Floats:
    """(n,) what rounding may add to the volumes that the chosen faces span and to the sum of these."""
    terms, base = np.empty(len(chosen)), _bases(surface, label)
    for block in slices(len(chosen)):
        t = triangles(surface.xyz, surface.faces[chosen[block]])
        seen = _from_base(surface, base, label[chosen[block]], t)
        terms[block] = np.sqrt(dot(seen, seen)) * t.twice_area / 6
    errors: Floats = (16 + np.log2(len(chosen))) * EPSILON * terms
    return errors


def _bases(surface: Surface, label: Index) -> Floats:
    """(3, G) the first corner of the first face of each group; of one group the base of the surface."""
    if label.max() == 0:
        return surface.base[:, None]
    first = np.full(int(label.max()) + 1, surface.n_faces, np.int64)
    np.minimum.at(first, label, np.arange(surface.n_faces))
    return surface.xyz[:, surface.faces[first, 0]]


def _from_base(surface: Surface, base: Floats, label: Index, t: Triangles) -> list[Floats]:
    """The first corners of some triangles, seen from the bases of their groups."""
    at = base if base.shape[1] == 1 else base[:, label]
    return [x.take(t.corners[0]) - b for x, b in zip(surface.xyz, at, strict=True)]


@dataclass(frozen=True)
class StarSums:
    """What one sweep over the faces leaves at vertices and faces; see the passes that publish it."""

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

    Each star's faces enter its vector area with the sign that orients the star (`Surface.corner_sign`). The curvature
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
    # Memory that another thread allocates is given back and touched anew with every block; two are in use at a time.
    rooms = cycle(np.empty((2, 3, min(ENTRIES, n_faces))))
    # Arc tangents are nearly half of the work: those of a block are worked out beside all the rest of it.
    with another_thread(n_faces > ENTRIES) as begun:
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
    """Sum large stars again in pairs: one after the other, thousands of faces would cost the last digits.

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
    """Mark corners that lie on another corner of their face: their angle there has no meaning."""
    for k, corner in enumerate(t.corners):
        coincident[corner[t.no_angle(k)]] = True

"""Sides of points about closed surfaces, by winding numbers from certain signs."""

from __future__ import annotations

from functools import reduce
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...support.arrays import Floats, Ints, Mask
from ...support.blocks import slices
from ..triangles import EPSILON, Vector, cross, dot
from .boxes import BoxTree

if TYPE_CHECKING:
    from fractions import Fraction


# Determinants of three differences of coordinates have an error below 5ε times the sum of their absolute terms.
CERTAIN = 8 * EPSILON
# Rounding of coordinates that were rotated, moved and written, relative to the largest of them.
ROUNDING = 8 * EPSILON
# Rays with signs undecided in double precision are followed exactly, so many at a time.
_FEW = 2048

# The axes of a rotation in general position to the coordinate planes; rays run along the third axis.
_a, _b, _c, _d = 0.6210733, 0.3717021, 0.5478113, 0.4193127
_AXES = np.array(
    [
        [_a * _a + _b * _b - _c * _c - _d * _d, 2 * (_b * _c - _a * _d), 2 * (_b * _d + _a * _c)],
        [2 * (_b * _c + _a * _d), _a * _a - _b * _b + _c * _c - _d * _d, 2 * (_c * _d - _a * _b)],
        [2 * (_b * _d - _a * _c), 2 * (_c * _d + _a * _b), _a * _a - _b * _b - _c * _c + _d * _d],
    ]
)

INSIDE, OUTSIDE, UNDECIDED = 1, 0, -1


def size(vector: Vector) -> Floats:
    """(n,) lengths |v| of (3, n) vectors."""
    length: Floats = np.sqrt(dot(vector, vector))
    return length


def permanent(a: Vector, b: Vector) -> list[Floats]:
    """(3, n) a × b with absolute values and plus signs: a bound of its terms."""
    return [a[1] * b[2] + a[2] * b[1], a[2] * b[0] + a[0] * b[2], a[0] * b[1] + a[1] * b[0]]


def certain_sign(value: Floats, error: Floats) -> NDArray[np.int8]:
    """(n,) sign of a value, +1 or -1, where it exceeds its error, else 0."""
    return (value > error).astype(np.int8) - (value < -error).astype(np.int8)


class Sides:
    """Closed surfaces, for queries of the side of a point.

    xyz: (3, V). faces: (n, 3) corners. group: (n,) the surface of each face.
    """

    def __init__(self, xyz: Floats, faces: NDArray[np.integer[Any]], group: Ints, groups: int) -> None:
        self.xyz, self.faces = xyz, np.ascontiguousarray(faces.T, np.intp)
        self._base = xyz[:, self.faces[0, 0]]
        low, high = np.empty((3, len(group))), np.empty((3, len(group)))
        self.reach = np.empty(len(group))
        for block in slices(len(group)):
            corners = [np.array([x.take(corner[block]) for x in xyz]) for corner in self.faces]
            a, b, c = (self._turned(corner) for corner in corners)
            np.minimum(np.minimum(a, b), c, out=low[:, block])
            np.maximum(np.maximum(a, b), c, out=high[:, block])
            self.reach[block] = reduce(np.maximum, (np.abs(row) for corner in corners for row in corner))
        # Contact is tested within the rounding of the coordinates, rotation included.
        margin = 16 * EPSILON * max(np.abs(low).max(), np.abs(high).max()) + 4 * ROUNDING * self.reach.max()
        self.tree = BoxTree(low - margin, high + margin, group, groups)

    def _turned(self, points: Floats) -> Floats:
        turned: Floats = np.einsum("ij,jn->in", _AXES, points - self._base[:, None])
        return turned

    def corners(self, face: Ints) -> Floats:
        """(3, 3, n) the corners of some faces: corner, coordinate, face."""
        return np.array([[x.take(corner.take(face)) for x in self.xyz] for corner in self.faces])

    def of(self, points: Floats, group: Ints) -> NDArray[np.int8]:
        """(n,) the side of points (3, n) about one surface each: INSIDE for a nonzero winding number, else OUTSIDE;
        UNDECIDED within rounding of a face."""
        turned = self._turned(points)
        undecided = np.zeros(len(group), bool)
        for point, face in self.tree.holding(turned, group):
            undecided[point[self._near(points[:, point], face)]] = True
        clear = np.flatnonzero(~undecided)
        winding = np.zeros(len(group), np.int64)
        for number, face in self.tree.holding(turned[:, clear], group[clear], above=True):
            point = clear[number]
            crossing, open_ = self._crossed(points[:, point], face)
            np.add.at(winding, point, crossing)
            undecided[point[open_]] = True
        return np.where(undecided, UNDECIDED, winding != 0).astype(np.int8)

    def _near(self, points: Floats, face: Ints) -> Mask:
        """(n,) flags: the point is within the rounding of coordinates of its face."""
        d = self.corners(face) - points
        distance = np.full(len(face), np.inf)
        for a, b in ((0, 1), (1, 2), (2, 0)):
            along = d[b] - d[a]
            square = dot(along, along)
            part = np.divide(-dot(d[a], along), square, where=square > 0, out=np.zeros_like(square)).clip(0, 1)
            np.minimum(distance, size(d[a] + part * along), out=distance)
        spokes = cross(d[0], d[1]), cross(d[1], d[2]), cross(d[2], d[0])
        normal = [x + y + z for x, y, z in zip(*spokes, strict=True)]
        over = np.logical_and.reduce([dot(normal, spoke) >= 0 for spoke in spokes])
        length = size(normal)
        height = np.divide(np.abs(dot(d[0], normal)), length, where=length > 0, out=np.full(len(face), np.inf))
        reach = np.maximum(self.reach.take(face), np.abs(points).max(axis=0))
        near: Mask = np.minimum(distance, np.where(over, height, np.inf)) <= ROUNDING * reach
        return near

    def _crossed(self, points: Floats, face: Ints) -> tuple[NDArray[np.int64], Mask]:
        """(n,) crossings of rays with faces: +1 through the outer side, -1 through the inner side, 0 for none; flags
        of the rays that are undecided because they meet an edge."""
        a, b, c = d = self.corners(face) - points
        sizes = np.abs(d)
        normals = cross(b, c), cross(c, a), cross(a, b)
        terms = permanent(sizes[1], sizes[2]), permanent(sizes[2], sizes[0]), permanent(sizes[0], sizes[1])
        ray = _AXES[2]
        signs = np.stack(
            [certain_sign(dot(ray, n), CERTAIN * dot(np.abs(ray), t)) for n, t in zip(normals, terms, strict=True)]
        )
        least, most = signs.min(axis=0), signs.max(axis=0)
        through = np.abs(signs.sum(axis=0)) == 3
        up = certain_sign(dot(a, normals[0]), CERTAIN * dot(sizes[0], terms[0]))
        crossing = np.where(through & (up == signs[0]), signs[0], 0).astype(np.int64)
        open_ = (through & (up == 0)) | ~(through | ((least < 0) & (most > 0)))
        for k in np.flatnonzero(open_)[:_FEW]:
            corners = [[float(x[corner[face[k]]]) for x in self.xyz] for corner in self.faces]
            sign = _exactly_crossed(points[:, k].tolist(), corners)
            if sign is not None:
                crossing[k], open_[k] = sign, False
        return crossing, open_


def _exactly_crossed(point: list[float], corners: list[list[float]]) -> int | None:
    """The crossing of one ray in rational arithmetic; None if it meets an edge of the face or begins on it."""
    from fractions import Fraction

    start, ray = [Fraction(x) for x in point], [Fraction(float(x)) for x in _AXES[2]]
    a, b, c = ([Fraction(x) - p for x, p in zip(corner, start, strict=True)] for corner in corners)
    signs = [_determinant(ray, *two) for two in ((b, c), (c, a), (a, b))]
    if min(signs) < 0 < max(signs):
        return 0
    if not (min(signs) > 0 or max(signs) < 0):
        # A ray in the plane of a face meets no inner point of it; it may miss the face altogether.
        return None
    height = _determinant(a, b, c)
    if height == 0:
        return None
    way = 1 if signs[0] > 0 else -1
    return way if (height > 0) == (way > 0) else 0


def _determinant(a: list[Fraction], b: list[Fraction], c: list[Fraction]) -> Fraction:
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])

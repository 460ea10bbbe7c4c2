"""Normal cones of the convex hulls of stars, as solid angles.

Directions have shape (3, d, n): d directions at each of n apices, and all apices are computed at once. Few directions
in general position use an enumeration of facets, n d³ simple operations; the other hulls are built incrementally
with exact signs.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from ...mesh.triangles import EPSILON, cross, dot
from ...support.arrays import Floats, Mask
from .hulls import hull_cone_areas

# Up to so many directions, all determinants cost less than an incremental hull.
_COUNTED = 16
# The error bound of a determinant of unit vectors, with room.
_COPLANAR = 32 * EPSILON
# Squares below this have lost digits to underflow.
_UNDERFLOW = float(np.finfo(np.float64).tiny) / EPSILON


def normal_cone_areas(directions: Floats) -> Floats:
    """(n,) solid angle of the normal cone {x: x·d_i ≤ 0} of the cone that the directions span.

    2π − Σ of the angles between neighbouring extreme directions; 0 where the cone contains a line. directions:
    (3, d, n), none of them zero.
    """
    if directions.shape[1] > _COUNTED:
        return hull_cone_areas(directions)
    area, unsure = _by_facets(directions)
    rest = np.flatnonzero(unsure)
    if len(rest):
        area[rest] = hull_cone_areas(directions[:, :, rest])
    return area


def _by_facets(directions: Floats) -> tuple[Floats, Mask]:
    """Compute the areas for directions in general position, and the mask of the undecided cones.

    Undecided cones have three directions that are coplanar to rounding.

    Two directions span a facet if their determinants with all others have one sign. A cone with none is all of space.
    """
    d, n = directions.shape[1:]
    square = dot(directions, directions).max(axis=0)
    rounding = _COPLANAR * square * np.sqrt(square)
    pairs = list(combinations(range(d), 2))
    place = {pair: k for k, pair in enumerate(pairs)}
    sides = np.zeros((len(pairs), n), np.int8)
    unsure = np.full(n, d < 3) | ((_COPLANAR * square) ** 2 < _UNDERFLOW)
    for i, j in pairs:
        later = d - 1 - j
        if not later:
            continue
        determinant = dot(cross(directions[:, i], directions[:, j]), directions[:, j + 1 :])
        sign = (determinant > rounding).view(np.int8) - (determinant < -rounding).view(np.int8)
        unsure |= (sign == 0).any(axis=0)
        with_i, with_j = place[i, j + 1], place[j, j + 1]
        sides[place[i, j]] += sign.sum(axis=0, dtype=np.int8)
        sides[with_i : with_i + later] -= sign
        sides[with_j : with_j + later] += sign
    facets = np.abs(sides) == d - 2
    area = np.full(n, 2 * np.pi)
    for (i, j), facet in zip(pairs, facets, strict=True):
        there = np.flatnonzero(facet)
        a, b = ([x[end].take(there) for x in directions] for end in (i, j))
        normal = cross(a, b)
        area[there] -= np.arctan2(np.sqrt(dot(normal, normal)), dot(a, b))
    return np.where(facets.any(axis=0), np.maximum(area, 0.0), 0.0), unsure

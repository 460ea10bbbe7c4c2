"""Places of contact: a point in both faces of each pair."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...support.arrays import Floats
from ..triangles import dot


def contact_points(p: Floats, q: Floats) -> Floats:
    """(3, n) a point of each pair of triangles in contact, within rounding: the mean of the points below.

    p, q: (3, 3, n) corners, coordinate, pair. Of the points in which edges of one meet the plane of the other, the
    points in which two edges come nearest, and the corners, those count that lie nearest to both triangles.
    """
    points = [*p, *q]
    for ends, face in ((p, q), (q, p)):
        normal = np.cross(face[1] - face[0], face[2] - face[0], axis=0)
        for a, b in ((0, 1), (1, 2), (2, 0)):
            along = ends[b] - ends[a]
            points.append(ends[a] + _part(dot(normal, face[0] - ends[a]), dot(normal, along)) * along)
            for c, d in ((0, 1), (1, 2), (2, 0)):
                if ends is p:
                    points.append(_nearest(ends[a], along, q[c], q[d] - q[c]))
    candidates = np.array(points)
    distance = np.array([np.maximum(_distance(x, p), _distance(x, q)) for x in candidates])
    reach = np.abs(np.concatenate([p, q])).max(axis=(0, 1)) + np.ptp(np.concatenate([p, q]), axis=0).max(axis=0)
    weight = distance <= distance.min(axis=0) + 64 * np.finfo(np.float64).eps * reach
    return np.asarray((candidates * weight[:, None]).sum(axis=0) / weight.sum(axis=0))


def _part(over: Floats, under: Floats) -> Floats:
    """over / under within 0 … 1; 0 where under is 0."""
    return np.divide(over, under, out=np.zeros_like(over), where=under != 0).clip(0, 1)


def _nearest(a: Floats, u: Floats, b: Floats, v: Floats) -> Floats:
    """The point of the segment a + t u nearest to the line b + s v; a where they are parallel."""
    normal = np.cross(np.cross(u, v, axis=0), v, axis=0)
    return np.asarray(a + _part(dot(normal, b - a), dot(normal, u)) * u)


def _distance(x: Floats, face: Floats) -> Floats:
    """(n,) distance of a point from a triangle; to its plane where it lies over the inside."""
    a, b, c = face
    normal = np.cross(b - a, c - a, axis=0)
    size = np.sqrt(dot(normal, normal))
    height = np.abs(dot(normal, x - a)) / np.where(size > 0, size, 1)
    inside, nearest = size > 0, np.full(x.shape[-1], np.inf)
    for tail, head in ((a, b), (b, c), (c, a)):
        along, d = head - tail, x - tail
        inside &= dot(np.cross(along, d, axis=0), normal) >= 0
        rest = d - _part(dot(d, along), dot(along, along)) * along
        np.minimum(nearest, np.sqrt(dot(rest, rest)), out=nearest)
    return np.where(inside, height, nearest)


def corners_of(xyz: Floats, faces: NDArray[np.integer[Any]]) -> Floats:
    """(3, 3, n) corners of faces (n, 3): corner, coordinate, face."""
    return np.stack([xyz[:, corner] for corner in faces.T])

"""Tangential parts of symmetric tensors at vertices."""

from __future__ import annotations

import numpy as np

from ...mesh.triangles import EPSILON, cross, dot
from ...support.arrays import Floats, VectorColumn

# The six entries of a symmetric 3 × 3 matrix, and the position of each of the nine among them.
ENTRIES = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
WHERE = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])
# Components of a direction whose ratio is within this of 1 are equally large.
_EQUAL = 1 - 64 * EPSILON


def frame(normal: VectorColumn) -> tuple[Floats, Floats]:
    """Two unit vectors that make a right-handed frame with each unit normal, (3, n) each.

    Without branches in the formula (Duff et al., Building an orthonormal basis, revisited): e_x and e_y at ±e_z.
    """
    side = np.copysign(1.0, normal[2])
    slant = -1 / (side + normal[2])
    mixed = normal[0] * normal[1] * slant
    u = np.array([1 + side * normal[0] ** 2 * slant, side * mixed, -side * normal[0]])
    v = np.array([mixed, side + normal[1] ** 2 * slant, -normal[1]])
    return u, v


def _entries(tensor: Floats, normal: VectorColumn) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    """The frame u, v of each unit normal, and the tensor's entries in it: those of uu, vv and uv."""
    u, v = frame(normal)
    image_u, image_v = ([dot(tensor[row], w) for row in WHERE] for w in (u, v))
    return u, v, dot(u, image_u), dot(v, image_v), dot(u, image_v)


def half_gap(tensor: Floats, normal: VectorColumn) -> Floats:
    """Half the difference (≥ 0) of the two tangential eigenvalues of a tensor (6, n); normal (3, n), of unit length."""
    _, _, uu, vv, uv = _entries(tensor, normal)
    return np.asarray(np.hypot(0.5 * (uu - vv), uv))


def tangential(tensor: Floats, normal: VectorColumn) -> tuple[Floats, Floats, Floats, Floats]:
    """Half the sum and half the difference (≥ 0) of the two tangential eigenvalues, and the unit eigenvectors of the
    larger and the smaller one.

    tensor: (6, n). normal: (3, n), of unit length.
    """
    u, v, uu, vv, uv = _entries(tensor, normal)
    half = 0.5 * (uu - vv)
    # The rotation by half the angle of (half, uv) takes u to the eigenvector of the larger eigenvalue.
    turn = 0.5 * np.arctan2(uv, half)
    larger = np.cos(turn) * u + np.sin(turn) * v
    return 0.5 * (uu + vv), np.hypot(half, uv), larger, np.array(cross(normal, larger))


def line(vector: VectorColumn) -> VectorColumn:
    """Choose the sign of a vector so that its first largest component, to rounding, is positive."""
    size = np.abs(vector)
    largest = size >= _EQUAL * size.max(axis=0)
    leading = np.where(largest[0], vector[0], np.where(largest[1], vector[1], vector[2]))
    signed: VectorColumn = np.copysign(1.0, leading) * vector
    return signed

"""Normal holonomy of a closed polygon in any dimension."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..errors import InputError
from ..support.arrays import Floats
from .polygon import curves_of
from .turning import Turning

_EDGES_PER_BLOCK = 4096


def normal_holonomy(points: ArrayLike) -> Floats:
    """Compute the rotation of the normals of the first edge by parallel transport once round a closed polygon.

    The product of the rotations R_i that take T_{i−1} to T_i within the plane of both and fix its normals. It fixes
    T_0; the result is its matrix on the normals of T_0, an element of SO(d − 1), defined up to conjugation by the
    choice of the first edge. Basis: `normal_basis(T_0)`, with which (T_0, b_1, …, b_{d−1}) is positively oriented, so
    that in E³ the matrix is the right-handed rotation by `Bishop.holonomy`.

    points: (n, d), d ≥ 3, in order, the first not repeated at the end; points that repeat their neighbour are skipped.
    Returns (d − 1, d − 1); NaN where the polygon turns back on itself.
    Errors: InputError for other shapes, coordinates that are not finite, or fewer than two distinct points.
    Source: Sullivan, Curves.
    """
    curves, _ = curves_of(points, closed=True).distinct()
    d = curves.dimension
    if d < 3 or curves.size < 2:
        raise InputError(f"{curves.size} distinct points in E^{d}, expected at least 2 in E^3 or higher")
    if Turning(curves).reversed.any():
        return np.full((d - 1, d - 1), np.nan)
    tangent = curves.tangent.T
    heads = np.roll(tangent, -1, axis=0)
    product = np.eye(d)
    for begin in range(0, len(tangent), _EDGES_PER_BLOCK):
        block = slice(begin, begin + _EDGES_PER_BLOCK)
        product = _product(_least_rotations(tangent[block], heads[block])) @ product
    basis = normal_basis(tangent[0])
    return np.asarray(basis.T @ product @ basis)


def normal_basis(tangent: Floats) -> Floats:
    """(d, d − 1) orthonormal columns b_k that complete a unit vector to a positively oriented basis (T, b_1, …).

    The images of the coordinate axes under the reflection that takes the first axis to ∓T.
    """
    sign = 1.0 if tangent[0] >= 0 else -1.0
    mirror = tangent.copy()
    mirror[0] += sign
    reflection = np.eye(len(tangent)) - np.outer(mirror, mirror) * (2 / (mirror @ mirror))
    basis = reflection[:, 1:]
    # A reflection has determinant −1 and takes the first axis to −sign T.
    if sign < 0:
        basis[:, -1] *= -1
    return basis


def _least_rotations(tail: Floats, head: Floats) -> Floats:
    """(k, d, d) rotations that take each unit vector of `tail` to that of `head` within the plane of both."""
    both = tail + head
    square = (both * both).sum(axis=1)[:, None, None]
    eye = np.eye(tail.shape[1])
    return np.asarray(eye - 2 * both[:, :, None] * both[:, None, :] / square + 2 * head[:, :, None] * tail[:, None, :])


def _product(matrices: Floats) -> Floats:
    """… M_2 M_1 M_0, two by two."""
    while len(matrices) > 1:
        odd = matrices[-1:] if len(matrices) % 2 else matrices[:0]
        even = matrices[: len(matrices) // 2 * 2]
        matrices = np.concatenate([even[1::2] @ even[::2], odd])
    return np.asarray(matrices[0])

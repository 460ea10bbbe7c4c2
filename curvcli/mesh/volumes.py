"""Signed volumes of the tetrahedra that faces span with the base point of their group."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..support.arrays import Floats, Index
from ..support.blocks import slices
from .triangles import EPSILON, Triangles, dot, triangles


def triple_products(xyz: Floats, faces: Index, label: Index) -> Floats:
    """(F,) six times the signed volume of the tetrahedron of each face, as the file winds it, and its group's base.

    label: group of each face; the base is the first corner of the group's first face. The sum over a closed group is
    independent of the base, its rounding is not. Integer corners give integers, whose sums are exact.
    """
    product, base = np.empty(len(faces)), _bases(xyz, faces, label)
    for block in slices(len(faces)):
        t = triangles(xyz, faces[block])
        # From the normal of the face: a product of two corners has an error proportional to lengths instead of areas.
        product[block] = dot(_from_base(xyz, base, label[block], t), t.normal)
    return product


def volume_errors(xyz: Floats, faces: Index, label: Index, chosen: NDArray[np.integer]) -> Floats:
    """(n,) bounds of the rounding errors of the volumes of the chosen faces and of their sum.

    xyz: (3, V). faces: (F, 3). label: (F,) group of each face. chosen: (n,) indices.
    """
    terms, base = np.empty(len(chosen)), _bases(xyz, faces, label)
    for block in slices(len(chosen)):
        t = triangles(xyz, faces[chosen[block]])
        seen = _from_base(xyz, base, label[chosen[block]], t)
        terms[block] = np.sqrt(dot(seen, seen)) * t.twice_area / 6
    errors: Floats = (16 + np.log2(len(chosen))) * EPSILON * terms
    return errors


def _bases(xyz: Floats, faces: Index, label: Index) -> Floats:
    """(3, G) the first corner of the first face of each group; for one group the base of the surface."""
    if label.max() == 0:
        return xyz[:, faces[0, 0], None]
    first = np.full(int(label.max()) + 1, len(faces), np.int64)
    np.minimum.at(first, label, np.arange(len(faces)))
    return xyz[:, faces[first, 0]]


def _from_base(xyz: Floats, base: Floats, label: Index, t: Triangles) -> list[Floats]:
    """The first corners of some triangles relative to the bases of their groups."""
    at = base if base.shape[1] == 1 else base[:, label]
    return [x.take(t.corners[0]) - b for x, b in zip(xyz, at, strict=True)]

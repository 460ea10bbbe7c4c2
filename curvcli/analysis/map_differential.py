"""Differential of a map between surfaces on the same faces: singular values and conformal distortion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..mesh.triangles import EPSILON, dot, triangles
from ..support.arrays import Floats, Index, Mask
from ..support.blocks import slices

if TYPE_CHECKING:
    from ..mesh.surface import Surface


@dataclass(frozen=True)
class Stretch:
    """Differential of f on every face, in the units of computation; (F,) each.

    energy: ½ |∇f_T|² area. terms: sum of its absolute terms, for the bound on its rounding.
    collapsed: true where the image of the face has no area.
    """

    sigma_1: Floats
    sigma_2: Floats
    area: Floats
    image_area: Floats
    nonconformality: Floats
    energy: Floats
    terms: Floats
    collapsed: Mask


def stretch(source: Surface, image: Surface) -> Stretch:
    """Singular values of the differential on every face, with energy and non-conformality.

    In orthonormal frames along the image of one edge the differential is [[a, b], [0, d]] with a, d ≥ 0. Then
    σ₁ + σ₂ = √((a + d)² + b²) and |σ₁ − σ₂| = √((a − d)² + b²): neither is a difference of squares, so that a
    conformal map shows a non-conformality of order ε², not ε. σ₂ = a d / σ₁ is as accurate where it is small.
    """
    made: dict[str, Any] = {name: np.empty(source.n_faces) for name in Stretch.__dataclass_fields__}
    made["collapsed"] = np.zeros(source.n_faces, bool)
    for block in slices(source.n_faces):
        face = _largest_angle_first(source.xyz, source.faces[block])
        s, t = triangles(source.xyz, face), triangles(image.xyz, face)
        flat = s.twice_area == 0 if s.degenerate is None else s.degenerate
        area = np.where(flat, np.nan, s.twice_area)
        u, w = (np.sqrt(dot(edge, edge)) for edge in (s.u, s.w))
        U, W = (np.sqrt(dot(edge, edge)) for edge in (t.u, t.w))
        a = U / u if u.all() else np.divide(U, u, where=u > 0, out=np.full_like(u, np.nan))
        moves = U > 0
        with np.errstate(divide="ignore", invalid="ignore"):
            # If f sends the edge to a point, the other edge carries all the stretch.
            b = np.where(moves, (t.cosines[0] * u / U - s.cosines[0] * a) / area, W * u / area)
            d = np.where(moves, t.twice_area * u / (U * area), 0.0)
        reach = (W * u + U * w) / area
        total, gap = np.hypot(a + d, b), np.hypot(a - d, b)
        sigma_1 = 0.5 * (total + gap)
        made["sigma_1"][block] = sigma_1
        scale = np.where(sigma_1 > 0, sigma_1, 1.0)
        made["sigma_2"][block] = np.minimum(t.twice_area / (area * scale), sigma_1)
        made["area"][block], made["image_area"][block] = s.twice_area / 2, t.twice_area / 2
        # Each factor gets the root of the area: squares alone would leave the range of doubles on small faces.
        root = np.sqrt(area)
        a, b, d, gap, reach = (root * x for x in (a, b, d, gap, reach))
        made["nonconformality"][block] = 0.25 * gap * gap
        made["energy"][block] = 0.25 * (a * a + b * b + d * d)
        made["terms"][block] = np.where(flat, 0.0, 0.5 * (a * a + (np.abs(b) + d + EPSILON * reach) * reach))
        made["collapsed"][block] = t.twice_area == 0 if t.degenerate is None else t.degenerate
    return Stretch(**made)


def _largest_angle_first(xyz: Floats, face: Index) -> Index:
    """Faces rotated so that the longest edge lies opposite corner 0: the sine there is the largest."""
    p, q, r = ([x[face[:, k]] for x in xyz] for k in range(3))
    edges = ([b - a for a, b in zip(tail, head, strict=True)] for tail, head in ((q, r), (r, p), (p, q)))
    first = np.argmax([dot(edge, edge) for edge in edges], axis=0)
    return np.take_along_axis(face, (first[:, None] + np.arange(3)) % 3, axis=1)

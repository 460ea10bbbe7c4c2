"""Stars whose triangles are so thin or obtuse that their densities are wrong by a large factor.

On a sphere the mean curvature h and the density K_density of a star are those of the sphere times A°/A, to first order
in the squared edges. A° is the circumcentric area ⅛ Σ (cot α + cot β)|e|², signed, and A a third of the area of the
star: the area gradient weighs squared edges by cotangents, and so do angle defects. A°/A is 1 on average, and near 1 on
even triangles. On needles and obtuse triangles it can be anything, also negative. It depends on the shape of the star
alone, and not on the scale or on the resolution.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mesh.precision import is_single, last_place
from ..mesh.surface import Surface
from ..mesh.triangles import Triangles, dot, span, triangles
from ..support.arrays import Floats, Mask
from ..support.blocks import slices
from .notices import TRUSTED, rounding_of_K

# A density that is wrong by more than this factor on a sphere is no density of the surface.
FACTOR = 4
# Part of Σ|K| at such vertices that is reported.
_PART = 0.1
# Faces that are sampled, at equal steps.
_SAMPLE = 1 << 14


def circumcentric_areas(t: Triangles) -> list[Floats]:
    """The parts of A° of some faces, an array for each corner."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        # Of the edge from corner 1 to 2 by the angle at 0, and so on.
        v, w, u = (
            dot(edge, edge) * cosine / t.twice_area / 8 for edge, cosine in zip((t.v, t.w, t.u), t.cosines, strict=True)
        )
        return [w + u, u + v, v + w]


def distorted_stars(surface: Surface, columns: Mapping[str, Any]) -> tuple[NDArray[np.intp], float]:
    """Interior vertices of distorted stars, and the part of Σ|K| that they carry; none where that is less than a
    tenth. K that rounding of the coordinates explains does not count."""
    none = np.empty(0, np.intp), 0.0
    if not _may_be_distorted(surface, columns):
        return none
    area = np.zeros(surface.n_vertices)
    for block in slices(surface.n_faces):
        t = triangles(surface.xyz, surface.faces[block])
        for corner, part in zip(t.corners, circumcentric_areas(t), strict=True):
            np.add.at(area, corner, part)
    distorted = _exceeds_factor(area, columns["star_area"])
    size = _size(columns["K"], columns["h_signed"])
    if not size[distorted].sum() >= _PART * size.sum() > 0:
        return none
    size[size <= _rounding(surface)] = 0.0
    whole, carried = size.sum(), size[distorted].sum()
    return (np.flatnonzero(distorted & (size > 0)), float(carried / whole)) if carried >= _PART * whole > 0 else none


def _may_be_distorted(surface: Surface, columns: Mapping[str, Any]) -> bool:
    """False if distorted stars surely carry less than a tenth of Σ|K|, by a sample of corners: A°/A of a star is the
    mean of its faces, so that a distorted star has such a face, one of 16 at least."""
    t = triangles(surface.xyz, surface.faces[:: max(surface.n_faces // _SAMPLE, 1)])
    whole = carried = 0.0
    for corner, part in zip(t.corners, circumcentric_areas(t), strict=True):
        size = _size(columns["K"][corner], columns["h_signed"][corner])
        whole += float(size.sum())
        carried += float(size[_exceeds_factor(part, t.twice_area / 6)].sum())
    return carried >= _PART / 16 * whole > 0


def _size(K: Floats, h_signed: Floats) -> Floats:
    """|K| where densities are defined, else 0."""
    return np.where(np.isfinite(K) & np.isfinite(h_signed), np.abs(K), 0.0)


def _exceeds_factor(circumcentric: Floats, barycentric: Floats) -> Mask:
    exceeds: Mask = ~((circumcentric * FACTOR >= barycentric) & (circumcentric <= FACTOR * barycentric))
    return exceeds


def _rounding(surface: Surface) -> Floats:
    """(V,) bound on the change of K by rounding of the coordinates."""
    along = span(surface.xyz, surface.edges.a, surface.edges.b)
    place = last_place(surface, np.float32 if is_single(surface.xyz_given) else np.float64)
    return rounding_of_K(surface, np.sqrt(dot(along, along)), place, TRUSTED)

"""Mixed Voronoi areas of vertices."""

from __future__ import annotations

import numpy as np

from ..mesh.surface import Surface
from ..mesh.triangles import Triangles, dot, triangles
from ..support.arrays import Column, Floats, Index
from ..support.blocks import slices
from ..support.double_double import THIN_COTANGENT, corner_products
from .registry import curvature_pass
from .star import null_where


@curvature_pass(
    symbol="A_mixed",
    formula="Σ over the faces at p: ⅛ Σ cot θ |opposite edge|² over its two edges at p; where the face is obtuse half "
    "its area at the obtuse corner, a quarter at the others",
    length_exponent=2,
    preserves="ΣA_mixed = area",
    boundary="same",
    source="Sullivan, Discrete surfaces; Meyer, Desbrun, Schröder and Barr, Discrete differential-geometry operators "
    "for triangulated 2-manifolds, section 3.3",
    after="A",
)
def A_mixed(surface: Surface) -> Column:
    """Area of the vertex's mixed cell: the Voronoi cell within each face that is not obtuse.

    Always positive. An obtuse face's cell is cut at the midpoints of its edges. A face without area adds nothing.
    """
    area = np.zeros(surface.n_vertices)
    for block in slices(surface.n_faces):
        face = surface.faces[block]
        for corner, part in zip(face.T, _parts(surface, face), strict=True):
            np.add.at(area, np.ascontiguousarray(corner), part)
    return null_where(~surface.referenced, area)


def _parts(surface: Surface, face: Index) -> Floats:
    """(3, n) the parts of each face's area at its corners."""
    t = triangles(surface.xyz, face)
    cosines = np.array(t.cosines)
    squares = np.array([dot(side, side) for side in (t.v, t.w, t.u)])
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        shares = _voronoi_parts(squares * (cosines / t.twice_area))
        thin = np.flatnonzero(~(np.abs(cosines).max(axis=0) <= THIN_COTANGENT * t.twice_area))
        if len(thin):
            shares[:, thin], cosines[:, thin] = _thin_parts(surface, face[thin])
    return _with_obtuse(shares, cosines, t)


def _voronoi_parts(shares: Floats) -> Floats:
    """⅛ of the shares |e|² cot of the two edges at each corner, given the share of the edge opposite it."""
    areas: Floats = (shares[[1, 2, 0]] + shares[[2, 0, 1]]) / 8
    return areas


def _thin_parts(surface: Surface, face: Index) -> tuple[Floats, Floats]:
    """Compute the shares and the sign of each angle's cosine in double-double arithmetic."""
    c, twice_area = corner_products(surface.xyz, tuple(face.T))
    shares = np.array([((c[i - 2] + c[i - 1]) * (c[i] / twice_area)).high for i in range(3)])
    return _voronoi_parts(shares), np.array([x.high for x in c])


def _with_obtuse(shares: Floats, cosines: Floats, t: Triangles) -> Floats:
    """Apply the rule for obtuse faces; 0 on faces without area."""
    at_obtuse = cosines < 0
    obtuse = np.flatnonzero(at_obtuse.any(axis=0) | (t.twice_area == 0))
    if len(obtuse):
        shares[:, obtuse] = t.twice_area[obtuse] * np.where(at_obtuse[:, obtuse], 0.25, 0.125)
    return shares

"""Quantities of faces: normals and areas."""

from __future__ import annotations

import numpy as np

from ..mesh.surface import Surface
from ..mesh.triangles import triangles
from ..support.arrays import Column, Flags, VectorColumn
from ..support.blocks import slices
from .registry import curvature_pass


@curvature_pass(on="face", vector=True, public=False, kind="direction")
def unit_normal(surface: Surface, degenerate_face: Flags) -> VectorColumn:
    """Unit normals by the file's own winding; null on degenerate faces."""
    nu = np.empty((3, surface.n_faces))
    for block in slices(surface.n_faces):
        t = triangles(surface.xyz, surface.faces[block])
        with np.errstate(divide="ignore", invalid="ignore"):
            for row, component in zip(nu, t.normal, strict=True):
                np.divide(component, t.twice_area, out=row[block])
    nu[:, degenerate_face] = np.nan
    return nu


@curvature_pass(
    symbol="area(T)",
    formula="½ |u × v|",
    on="face",
    length_exponent=2,
    preserves="Σ area(T) = area",
    boundary="same",
    source="curvcli conventions",
    column="area",
    after="",
)
def area_of_face(face_area: Column) -> Column:
    """Area of the face."""
    return face_area


@curvature_pass(
    symbol="ν_T",
    formula="u × v / |u × v|",
    on="face",
    kind="direction",
    parity="odd",
    vector=True,
    preserves="Σ area(T) ν_T = vector area",
    boundary="same",
    source="curvcli conventions",
    after="area_of_face",
)
def normal(surface: Surface, unit_normal: VectorColumn) -> VectorColumn:
    """Unit normal of the face, right-handed with its oriented winding; null on degenerate faces."""
    sign = surface.orientation.face_sign
    return unit_normal if sign is None else unit_normal * sign

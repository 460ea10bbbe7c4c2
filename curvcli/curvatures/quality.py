"""Quality of triangles, as Verdict names and defines it, and the Delaunay defect of edges."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..mesh.surface import Surface
from ..mesh.triangles import Vector, triangles
from ..support.arrays import Column, Flags, Floats, VectorColumn
from ..support.blocks import for_each, slices
from .edges import EDGES_PER_BLOCK
from .quantity import Quantity
from .registry import curvature_pass
from .star import null_where

_VERDICT = "Stimpson, Ernst, Knupp, Pébay and Thompson, The Verdict Geometric Quality Library"
_FACES: dict[str, Any] = {"on": "face", "boundary": "same", "source": _VERDICT}


@curvature_pass(on="face", kind="angle", vector=True, public=False)
def corner_angle(surface: Surface) -> VectorColumn:
    """Angles of each face at its corners; null at a corner that coincides with another one of the face."""
    angles = np.empty((3, surface.n_faces))

    def measure(block: slice) -> None:
        t = triangles(surface.xyz, surface.faces[block])
        for corner in range(3):
            angles[corner, block] = null_where(t.no_angle(corner), t.angle(corner))

    for_each(slices(surface.n_faces), measure)
    return angles


@curvature_pass(
    provides=(
        Quantity(
            "angle_min",
            symbol="α_min",
            formula="smallest angle of the triangle, in radians; Verdict's minimum angle, in degrees there",
            kind="angle",
            preserves="π/3 for an equilateral triangle, 0 where its corners lie on a line",
            after="dirichlet",
            description="Smallest angle of the face; null where two of its corners coincide.",
            **_FACES,
        ),
        Quantity(
            "angle_max",
            symbol="α_max",
            formula="largest angle of the triangle, in radians; Verdict's maximum angle, in degrees there",
            kind="angle",
            preserves="π/3 for an equilateral triangle, π where its corners lie on a line",
            after="angle_min",
            description="Largest angle of the face; null where two of its corners coincide.",
            **_FACES,
        ),
    )
)
def extreme_angles(corner_angle: VectorColumn) -> tuple[Column, Column]:
    """Smallest and largest angle of the face; null where two of its corners coincide."""
    return corner_angle.min(axis=0), corner_angle.max(axis=0)


@curvature_pass(
    provides=(
        Quantity(
            "aspect_ratio",
            symbol="q",
            formula="L_max (L₀ + L₁ + L₂) / (4√3 area) = L_max / (2√3 r), r the inradius",
            kind="ratio",
            preserves="1 for an equilateral triangle, greater for any other",
            after="angle_max",
            description="Aspect ratio of the face; null on degenerate faces, where it would be infinite.",
            **_FACES,
        ),
        Quantity(
            "edge_ratio",
            symbol="L_max/L_min",
            formula="L_max / L_min",
            kind="ratio",
            preserves="1 for an equilateral triangle, greater for any other",
            after="aspect_ratio",
            description="Longest edge of the face over its shortest; null where two of its corners coincide.",
            **_FACES,
        ),
        Quantity(
            "radius_ratio",
            symbol="R/2r",
            formula="R / (2r) = L₀L₁L₂ (L₀ + L₁ + L₂) / (16 area²)",
            kind="ratio",
            preserves="1 for an equilateral triangle, greater for any other",
            after="edge_ratio",
            description="Circumradius of the face over twice its inradius; null on degenerate faces.",
            **_FACES,
        ),
        Quantity(
            "circumradius",
            symbol="R",
            formula="L₀L₁L₂ / (4 area)",
            kind="length",
            length_exponent=1,
            preserves="normals of inscribed triangles converge to those of the surface as R tends to 0",
            after="radius_ratio",
            description="Radius of the circle through the corners of the face; null on degenerate faces.",
            on="face",
            boundary="same",
            source="Morvan and Thibert, On the approximation of a smooth surface with a triangulated mesh",
        ),
    )
)
def ratios(surface: Surface, degenerate_face: Flags) -> tuple[Column, ...]:
    """Aspect ratio, edge ratio, radius ratio and circumradius of the face."""
    quality = np.empty((4, surface.n_faces))

    def measure(block: slice) -> None:
        t = triangles(surface.xyz, surface.faces[block])
        a, b, c = (_length(edge) for edge in (t.u, t.v, t.w))
        longest, perimeter = np.maximum(np.maximum(a, b), c), a + b + c
        shortest = np.minimum(np.minimum(a, b), c)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            quality[0, block] = longest / t.twice_area * perimeter / (2 * np.sqrt(3))
            quality[1, block] = longest / shortest
            quality[3, block] = a / t.twice_area * b * c / 2
            quality[2, block] = quality[3, block] / t.twice_area * perimeter / 2

    for_each(slices(surface.n_faces), measure)
    quality[1, ~np.isfinite(quality[1])] = np.nan
    for row in (0, 2, 3):
        quality[row, degenerate_face] = np.nan
    return tuple(quality)


def _length(edge: Vector) -> Floats:
    length: Floats = np.hypot(np.hypot(edge[0], edge[1]), edge[2])  # without underflow of a square
    return length


@curvature_pass(
    symbol="α + β − π",
    formula="α + β − π, the angles opposite the edge in its two faces",
    on="edge",
    kind="angle",
    signed=True,
    preserves="Delaunay: at most 0 at every edge, as cot α + cot β ≥ 0; intrinsic, so bending does not change it",
    boundary="null; also where n_e ≠ 2, and where an angle is undefined",
    source="Bobenko and Springborn, A discrete Laplace–Beltrami operator for simplicial surfaces",
    after="beta",
)
def delaunay_defect(surface: Surface, corner_angle: VectorColumn) -> Column:
    """Delaunay defect of the edge: positive where the two angles opposite it exceed π.

    The cotangent weight of such an edge is negative, and a flip would make the triangulation better.
    """
    defect = np.full(len(surface.edges), np.nan)

    def add(block: slice) -> None:
        edges = surface.edges.inner_edges(block)
        angle, twin_angle = (corner_angle[(side % 3 + 2) % 3, side // 3] for side in (edges.half_edge, edges.twin))
        defect[edges.where] = (angle - np.pi) + twin_angle

    for_each(slices(len(surface.edges.pairs[0]), EDGES_PER_BLOCK), add)
    return defect

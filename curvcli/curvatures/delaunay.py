"""Areas of the cells of the intrinsic Voronoi diagram."""

from __future__ import annotations

import numpy as np

from ..mesh.surface import Surface
from ..mesh.topology import next_corner
from ..support.arrays import Column, Flags, Floats
from ..support.blocks import slices
from .kernels.intrinsic_delaunay import IntrinsicTriangulation
from .quantity import FlagNotice, Quantity
from .registry import curvature_pass
from .star import null_where


@curvature_pass(
    provides=(
        Quantity(
            "A_voronoi",
            symbol="A_voronoi",
            formula="⅛ Σ (cot α + cot β) |e|² over the edges at p of the intrinsic Delaunay triangulation",
            length_exponent=2,
            preserves="ΣA_voronoi = area; unchanged where the surface is bent isometrically",
            boundary="of the constrained Delaunay triangulation: edges of the boundary, and edges with more than two "
            "faces, stay; the cell may be negative beyond them",
            source="Sullivan, Discrete surfaces; Bobenko and Springborn, A discrete Laplace–Beltrami operator for "
            "simplicial surfaces",
            after="A_mixed",
        ),
        Quantity(
            "voronoi_unfinished",
            kind="flag",
            public=False,
            notice=FlagNotice(
                "voronoi_unfinished",
                "[vertex|vertices] whose Voronoi cell would take too many flips to find; it is left empty",
                "--area mixed needs none; a mesh without long fans of thin triangles needs few",
                after="no_graph",
            ),
        ),
    )
)
def delaunay(surface: Surface) -> tuple[Column | Flags, ...]:
    """Area of the vertex's cell in the intrinsic Voronoi diagram: the points of the surface that are closest to it.

    The surface is first flipped to Delaunay, intrinsically: along straight edges within it. Null at the corners of
    faces without area that no flip can mend, and where the flips were given up.
    """
    triangulation = IntrinsicTriangulation(surface)
    hidden = triangulation.degenerate_corners() | ~surface.referenced
    area = circumcentric_areas(triangulation)
    # A face so thin that a cotangent overflows is indistinguishable from the result of its flip.
    unfinished = triangulation.unfinished_corners() | (~hidden & ~np.isfinite(area))
    return null_where(hidden | unfinished, area), unfinished


def circumcentric_areas(triangulation: IntrinsicTriangulation) -> Floats:
    """(V,) circumcentric dual area ⅛ Σ (cot α + cot β) |e|² over the edges at each vertex."""
    t = triangulation
    area = np.zeros(t.n_vertices)
    with np.errstate(over="ignore", invalid="ignore"):  # at the corners of faces without area
        for block in slices(len(t.side)):
            side = t.side[block].astype(np.intp)
            part = t.lengths_squared(block) * t.weight[block] / 8
            if t.twofold is not None:
                part[t.twofold[side // 3]] /= 2
            for corner in (side, next_corner(side)):
                np.add.at(area, t.tail.take(corner).astype(np.intp), part)
    return area

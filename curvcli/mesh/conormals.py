"""Outward conormals of half-edges in their own faces."""

from __future__ import annotations

import numpy as np

from ..support.arrays import Index, VectorColumn
from .surface import Surface
from .topology import next_corner
from .triangles import cross, triangles


def conormals(surface: Surface, half_edges: Index) -> VectorColumn:
    """(3, n) outward conormals η|e| = e × ν, as long as the edge, of the given half-edges in their own faces."""
    head = next_corner(half_edges)
    corners = [surface.faces.ravel().take(each) for each in (half_edges, head, next_corner(head))]
    t = triangles(surface.xyz, np.stack(corners, axis=1))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.array(cross(t.u, t.normal)) / t.twice_area

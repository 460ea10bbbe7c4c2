"""Status and degree of vertices."""

from __future__ import annotations

import numpy as np

from ..mesh.surface import STATUS, Surface
from ..support.arrays import Codes, Counts, Flags
from .registry import curvature_pass


@curvature_pass(
    symbol="status",
    formula="the first that applies: unreferenced, nonmanifold, degenerate, boundary, interior",
    kind="label",
    boundary="boundary: some edge at the vertex has one face",
    source="curvcli conventions",
    labels=STATUS,
    after="",
)
def status(surface: Surface, degenerate: Flags) -> Codes:
    """Kind of the vertex; codes index `interior, boundary, degenerate, nonmanifold, unreferenced`."""
    code = np.zeros(surface.n_vertices, np.int8)
    for value, mask in enumerate((surface.boundary, degenerate, surface.nonmanifold, ~surface.referenced), start=1):
        code[mask] = value
    return code


@curvature_pass(
    symbol="deg p",
    formula="number of edges at p",
    kind="count",
    boundary="same",
    source="curvcli conventions",
    after="status",
)
def degree(surface: Surface) -> Counts:
    """Number of edges at the vertex, 0 where no face uses it."""
    return surface.degree

"""Quantities of edges."""

from __future__ import annotations

import numpy as np

from ..blocks import dot
from ..declare import Column, curvature_pass
from ..surface import Surface


@curvature_pass(
    symbol="|e|",
    formula="|b − a|",
    on="edge",
    kind="length",
    length_exponent=1,
    boundary="same",
    source="curvcli conventions",
)
def edge_length(surface: Surface) -> Column:
    """Length of the edge."""
    span = [x[surface.edges.b] - x[surface.edges.a] for x in surface.xyz]
    return np.asarray(np.sqrt(dot(span, span)))

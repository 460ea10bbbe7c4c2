"""Star sums of each vertex, from one sweep over the faces."""

from __future__ import annotations

import numpy as np

from ..mesh.surface import Surface
from ..support.arrays import Column, Flags
from .kernels.star_sums import star_sums as sweep
from .quantity import Quantity
from .registry import curvature_pass


def null_where(mask: Flags, values: Column) -> Column:
    """Set a column, (n,) or (3, n), to NaN where the mask holds; a copy, or the column itself for an empty mask."""
    return np.where(mask, np.nan, values) if mask.any() else values


def ratio(numerator: Column, denominator: Column, usable: Flags) -> Column:
    """Divide where `usable` holds and the denominator is positive; NaN elsewhere."""
    usable = usable & (denominator > 0)
    quotient: Column = numerator / (denominator if usable.all() else np.where(usable, denominator, np.nan))
    return quotient


@curvature_pass(
    provides=(
        Quantity("angle_sum", public=False),
        Quantity("star_area", public=False, length_exponent=2),
        Quantity("star_vector", public=False, vector=True, length_exponent=2, parity="odd"),
        Quantity("star_curvature", public=False, vector=True, length_exponent=1),
        Quantity("star_extent", public=False, length_exponent=1),
        Quantity(
            "face_area",
            on="face",
            public=False,
            length_exponent=2,
            total="area",
            description="Area of the face.",
            total_after="",
        ),
        Quantity("degenerate_face", on="face", kind="flag", public=False),
        Quantity("coincident", kind="flag", public=False),
        Quantity("degenerate", kind="flag", public=False),
    )
)
def star_sums(surface: Surface) -> tuple[Column | Flags, ...]:
    """Σθ, ⅓Σ area, ⅓Σ area ν with the star oriented, −∇_p area, Σ extents; face areas; where undefined.

    Without a face the scalar sums are 0 and the vectors null; −∇_p area is null at corners of degenerate faces too.
    """
    sums = sweep(surface)
    degenerate = np.zeros(surface.n_vertices, bool)
    degenerate[surface.faces[np.flatnonzero(sums.degenerate_face)]] = True
    loose = ~surface.referenced
    for vectors, undefined in ((sums.vector, loose), (sums.curvature, loose | degenerate)):
        if undefined.any():
            np.copyto(vectors, np.nan, where=undefined)
    return (
        sums.angle_sum,
        sums.area,
        sums.vector,
        sums.curvature,
        sums.extent,
        sums.face_area,
        sums.degenerate_face,
        sums.coincident,
        degenerate,
    )

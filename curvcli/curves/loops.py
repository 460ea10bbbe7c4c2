"""The table of boundary loops: what each one measures, and what the surface pulls with along it."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..blocks import cross
from ..surface import Surface
from .boundary import Boundary, boundary_loops
from .darboux import Darboux
from .frames import Bishop, twist
from .polygon import Curves, Floats
from .turning import Turning
from .writhe import writhe

LOOP_WRITHE_EDGES = 2_000
"""Size of the double sums that a table of loops does unasked: a fraction of a second."""


def boundary_of(surface: Surface) -> Boundary:
    """The boundary curves of a surface, found once."""
    cache: dict[str, Boundary] = surface.__dict__.setdefault("_boundary_curves", {})
    if "boundary" not in cache:
        cache["boundary"] = boundary_loops(surface)
    return cache["boundary"]


def loop_table(surface: Surface, *, max_writhe: int | None = LOOP_WRITHE_EDGES) -> dict[str, Any]:
    """One row per boundary curve of a surface, in the file's unit of length; NaN is undefined.

    loop, component, closed, vertices: which it is. length. total_curvature: Σψ ≥ 2π (Fenchel). sum_kappa_g: Σ(π − Σθ).
    vector_area_*: ½ Σ a × b, closed curves only. force_*: Σ η|e|, what the surface pulls with along the curve.
    torque_*: Σ m × η|e| about the origin. holonomy: of the parallel frame, ≡ 2π · writhe (mod 2π). writhe: in turns,
    where the double sums are within max_writhe (see `writhe`). twist: of the surface along the curve, radians.
    linking: writhe + twist / 2π, the number of times the curve links itself pushed along ν.

    On patches without an orientation a curve's direction, and with it the sign of its vector area, is that of the file
    at its lowest edge; the rest does not depend on it. Order and directions: see `boundary_loops`.
    Source: Sullivan, Curves; Discrete surfaces.
    """
    boundary = boundary_of(surface)
    given = boundary.curves
    distinct, kept = given.distinct()
    turning, darboux = Turning(distinct), Darboux(boundary)
    turns, _ = writhe(distinct, max_writhe)
    turned = twist(turning, darboux.nu[:, kept])
    table: dict[str, Any] = {
        "loop": np.arange(len(given), dtype=np.int32),
        "component": boundary.component.astype(np.int32),
        "closed": boundary.closed,
        "vertices": given.sizes.astype(np.int32),
        "length": given.length,
        "total_curvature": turning.total,
        "sum_kappa_g": _whole(given, darboux.kappa_g),
    }
    area, force, torque = moments(boundary, darboux)
    for name, vector in (("vector_area", area), ("force", force), ("torque", torque)):
        table |= {f"{name}_{axis}": component for axis, component in zip("xyz", vector, strict=True)}
    table |= {
        "holonomy": Bishop(turning).holonomy,
        "writhe": turns,
        "twist": turned,
        "linking": np.rint(turns + turned / (2 * np.pi)) + 0.0,
    }
    return table


def _whole(curves: Curves, values: Floats) -> Floats:
    """(m,) sums over vertices between two edges; NaN where one of the terms is undefined."""
    missing = curves.sum(np.isnan(values) & curves.inner) > 0
    return np.where(missing, np.nan, curves.sum(values))


def moments(boundary: Boundary, darboux: Darboux) -> tuple[Floats, Floats, Floats]:
    """(3, m) vector area, conormal force and torque of each boundary curve, in the file's unit of length.

    Taken about the first vertex of each curve, where an offset costs no digits, then moved to the origin.
    """
    surface, curves = boundary.surface, boundary.curves
    xyz = surface.xyz[:, boundary.vertex]
    base = xyz[:, curves.start[:-1]]
    here = xyz - np.repeat(base, curves.sizes, axis=1)
    there = here[:, curves.following]
    swept = 0.5 * np.array(cross(here, there))
    area = np.stack([curves.sum(x) for x in swept])
    area[:, ~curves.closed] = np.nan
    conormal = darboux.conormal
    missing = curves.sum(np.isnan(conormal[0]) & curves.has_edge) > 0
    force = np.stack([curves.sum(x) for x in conormal])
    torque = np.stack([curves.sum(x) for x in cross(0.5 * (here + there), conormal)]) + np.array(cross(base, force))
    force[:, missing] = torque[:, missing] = np.nan
    return tuple(surface.in_file_unit(x, power) for x, power in ((area, 2), (force, 1), (torque, 2)))  # type: ignore[return-value]

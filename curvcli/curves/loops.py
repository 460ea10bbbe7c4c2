"""Table of boundary loops: lengths, curvatures, conormal forces and torques, writhe and linking."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..mesh.surface import Surface
from ..mesh.triangles import cross
from ..support.arrays import Floats, Mask
from .boundary import Boundary, boundary_loops
from .darboux import Darboux
from .frames import Bishop, twist, twist_error
from .polygon import Curves, scaled
from .turning import Turning
from .writhe import UNSURE, writhe

LOOP_WRITHE_EDGES = 2_000
"""Size of the double sums that a table of loops does unasked: a fraction of a second."""


def loop_table(surface: Surface, *, max_writhe: int | None = LOOP_WRITHE_EDGES) -> dict[str, Any]:
    """One row per boundary curve of a surface, in the file's unit of length; NaN is undefined.

    loop, component, closed, vertices: identification. length. total_curvature: Σψ ≥ 2π (Fenchel). sum_kappa_g:
    Σ(π − Σθ). vector_area_*: ½ Σ a × b, closed curves only. force_*: Σ η|e|, the pull of the surface along the curve.
    torque_*: Σ m × η|e| about the origin. holonomy: of the parallel frame, ≡ 2π · writhe (mod 2π). writhe: in turns,
    where the double sums are within max_writhe (see `writhe`). twist: of the surface along the curve, radians.
    linking: writhe + twist / 2π, the number of times the curve links itself pushed along ν. writhe_error,
    linking_error: bounds of their rounding errors, in turns; a number whose bound exceeds ¼ is undefined.

    On patches without an orientation a curve's direction, and with it the sign of its vector area, is that of the file
    at its lowest edge; the rest does not depend on it. Order and directions: see `boundary_loops`.
    Source: Sullivan, Curves; Discrete surfaces.
    """
    boundary = boundary_loops(surface)
    given = boundary.curves
    distinct, kept = given.distinct()
    turning, darboux = Turning(distinct), Darboux(boundary)
    turns, error = writhe(distinct, max_writhe)
    nu = darboux.nu[:, kept]
    turned = twist(turning, nu)
    table: dict[str, Any] = {
        "loop": np.arange(len(given), dtype=np.int32),
        "component": boundary.component.astype(np.int32),
        "closed": boundary.closed,
        "vertices": given.sizes.astype(np.int32),
        "length": given.length,
        "total_curvature": turning.total,
        "sum_kappa_g": complete_sum(given, darboux.kappa_g),
    }
    force, torque = pull(boundary, darboux)
    for name, vector in (("vector_area", vector_area(given)), ("force", force), ("torque", torque)):
        table |= components(name, vector)
    table |= {
        "holonomy": Bishop(turning).holonomy,
        "writhe": turns,
        "writhe_error": error,
        "twist": turned,
        **linking(turns, error, turned, twist_error(turning, nu)),
    }
    return table


def components(name: str, vector: Floats) -> dict[str, Floats]:
    """The columns of a vector (3, n), without negative zeros."""
    return {f"{name}_{axis}": component + 0.0 for axis, component in zip("xyz", vector, strict=True)}


def linking(turns: Floats, turns_error: Floats, turned: Floats, turned_error: Floats) -> dict[str, Any]:
    """(m,) the integer `linking`, writhe + twist / 2π rounded, and `linking_error`, the bound of their errors in turns;
    masked where writhe or twist is undefined or the bound exceeds a quarter."""
    number, error = turns + turned / (2 * np.pi), turns_error + turned_error / (2 * np.pi)
    unknown = np.isnan(number) | ~(error <= UNSURE)
    return {
        "linking": np.ma.masked_array(np.rint(np.where(unknown, 0.0, number)).astype(np.int32), unknown),
        "linking_error": error,
    }


def complete_sum(curves: Curves, values: Floats, where: Mask | None = None) -> Floats:
    """(m,) sums over vertices between two edges (or `where`); NaN if any term is undefined."""
    missing = curves.sum(np.isnan(values) & (curves.inner if where is None else where)) > 0
    return np.where(missing, np.nan, curves.sum(values))


def vector_area(curves: Curves) -> Floats:
    """(3, m) ½ Σ a × b of closed curves, in the square of their unit; NaN on open ones."""
    local, power = curves.local
    swept = 0.5 * np.array(cross(local, local[:, curves.following]))
    area = scaled(np.stack([curves.sum(x) for x in swept]), 2 * power)
    return np.where(curves.closed, area, np.nan)


def pull(boundary: Boundary, darboux: Darboux) -> tuple[Floats, Floats]:
    """(3, m) twice: conormal force Σ η|e| and torque Σ m × η|e| of each boundary curve, in the file's unit of length.

    Computed about the first vertex of each curve, so that an offset costs no digits, then moved to the origin.
    """
    surface, curves = boundary.surface, boundary.curves
    xyz = surface.xyz[:, boundary.vertex]
    base = xyz[:, curves.start[:-1]]
    here = xyz - np.repeat(base, curves.sizes, axis=1)
    conormal = darboux.conormal
    missing = curves.sum(np.isnan(conormal[0]) & curves.has_edge) > 0
    force = np.stack([curves.sum(x) for x in conormal])
    about = np.stack([curves.sum(x) for x in cross(0.5 * (here + here[:, curves.following]), conormal)])
    torque = about + np.array(cross(base, force))
    force[:, missing] = torque[:, missing] = np.nan
    return surface.in_file_unit(force, 1), surface.in_file_unit(torque, 2)

"""Curvature and torsion per length at the vertices of curves, from turning and torsion angles."""

from __future__ import annotations

import numpy as np

from ..mesh.triangles import dot
from ..support.arrays import Floats
from .frames import Frenet
from .plane import PlaneCurves
from .polygon import Curves
from .turning import Turning


def cell_length(curves: Curves) -> Floats:
    """(n,) ℓ, half the length of the edges at each vertex; NaN at the ends of open curves."""
    length = curves.edge_length
    return np.where(curves.inner, 0.5 * length + 0.5 * length[curves.preceding], np.nan)


def curvature(turning: Turning) -> Floats:
    """(n,) κ = 2 sin(ψ/2)/ℓ = |T′ − T|/ℓ; NaN at the ends of open curves and where no double holds it.

    Keeps Σ κNℓ = T(q) − T(p). 1/r at every vertex of a regular polygon in a circle of radius r.
    """
    return _quotient(turning.sin2, cell_length(turning.curves))


def signed_curvature(turning: Turning, plane: PlaneCurves) -> Floats:
    """(n,) κ of plane curves, positive where they turn counterclockwise seen from the tip of the plane's normal.

    NaN on curves that are not plane and where a curve turns back on itself.
    """
    curves, size = turning.curves, curvature(turning)
    turn = np.array(_bend(curves))
    side = dot(np.repeat(plane.normal, curves.sizes, axis=1), turn)
    signed = np.where(side < 0, -size, size)
    known = np.repeat(plane.plane, curves.sizes) & ~turning.reversed & (turning.straight | ~np.isnan(side))
    return np.where(known, signed, np.nan)


def torsion_density(frenet: Frenet) -> Floats:
    """(n,) τ of the helix that turns by ψ at each vertex and by the torsion angle φ on each edge, of length ℓ.

    Its step turns by θ, sin²(θ/2) = sin²(ψ/2) + cos²(ψ/2) sin²(φ/2), and rises by d = ℓ cos(ψ/2) sin(φ/2) / sin(θ/2) on
    a cylinder of radius r = ℓ sin(ψ/2) / 2 sin²(θ/2); τ = dθ/(r²θ² + d²), the torsion of the helix through the points.
    φ/ℓ is the mean over those of the two edges that have a torsion, each per third of the three edges that decide it,
    so that it converges on curves whose edges differ in length. Positive where right-handed. NaN at the ends of
    open curves and where no edge at the vertex has a torsion.
    Source: Miyazawa, Molecular vibrations and structure of high polymers, 1961.
    """
    curves, torsion = frenet.turning.curves, frenet.torsion
    cell, before = cell_length(curves), curves.preceding
    known = ~np.isnan(torsion)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore", under="ignore"):
        angle = np.where(known, torsion, 0.0) + np.where(known[before], torsion[before], 0.0)
        # The torsion of four points of a smooth curve is its mean over a third of their three edges.
        length = curves.edge_length
        third = length / 3 + length[before] / 3 + length[curves.following] / 3
        part = np.where(known, third / cell, 0.0) + np.where(known[before], third[before] / cell, 0.0)
        phi = angle / part
        turn, twist = np.sin(frenet.turning.angle / 2), np.sin(phi / 2)
        across = np.hypot(turn, np.cos(frenet.turning.angle / 2) * twist)  # sin(θ/2)
        theta = 2 * np.arcsin(np.minimum(across, 1.0))
        rise = np.cos(frenet.turning.angle / 2) * twist / across
        radius = turn / (2 * across * across)
        density = rise * theta / ((radius * theta) ** 2 + rise * rise)
    return _quotient(density, cell)


def _bend(curves: Curves) -> Floats:
    tangent = curves.tangent
    return np.cross(tangent[:, curves.preceding], tangent, axis=0)


def _quotient(value: Floats, length: Floats) -> Floats:
    with np.errstate(divide="ignore", invalid="ignore", over="ignore", under="ignore"):
        result = value / length
    tiny = (np.abs(result) < np.finfo(np.float64).tiny) & (value != 0)
    return np.where(np.isfinite(result) & ~tiny, result, np.nan)

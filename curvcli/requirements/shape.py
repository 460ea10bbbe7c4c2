"""What the surface bounds or minimises."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..analysis import Analysis
from ..blocks import EPSILON
from ..pipeline import evaluate
from ..totals import constant_mean_curvature, steiner
from .base import requirement
from .places import joined, vertices
from .topology import closed, connected, euler, manifold, oriented


@requirement("convex", remedy="look where `K_minus` is largest: there the surface is not convex")
def convex(analysis: Analysis) -> str:
    """The surface bounds a convex body: closed, connected, χ = 2 and ΣK⁻ = 0."""
    surface = analysis.surface
    problem = joined(closed(analysis), manifold(analysis), connected(analysis)) or euler(analysis, 2)
    if problem:
        return problem
    columns = _columns(analysis, "face_area", "H_theta", "K", "K_minus")
    K_minus = columns["K_minus"]
    lost = np.flatnonzero(np.isnan(K_minus) & surface.referenced)
    if len(lost):
        return "K⁻ is undefined at " + vertices(lost, "of a degenerate star", "of degenerate stars")
    if bool(steiner(surface, surface.whole, columns)["convex"][0]):
        return ""
    bound = 16 * EPSILON * (surface.n_faces + int(np.count_nonzero(surface.referenced)))
    worst = int(np.argmax(np.where(surface.referenced, K_minus, 0)))
    return f"ΣK⁻ = {float(surface.whole.vertices.sum(K_minus)[0]):.6g} (allowed {bound:.2g}), most at vertex {worst}"


@requirement(
    "minimal",
    "TOL",
    remedy="refine or evolve the surface, or allow more; `H_vec` is largest at the worst vertex",
)
def minimal(analysis: Analysis, tolerance: float) -> str:
    """The largest |H_p| inside is at most TOL, in the file's unit of length."""
    return _largest(analysis, "H_vec_max", "|H_p|", tolerance)


@requirement("cmc", "TOL", remedy="refine or evolve the surface, or allow more")
def cmc(analysis: Analysis, tolerance: float) -> str:
    """The largest |H_p + H A_p| inside, H the best constant, is at most TOL, in the file's unit of length."""
    return _largest(analysis, "residual_max", "|H_p + H A_p|", tolerance)


def _largest(analysis: Analysis, key: str, symbol: str, tolerance: float) -> str:
    surface = analysis.surface
    columns = _columns(analysis, "H_vec", "A_vec")
    found = surface.in_file_unit(constant_mean_curvature(surface, surface.whole, columns)[key], 1)
    value = float(found[0]) * (0.5 if analysis.conventions.mean == "average" else 1.0)
    if math.isnan(value):
        inside = surface.interior & ~np.isnan(columns["H_vec"]).any(axis=0)
        return f"max {symbol} is undefined: " + (oriented(analysis) if inside.any() else "no vertex inside has a value")
    return "" if value <= tolerance else f"max {symbol} = {value:.6g} (allowed {tolerance:g})"


def _columns(analysis: Analysis, *names: str) -> dict[str, Any]:
    return evaluate(analysis.surface, names, area=analysis.conventions.area, known=analysis.columns)

"""What the surface bounds or minimises."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..analysis import Analysis
from ..blocks import EPSILON, dot
from ..declare import Flags, VectorColumn
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
    remedy="evolve the surface, refine it regularly, or allow more; `h_hks` is largest at the worst vertex",
)
def minimal(analysis: Analysis, tolerance: float) -> str:
    """The largest |H_p|/A_p · √area off the boundary is at most TOL, whatever the unit and the size of the mesh."""
    surface = analysis.surface
    columns = _columns(analysis, "H_vec", "star_area", "star_extent", "face_area")
    covered = surface.referenced & ~surface.boundary
    scale = math.sqrt(surface.whole.faces.sum(columns["face_area"])[0])
    largest, vertex = _largest_density(columns["H_vec"], columns, covered)
    value = largest * scale * (0.5 if analysis.conventions.mean == "average" else 1.0)
    return _judged("max |H_p|/A_p · √area", value, vertex, tolerance) or _untested(columns["H_vec"], covered, "H_vec")


@requirement(
    "cmc",
    "TOL",
    remedy="evolve the surface, refine it regularly, or allow more; where H is 0, require `minimal` instead",
)
def cmc(analysis: Analysis, tolerance: float) -> str:
    """The largest |H_p + H A_p|/A_p inside is at most TOL · |H|, H the best constant, whatever the unit."""
    surface = analysis.surface
    columns = _columns(analysis, "H_vec", "A_vec", "star_area", "star_extent")
    H = float(constant_mean_curvature(surface, surface.whole, columns)["H"][0])
    residual = columns["H_vec"] + H * columns["A_vec"]
    largest, vertex = _largest_density(residual, columns, surface.interior)
    name = "max |H_p + H A_p|/A_p ÷ |H|"
    if math.isnan(largest) and surface.without_orientation.any():
        return f"{name} is undefined: {oriented(analysis)}"
    value = 0.0 if largest == 0 else largest / abs(H) if H else math.inf
    others = np.flatnonzero(surface.nonmanifold & ~surface.boundary)
    return (
        _judged(name, value, vertex, tolerance)
        or _untested(residual, surface.interior, "H_vec or A_vec")
        or (f"{name} is untested at {vertices(others, _NOT_A_FAN, _NOT_FANS)}" if len(others) else "")
    )


_NOT_A_FAN, _NOT_FANS = "whose star is not one fan", "whose stars are not one fan"


def _largest_density(vectors: VectorColumn, columns: dict[str, Any], where: Flags) -> tuple[float, int]:
    """The largest |v|/A_p and its vertex, a v that rounding explains taken as 0; NaN where there is none."""
    size, area = np.sqrt(dot(vectors, vectors)), columns["star_area"]
    size[size <= 16 * EPSILON * columns["star_extent"]] = 0.0
    density = np.divide(size, area, out=np.full_like(size, np.nan), where=where & (area > 0))
    if np.isnan(density).all():
        return math.nan, -1
    vertex = int(np.nanargmax(density))
    return float(density[vertex]), vertex


def _judged(name: str, value: float, vertex: int, tolerance: float) -> str:
    if math.isnan(value):
        return f"{name} is undefined: no vertex inside has a value"
    return "" if value <= tolerance else f"{name} = {value:.6g} (allowed {tolerance:g}), at vertex {vertex}"


def _untested(vectors: VectorColumn, where: Flags, what: str) -> str:
    lost = np.flatnonzero(where & np.isnan(vectors).any(axis=0))
    return (
        f"{what} is undefined at " + vertices(lost, "of a degenerate star", "of degenerate stars") if len(lost) else ""
    )


def _columns(analysis: Analysis, *names: str) -> dict[str, Any]:
    return evaluate(analysis.surface, names, area=analysis.conventions.area, known=analysis.columns)

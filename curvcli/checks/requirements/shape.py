"""Requirements of shape: convex, minimal, constant mean curvature."""

from __future__ import annotations

import math

import numpy as np

from ...mesh.surface import Surface
from ...mesh.triangles import EPSILON, dot
from ...support.arrays import Column, Flags, VectorColumn
from ...support.words import format_rounded
from ..special import constant_mean_curvature, steiner
from .base import requirement
from .topology import closed, connected, euler, manifold, oriented
from .wording import join_problems, vertices


@requirement("convex", remedy="look where `K_minus` is largest: there the surface is not convex", after="components")
def convex(surface: Surface, face_area: Column, H_theta: Column, K: Column, K_minus: Column) -> str:
    """The surface bounds a convex body: closed, connected, χ = 2 and ΣK⁻ = 0."""
    problem = join_problems(closed(surface), manifold(surface), connected(surface)) or euler(surface, 2)
    if problem:
        return problem
    columns = {"face_area": face_area, "H_theta": H_theta, "K": K, "K_minus": K_minus}
    lost = np.flatnonzero(np.isnan(K_minus) & surface.referenced)
    if len(lost):
        return "K⁻ is undefined at " + vertices(surface, lost, "of a degenerate star", "of degenerate stars")
    if bool(steiner(surface, surface.whole, columns)["convex"][0]):
        return ""
    bound = 16 * EPSILON * (surface.n_faces + int(np.count_nonzero(surface.referenced)))
    worst = int(np.argmax(np.where(surface.referenced, K_minus, 0)))
    total = float(surface.whole.vertices.sum(K_minus)[0])
    return f"ΣK⁻ = {format_rounded(total)} (allowed {format_rounded(bound, 2)}), most at vertex {worst}"


@requirement(
    "minimal",
    "TOL",
    remedy="evolve the surface, refine it regularly, or allow more; `h_hks` is largest at the worst vertex",
    after="convex",
)
def minimal(
    surface: Surface,
    tolerance: float,
    H_vec: VectorColumn,
    star_area: Column,
    star_extent: Column,
    face_area: Column,
    mean: str,
) -> str:
    """The largest |H_p|/A_p · √area off the boundary is at most TOL, whatever the unit and the size of the mesh."""
    covered = surface.referenced & ~surface.boundary
    scale = math.sqrt(surface.whole.faces.sum(face_area)[0])
    largest, vertex = _largest_density(H_vec, star_area, star_extent, covered)
    value = largest * scale * (0.5 if mean == "average" else 1.0)
    return _judged("max |H_p|/A_p · √area", value, vertex, tolerance) or _untested(surface, H_vec, covered, "H_vec")


@requirement(
    "cmc",
    "TOL",
    remedy="evolve the surface, refine it regularly, or allow more; where H is 0, require `minimal` instead",
    after="minimal",
)
def cmc(
    surface: Surface,
    tolerance: float,
    H_vec: VectorColumn,
    A_vec: VectorColumn,
    star_area: Column,
    star_extent: Column,
) -> str:
    """The largest |H_p + H A_p|/A_p inside is at most TOL · |H|, H the best constant, whatever the unit."""
    columns = {"H_vec": H_vec, "A_vec": A_vec, "star_area": star_area}
    H = float(constant_mean_curvature(surface, surface.whole, columns)["H"][0])
    residual = H_vec + H * A_vec
    largest, vertex = _largest_density(residual, star_area, star_extent, surface.interior)
    name = "max |H_p + H A_p|/A_p ÷ |H|"
    if math.isnan(largest) and surface.without_orientation.any():
        return f"{name} is undefined: {oriented(surface)}"
    value = 0.0 if largest == 0 else largest / abs(H) if H else math.inf
    others = np.flatnonzero(surface.nonmanifold & ~surface.boundary)
    return (
        _judged(name, value, vertex, tolerance)
        or _untested(surface, residual, surface.interior, "H_vec or A_vec")
        or (f"{name} is untested at " + vertices(surface, others, _NOT_A_FAN, _NOT_FANS) if len(others) else "")
    )


_NOT_A_FAN, _NOT_FANS = "whose star is not one fan", "whose stars are not one fan"


def _largest_density(vectors: VectorColumn, area: Column, extent: Column, where: Flags) -> tuple[float, int]:
    """The largest |v|/A_p and its vertex, with v within rounding taken as 0; NaN without a vertex."""
    size = np.sqrt(dot(vectors, vectors))
    size[size <= 16 * EPSILON * extent] = 0.0
    density = np.divide(size, area, out=np.full_like(size, np.nan), where=where & (area > 0))
    if np.isnan(density).all():
        return math.nan, -1
    vertex = int(np.nanargmax(density))
    return float(density[vertex]), vertex


def _judged(name: str, value: float, vertex: int, tolerance: float) -> str:
    if math.isnan(value):
        return f"{name} is undefined: no vertex inside has a value"
    return (
        ""
        if value <= tolerance
        else f"{name} = {format_rounded(value)} (allowed {format_rounded(tolerance)}), at vertex {vertex}"
    )


def _untested(surface: Surface, vectors: VectorColumn, where: Flags, what: str) -> str:
    lost = np.flatnonzero(where & np.isnan(vectors).any(axis=0))
    if not len(lost):
        return ""
    return f"{what} is undefined at " + vertices(surface, lost, "of a degenerate star", "of degenerate stars")

"""Force and torque balance: boundary conormals against the mean curvature vectors inside."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from ..mesh.conormals import conormals
from ..mesh.groups import Groups, Segments
from ..mesh.surface import Surface
from ..mesh.topology import ends_of
from ..mesh.triangles import EPSILON, cross, dot
from ..support.arrays import Column, Floats, Index, VectorColumn
from ..support.cache import cached
from .base import IdentityValues, check, exclude_null, rounding


def vector_sum(segments: Segments, vectors: Iterable[Column]) -> Floats:
    """(G, 3) sums over each group of vectors given by their components."""
    return np.stack([segments.sum(component) for component in vectors], axis=1)


def boundary_segments(groups: Groups, half_edges: Index) -> Segments:
    """Segments of (n,) half-edges by the groups of their faces."""
    label = None if groups.faces.label is None else groups.face[half_edges // 3]
    return Segments(label, groups.count, len(half_edges))


@cached
def _boundary(surface: Surface, groups: Groups) -> tuple[Segments, VectorColumn, VectorColumn]:
    """Segments, midpoints about the base and conormals η|e| of the boundary edges."""
    half_edges = surface.boundary_half_edges
    tail, head = ends_of(surface.faces, half_edges)
    base = surface.base[:, None]
    midpoint = 0.5 * (surface.xyz[:, tail] - base) + 0.5 * (surface.xyz[:, head] - base)
    return boundary_segments(groups, half_edges), midpoint, conormals(surface, half_edges)


def _offset(surface: Surface, axis: int) -> Column:
    """(V,) a coordinate about the base; unreferenced vertices may lie anywhere, but their vectors are null."""
    offset: Column = surface.xyz[axis] - surface.base[axis]
    return offset


def dot_offset(surface: Surface, vectors: VectorColumn) -> Column:
    """(V,) p · v about the base."""
    with np.errstate(over="ignore", invalid="ignore"):
        product: Column = _offset(surface, 0) * vectors[0]
        for axis in (1, 2):
            product += _offset(surface, axis) * vectors[axis]
    return product


def _cross_offset(surface: Surface, vectors: VectorColumn) -> Iterator[Column]:
    """The components (V,) of p × v about the base, one after the other."""
    for i, j in ((1, 2), (2, 0), (0, 1)):
        with np.errstate(over="ignore", invalid="ignore"):
            product = _offset(surface, i) * vectors[j]
            product -= _offset(surface, j) * vectors[i]
        yield product


def moments(surface: Surface, sizes: Column) -> Column:
    """(V,) sizes times the distance from the base, a bound for the terms of sums of p · v and p × v."""
    with np.errstate(over="ignore", invalid="ignore"):
        square = _offset(surface, 0) ** 2
        for axis in (1, 2):
            square += _offset(surface, axis) ** 2
        return np.asarray(np.sqrt(square) * sizes)


@check(
    gap="ΣH_p − Ση|e|",
    applies="every surface, orientable or not; not where H_vec is undefined at a corner of a degenerate face",
    bound="(16 + log₂N)ε · Σ over the corners of faces of the extent",
    failure="H_vec of some vertex is wrong, or an edge was taken for boundary that is not.",
    after="total_absolute_curvature",
)
def force_balance(surface: Surface, groups: Groups, H_vec: VectorColumn, star_extent: Column) -> IdentityValues:
    """Σ η|e| over the boundary = Σ H_p: translations change no area; needs no orientation."""
    segments, _, conormal = _boundary(surface, groups)
    value, expected = vector_sum(groups.vertices, H_vec), vector_sum(segments, conormal)
    tolerance = rounding(surface, groups.vertices.sum(star_extent))
    outcome = IdentityValues(
        value, expected, tolerance, length_exponent=1, detail="Σ H_p against Σ η|e| over the boundary"
    )
    exclude_null(outcome, groups, surface, np.isnan(H_vec[0]), "H_vec")
    return outcome


@check(
    gap="Σp × H_p − Σm × η|e|",
    applies="as force_balance",
    bound="(16 + log₂N)ε · Σ over the corners of faces of the extent · distance from the base",
    failure="if force_balance passes: values of H_vec stand at the wrong vertices.",
    after="force_balance",
)
def torque_balance(surface: Surface, groups: Groups, H_vec: VectorColumn, star_extent: Column) -> IdentityValues:
    """Σ m × η|e| over the boundary = Σ p × H_p: rotations change no area; needs no orientation."""
    segments, midpoint, conormal = _boundary(surface, groups)
    value = vector_sum(groups.vertices, _cross_offset(surface, H_vec))
    expected = vector_sum(segments, cross(midpoint, conormal))
    tolerance = rounding(surface, groups.vertices.sum(moments(surface, star_extent)))
    # Computed about the base, for the least rounding, then moved to the origin.
    outcome = IdentityValues(value, expected, tolerance, length_exponent=2, detail="Σ p × H_p against Σ m × η|e|")
    outcome.residual = np.sqrt(((value - expected) ** 2).sum(axis=1))
    with np.errstate(over="ignore", invalid="ignore"):  # moments that overflow are null
        outcome.value = value + np.cross(surface.base, vector_sum(groups.vertices, H_vec))
        outcome.expected = expected + np.cross(surface.base, vector_sum(segments, conormal))
    exclude_null(outcome, groups, surface, np.isnan(H_vec[0]), "H_vec")
    return outcome


@check(
    gap="Σp·H_p + 2 area − Σm·η|e|",
    applies="as force_balance",
    bound="(16 + log₂N)ε · Σ over the corners of faces of the extent · distance from the base",
    failure="if force_balance passes: the area of a face is wrong, or values of H_vec stand at the wrong vertices.",
    after="torque_balance",
)
def position_balance(
    surface: Surface, groups: Groups, H_vec: VectorColumn, face_area: Column, star_extent: Column
) -> IdentityValues:
    """Σ m·η|e| over the boundary = Σ p·H_p + 2 area: scaling changes area by its square; needs no orientation."""
    segments, midpoint, conormal = _boundary(surface, groups)
    value = groups.vertices.sum(dot_offset(surface, H_vec)) + 2 * groups.faces.sum(face_area)
    expected = segments.sum(dot(midpoint, conormal))
    tolerance = rounding(surface, groups.vertices.sum(moments(surface, star_extent)))
    outcome = IdentityValues(value, expected, tolerance, length_exponent=2, detail="Σ p·H_p + 2 area against Σ m·η|e|")
    outcome.residual = np.abs(value - expected)
    with np.errstate(over="ignore", invalid="ignore"):
        outcome.value = value + vector_sum(groups.vertices, H_vec) @ surface.base
        outcome.expected = expected + vector_sum(segments, conormal) @ surface.base
    exclude_null(outcome, groups, surface, np.isnan(H_vec[0]), "H_vec")
    return outcome


@check(
    gap="ΣA_p − ½Σ a × b",
    applies="orientable surfaces",
    bound="(16 + log₂N)ε · (area + ½Σ|a||b| over the half-edges that do not cancel) + ε · Σ(Σ extents)² over the stars",
    failure="A_vec of some vertex, or the orientation of some face, is wrong.",
    after="position_balance",
)
def vector_area(
    surface: Surface, groups: Groups, A_vec: VectorColumn, face_area: Column, star_extent: Column
) -> IdentityValues:
    """½ Σ a × b over the oriented half-edges that do not cancel = Σ area ν; 0 on closed surfaces."""
    left, times = surface.uncancelled, surface.uncancelled.surplus
    base = surface.base[:, None]
    a, b = (surface.xyz[:, end] - base for end in (left.a, left.b))
    label = None if groups.vertices.label is None else groups.vertices.label[left.a]
    segments = Segments(label, groups.count, len(times))
    swept = [0.5 * part * times for part in cross(a, b)]
    expected, value = vector_sum(segments, swept), vector_sum(groups.vertices, A_vec)
    span = 0.5 * np.sqrt(dot(a, a)) * np.sqrt(dot(b, b)) * np.abs(times)
    # The area vector of a needle, in compensated arithmetic, has an error of ε² times a product of its edges.
    needles = EPSILON * groups.vertices.sum(star_extent**2)
    outcome = IdentityValues(
        value,
        expected,
        rounding(surface, groups.faces.sum(face_area) + segments.sum(span) + needles),
        length_exponent=2,
        detail="Σ A_p against ½ Σ a × b",
    )
    outcome.exclude(groups.vertices.any(surface.without_orientation), "the surface has no orientation")
    exclude_null(outcome, groups, surface, np.isnan(A_vec[0]), "A_vec")
    return outcome

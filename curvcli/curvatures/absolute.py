"""Absolute Gauss curvature: K⁺ of the convex hull of the star, and K⁻ = K⁺ − K."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ..mesh.surface import Surface
from ..mesh.triangles import EPSILON
from ..support.arrays import Column, Flags, Index
from ..support.blocks import for_each, slices
from .kernels.normal_cones import normal_cone_areas
from .quantity import Quantity
from .registry import curvature_pass

# Directions per block: enough that two threads rarely wait for the interpreter lock.
_DIRECTIONS = 131072
# Degrees up to this form one group each; larger ones are rounded up, with the last direction repeated.
_EXACT_DEGREE = 24

_SHARED = {
    "boundary": "null",
    "source": "Sullivan, Discrete surfaces; Banchoff, Critical points and curvature for embedded polyhedra",
}


@curvature_pass(
    provides=(
        Quantity(
            "K_plus",
            symbol="K⁺_p",
            formula="2π − Σ of the angles at p of the convex hull of Star(p) if p is extreme on it, else 0",
            total="K_plus",
            preserves="K⁺ − K⁻ = K; Σ(K⁺ + K⁻)/2π is the mean number of critical points of height functions",
            description="Positive part of the Gauss curvature, a measure: the solid angle of the star's normal cone.",
            **_SHARED,  # type: ignore[arg-type]
            after="K_comb",
            total_after="H_tan",
        ),
        Quantity(
            "K_minus",
            symbol="K⁻_p",
            formula="K⁺ − K ≥ 0",
            total="K_minus",
            preserves="K⁺ − K⁻ = K; 0 everywhere exactly on locally convex surfaces",
            description="Negative part of the Gauss curvature, a measure.",
            **_SHARED,  # type: ignore[arg-type]
            after="K_plus",
            total_after="K_plus",
        ),
        Quantity(
            "K_abs",
            symbol="|K|_p",
            formula="K⁺ + K⁻",
            total="K_abs",
            preserves="total_absolute_curvature: Σ ≥ 2π(4 − χ), equality on tight surfaces",
            description="Absolute Gauss curvature, a measure: K_abs/2π is the mean number of critical points, counted "
            "with multiplicity, that height functions have at p.",
            **_SHARED,  # type: ignore[arg-type]
            after="K_minus",
            total_after="K_minus",
        ),
    )
)
def absolute_curvature(surface: Surface, K: Column, theta: Column) -> tuple[Column, ...]:
    """K⁺, K⁻ and |K| from the convex hull of each star; needs no orientation."""
    plus = np.where(surface.interior, np.maximum(K, 0.0), np.nan)
    chosen = np.flatnonzero(surface.interior & ~np.isnan(K) & ~locally_convex(surface, K, theta))
    neighbours = _Neighbours(surface)

    def hull(block: tuple[NDArray[np.intp], int]) -> None:
        vertices, degree = block
        around = neighbours.of(vertices, degree)
        directions = np.array([x.take(around) - x.take(vertices) for x in surface.xyz])
        plus[vertices] = np.maximum(plus[vertices], normal_cone_areas(directions))

    for_each(_blocks_by_degree(chosen, surface.degree), hull)
    minus = np.maximum(plus - K, 0.0)
    return plus, minus, plus + minus


def locally_convex(surface: Surface, K: Column, theta: Column) -> Flags:
    """(V,) mask of the interior vertices whose star is the boundary of its own convex hull, so that K⁺ = K.

    Dihedral angles of one sign mean that the link is locally convex. K ≥ 0 makes it no longer than 2π, and it winds
    once exactly if they sum to at most 2π: a link with w turns has Σ|θ| = 2πw − area, area < 2π. False where θ is
    null or has no sign for want of an orientation.
    """
    up, down = np.zeros(surface.n_vertices), np.zeros(surface.n_vertices)
    for block in slices(len(surface.edges)):
        a, b = (end[block].astype(np.intp) for end in (surface.edges.a, surface.edges.b))
        angle = theta[block]
        for total, part in ((up, np.maximum(angle, 0.0)), (down, np.maximum(-angle, 0.0))):
            np.add.at(total, a, part)
            np.add.at(total, b, part)
    rounding = 8 * EPSILON * surface.degree
    convex = (np.minimum(up, down) <= rounding) & (up + down <= 2 * np.pi + rounding) & (rounding + K >= 0)
    return np.asarray(convex & ~surface.without_orientation)


class _Neighbours:
    """Neighbours of every vertex: those with lower numbers, then those with higher ones."""

    def __init__(self, surface: Surface) -> None:
        edges, vertices = surface.edges, surface.n_vertices
        rows = np.arange(len(edges) + 1, dtype=np.int32)
        by_high_end = csr_array((edges.a, edges.b, rows), shape=(len(edges), vertices)).tocsc()
        self.lower, first_lower = by_high_end.data, by_high_end.indptr
        self.higher = edges.b  # edges are sorted by their lower ends
        self.first_lower, self.count_lower = first_lower[:-1], np.diff(first_lower)
        count_higher = surface.degree - self.count_lower
        self.first_higher = np.cumsum(count_higher, dtype=np.int32) - count_higher
        self.degree = surface.degree

    def of(self, vertices: NDArray[np.intp], degree: int) -> NDArray[np.intp]:
        """(degree, n) neighbours of vertices of at most that degree, with the last one repeated."""
        rank = np.minimum(np.arange(degree, dtype=np.int32)[:, None], self.degree.take(vertices) - np.int32(1))
        above = rank - self.count_lower.take(vertices)
        lower = self.lower.take(self.first_lower.take(vertices) + rank, mode="clip")
        higher = self.higher.take(self.first_higher.take(vertices) + above, mode="clip")
        return np.asarray(np.where(above < 0, lower, higher), np.intp)


def _blocks_by_degree(chosen: NDArray[np.intp], degree: Index) -> Iterator[tuple[NDArray[np.intp], int]]:
    """Yield blocks of vertices with the same number of directions, and that number."""
    size = _rounded_up(degree[chosen])
    order = np.argsort(size, kind="stable")
    chosen, size = chosen[order], size[order]
    groups, begin = np.unique(size, return_index=True)
    for common, group in zip(groups.tolist(), np.split(chosen, begin)[1:], strict=True):
        for block in slices(len(group), max(_DIRECTIONS // common, 1)):
            yield group[block], common


def _rounded_up(degree: Index) -> NDArray[np.int64]:
    """Round up degrees above a limit by at most an eighth, to get few groups."""
    exponent = np.frexp(np.maximum(degree - 1, 1))[1].astype(np.int64)
    unit = np.left_shift(1, np.maximum(exponent - 4, 0))
    return np.where(degree <= _EXACT_DEGREE, degree, -(-degree.astype(np.int64) // unit) * unit)

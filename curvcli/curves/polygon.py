"""Curves: arrays of many polygons, open and closed, in any dimension, with edges and tangents."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import InputError
from ..support.arrays import Floats, Mask

Rows = NDArray[np.int64]


def scaled(values: Floats, power: Rows | NDArray[np.int32]) -> Floats:
    """Values times 2 to a power; NaN on overflow."""
    with np.errstate(over="ignore", under="ignore"):
        result = np.ldexp(values, power)
    return np.where(np.isfinite(result) & ((result != 0) | (values == 0)), result, np.nan)


class Curves:
    """Polygonal curves in concatenated arrays, for vectorised functions over any number of curves.

    xyz: (d, n) positions of all vertices. start: (m + 1,) first vertex of each curve. closed: (m,).
    Edge i leaves vertex i; the last vertex of an open curve has none. Values of an edge are in the row of its first
    vertex, NaN without an edge. Lengths are in the unit of xyz.
    """

    def __init__(self, xyz: Floats, start: Rows, closed: Mask) -> None:
        self.xyz, self.start, self.closed = xyz, start, closed

    def __len__(self) -> int:
        return len(self.closed)

    @property
    def size(self) -> int:
        """Number of vertices of all curves."""
        return int(self.xyz.shape[1])

    @property
    def dimension(self) -> int:
        """d, the dimension of space."""
        return len(self.xyz)

    @cached_property
    def sizes(self) -> Rows:
        """(m,) vertices of each curve."""
        return np.diff(self.start)

    @cached_property
    def edges(self) -> Rows:
        """(m,) edges of each curve."""
        return np.where(self.closed, self.sizes, np.maximum(self.sizes - 1, 0))

    @cached_property
    def label(self) -> Rows:
        """(n,) the curve of each vertex."""
        return np.repeat(np.arange(len(self)), self.sizes)

    @cached_property
    def following(self) -> Rows:
        """(n,) the vertex at the head of each vertex's edge; the vertex itself without an edge."""
        after = np.arange(1, self.size + 1)
        filled = self.sizes > 0
        last = self.start[1:][filled] - 1
        after[last] = np.where(self.closed[filled], self.start[:-1][filled], last)
        return after

    @cached_property
    def preceding(self) -> Rows:
        """(n,) the vertex before each one; the vertex itself at the beginning of an open curve."""
        before = np.arange(-1, self.size - 1)
        filled = self.sizes > 0
        first = self.start[:-1][filled]
        before[first] = np.where(self.closed[filled], self.start[1:][filled] - 1, first)
        return before

    @cached_property
    def has_edge(self) -> Mask:
        """(n,) mask of the vertices with a leaving edge: all but the last of open curves."""
        mask = np.ones(self.size, bool)
        mask[self.start[1:][~self.closed & (self.sizes > 0)] - 1] = False
        return mask

    @cached_property
    def inner(self) -> Mask:
        """(n,) mask of the vertices between two edges: all but the ends of open curves."""
        mask = self.has_edge.copy()
        mask[self.start[:-1][~self.closed & (self.sizes > 0)]] = False
        return mask

    @cached_property
    def _safe(self) -> tuple[Floats, int]:
        """Positions in units of 2 to a power, so that no difference overflows: power 0 but at the end of the range."""
        if np.abs(self.xyz).max(initial=0.0) < 2.0**1020:
            return self.xyz, 0
        return np.ldexp(self.xyz, -4), 4

    @cached_property
    def _edge(self) -> tuple[Floats, Floats]:
        """Lengths (n,) and unit tangents (d, n) of the edges, at any scale: squares are taken near 1."""
        xyz, unit = self._safe
        vector = xyz[:, self.following] - xyz
        power = np.frexp(np.abs(vector).max(axis=0, initial=0.0))[1]
        vector = np.ldexp(vector, -power)
        norm = np.sqrt((vector * vector).sum(axis=0))
        length = np.where(self.has_edge, scaled(norm, power + unit), np.nan)
        norm[norm == 0] = np.nan
        return length, vector / norm

    @property
    def edge_length(self) -> Floats:
        """(n,) length of the edge leaving each vertex; NaN at the end of open curves."""
        return self._edge[0]

    @property
    def tangent(self) -> Floats:
        """(d, n) unit tangent T of the edge leaving each vertex; NaN for edges of length 0."""
        return self._edge[1]

    @cached_property
    def length(self) -> Floats:
        """(m,) length of each curve; NaN on overflow."""
        with np.errstate(over="ignore"):
            length = self.sum(self.edge_length)
        # An edge length that overflows is NaN, which a sum would leave out.
        unknown = self.sum(np.isnan(self.edge_length) & self.has_edge) > 0
        return np.where(np.isfinite(length) & ~unknown, length, np.nan)

    @cached_property
    def arc(self) -> Floats:
        """(n,) arc length from the beginning of the curve to each vertex; NaN on overflow."""
        with np.errstate(over="ignore"):
            arc = self.running(np.where(np.isnan(self.edge_length), np.inf, self.edge_length))
        return np.where(np.isfinite(arc), arc, np.nan)

    @cached_property
    def local(self) -> tuple[Floats, Rows]:
        """Positions (d, n) about the first point of each curve, in units of a power of 2 (m,) near its size."""
        filled = self.sizes > 0
        xyz, unit = self._safe
        origin = np.zeros((self.dimension, len(self)))
        origin[:, filled] = xyz[:, self.start[:-1][filled]]
        offset = xyz - np.repeat(origin, self.sizes, axis=1)
        power = np.frexp(np.maximum(self.max(np.abs(offset).max(axis=0, initial=0.0)), 0.0))[1].astype(np.int64)
        return np.ldexp(offset, -np.repeat(power, self.sizes)), power + unit

    # ------------------------------------------------------------------ sums along curves

    def sum(self, values: NDArray[Any]) -> Floats:
        """(m,) sums along each curve, pairwise; nulls (NaN) are left out."""
        filled_values = np.asarray(values, np.float64)
        filled_values = np.where(np.isnan(filled_values), 0.0, filled_values)
        sums = np.zeros(len(self))
        filled = self.sizes > 0
        if filled.any():
            sums[filled] = np.add.reduceat(filled_values, self.start[:-1][filled])
        return sums

    def max(self, values: Floats) -> Floats:
        """(m,) the largest value along each curve; -inf on a curve without vertices."""
        largest = np.full(len(self), -np.inf)
        filled = self.sizes > 0
        if filled.any():
            largest[filled] = np.maximum.reduceat(values, self.start[:-1][filled])
        return largest

    def running(self, values: Floats) -> Floats:
        """(n,) at each vertex the sum of the values at the vertices before it on its curve.

        Computed by doubling: as exact as a pairwise sum, without rounding errors from other curves.
        """
        total = np.zeros(self.size)
        position = np.arange(self.size) - np.repeat(self.start[:-1], self.sizes)
        later = position > 0
        total[1:][later[1:]] = values[:-1][later[1:]]
        step, longest = 1, int(self.sizes.max(initial=0))
        while step < longest:
            total[step:] += np.where(position[step:] >= step, total[:-step], 0.0)
            step *= 2
        return total

    # ------------------------------------------------------------------ repeated points

    def distinct(self) -> tuple[Curves, Rows]:
        """Remove edges of length 0: the curves, and the index of the remaining vertices.

        The last of equal consecutive points is kept.
        """
        keep = ~(self.edge_length == 0)
        # A closed curve of equal points keeps no vertex; an open one keeps its last.
        if keep.all():
            return self, np.arange(self.size)
        kept = np.flatnonzero(keep)
        start = np.concatenate([[0], np.cumsum(keep)])[self.start]
        return Curves(self.xyz[:, kept], start, self.closed), kept


def curves_of(points: ArrayLike, closed: bool) -> Curves:
    """Make one curve from its points (n, d).

    Errors: InputError for points that are not finite numbers of shape (n, d), n ≥ 1 and d ≥ 2.
    """
    given = np.asarray(points)
    if given.ndim != 2 or given.shape[1] < 2 or not len(given) or given.dtype.kind not in "fiu":
        raise InputError(f"points have shape {given.shape} and type {given.dtype}, expected numbers of shape (n, d)")
    xyz = np.ascontiguousarray(given.T, np.float64)
    bad = np.flatnonzero(~np.isfinite(xyz).all(axis=0))
    if len(bad):
        raise InputError("coordinates are not finite, expected finite numbers", place=f"point {bad[0]}")
    return Curves(xyz, np.array([0, len(given)]), np.array([closed]))

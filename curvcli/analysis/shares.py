"""Shares: the parts of a total that belong to the faces of each region; they add up to the total of the whole.

A vertex measure is split over the faces at its vertex in proportion to their areas, evenly where all of them have area
0; an edge measure is split evenly over its n_e faces. The share of a region is the sum over its faces. Values are those
of the whole surface, which is not cut: a vertex on the border of a region counts, in part.
Source: curvcli conventions.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from ..checks.base import rounding
from ..checks.partition import Share
from ..curvatures.quantity import AT_SCALE, Quantity
from ..curvatures.registry import passes
from ..mesh.borders import vertex_regions
from ..mesh.groups import Segments
from ..mesh.scale import DEFAULTS, EstimatorSettings
from ..mesh.surface import Surface
from ..mesh.triangles import EPSILON
from ..support.arrays import Floats, Index, Mask
from .totals import summed


class _Split:
    """Split of the values of one kind of element over the faces of regions.

    label: (n,) region of each element that has one, −1 for those on a border. element, region, weight: of the parts of
    elements on a border; the weights of an element add up to 1.
    """

    def __init__(self, label: Index, count: int, element: Index, region: Index, weight: Floats) -> None:
        self.inner, self.border = Segments(label, count, len(label)), Segments(region, count, len(region))
        self.element, self.weight = element, weight
        self.faces = np.bincount(element, minlength=len(label))[element]

    def sum(self, values: Floats) -> Floats:
        """(count,) sums of a measure over the faces of each region; nulls count as 0."""
        return self.inner.sum(values) + self.border.sum(values[self.element] * self.weight)

    def rounding(self, values: Floats) -> float:
        """Error of the weights: that of an area summed over the n faces of a star is at most nε."""
        return EPSILON * float(np.nansum(np.abs(values[self.element]) * self.weight * self.faces))


class Partition:
    """Partition of the faces of a surface into regions and the faces without one.

    face: (F,) region of each face, −1 for none. count: of the regions. area: (F,) areas of the faces. borders: the
    result of `vertex_regions`, where it is known.
    """

    def __init__(
        self, surface: Surface, face: Index, count: int, area: Floats, borders: tuple[Index, Mask] | None = None
    ) -> None:
        self.surface, self.count, self._area = surface, count, area
        self._borders = vertex_regions(surface.faces, face, surface.n_vertices) if borders is None else borders
        self._face = np.where(face < 0, np.int32(count), face).astype(np.int32)

    def shares(
        self,
        columns: Mapping[str, Any],
        of_faces: Mapping[str, tuple[Floats, Floats]] | None = None,
        settings: EstimatorSettings = DEFAULTS,
    ) -> list[Share]:
        """Shares of every total that the given columns provide, in the order of the report.

        of_faces: (F,) parts of the faces, and sizes of their terms, for measures that a pass splits itself.
        """
        own, quantities = of_faces or {}, summed(columns, settings)
        return [self._share(quantity, columns[quantity.name], own.get(quantity.name)) for quantity in quantities]

    def _share(self, quantity: Quantity, column: Any, own: tuple[Floats, Floats] | None) -> Share:
        if own is not None:
            return self._split_by_pass(quantity, column, *own)
        scalars = list(column) if quantity.vector else [np.asarray(column, np.float64)]
        each = [self._sum(quantity.on, values) for values in scalars]
        values, total, bound = (np.stack(part, axis=-1) for part in zip(*each, strict=True))
        if not quantity.vector:
            values, total, bound = (part[..., 0] for part in (values, total, bound))
        if self._is_null(quantity, scalars[0]):
            values, total = np.full_like(values, np.nan), np.full_like(total, np.nan)
        exponents = quantity.length_exponent, quantity.mean_degree
        return Share(str(quantity.total), *exponents, values, total, bound, quantity.energy)

    def _split_by_pass(self, quantity: Quantity, column: Floats, face_values: Floats, sizes: Floats) -> Share:
        """Shares of a measure of vertices from the parts of the faces; a mean over the n faces of a star is known to
        (n + 3)ε of its terms, and so is the square of its difference from another number, twice."""
        values, total = self._faces.sum(face_values), Segments(None, 1, len(column)).sum(column)[0]
        stars = 2 * (int(self.surface.degree.max()) + 3) * EPSILON * float(sizes.sum())
        bound = float(rounding(self.surface, Segments(None, 1, len(sizes)).sum(sizes))[0]) + stars
        if self._is_null(quantity, column):
            values, total = np.full_like(values, np.nan), np.nan
        exponents = quantity.length_exponent, quantity.mean_degree
        return Share(str(quantity.total), *exponents, values, np.asarray(total), np.asarray(bound), quantity.energy)

    def _is_null(self, quantity: Quantity, column: Floats) -> bool:
        """True where the total of the whole is null: without an orientation, or without any estimate."""
        scaled = passes.depends_on_scale(quantity.name.partition(AT_SCALE)[0])
        unoriented = quantity.parity == "odd" and not self.surface.orientable
        return unoriented or (scaled and bool(np.isnan(column).all()))

    def _sum(self, on: str, values: Floats) -> tuple[Floats, float, float]:
        """Shares, total and bound of one scalar measure."""
        whole = Segments(None, 1, len(values))
        bound = float(rounding(self.surface, whole.sum(np.abs(values)))[0])
        if on == "face":
            return self._faces.sum(values), float(whole.sum(values)[0]), bound
        split = self._edges if on == "edge" else self._vertices
        return split.sum(values), float(whole.sum(values)[0]), bound + split.rounding(values)

    @cached_property
    def _faces(self) -> Segments:
        return Segments(self._face, self.count + 1, len(self._face))

    @cached_property
    def _vertices(self) -> _Split:
        faces, n = self.surface.faces, self.surface.n_vertices
        label, mixed = self._borders
        label = np.where(mixed, np.int32(-1), np.where(label < 0, np.int32(self.count), label))
        at = np.flatnonzero(mixed[faces])
        vertex, area = faces.ravel()[at], self._area[at // 3]
        star = np.bincount(vertex, area, minlength=n)[vertex]
        share = np.bincount(vertex, minlength=n)[vertex].astype(np.float64)
        weight = np.divide(area, star, out=1 / share, where=star > 0)
        return _Split(label, self.count + 1, vertex, self._face[at // 3], weight)

    @cached_property
    def _edges(self) -> _Split:
        edges = self.surface.edges
        region = self._face[edges.order // 3]
        first = region[edges.start[:-1]]
        valence = edges.valence
        mixed = np.logical_or.reduceat(region != np.repeat(first, valence), edges.start[:-1])
        border = np.flatnonzero(mixed)
        half_edges = edges.half_edges(border)
        edge = np.repeat(border, valence[border]).astype(np.int32)
        label = np.where(mixed, np.int32(-1), first)
        return _Split(label, self.count + 1, edge, self._face[half_edges // 3], 1.0 / valence[edge])

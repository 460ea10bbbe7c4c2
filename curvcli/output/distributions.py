"""Distributions of columns over bins of equal width, by number of vertices and by area, of one mesh or several.

Every vertex has the weight of its star's area, a third of its faces, so the areas of all rows add up to the surface.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..curvatures.quantity import Quantity
from ..curvatures.registry import passes
from ..support.arrays import Floats, Ints, Mask
from .appearance import REGION

if TYPE_CHECKING:
    from ..analysis.result import Result
    from .appearance import Appearance
    from .pictures.colors import ColorScale

_FEWEST, _MOST = 10, 60
# Each number of such a column has a bin, up to this many.
_WHOLE_NUMBERS = 60


@dataclass(frozen=True)
class ColumnSample:
    """Values of one column of one mesh.

    values: (V,) NaN where undefined, or codes of labels. area: (V,) in the file's unit. apart: (V,) vertices that are
    left out of the choice of a range. floor: (V,) sizes up to which values are rounding, None if no value is. energy:
    the unit of energies, None for κ.
    """

    mesh: str
    name: str
    quantity: Quantity
    values: NDArray[Any]
    area: Floats
    apart: Mask
    floor: Floats | None = None
    energy: str | None = None

    @property
    def defined(self) -> Mask:
        """(V,) true where the column has a value."""
        return self.values >= 0 if self.quantity.labels else np.isfinite(self.values)


def vertex_quantities(chosen: list[str]) -> dict[str, Quantity]:
    """Vertex columns that were computed, each with its quantity."""
    return {column: q for q in map(passes.quantity, chosen) for column in q.columns if q.on == "vertex"}


def sample(analysis: Result, name: str, mesh: str | None = None, *, areas: bool = True) -> ColumnSample:
    """The values of one vertex column of an analysis.

    mesh: its name, by default that of its file. areas: false where only the colours count.
    """
    from .pictures.legend import mesh_name
    from .pictures.rounding_floor import floor

    quantity, surface = vertex_quantities(analysis.chosen)[name], analysis.surface
    names = mesh or mesh_name(analysis), name, quantity
    area = analysis.column("star_area") if areas else np.empty(0)
    if quantity.labels:
        return ColumnSample(*names, analysis.columns[name], area, surface.boundary)
    values = np.where(surface.referenced, analysis.vertices[name].astype(np.float64), np.nan)
    rigidity = analysis.conventions.rigidity
    energy = None if rigidity is None else rigidity.unit
    return ColumnSample(*names, values, area, surface.boundary, floor(analysis, quantity, values), energy)


def histograms(appearance: Appearance, chosen: list[str]) -> tuple[tuple[str, ...], ...]:
    """The columns of each histogram: those asked for, or all numbers of vertices, one by one."""

    numbers = (name for name, q in vertex_quantities(chosen).items() if not q.vector and not q.labels)
    colored = [name for name in appearance.color_by if name != REGION]
    return appearance.histograms or tuple((name,) for name in colored or numbers)


def histogram_columns(appearance: Appearance, chosen: list[str]) -> tuple[str, ...]:
    """The columns of all histograms."""
    return tuple(name for columns in histograms(appearance, chosen) for name in columns)


@dataclass(frozen=True)
class MeshSamples:
    """The histograms of one mesh or several.

    histograms: for each histogram its columns, one or two, and for each column the sample of every mesh. texts: the
    meshes, and the conventions that the columns depend on. unit: of lengths. compared: true if meshes are compared.
    """

    histograms: list[list[list[ColumnSample]]]
    texts: list[str]
    unit: str | None
    compared: bool = False

    @property
    def meshes(self) -> list[str]:
        """Names of the meshes."""
        return [sample.mesh for sample in self.histograms[0][0]] if self.histograms else []


def samples_of(analysis: Result, appearance: Appearance, mesh: str | None = None) -> MeshSamples:
    """The histograms of one mesh. mesh: its name, by default that of its file."""
    from .pictures.legend import about

    groups = histograms(appearance, analysis.chosen)
    samples = [[[sample(analysis, name, mesh)] for name in columns] for columns in groups]
    quantities = [column[0].quantity for columns in samples for column in columns]
    return MeshSamples(samples, about(analysis, quantities), analysis.conventions.unit)


def several(meshes: Sequence[MeshSamples]) -> MeshSamples:
    """The same histograms of several meshes."""
    together = [
        [[samples[0] for samples in columns] for columns in zip(*each, strict=True)]
        for each in zip(*(mesh.histograms for mesh in meshes), strict=True)
    ]
    texts = dict.fromkeys(text for place in zip(*(mesh.texts[1:] for mesh in meshes), strict=False) for text in place)
    return MeshSamples(together, list(texts), meshes[0].unit, compared=True)


def common_scale(samples: Sequence[ColumnSample], appearance: Appearance, *, symmetric: bool = True) -> ColorScale:
    """The range and the colours of a column, common to all meshes; one colour for each value of the meshes in turn.

    symmetric: whether the range of a signed column is symmetric about 0.
    """
    from .pictures.colors import categorize, colorize

    quantity = samples[0].quantity
    values = _joined([each.values for each in samples])
    if quantity.labels:
        return categorize(values, quantity.labels)
    floors = None
    if any(each.floor is not None for each in samples):
        floors = _joined([np.zeros(len(each.values)) if each.floor is None else each.floor for each in samples])
    return colorize(
        values,
        cmap=appearance.cmap,
        value_range=appearance.range_of(samples[0].name),
        signed=symmetric and (quantity.signed or quantity.vector),
        ignore=_joined([each.apart for each in samples]),
        floor=floors,
    )


def _joined(arrays: Sequence[NDArray[Any]]) -> NDArray[Any]:
    """Arrays one behind the other; a single one without a copy."""
    return arrays[0] if len(arrays) == 1 else np.concatenate(arrays)


@dataclass(frozen=True)
class Axis:
    """One column of a histogram: its values in every mesh, their common range, and the edges of the bins.

    edges: (n + 1,) ascending, empty for labels and where no value is defined. least, most: extremes of all values.
    """

    samples: Sequence[ColumnSample]
    scale: ColorScale
    values: Sequence[NDArray[Any]]
    edges: Floats
    least: float
    most: float

    @property
    def name(self) -> str:
        """Name of the column."""
        return self.samples[0].name

    @property
    def quantity(self) -> Quantity:
        """Quantity of the column."""
        return self.samples[0].quantity

    @property
    def bins(self) -> int:
        """Number of bins within the range."""
        return len(self.quantity.labels) if self.quantity.labels else max(0, len(self.edges) - 1)

    def place(self, number: int) -> Ints:
        """(V,) bin of every value of one mesh: 1 … n, 0 below the range, n + 1 above it, -1 where undefined.

        A bin has its lower edge, the last one both.
        """
        values = self.values[number]
        if self.quantity.labels:
            return np.where(values >= 0, values + 1, -1).astype(np.int64)
        if not self.bins:
            return np.full(len(values), -1)
        place = np.searchsorted(self.edges[1:-1], values, side="right") + 1
        place[values < self.edges[0]] = 0
        place[values > self.edges[-1]] = self.bins + 1
        place[~np.isfinite(values)] = -1
        return place.astype(np.int64)


def axis(samples: Sequence[ColumnSample], appearance: Appearance, *, paired: bool = False) -> Axis:
    """The bins of a column: as many as asked for, else 2∛n (Rice's rule) for n values of the largest mesh, 10 to 60.

    paired: of two columns against each other, with 2∜n bins each and a range that need not be symmetric about 0; the
    range of one column is that of its colours. Columns of counts have a bin for each number; a range of a single value
    has one bin. Values within their rounding are 0, as in pictures.
    """
    scale = common_scale(samples, appearance, symmetric=not paired)
    power = 1 / 4 if paired else 1 / 3
    ends = np.cumsum([len(each.values) for each in samples])[:-1]
    values = _joined([each.values for each in samples])
    if samples[0].quantity.labels or scale.low is None or scale.high is None:
        return Axis(samples, scale, np.split(values, ends), np.empty(0), math.nan, math.nan)
    values = scale.settled(values)
    low, high = scale.low, scale.high
    most = max(int(each.defined.sum()) for each in samples)
    count = appearance.bins or int(np.clip(2 * round(most**power), _FEWEST, _MOST))
    if samples[0].quantity.kind == "count" and high - low < _WHOLE_NUMBERS and appearance.bins is None:
        # Each number has a bin with the number in the middle.
        low, high = math.floor(low) - 0.5, math.ceil(high) + 0.5
        count = round(high - low)
    edges = _edges(low, high, count if high > low else 1)
    return Axis(samples, scale, np.split(values, ends), edges, float(np.nanmin(values)), float(np.nanmax(values)))


def _edges(low: float, high: float, bins: int) -> Floats:
    """Edges of bins of equal width; halves, because the width of a range may exceed the largest double."""
    edges = low + (high / 2 - low / 2) * np.linspace(0.0, 2.0, bins + 1)
    edges[-1] = high
    return np.asarray(edges)


@dataclass(frozen=True)
class Distribution:
    """Vertices and area of one mesh in the bins of one axis, (n + 2,), or of two axes, (n + 2, m + 2).

    The first and the last bin have the values below and above the range. undefined: vertices and area without a value.
    """

    vertices: Floats
    area: Floats
    undefined: tuple[int, float]

    @property
    def shares(self) -> tuple[Floats, Floats]:
        """Shares of the vertices and of the area that have values."""
        return self.vertices / (self.vertices.sum() or 1.0), self.area / (self.area.sum() or 1.0)


def distribution(axes: Sequence[Axis], number: int) -> Distribution:
    """The distribution of one mesh over one or two axes."""
    shape = [each.bins + 2 for each in axes]
    bins = [each.place(number) for each in axes]
    area = axes[0].samples[number].area
    known = np.logical_and.reduce([place >= 0 for place in bins])
    flat = np.ravel_multi_index([place[known] for place in bins], shape)
    size = math.prod(shape)
    vertices = np.bincount(flat, minlength=size).astype(np.float64).reshape(shape)
    areas = np.zeros(size)
    np.add.at(areas, flat, area[known])
    lost = int(len(known) - np.count_nonzero(known)), float(area[~known].sum())
    return Distribution(vertices, areas.reshape(shape), lost)

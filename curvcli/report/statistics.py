"""Statistics of the vertex columns: of the whole surface, and of each of its components or regions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from ..analysis.statistics import REPORTED, GroupedColumn
from ..curvatures.quantity import Quantity
from ..curvatures.registry import passes
from ..mesh.groups import Groups, Segments
from ..mesh.surface import Surface
from ..support.arrays import Floats, Ints, Mask, numbers_or_none

if TYPE_CHECKING:
    from ..analysis.result import Result

# Statistics of one column of a component or region, by their names.
Statistics = dict[str, int | float | None]


class ColumnStatistics(msgspec.Struct):
    """Distribution of a column; percentiles interpolate linearly, std is of the population.

    count: of the values that are not null; count + nulls is the number of rows of the vertex table.
    """

    symbol: str
    unit: str
    kind: str
    length_exponent: int
    min: float | None
    max: float | None
    mean: float | None
    area_mean: float | None
    std: float | None
    p02: float | None
    median: float | None
    p98: float | None
    nulls: int
    count: int | msgspec.UnsetType = msgspec.UNSET  # absent in older reports


def statistics(quantity: Quantity, values: NDArray[Any], area: Floats, used: Mask, unit: str) -> ColumnStatistics:
    """Statistics of one column of the whole surface.

    area: (n,) the weights of `area_mean`. used: (n,) elements that count; the values of others are nulls.
    """
    grouped = GroupedColumn(values.astype(np.float64, copy=False), area, Segments(None, 1, len(values)), used)
    numbers: dict[str, Any] = {name: _plain(grouped.statistic(name))[0] for name in REPORTED}
    symbol = quantity.symbol.replace("*", "")
    return ColumnStatistics(symbol, unit, quantity.kind, quantity.length_exponent, **numbers)


def described(analysis: Result) -> Iterator[tuple[Quantity, str, Floats]]:
    """Quantity, name and values of every scalar vertex column with statistics, in the order of the table."""
    for name in analysis.chosen:
        quantity = passes.quantity(name)
        if quantity.on == "vertex" and quantity.kind != "label":
            shown = analysis.column(name)
            for column, values in zip(quantity.columns, shown.T if quantity.vector else [shown], strict=True):
                yield quantity, column, values.astype(np.float64, copy=False)


def grouped_statistics(
    analysis: Result, groups: Groups, names: Sequence[str] = ()
) -> dict[str, dict[str, Floats | Ints]]:
    """(G,) statistics of every vertex column in each group, by column and statistic; none named: those of the report.

    A vertex counts in the group of its faces. Regions are groups of the surface that is cut along them: a vertex on a
    cut counts in each of its regions, with the value and the area that it has in that region.
    """
    plans: dict[bytes, Any] = {}
    area, segments = analysis.columns["star_area"], _referenced(groups, analysis.surface)
    by_column: dict[str, dict[str, Floats | Ints]] = {}
    for _, column, values in described(analysis):
        grouped = GroupedColumn(values, area, segments, plans=plans)
        by_column[column] = {name: grouped.statistic(name) for name in names or REPORTED}
    return by_column


def _referenced(groups: Groups, surface: Surface) -> Segments:
    """Vertices by group; a single component has no unreferenced vertices either."""
    if groups.vertices.label is not None or surface.referenced.all():
        return groups.vertices
    return Segments(np.where(surface.referenced, 0, -1).astype(np.int32), 1, surface.n_vertices)


def listed_statistics(analysis: Result, groups: Groups, names: Sequence[str] = ()) -> list[dict[str, Statistics]]:
    """The same as one dictionary per group, with None for NaN."""
    by_column = {
        column: {name: _plain(each) for name, each in statistics.items()}
        for column, statistics in grouped_statistics(analysis, groups, names).items()
    }
    return [
        {column: {name: each[g] for name, each in statistics.items()} for column, statistics in by_column.items()}
        for g in range(groups.count)
    ]


def _plain(values: Floats | Ints) -> list[Any]:
    """Numbers of Python, None for NaN and infinity."""
    return numbers_or_none(values)

"""Comparison of two vertex tables: the cells that differ beyond tolerance, column by column."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...curvatures.catalogue import load_passes
from ...curvatures.registry import passes
from ...mesh.triangles import EPSILON
from .values import DEFAULT, EVERYTHING, Difference, Tolerance, noise_of, stem

CellArray = NDArray[Any]


@dataclass(frozen=True)
class MovedColumn:
    """A column of the vertex tables with cells that differ, and the cell that moved most.

    A null against a number has `moved` null and comes before any other cell.
    """

    name: str
    rows: int
    differing: int
    vertex: int
    a: float | str | None
    b: float | str | None
    moved: float | None
    allowed: float | None


def compare_cells(
    a: Mapping[str, CellArray],
    b: Mapping[str, CellArray],
    tolerance: Tolerance = DEFAULT,
    wanted: Callable[[str], bool] = EVERYTHING,
    *,
    common: bool = False,
) -> tuple[list[MovedColumn], list[Difference], int]:
    """Columns with cells that differ, columns that one side lacks, and how many columns were compared.

    a, b: columns (n,) of numbers (NaN is null) or words (None is null) by name, equally long; column K is
    `vertices.K` for `wanted`. A cell may move by atol + rtol · max(|a|, |b|, median size of the
    column) + noise; positions are measured by the extent of the mesh.
    """
    moved: list[MovedColumn] = []
    lacking: list[Difference] = []
    compared = 0
    scale = _Scales(a, b)
    for name in dict.fromkeys([*a, *b]):
        if not wanted(f"vertices.{name}"):
            continue
        if name not in a or name not in b:
            if not common:
                status = "absent_in_b" if name in a else "absent_in_a"
                lacking.append(Difference(f"vertices.{name}", status, None, None, None, None))
            continue
        compared += 1
        cells_a, cells_b = a[name], b[name]
        if "f" not in cells_a.dtype.kind + cells_b.dtype.kind and not (_numeric(cells_a) and _numeric(cells_b)):
            column = _words(name, cells_a, cells_b)
        elif not (_numeric(cells_a) and _numeric(cells_b)):
            column = _words(name, cells_a.astype(object), cells_b.astype(object))
        else:
            numbers = scale.along(name, cells_a.astype(np.float64), cells_b.astype(np.float64))
            column = _moved(name, *numbers, scale.typical(name), scale.noise(name), tolerance)
        moved += [column] if column else []
    return moved, lacking, compared


def _numeric(column: CellArray) -> bool:
    return column.dtype.kind in "fiub"


def _words(name: str, first: CellArray, second: CellArray) -> MovedColumn | None:
    differ = np.flatnonzero(first.astype(object) != second.astype(object))
    if not len(differ):
        return None
    row = int(differ[0])
    first_text, second_text = (None if side[row] is None else str(side[row]) for side in (first, second))
    return MovedColumn(name, len(first), len(differ), row, first_text, second_text, None, None)


def _moved(name: str, first: CellArray, second: CellArray, typical: float, noise: float, tolerance: Tolerance) -> Any:
    with np.errstate(invalid="ignore", over="ignore"):
        size = np.maximum(np.maximum(np.abs(first), np.abs(second)), typical)
        allowed = tolerance.allowed(size, noise)
        gap = np.abs(first - second)
    only_one = np.isnan(first) != np.isnan(second)
    beyond = (gap > allowed) & (first != second)
    differing = int(np.count_nonzero(beyond | only_one))
    if not differing:
        return None
    lost = bool(only_one.any())
    row = int(np.argmax(only_one if lost else np.where(beyond, gap, -1.0)))
    cells = [None if math.isnan(side[row]) else float(side[row]) for side in (first, second)]
    move = (None, None) if lost else (float(gap[row]), float(allowed[row]))
    return MovedColumn(name, len(first), differing, row, *cells, *move)


class _Scales:
    """Scales for the moves of each column."""

    def __init__(self, a: Mapping[str, CellArray], b: Mapping[str, CellArray]) -> None:
        load_passes()
        self._tables = a, b
        self._stems: dict[str, list[str]] = {}
        for name in dict.fromkeys([*a, *b]):
            self._stems.setdefault(stem(name), []).append(name)
        areas = [side["A"] for side in self._tables if "A" in side and _numeric(side["A"])]
        self.edge = max((_of(np.nanmean, np.sqrt(area)) for area in areas), default=0.0)

    def typical(self, name: str) -> float:
        """Median size of the column and the other axes of its vector; the extent for positions."""
        shared = [side[axis] for axis in self._stems[stem(name)] for side in self._tables if axis in side]
        columns = [column.astype(np.float64) for column in shared if _numeric(column)]
        if stem(name) == "xyz":
            extent = max(_of(np.nanmax, column) - _of(np.nanmin, column) for column in columns)
            return min(extent, sys.float_info.max)
        return max(2 * _of(np.nanmedian, np.abs(column) / 2) for column in columns)

    def noise(self, name: str) -> float:
        """Bound on the rounding of one cell."""
        if stem(name) == "xyz":
            return 4 * EPSILON * max(_of(np.nanmax, np.abs(side[name])) for side in self._tables)
        quantity = passes.column(name)
        return noise_of(name, quantity.length_exponent, self.edge) if quantity else 0.0

    def along(self, name: str, first: CellArray, second: CellArray) -> tuple[CellArray, CellArray]:
        """Both columns, lines of b turned to point along those of a: ±d is the same line."""
        quantity, axes = passes.column(name), self._stems[stem(name)]
        if not (quantity and quantity.line) or not all(axis in side for axis in axes for side in self._tables):
            return first, second
        a, b = self._tables
        with np.errstate(invalid="ignore"):
            against = sum(a[axis] * b[axis] for axis in axes) < 0
        return first, np.where(against, -second, second)


def _of(function: Callable[[CellArray], Any], column: CellArray) -> float:
    """Statistic of the values that are not null; 0 without values."""
    known = column[~np.isnan(column)] if column.dtype.kind == "f" else column
    return float(function(known)) if len(known) else 0.0

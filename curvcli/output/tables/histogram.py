"""Table of histograms: a row for each bin, with its edges, the vertices and the area in it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...mesh.file import Labels
from ..distributions import Axis, Distribution, axis, distribution

if TYPE_CHECKING:
    from ..appearance import Appearance
    from ..distributions import ColumnSample, MeshSamples

# Parts of a histogram; a label is the part of its own row.
BELOW, INSIDE, ABOVE, UNDEFINED = "below", "bin", "above", "undefined"
_EDGES = ("low", "high", "against_low", "against_high")
_NUMBERS = ("vertices", "area", "vertex_share", "area_share")


def histogram_table(samples: MeshSamples, appearance: Appearance) -> dict[str, Any]:
    """Rows of all histograms: column, part, edges, vertices, area, and their shares of what has a value.

    part: `bin`, `below` and `above` the range (rows only where there are such values; their outer edge is the extreme),
    `undefined`, or a label. Two columns have `against`, the name of the second, and its edges; all cells within the
    ranges have a row, those beyond only where there are values, as `below` or `above` by either column. Several meshes
    have `mesh`, and common edges. The areas of all rows of a histogram and a mesh add up to the surface.
    """
    histograms = samples.histograms
    paired = any(len(columns) > 1 for columns in histograms)
    rows = [row for columns in histograms for row in _rows([axis_of(each, columns, appearance) for each in columns])]
    label_columns = ["mesh"] * samples.compared + ["column"] + ["against"] * paired + ["part"]
    table: dict[str, Any] = {name: _labels([row.get(name) for row in rows]) for name in label_columns}
    for name in (*(_EDGES if paired else _EDGES[:2]), *_NUMBERS):
        table[name] = np.array([row.get(name, np.nan) for row in rows], np.float64)
    table["vertices"] = table["vertices"].astype(np.int64)
    return table


def axis_of(samples: Sequence[ColumnSample], columns: Sequence[Sequence[ColumnSample]], appearance: Appearance) -> Axis:
    """The bins of one column of a histogram."""
    return axis(samples, appearance, paired=len(columns) > 1)


def _rows(axes: Sequence[Axis]) -> Iterator[dict[str, Any]]:
    meshes = axes[0].samples
    counts = [distribution(axes, number) for number in range(len(meshes))]
    occupied = np.sum([counted.vertices for counted in counts], axis=0) > 0
    names = {"column": axes[0].name} | ({"against": axes[1].name} if len(axes) > 1 else {})
    for mesh, counted in zip((sample.mesh for sample in meshes), counts, strict=True):
        for cell in np.ndindex(occupied.shape):
            cell_parts = [_part(column, place) for column, place in zip(axes, cell, strict=True)]
            inside = not {BELOW, ABOVE}.intersection(cell_parts)
            if inside or occupied[cell]:
                part = next((part for part in cell_parts if part in (BELOW, ABOVE)), cell_parts[0])
                yield {"mesh": mesh, **names, "part": part, **_edges_of(axes, cell), **_counts(counted, cell)}
        vertices, area = counted.undefined
        yield {"mesh": mesh, **names, "part": UNDEFINED, "vertices": vertices, "area": area}


def _part(column: Axis, place: int) -> str:
    if place in (0, column.bins + 1):
        return BELOW if place == 0 else ABOVE
    return column.quantity.labels[place - 1] if column.quantity.labels else INSIDE


def _edges_of(axes: Sequence[Axis], cell: Sequence[int]) -> dict[str, float]:
    edges: dict[str, float] = {}
    for low, high, column, place in zip(_EDGES[::2], _EDGES[1::2], axes, cell, strict=False):
        if len(column.edges):
            ends = np.concatenate([[column.least], column.edges, [column.most]])
            edges |= {low: float(ends[place]), high: float(ends[place + 1])}
    return edges


def _counts(counted: Distribution, cell: tuple[int, ...]) -> dict[str, float]:
    shares = counted.shares
    values = (counted.vertices[cell], counted.area[cell], shares[0][cell], shares[1][cell])
    return {name: float(value) for name, value in zip(_NUMBERS, values, strict=True)}


def _labels(texts: Sequence[str | None]) -> Labels:
    names = tuple(dict.fromkeys(text for text in texts if text is not None))
    number = {name: code for code, name in enumerate(names)}
    return Labels(np.array([-1 if text is None else number[text] for text in texts], np.int32), names)

"""Edges of a page in the colours of one of their columns, and vertex columns that are painted in cells."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...analysis.scale_notices import STARS
from ..coloring import along_edges, colored
from ..pictures.legend import Colored
from .display import Display

if TYPE_CHECKING:
    from ...analysis.result import Result
    from ..appearance import Appearance

# Number of colours of lines; and the most faces drawn with cells: a browser stores seven triangles for each.
_SHADES, _MOST_FACES = 31, 100_000


@dataclass(frozen=True)
class Bend:
    """Edges with their colours: pairs (k, 2) of shown vertices by shade; the bytes and the count of each shade."""

    painted: Colored
    unit: str
    pairs: NDArray[np.int32]
    shades: list[tuple[tuple[int, int, int], int]]


def bend(analysis: Result, appearance: Appearance, asked: tuple[str, ...], display: Display) -> Bend | None:
    """First column of edges asked for, on the edges whose two ends are shown; None without one.

    Undefined edges and those with the colour of 0 are left out.
    """
    names = along_edges()
    name = next((name for name in asked if name in names), None)
    if name is None:
        return None
    column = colored(analysis, name, appearance)
    low, high = column.scale.low, column.scale.high
    edges, place = analysis.surface.edges, np.full(analysis.surface.n_vertices, -1, np.int32)
    place[display.vertices] = np.arange(len(display.vertices), dtype=np.int32)
    ends = np.stack([place[edges.a], place[edges.b]], axis=1)
    values = column.scale.settled(analysis.edges[name].astype(np.float64))
    shown = (ends >= 0).all(axis=1) & np.isfinite(values) & (values != 0)
    shades: list[tuple[tuple[int, int, int], int]] = []
    order = np.empty(0, np.intp)
    if low is not None and high is not None and high > low:
        share = np.clip((values / 2 - low / 2) / (high / 2 - low / 2), 0, 1)
        shade = np.rint(np.nan_to_num(share) * (_SHADES - 1)).astype(np.intp)
        if column.scale.signed:
            shown &= shade != _SHADES // 2
        chosen = np.flatnonzero(shown)
        order = chosen[np.argsort(shade[chosen], kind="stable")]
        for number, count in enumerate(np.bincount(shade[chosen], minlength=_SHADES).tolist()):
            red, green, blue = column.scale.gradient[
                round(number / (_SHADES - 1) * (len(column.scale.gradient) - 1))
            ].tolist()
            if count:
                shades.append(((red, green, blue), count))
    return Bend(column, column.unit(analysis.conventions.unit), ends[order].astype(np.int32), shades)


def in_cells(analysis: Result, display: Display) -> bool:
    """True if densities of stars are painted in the cells of their vertices: on creased meshes that are shown whole."""
    few = display.whole and len(display.faces) <= _MOST_FACES
    return few and any(notice.code == "creased" for notice in analysis.notices)


def cell(column: Colored) -> bool:
    """True if a column is a density of stars that has colours."""
    return column.quantity.name in STARS and column.scale.low is not None

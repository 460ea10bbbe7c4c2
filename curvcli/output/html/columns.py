"""Columns of a page: values, colours and histograms."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...mesh.file import Labels
from ..coloring import colored
from ..pictures.colors import ColorScale
from ..pictures.legend import Colored
from ..tables.columns import vertex_table

if TYPE_CHECKING:
    from ...analysis.result import Result
    from ..appearance import Appearance

_BINS = 60
# Codes of values without a colour of their own.
_PLAIN = ("vertex", "x", "y", "z", "status", "welded_to")


@dataclass(frozen=True)
class Bar:
    """Bar of a histogram in hundredths of its width and height, and its colour."""

    left: float
    width: float
    height: float
    color: str


@dataclass(frozen=True)
class PageColumn:
    """Column with a value per vertex of the file, NaN where undefined, and its colours."""

    painted: Colored
    unit: str
    values: NDArray[np.float64]
    bars: list[Bar]
    most: int

    @property
    def name(self) -> str:
        """Name of the column in the table."""
        return self.painted.name

    @property
    def scale(self) -> ColorScale:
        """Colours of the column."""
        return self.painted.scale

    @property
    def middle(self) -> float | None:
        """Value in the middle of the colours."""
        low, high = self.scale.low, self.scale.high
        return None if low is None or high is None else low / 2 + high / 2


def columns(analysis: Result, appearance: Appearance, asked: tuple[str, ...]) -> list[PageColumn]:
    """Every numeric column of the vertex table, in its order.

    asked: the columns that `--range LO:HI` applies to; a percentage applies to all.
    """
    referenced = analysis.surface.referenced
    own_range = replace(appearance, value_range=None)
    shared = appearance.value_range is not None and ":" not in appearance.value_range
    page_columns = []
    for name, given in vertex_table(analysis).items():
        if name in _PLAIN or isinstance(given, Labels):
            continue
        values = np.where(referenced & ~np.ma.getmaskarray(given), np.ma.getdata(given), np.nan).astype(np.float64)
        painted = colored(analysis, name, appearance if shared or name in asked else own_range)
        bars, most = histogram(painted.scale.settled(values)[referenced], painted.scale)
        page_columns.append(PageColumn(painted, painted.unit(analysis.conventions.unit), values, bars, most))
    return page_columns


def histogram(values: NDArray[np.float64], scale: ColorScale) -> tuple[list[Bar], int]:
    """Bars over the colours, one at each side for values beyond the range; and the count of the tallest bar."""
    low, high = scale.low, scale.high
    if low is None or high is None:
        return [], 0
    inside = values[(values >= low) & (values <= high)]
    half = high / 2 - low / 2
    place = np.full(len(inside), 0.5) if half == 0 else np.clip((inside / 2 - low / 2) / half, 0, 1)
    counts = np.bincount((place * _BINS).astype(np.int64).clip(0, _BINS - 1), minlength=_BINS)
    below, above = int((values < low).sum()), int((values > high).sum())
    most = max(int(counts.max()), below, above, 1)
    steps = len(scale.gradient) - 1
    # Room for the bars of values beyond the range: 3 % and a gap of 1 % at either side.
    wide = 92 / _BINS
    bars = [Bar(0, 3, 100 * below / most, hex_color(scale.gradient[0]))] if below else []
    for k in np.flatnonzero(counts).tolist():
        color = hex_color(scale.gradient[round((k + 0.5) / _BINS * steps)])
        bars.append(Bar(round(4 + k * wide, 3), round(wide, 3), 100 * int(counts[k]) / most, color))
    if above:
        bars.append(Bar(97, 3, 100 * above / most, hex_color(scale.gradient[-1])))
    return bars, most


def hex_color(rgb: Any) -> str:
    """Colour as #rrggbb."""
    return "#" + "".join(f"{int(part):02x}" for part in rgb)

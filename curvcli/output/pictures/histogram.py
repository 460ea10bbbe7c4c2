"""Histograms of columns, by number of vertices and by area."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from .legend import Colored, about, mesh_name, sentence, ticks
from .options import PictureOptions, arrange
from .panels import draw_title, legend
from .sheet import LINE, Box, LegendEntry, Sheet

if TYPE_CHECKING:
    from ...analysis.result import Result

Shares = NDArray[np.float64]

_PANEL, _SINGLE = (560, 420), (900, 640)
_FEWEST, _MOST = 10, 60


@dataclass(frozen=True)
class Distribution:
    """Shares of the defined values in bins of equal width from `low` to `high`, by number and by area.

    edges: (n + 1,). vertices, area: (n + 2,), the first and the last for values below and above.
    """

    edges: NDArray[np.float64]
    vertices: Shares
    area: Shares


def distribution(
    values: NDArray[np.float64], areas: NDArray[np.float64], low: float, high: float, bins: int | None = None
) -> Distribution:
    """Distribution of the defined values; a single value has one bin. Areas are weights; NaN is left out."""
    defined = np.isfinite(values)
    values, areas = values[defined], np.nan_to_num(areas[defined])
    if bins is None:
        bins = int(np.clip(2 * round(len(values) ** (1 / 3)), _FEWEST, _MOST)) if high > low else 1
    edges = low + (high / 2 - low / 2) * np.linspace(0.0, 2.0, bins + 1)
    edges[-1] = high
    place = np.searchsorted(edges[1:-1], values, side="right") + 1
    place[values < low] = 0
    place[values > high] = bins + 1
    counts, weights = (np.bincount(place, weight, bins + 2) for weight in (None, areas))
    return Distribution(edges, counts / max(1, len(values)), weights / (weights.sum() or 1.0))


def write_histograms(
    stream: BinaryIO,
    analysis: Result,
    columns: Sequence[Colored],
    options: PictureOptions,
    value_range: str | None,
    suffix: str = ".png",
) -> None:
    """Write a panel per column: bars are shares of the vertices, the line shares of their area.

    The range and the colours are those of the colour map; values beyond it are in a pale bar at each end.
    Each vertex has the weight of its star's area. Labels have a bar each.
    """
    count = max(1, len(columns))
    across, down, size = arrange(count, options.size, _SINGLE if count == 1 else _PANEL)
    sheet = Sheet(size, options.background, suffix)
    font = sheet.font(1.3 * size[0] / across, 1.3 * size[1] / down)
    small, margin = max(0.85 * font, 8.0), round(0.8 * font)
    keys = [LegendEntry("bars: share of the vertices"), LegendEntry("share of the area", "line", sheet.ink)]
    if any(column.scale.clipped_below or column.scale.clipped_above for column in columns):
        keys.append(LegendEntry("beyond the range", "square", sheet.pale))
    about_lines = about(analysis, columns)
    footer = sheet.flow([*keys, *map(LegendEntry, about_lines)], size[0] - 2 * margin, small)
    foot = len(footer) * LINE * small + margin
    width, height = size[0] / across, (size[1] - foot) / down
    legends = [sheet.flow(legend(column, value_range), width - 2 * margin, small) for column in columns]
    below = max(map(len, legends), default=0) * LINE * small
    areas = np.asarray(analysis.columns["star_area"], np.float64)
    for place, column in enumerate(columns):
        left, top = place % across * width + margin, place // across * height
        room = width - 2 * margin
        draw_title(sheet, column, analysis.conventions.unit, (left, top + 1.2 * font), font, room)
        tall = height - below - 5.0 * font
        box = (left + 3.2 * font, top + 2.3 * font, room - 3.6 * font, max(tall, 10.0))
        if column.scale.categories:
            _labels(sheet, column, areas, analysis, box, font)
        elif column.scale.low is not None:
            _numbers(sheet, column, areas, analysis, box, font)
        sheet.draw(legends[place], left, top + height - below - 0.2 * font, small)
    sheet.draw(footer, margin, size[1] - len(footer) * LINE * small - 0.5 * margin, small)
    sentences = [sentence(column, value_range, analysis.conventions.unit) for column in columns]
    stream.write(sheet.content(f"{mesh_name(analysis)}: histograms", "\n".join(sentences)))


def _numbers(sheet: Sheet, column: Colored, areas: Shares, analysis: Result, box: Box, font: float) -> None:
    scale = column.scale
    assert scale.low is not None
    assert scale.high is not None
    values = np.where(analysis.surface.referenced, analysis.vertices[column.name].astype(np.float64), np.nan)
    low, high, bins = scale.low, scale.high, None
    values = scale.settled(values)
    if column.quantity.kind == "count" and high - low < _MOST:
        # Each number has a bin with the number in the middle.
        low, high = math.floor(low) - 0.5, math.ceil(high) + 0.5
        bins = round(high - low)
    shares = distribution(values, areas, low, high, bins)
    bins = len(shares.edges) - 1
    axes = sheet.axes(box)
    # Positions in bins, since differences of values may overflow; values beyond the range are outside.
    at = np.array([-1.0, *range(bins), bins + 0.5])
    middle = np.rint((np.arange(bins) + 0.5) / bins * (len(scale.gradient) - 1)).astype(int)
    colors = [sheet.pale, *(scale.gradient[middle] / 255), sheet.pale]
    axes.bar(
        at + 0.25 * (at < 0),
        shares.vertices,
        1.0,
        align="edge",
        color=colors,
        edgecolor=sheet.pale,
        linewidth=0.02 * font,
    )
    axes.stairs(shares.area[1:-1], range(bins + 1), color=sheet.ink, linewidth=0.1 * font)
    for edge, share in ((-0.75, shares.area[0]), (bins + 0.5, shares.area[-1])):
        if share:
            axes.hlines(share, edge, edge + 1.0, color=sheet.ink, linewidth=0.1 * font)
    axes.set_xlim(-1.0, bins + 1.75)
    room = max(2, int(box[2] / (4.5 * font)))
    positions, labels, _ = ticks(scale.low, scale.high, room, whole=column.quantity.kind == "count")
    half = high / 2 - low / 2
    axes.set_xticks([bins * (place / 2 - low / 2) / half for place in positions] if half > 0 else [0.5], labels)
    _finish(sheet, axes, box[3], font)


def _labels(sheet: Sheet, column: Colored, areas: Shares, analysis: Result, box: Box, font: float) -> None:
    codes = analysis.columns[column.name]
    axes = sheet.axes(box)
    total, weight = len(codes), float(areas.sum()) or 1.0
    for place, category in enumerate(column.scale.categories):
        mine = codes == column.quantity.labels.index(category.name)
        color = np.array(category.color) / 255
        axes.bar(place, category.count / total, 0.8, color=color)
        axes.hlines(float(areas[mine].sum()) / weight, place - 0.4, place + 0.4, color=sheet.ink, linewidth=0.1 * font)
    axes.set_xlim(-0.8, max(4, len(column.scale.categories)) - 0.2)
    axes.set_xticks([])
    _finish(sheet, axes, box[3], font)


def _finish(sheet: Sheet, axes: Any, tall: float, font: float) -> None:
    """Format the axes: shares in per cent, few ticks, thin lines."""
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    axes.set_facecolor("none")
    axes.yaxis.set_major_locator(MaxNLocator(min(4, max(1, int(tall / (2.5 * font))))))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda share, _: f"{100 * share:g} %"))
    axes.set_ylim(bottom=0)
    axes.tick_params(
        colors=sheet.pale,
        labelsize=0.8 * font * 0.72,
        labelfontfamily="DejaVu Sans",
        length=0.25 * font,
        width=0.05 * font,
        pad=0.2 * font,
    )
    for side, spine in axes.spines.items():
        spine.set_visible(side in ("left", "bottom"))
        spine.set_color(sheet.pale)
        spine.set_linewidth(0.05 * font)

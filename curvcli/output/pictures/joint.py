"""Histogram of two columns against each other: cells in the colour of their share of the area."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...support.words import typeset_number
from ..distributions import Axis, distribution
from .colors import SEQUENTIAL, color_map
from .legend import ticks
from .panels import finish_axes
from .sheet import Box, Sheet

if TYPE_CHECKING:
    from ..appearance import Appearance


def draw_joint(sheet: Sheet, axes: Sequence[Axis], number: int, box: Box, font: float, appearance: Appearance) -> None:
    """Draw one mesh: the first column to the right, the second one upwards, a bar of the colours at the right.

    The colours are logarithmic, from the smallest to the largest share of a cell in any mesh; empty cells have none.
    Values beyond the ranges are in cells of half the size around.
    """
    from matplotlib.colors import ListedColormap, LogNorm

    if not all(axis.bins for axis in axes):
        return
    meshes = range(len(axes[0].samples))
    each = [distribution(axes, place).shares[1] for place in meshes]
    filled = np.concatenate([shares[shares > 0] for shares in each])
    if not len(filled):
        return
    low, high = float(filled.min()), float(filled.max())
    left, top, width, height = box
    bar = 5.2 * font
    plot = sheet.axes((left, top, width - bar, height))
    colors = ListedColormap(color_map(appearance.cmap or SEQUENTIAL) / 255.0)
    norm = LogNorm(low, high if high > low else low * 1.001)
    edges = [np.array([-0.75, *range(axis.bins + 1), axis.bins + 0.75]) for axis in axes]
    cells = each[number].T
    plot.pcolormesh(*edges, np.ma.masked_where(cells <= 0, cells), cmap=colors, norm=norm, rasterized=False)
    for axis, set_ticks, long in ((axes[0], plot.set_xticks, width - bar), (axes[1], plot.set_yticks, height)):
        positions, labels = _ticks(axis, max(2, int(long / (4.5 * font))))
        set_ticks(positions, labels)
    finish_axes(sheet, plot, height, font, percent=False)
    key = sheet.axes((left + width - bar + 0.9 * font, top, 0.8 * font, height))
    key.imshow(colors(np.linspace(1, 0, 256))[:, None], aspect="auto", extent=(0, 1, 0, 1), interpolation="nearest")
    key.set_xticks([])
    key.yaxis.tick_right()
    key.set_yticks([0, 0.5, 1], [f"{typeset_number(100 * share, 2)} %" for share in (low, (low * high) ** 0.5, high)])
    finish_axes(sheet, key, height, font, percent=False)


def _ticks(axis: Axis, room: int) -> tuple[list[float], list[str]]:
    """Positions in bins, and labels."""
    low, high = float(axis.edges[0]), float(axis.edges[-1])
    tick_values, labels, _ = ticks(low, high, room)
    half = high / 2 - low / 2
    return ([axis.bins * (value / 2 - low / 2) / half for value in tick_values] if half > 0 else [0.5]), labels

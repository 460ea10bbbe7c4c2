"""Title, colour bar and legend of the panels of pictures and histograms."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...support.words import format_exponent
from .legend import Colored, range_text, ticks
from .render import Color
from .sheet import Box, LegendEntry, Sheet


def draw_title(
    sheet: Sheet,
    columns: Sequence[Colored],
    length: str | None,
    place: tuple[float, float],
    font: float,
    room: float,
) -> None:
    """Draw names, symbols and units of a column, or of two with their directions; a unit has the power of its ticks."""
    texts: list[tuple[str, bool]] = []
    for column in columns:
        scale = column.scale
        power = ticks(scale.low, scale.high, 5)[2] if scale.low is not None and scale.high is not None else 0
        unit = " ".join(part for part in (f"10{format_exponent(power)}" if power else "", column.unit(length)) if part)
        rest = "  ".join(part for part in (column.symbol, f"[{unit}]" if unit else "") if part)
        texts += [(column.name, True), (rest, False)]
        if len(columns) > 1:
            texts.append(("upwards" if column is columns[-1] else "to the right,", False))
    gap = 0.8 * font
    widths = [sheet.measure(text, font, bold) for text, bold in texts]
    size = font * min(1.0, room / (sum(widths) + gap * (len(texts) - 1)))
    left = place[0]
    for (text, bold), width in zip(texts, widths, strict=True):
        sheet.text(left, place[1], text, size, bold=bold)
        left += (width + gap) * size / font


def finish_axes(sheet: Sheet, axes: Any, tall: float, font: float, percent: bool = True) -> None:
    """Format axes: few ticks, thin lines; percent: shares upwards, in per cent from 0."""
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    axes.set_facecolor("none")
    if percent:
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


def draw_bar(sheet: Sheet, column: Colored, box: Box, font: float) -> None:
    """Draw the colour bar with its ticks; a pointed end marks values beyond it."""
    scale, (left, top, width, height) = column.scale, box
    assert scale.low is not None
    assert scale.high is not None
    axes = sheet.axes(box)
    spread = scale.high / 2 - scale.low / 2 > 0
    colors = scale.gradient if spread else scale.gradient[len(scale.gradient) // 2][None]
    axes.imshow(colors[None], aspect="auto", extent=(0, 1, 0, 1), interpolation="nearest")
    positions, labels, _ = ticks(scale.low, scale.high, max(2, int(width / (4.5 * font))))
    at = [(place / 2 - scale.low / 2) / (scale.high / 2 - scale.low / 2) for place in positions] if spread else [0.5]
    axes.set_yticks([])
    axes.set_xticks(at, labels, fontsize=0.85 * font * 0.72, color=sheet.pale, family="DejaVu Sans")
    axes.tick_params(length=0.3 * font * 0.72, width=0.06 * font, color=sheet.pale, pad=0.2 * font * 0.72)
    axes.set_xlim(0, 1)
    for spine in axes.spines.values():
        spine.set_visible(False)
    for cut, end, side, color in (
        (scale.clipped_below, left, -1, scale.gradient[0]),
        (scale.clipped_above, left + width, 1, scale.gradient[-1]),
    ):
        if cut:
            tip = np.array([[end, top], [end, top + height], [end + side * 0.9 * height, top + height / 2]])
            red, green, blue = color.tolist()
            sheet.triangle(tip, shares((red, green, blue)))


def legend(column: Colored, value_range: str | None) -> list[LegendEntry]:
    """Entries of the legend: range and values outside it, undefined vertices, or labels."""
    scale = column.scale
    if scale.categories:
        return [LegendEntry(f"{c.name} {c.count:,}", "square", shares(c.color)) for c in scale.categories]
    items = [LegendEntry(range_text(scale, value_range))]
    if scale.nulls:
        items.append(LegendEntry(f"undefined {scale.nulls:,}", "square", shares(scale.undefined)))
    return items


def shares(color: tuple[int, int, int]) -> Color:
    """Colour from bytes to 0 … 1."""
    return color[0] / 255, color[1] / 255, color[2] / 255

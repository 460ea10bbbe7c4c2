"""Plot of numbers over the meshes of a batch: a panel per key, a line per number that matches it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import BinaryIO

import numpy as np

from ...support.arrays import Floats
from ...support.words import counted, format_exponent
from .colors import color_map
from .legend import ticks
from .panels import finish_axes, shares
from .sheet import LINE, LegendEntry, Sheet

_WIDTH, _PANEL, _FONT, _MARGIN = 1000, 260, 15.0, 14.0
_COLORS, _LINES = "tol:muted", 9
# Longer series have no marks.
_MARKED = 80


def write_series(
    stream: BinaryIO, panels: Mapping[str, Mapping[str, Floats]], names: Sequence[str], suffix: str
) -> None:
    """Draw the panels below each other.

    panels: for each key its lines by name, (n,) with NaN where a mesh has no value: the line has a gap there. names: of
    the n meshes, numbered from 0 in the order of the summary.
    """
    small_font = 0.85 * _FONT
    sheet = Sheet((_WIDTH, 200), "white", suffix)
    footers = sheet.flow(_footer(names), _WIDTH - 2 * _MARGIN, small_font)
    legends = [sheet.flow(_legend(lines, len(names)), _WIDTH - 2 * _MARGIN, small_font) for lines in panels.values()]
    heights = [_PANEL + len(legend) * LINE * small_font for legend in legends]
    height = round(sum(heights) + len(footers) * LINE * small_font + _MARGIN)
    sheet = Sheet((_WIDTH, height), "white", suffix)
    top = 0.0
    for (key, lines), legend, tall in zip(panels.items(), legends, heights, strict=True):
        _panel(sheet, key, lines, len(names), top)
        sheet.draw(legend, _MARGIN, top + _PANEL, small_font)
        top += tall
    sheet.draw(footers, _MARGIN, top, small_font)
    stream.write(sheet.content(", ".join(panels), f"{counted(len(names), 'mesh', 'meshes')} in order"))


def _panel(sheet: Sheet, key: str, lines: Mapping[str, Floats], count: int, top: float) -> None:
    box = (_MARGIN + 4.2 * _FONT, top + 2.4 * _FONT, _WIDTH - 2 * _MARGIN - 4.6 * _FONT, _PANEL - 4.6 * _FONT)
    axes = sheet.axes(box)
    drawn = list(lines.values())[:_LINES]
    marker = "o" if count <= _MARKED else None
    known = np.concatenate([values[np.isfinite(values)] for values in drawn])
    tick_values, labels, power = ticks(float(known.min()), float(known.max()), 5)
    # In units of a power of two near the largest value, so that neither margins nor distances overflow.
    unit = float(np.ldexp(1.0, max(int(np.frexp(np.abs(known).max())[1]) - 1, -1000)))
    for values, color in zip(drawn, _colors(len(lines)), strict=False):
        axes.plot(np.arange(count), values / unit, color=color, linewidth=1.4, marker=marker, markersize=3.5)
    low, high = float(known.min()) / unit, float(known.max()) / unit
    room = 0.05 * (high - low) or 0.05
    axes.set_ylim(low - room, high + room)
    axes.set_yticks([tick / unit for tick in tick_values], labels)
    positions, numbers, _ = ticks(0, max(count - 1, 1), 9, whole=True)
    axes.set_xlim(-0.02 * max(count - 1, 1), 1.02 * max(count - 1, 1))
    axes.set_xticks(positions, numbers)
    finish_axes(sheet, axes, box[3], _FONT, percent=False)
    title = key + (f"  [10{format_exponent(power)}]" if power else "")
    size = min(_FONT, _FONT * (_WIDTH - 2 * _MARGIN) / max(sheet.measure(title, _FONT, bold=True), 1.0))
    sheet.text(_MARGIN, top + 1.2 * _FONT, title, size, bold=True)


def _colors(count: int) -> list[tuple[float, float, float]]:
    rows = color_map(_COLORS, _LINES).tolist()[: min(count, _LINES)]
    return [shares((red, green, blue)) for red, green, blue in rows]


def _legend(lines: Mapping[str, Floats], count: int) -> list[LegendEntry]:
    entries = []
    if len(lines) > 1:
        entries += [LegendEntry(name, "line", color) for name, color in zip(lines, _colors(len(lines)), strict=False)]
    if len(lines) > _LINES:
        entries.append(LegendEntry(f"{len(lines) - _LINES:,} more are not drawn"))
    missing = sum(int(np.isnan(values).sum()) for values in list(lines.values())[:_LINES])
    return entries + [LegendEntry(f"{counted(missing, 'value')} missing")] * bool(missing)


def _footer(names: Sequence[str]) -> list[LegendEntry]:
    ends = f": {names[0]} … {names[-1]}" if len(names) > 1 else f": {names[0]}"
    return [LegendEntry(f"{counted(len(names), 'mesh', 'meshes')} in the order of summary.csv{ends}")]

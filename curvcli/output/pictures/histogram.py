"""Histograms of columns, by number of vertices and by area: of one mesh, of several in one picture, of two columns."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, BinaryIO

import numpy as np

from ..distributions import Axis, distribution
from ..tables.histogram import axis_of
from .colors import color_map
from .joint import draw_joint
from .legend import Colored, sentence, ticks
from .options import arrange
from .panels import draw_title, finish_axes, legend, shares
from .render import Color
from .sheet import LINE, Box, LegendEntry, Sheet

if TYPE_CHECKING:
    from ..appearance import Appearance
    from ..distributions import MeshSamples

_PANEL, _SINGLE = (560, 420), (900, 640)
# Meshes in one picture: each has a colour of its own.
MOST_MESHES = 9
_LINES = "tol:muted"


def write_histograms(
    stream: BinaryIO,
    samples: MeshSamples,
    appearance: Appearance,
    suffix: str = ".png",
) -> list[str]:
    """Write a panel per histogram; returns a line per column, with its range.

    One mesh: bars are shares of the vertices, the line shares of their area; labels have a bar each. Several
    meshes: a line for the shares of the area of each. Two columns: cells in the colour of their share of the area, a
    panel for each mesh. Range and colours are those of the colour map, common to all meshes; values beyond it are in a
    pale bar at each end. Each vertex has the weight of its star's area.
    """
    axes = [[axis_of(each, columns, appearance) for each in columns] for columns in samples.histograms]
    meshes, unit = samples.meshes, samples.unit
    panels = [(each, number) for each in axes for number in range(len(meshes) if len(each) > 1 else 1)]
    count = max(1, len(panels))
    options = appearance.picture
    across, down, size = arrange(count, options.size, _SINGLE if count == 1 else _PANEL)
    sheet = Sheet(size, options.background, suffix)
    font = sheet.font(1.3 * size[0] / across, 1.3 * size[1] / down)
    small, margin = max(0.85 * font, 8.0), round(0.8 * font)
    footer = sheet.flow(_footer(sheet, axes, meshes, samples.texts), size[0] - 2 * margin, small)
    foot = len(footer) * LINE * small + margin
    width, height = size[0] / across, (size[1] - foot) / down
    entries = [_entries(each, meshes, number, appearance) for each, number in panels]
    legends = [sheet.flow(panel, width - 2 * margin, small) for panel in entries]
    below = max(map(len, legends), default=0) * LINE * small
    for place, (each, number) in enumerate(panels):
        row, column = divmod(place, across)
        left, top = column * width + margin, row * height
        room = width - 2 * margin
        draw_title(sheet, [_colored(axis) for axis in each], unit, (left, top + 1.2 * font), font, room)
        tall = height - below - 5.0 * font
        box = (left + 3.2 * font, top + 2.3 * font, room - 3.6 * font, max(tall, 10.0))
        if len(each) > 1:
            draw_joint(sheet, each, number, box, font, appearance)
        elif each[0].quantity.labels:
            _labels(sheet, each[0], box, font)
        elif each[0].bins:
            _numbers(sheet, each[0], box, font)
        sheet.draw(legends[place], left, top + height - below - 0.2 * font, small)
    sheet.draw(footer, margin, size[1] - len(footer) * LINE * small - 0.5 * margin, small)
    columns = {axis.name: axis for each in axes for axis in each}
    sentences = [sentence(_colored(axis), appearance.range_rule, unit) for axis in columns.values()]
    name = meshes[0] if len(meshes) == 1 else f"{len(meshes)} meshes"
    stream.write(sheet.content(f"{name}: histograms", "\n".join(sentences)))
    return sentences


def _colored(axis: Axis) -> Colored:
    return Colored(axis.name, axis.quantity, axis.scale, axis.samples[0].energy)


def _colors(meshes: Sequence[str]) -> list[Color]:
    red_green_blue = color_map(_LINES, MOST_MESHES).tolist()
    return [shares((red, green, blue)) for red, green, blue in red_green_blue[: len(meshes)]]


def _footer(
    sheet: Sheet, axes: Sequence[Sequence[Axis]], meshes: Sequence[str], texts: Sequence[str]
) -> list[LegendEntry]:
    single = [each[0] for each in axes if len(each) == 1]
    entries = []
    if single and len(meshes) > 1:
        entries += [LegendEntry("share of the area:")]
        entries += [LegendEntry(name, "line", color) for name, color in zip(meshes, _colors(meshes), strict=True)]
    elif single:
        entries += [LegendEntry("bars: share of the vertices"), LegendEntry("share of the area", "line", sheet.ink)]
        if any(axis.scale.clipped_below or axis.scale.clipped_above for axis in single):
            entries.append(LegendEntry("beyond the range", "square", sheet.pale))
    return [*entries, *map(LegendEntry, texts)]


def _entries(axes: Sequence[Axis], meshes: Sequence[str], number: int, appearance: Appearance) -> list[LegendEntry]:
    """Legend of a panel."""
    entries = [legend(_colored(axis), appearance.range_rule) for axis in axes]
    if len(axes) == 1:
        # Beside lines in the colours of the meshes, labels have no colours.
        return [LegendEntry(entry.text) for entry in entries[0]] if len(meshes) > 1 else entries[0]
    named = [
        [LegendEntry(f"{axis.name}: {first.text}", first.mark, first.color), *rest]
        for axis, (first, *rest) in zip(axes, entries, strict=True)
    ]
    mesh = [LegendEntry(meshes[number])] if len(meshes) > 1 else []
    return [*mesh, *(entry for listed in named for entry in listed)]


def _numbers(sheet: Sheet, axis: Axis, box: Box, font: float) -> None:
    """Bars of one mesh, or a line for each of several."""
    scale, bins = axis.scale, axis.bins
    axes = sheet.axes(box)
    several = len(axis.samples) > 1
    # Positions in bins, since differences of values may overflow; values beyond the range are outside.
    at = np.array([-1.0, *range(bins), bins + 0.5])
    middle = np.rint((np.arange(bins) + 0.5) / bins * (len(scale.gradient) - 1)).astype(int)
    colors = [sheet.pale, *(scale.gradient[middle] / 255), sheet.pale]
    lines = _colors([sample.mesh for sample in axis.samples]) if several else [sheet.ink]
    for number, color in enumerate(lines):
        by_number, by_area = distribution([axis], number).shares
        if not several:
            axes.bar(
                at + 0.25 * (at < 0),
                by_number,
                1.0,
                align="edge",
                color=colors,
                edgecolor=sheet.pale,
                linewidth=0.02 * font,
            )
        axes.stairs(by_area[1:-1], range(bins + 1), color=color, linewidth=(0.16 if several else 0.1) * font)
        for edge, share in ((-0.75, by_area[0]), (bins + 0.5, by_area[-1])):
            if share:
                axes.hlines(share, edge, edge + 1.0, color=color, linewidth=(0.16 if several else 0.1) * font)
    axes.set_xlim(-1.0, bins + 1.75)
    room = max(2, int(box[2] / (4.5 * font)))
    low, high = float(axis.edges[0]), float(axis.edges[-1])
    assert scale.low is not None
    assert scale.high is not None
    tick_values, labels, _ = ticks(scale.low, scale.high, room, whole=axis.quantity.kind == "count")
    half = high / 2 - low / 2
    axes.set_xticks([bins * (value / 2 - low / 2) / half for value in tick_values] if half > 0 else [0.5], labels)
    finish_axes(sheet, axes, box[3], font)


def _labels(sheet: Sheet, axis: Axis, box: Box, font: float) -> None:
    """A bar for each label of one mesh, or one for each of several meshes beside each other."""
    axes = sheet.axes(box)
    several = len(axis.samples) > 1
    wide = 0.8 / len(axis.samples)
    lines = _colors([sample.mesh for sample in axis.samples])
    categories = axis.scale.categories
    for number, color in enumerate(lines):
        by_number, by_area = distribution([axis], number).shares
        for place, category in enumerate(categories):
            code = 1 + axis.quantity.labels.index(category.name)
            middle = place - 0.4 + (number + 0.5) * wide
            if several:
                axes.bar(middle, by_area[code], wide, color=color)
                continue
            axes.bar(place, by_number[code], 0.8, color=shares(category.color))
            axes.hlines(by_area[code], place - 0.4, place + 0.4, color=sheet.ink, linewidth=0.1 * font)
    axes.set_xlim(-0.8, max(4, len(categories)) - 0.2)
    axes.set_xticks([])
    if several:
        axes.set_xticks(range(len(categories)), [category.name for category in categories])
    finish_axes(sheet, axes, box[3], font)

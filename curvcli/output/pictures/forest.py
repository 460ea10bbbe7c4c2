"""Plot of the differences of two groups: one line per number, with its confidence interval."""

from __future__ import annotations

from typing import TYPE_CHECKING, BinaryIO

import numpy as np

from .panels import finish_axes
from .sheet import LINE, LegendEntry, Sheet

if TYPE_CHECKING:
    from ...report.groups.model import GroupComparison, GroupDifference

_WIDTH, _ROW, _FONT = 1000, 26, 15.0
# Numbers in one plot: those with the smallest q.
_MOST = 60
# Ends of the axis, in pooled standard deviations.
_FARTHEST = 20.0
_SIGNIFICANT = (0.8, 0.2, 0.07)


def write_forest(stream: BinaryIO, report: GroupComparison, suffix: str) -> None:
    """Draw B − A of every tested number in units of its pooled standard deviation, the smallest q first.

    The bars are the confidence intervals of the difference, divided by the same deviation. Significant differences are
    red and filled, others are open.
    """
    tested = sorted(
        (row for row in report.differences if row.hedges_g is not None), key=lambda row: (row.q or 0.0, row.p or 0.0)
    )
    rows = tested[:_MOST][::-1]
    margin = 12.0
    small_font = 0.85 * _FONT
    sheet = Sheet((_WIDTH, 200), "white", suffix)
    footer = sheet.flow(_footer(report, sheet, len(tested)), _WIDTH - 2 * margin, small_font)
    foot = (len(footer) + 0.5) * LINE * small_font
    tall = _ROW * max(1, len(rows))
    height = round(4.2 * _FONT + tall + 2.6 * _FONT + foot)
    sheet = Sheet((_WIDTH, height), "white", suffix)
    title = f"{report.group_b.path} − {report.group_a.path}"
    sheet.text(margin, 1.3 * _FONT, title, min(_FONT, _FONT * (_WIDTH - 2 * margin) / sheet.measure(title, _FONT)))
    names = [sheet.measure(row.key, small_font) for row in rows]
    longest = 0.5 * _WIDTH
    left = margin + min(longest, max(names, default=0.0)) + 12
    axes = sheet.axes((left, 2.6 * _FONT, _WIDTH - left - 2 * margin, tall))
    for place, row in enumerate(rows):
        low, middle, high = _standardised(row)
        color = _SIGNIFICANT if row.significant else sheet.pale
        axes.plot(np.clip([low, high], -_FARTHEST, _FARTHEST), [place, place], color=color, linewidth=1.2)
        inside = color if row.significant else "white"
        mark = "o" if abs(middle) <= _FARTHEST else ">" if middle > 0 else "<"
        estimate = min(max(middle, -_FARTHEST), _FARTHEST)
        axes.plot([estimate], [place], mark, color=color, markersize=5, markerfacecolor=inside)
        y = 2.6 * _FONT + tall * (1 - (place + 0.5) / len(rows))
        sheet.text(margin, y, row.key, small_font * min(1.0, longest / max(names[place], 1.0)))
    axes.axvline(0.0, color=sheet.ink, linewidth=0.8)
    axes.set_ylim(-0.5, max(1, len(rows)) - 0.5)
    axes.set_yticks([])
    finish_axes(sheet, axes, tall, _FONT, percent=False)
    axes.spines["left"].set_visible(False)
    label = "difference of means in pooled standard deviations"
    sheet.text(left, 2.6 * _FONT + tall + 2.2 * _FONT, label, small_font, color=sheet.pale)
    sheet.draw(footer, margin, height - foot, small_font)
    stream.write(sheet.content(title, label))


def _standardised(row: GroupDifference) -> tuple[float, float, float]:
    """Interval and difference over the pooled standard deviation."""
    # In units of the larger deviation, so that no square leaves the range of doubles.
    unit = max(row.std_a or 0.0, row.std_b or 0.0)
    degrees = row.n_a + row.n_b - 2
    square = (row.n_a - 1) * ((row.std_a or 0.0) / unit) ** 2 + (row.n_b - 1) * ((row.std_b or 0.0) / unit) ** 2
    pooled = (square / degrees) ** 0.5
    difference = row.difference or 0.0
    low, high = (difference if end is None else end for end in (row.ci_low, row.ci_high))
    return low / unit / pooled, difference / unit / pooled, high / unit / pooled


def _footer(report: GroupComparison, sheet: Sheet, tested: int) -> list[LegendEntry]:
    test = report.test
    entries = [
        LegendEntry(
            f"A {report.group_a.path}: {len(report.group_a.meshes)}, B {report.group_b.path}: "
            f"{len(report.group_b.meshes)} meshes"
        ),
        LegendEntry(f"{100 * (1 - test.alpha):g} % interval of Welch", "line", sheet.pale),
        LegendEntry(f"q ≤ {test.alpha:g} ({test.name}, {test.correction})", "square", _SIGNIFICANT),
    ]
    if any(abs(_standardised(row)[1]) > _FARTHEST for row in report.differences if row.hedges_g is not None):
        entries.append(LegendEntry(f"an arrow: beyond ±{_FARTHEST:g}"))
    if tested > _MOST:
        entries.append(LegendEntry(f"the first {_MOST} of {tested:,} numbers by q"))
    return entries

"""Common range of colours over the meshes of a batch: the smallest range that has the range of each mesh."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import msgspec

from .._version import __version__
from ..analysis.result import Result
from ..output.appearance import Appearance
from ..output.coloring import colored
from ..output.distributions import histogram_columns
from ..output.registry import format_of
from .model import BatchItem, BatchSettings, Engine, Row

HISTOGRAM = "histogram"


def shown(save: Iterable[str], appearance: Appearance, chosen: list[str]) -> list[str]:
    """Columns that the outputs of `--save` show in colours or as histograms."""
    names: dict[str, None] = {}
    for text in save:
        kind, _, _ = text.partition(".")
        if kind == HISTOGRAM:
            names |= dict.fromkeys(histogram_columns(appearance, chosen))
            continue
        show = format_of(f"x.{text}").shows
        names |= dict.fromkeys(show(appearance, chosen) if show is not None else ())
    return list(names)


def ranges_of(analysis: Result, settings: BatchSettings) -> dict[str, tuple[float, float]]:
    """Range of each shown column by the rule of a single mesh; none for labels, and where nothing is defined."""
    own = replace(settings.appearance, ranges=())
    ranges = {}
    for name in shown(settings.save, own, analysis.chosen):
        scale = colored(analysis, name, own).scale
        if scale.low is not None and scale.high is not None:
            ranges[name] = (scale.low, scale.high)
    return ranges


def with_common_ranges(
    items: Sequence[BatchItem], settings: BatchSettings, engine: Engine, known: dict[str, Row], hashes: dict[str, str]
) -> BatchSettings:
    """Settings with the common range of every shown column.

    A first pass over the meshes computes the range of each, without outputs; two numbers per mesh and column are in
    memory. known: rows of an earlier run, whose ranges stand where the content (hashes) and the options are the same.
    Meshes that fail have no range.
    """
    options = settings.ranges_digest()
    rows, todo = [], []
    for item in items:
        row = known.get(item.path)
        comparable = row is not None and (row.ranges_options, row.version) == (options, __version__)
        if row is not None and comparable and row.sha256 is not None and row.sha256 == hashes.get(item.path):
            rows.append(row)
        else:
            todo.append(msgspec.structs.replace(item, outputs=()))
    rows += engine(todo, settings) if todo else []
    common: dict[str, tuple[float, float]] = {}
    for row in rows:
        for name, (low, high) in row.ranges.items():
            least, most = common.get(name, (low, high))
            common[name] = (min(low, least), max(high, most))
    ranges = tuple((name, low, high) for name, (low, high) in sorted(common.items()) if low < high)
    return msgspec.structs.replace(settings, appearance=replace(settings.appearance, ranges=ranges))

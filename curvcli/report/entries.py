"""Numbers of a report one by one: a region or the whole, a column or a total, a statistic, and its value."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec

from .build import column_statistics, region_statistics, whole_piece
from .statistics import listed_statistics

if TYPE_CHECKING:
    from ..analysis.result import Result

# Statistics of a total of a piece, and of the part of a total that belongs to a region.
TOTAL, SHARE = "total", "share"
# Keys of a column's statistics that describe it.
_DESCRIBING = ("symbol", "unit", "kind", "length_exponent")


class Entry(NamedTuple):
    """One number; region: None for the whole surface."""

    region: str | None
    column: str
    statistic: str
    value: float | int | None


def entries(report: Mapping[str, Any]) -> Iterator[Entry]:
    """Totals, shares and column statistics of the whole, then of each region, in the order of the report.

    report: as `Analysis.report()` gives it, or `measured`. Vectors have an entry for each component, NAME_x and so on.
    """
    yield from _piece(None, report)
    for piece in report["regions"]:
        yield from _piece(str(piece["name"]), piece)


def _piece(region: str | None, piece: Mapping[str, Any]) -> Iterator[Entry]:
    for statistic, section in ((TOTAL, "totals"), (SHARE, "shares")):
        for name, value in (piece.get(section) or {}).items():
            if isinstance(value, Sequence):
                for axis, component in zip("xyz", value, strict=True):
                    yield Entry(region, f"{name}_{axis}", statistic, component)
            else:
                yield Entry(region, name, statistic, value)
    for column, statistics in (piece.get("columns") or {}).items():
        for statistic, value in statistics.items():
            if statistic not in _DESCRIBING:
                yield Entry(region, column, statistic, value)


def measured(analysis: Result) -> dict[str, Any]:
    """The parts of the report that have entries; --stat chooses the statistics of the whole too."""
    names = analysis.request.statistics
    columns: Any = column_statistics(analysis)
    if names:
        columns = listed_statistics(analysis, analysis.surface.whole, names)[0]
    sections: dict[str, Any] = {
        "totals": whole_piece(analysis).totals,
        "columns": columns,
        "regions": region_statistics(analysis),
    }
    built: dict[str, Any] = msgspec.to_builtins(sections)
    return built

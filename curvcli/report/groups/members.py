"""Members of a group: the numbers of each report by key, with a bound on their rounding."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ...curvatures.registry import passes
from ...mesh.triangles import EPSILON
from ..compare.values import edge_length, noise_of, power, stem, total_exponents
from ..entries import SHARE, TOTAL, Entry

_SECTIONS = {TOTAL: "totals", SHARE: "shares"}
_COUNTS = ("count", "nulls")


@dataclass(frozen=True)
class Member:
    """One mesh of a group.

    values: by region, column and statistic; None is undefined. rounding: a bound on the rounding of each.
    conventions: of the report, empty where they are not known.
    """

    name: str
    values: Mapping[tuple[str | None, str, str], float | None]
    rounding: Mapping[tuple[str | None, str, str], float]
    conventions: Mapping[str, Any] = field(default_factory=dict)


def key_of(region: str | None, column: str, statistic: str) -> str:
    """Dotted key, as `--only` matches it: `totals.K`, `columns.h.mean`, `regions.V1.columns.h.mean`."""
    section = _SECTIONS.get(statistic)
    name = f"columns.{column}.{statistic}" if section is None else f"{section}.{column}"
    return name if region is None else f"regions.{region}.{name}"


def member(
    name: str, listed: Iterable[Entry], whole: Mapping[str, Any], conventions: Mapping[str, Any] | None = None
) -> Member:
    """Member from the entries of a report. whole: its topology and totals, which set the scale of rounding."""
    entries = list(listed)
    values = {entry[:3]: None if entry.value is None else float(entry.value) for entry in entries}
    sizes: dict[tuple[str | None, str], float] = {}
    for region, column, statistic, value in entries:
        if value is not None and statistic not in (*_COUNTS, TOTAL, SHARE):
            sizes[region, column] = max(abs(value), sizes.get((region, column), 0.0))
    bound = _RoundingBound(whole)
    rounding = {
        entry[:3]: bound.of(entry, sizes.get((entry.region, entry.column), 0.0))
        for entry in entries
        if entry.value is not None
    }
    return Member(name, values, rounding, conventions or {})


class _RoundingBound:
    """Bound on the rounding of a number of a mesh, from its area and the size and number of its faces."""

    def __init__(self, whole: Mapping[str, Any]) -> None:
        topology = whole["topology"]
        self._area = whole["totals"].get("area") or 0.0
        self._edge = edge_length(whole)
        self._terms = 16 * EPSILON * (topology["faces"] + topology["vertices"])
        self._exponents = total_exponents()

    def of(self, entry: Entry, size: float) -> float:
        """Bound for one entry. size: of the statistics of its column."""
        _, column, statistic, value = entry
        if statistic in _COUNTS:
            return 0.0
        if statistic in _SECTIONS:
            name = stem(column) if column not in self._exponents else column
            name = name if name in self._exponents else name.rpartition("_")[0]
            exponent, cancels = self._exponents.get(name, (0, False))
            size = power(self._area, exponent / 2) if cancels else 0.0
            noise = self._terms * power(self._edge, exponent)
        else:
            quantity = passes.column(column)
            noise = noise_of(column, quantity.length_exponent if quantity else 0, self._edge)
        return float(noise + self._terms * max(size, abs(value or 0.0)))

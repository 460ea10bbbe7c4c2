"""Statistics of a column over groups of elements (the whole, components, regions) by segment reductions.

Nulls are left out and counted. `mean`, `std` and percentiles give every value the same weight; the `area_` statistics
weigh each value by the area of its element. No step loops over groups.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..errors import UsageError
from ..mesh.groups import Segments
from ..support.arrays import Floats, Ints, Mask
from ..support.words import suggestion

# Statistics of a column in the report, in its order.
REPORTED = ("count", "nulls", "min", "max", "mean", "area_mean", "std", "p02", "median", "p98")
STATISTICS = (*REPORTED, "area_std", "area_median", "absmax", "sum")

_PERCENTILE = re.compile(r"(area_)?p(\d{1,3}(\.\d+)?)", re.ASCII)

# Groups whose sizes differ by less than this share of the size are sorted in one array.
_SLACK = 8


def parse_statistics(names: str | Iterable[str]) -> tuple[str, ...]:
    """Names of statistics, also in comma lists, in the given order and each once.

    Errors: UsageError for an unknown name, with the nearest.
    """
    entries = [names] if isinstance(names, str) else names
    listed = [name.strip() for entry in entries for name in entry.split(",")]
    for name in listed:
        if not is_statistic(name):
            raise UsageError(f"unknown statistic {name!r}{suggestion(name, [*STATISTICS, 'pNN', 'area_pNN'])}")
    return tuple(dict.fromkeys(listed))


def is_statistic(name: str) -> bool:
    """Test a name: one of `STATISTICS`, or a percentile such as p05, p97.5 or area_p10."""
    match = _PERCENTILE.fullmatch(name)
    return name in STATISTICS or (match is not None and float(match[2]) <= 100)


def _percentile(name: str) -> tuple[bool, float] | None:
    """True if weighted by area, and the share; None for a statistic that is no percentile."""
    if name in ("median", "area_median"):
        return name == "area_median", 0.5
    match = _PERCENTILE.fullmatch(name)
    return None if match is None else (match[1] is not None, float(match[2]) / 100)


class GroupedColumn:
    """Values of one column by group, and their statistics.

    values: (n,) NaN is null. area: (n,) weights, not negative. used: (n,) elements that count at all, None for all.
    plans: a dictionary that columns share, to group the same members once.
    Each statistic is (G,), NaN for a group without a value; an `area_` statistic is NaN where the area is 0. Sums are
    pairwise, in units of a power of two near the largest value of the group, so that no square leaves the range of
    doubles. Percentiles interpolate linearly between ordered values (`numpy.quantile`, method `linear`);
    weighted ones are the smallest value up to which the share of the area is reached (method `inverted_cdf`).
    """

    def __init__(
        self,
        values: Floats,
        area: Floats,
        segments: Segments,
        used: Mask | None = None,
        plans: dict[bytes, list[_GroupsOfLikeSize]] | None = None,
    ) -> None:
        self._plans = {} if plans is None else plans
        known = ~np.isnan(values)
        if used is not None:
            known &= used
        members = segments.members()
        self.groups = segments.count
        if segments.label is None:
            self._members = np.array([np.count_nonzero(known)])
        else:
            self._members = segments.count_true(known)
            values, area, known = (segments.gather(each) for each in (values, area, known))
        if len(values) > self._members.sum():
            values, area = values[known], area[known]
        self._values, self._area = values, area
        self.count: Ints = self._members
        self.nulls: Ints = members - self._members
        self._full = self._members > 0
        self._sizes = self._members[self._full]
        self._starts = np.cumsum(self._sizes) - self._sizes

    def statistic(self, name: str) -> Floats | Ints:
        """One statistic by its name."""
        percentile = _percentile(name)
        if percentile is not None:
            weighted, share = percentile
            return self._weighted(share) if weighted else self._quantile(share)
        values: Floats | Ints = getattr(self, name)
        return values

    def _reduced(self, ufunc: np.ufunc, values: Floats) -> Floats:
        """Reduction over each group that has values."""
        return np.asarray(ufunc.reduceat(values, self._starts) if len(values) else np.empty(0))

    def _spread(self, each: Floats) -> Floats:
        """Value of a group at each of its members; a scalar for a single group."""
        return each if len(each) == 1 else np.repeat(each, self._sizes)

    def _all(self, each: Floats) -> Floats:
        """(G,) from the groups that have values; NaN for the others."""
        values = np.full(self.groups, np.nan)
        values[self._full] = each
        return values

    @cached_property
    def min(self) -> Floats:
        """Smallest value."""
        return self._all(self._reduced(np.minimum, self._values))

    @cached_property
    def max(self) -> Floats:
        """Largest value."""
        return self._all(self._reduced(np.maximum, self._values))

    @cached_property
    def absmax(self) -> Floats:
        """Largest absolute value."""
        return np.asarray(np.maximum(-self.min, self.max))

    @cached_property
    def _size(self) -> Floats:
        """Power of two near the largest absolute value of each group that has values."""
        exponent = np.frexp(self.absmax[self._full])[1] - 1
        return np.asarray(np.ldexp(1.0, np.maximum(exponent, -1022)))

    @cached_property
    def _scaled(self) -> Floats:
        return np.asarray(self._values / self._spread(self._size))

    @cached_property
    def _mean(self) -> Floats:
        return np.asarray(self._reduced(np.add, self._scaled) / self._sizes)

    @cached_property
    def _weight(self) -> Floats:
        """Area of the members that have values; NaN where it is 0."""
        weight = self._reduced(np.add, self._area)
        return np.where(weight > 0, weight, np.nan)

    @cached_property
    def _area_mean(self) -> Floats:
        return self._reduced(np.add, self._scaled * self._area) / self._weight

    @cached_property
    def sum(self) -> Floats:
        """Sum."""
        with np.errstate(over="ignore"):  # beyond the range of doubles
            return self._all(self._mean * self._sizes * self._size)

    @cached_property
    def mean(self) -> Floats:
        """Mean of the values."""
        return self._all(self._mean * self._size)

    @cached_property
    def area_mean(self) -> Floats:
        """Mean weighted by area."""
        return self._all(self._area_mean * self._size)

    @cached_property
    def std(self) -> Floats:
        """Standard deviation of the population."""
        gaps = self._scaled - self._spread(self._mean)
        variance = self._reduced(np.add, np.square(gaps, out=gaps)) / self._sizes
        return self._all(np.sqrt(variance) * self._size)

    @cached_property
    def area_std(self) -> Floats:
        """Standard deviation about `area_mean`, weighted by area."""
        gaps = self._scaled - self._spread(self._area_mean)
        variance = self._reduced(np.add, np.square(gaps, out=gaps) * self._area) / self._weight
        return self._all(np.sqrt(variance) * self._size)

    @cached_property
    def _batches(self) -> list[_GroupsOfLikeSize]:
        """Groups of nearly equal size, together."""
        key = self._sizes.tobytes()
        if key not in self._plans:
            self._plans.clear()
            self._plans[key] = list(_batches(self._sizes, self._starts))
        return self._plans[key]

    @cached_property
    def _ordered(self) -> list[tuple[_GroupsOfLikeSize, Floats]]:
        """Values of the groups of each batch as rows, ascending; infinite beyond the end of a row."""
        blocks = []
        for batch in self._batches:
            block = batch.rows_of(self._values, np.inf)
            block.sort(axis=1)
            blocks.append((batch, block))
        return blocks

    def _quantile(self, share: float) -> Floats:
        """Value below which a share of the ordered values of each group lies, interpolated linearly."""
        result = np.empty(len(self._sizes))
        for batch, block in self._ordered:
            last, size, row = batch.sizes - 1, self._size[batch.groups], np.arange(len(block))
            place = share * last
            below = place.astype(np.int64)
            first, second = (block[row, rank] / size for rank in (below, np.minimum(below + 1, last)))
            result[batch.groups] = (first + (second - first) * (place - below)) * size
        return self._all(result)

    @cached_property
    def _cumulated(self) -> list[tuple[_GroupsOfLikeSize, Floats, Floats]]:
        """Values of the groups of each batch as rows, ascending, and the area up to and with each."""
        blocks = []
        for batch in self._batches:
            block, area = batch.rows_of(self._values, np.inf), batch.rows_of(self._area, 0.0)
            order = np.argsort(block, axis=1, kind="stable")
            block, area = (np.take_along_axis(part, order, axis=1) for part in (block, area))
            blocks.append((batch, block, area.cumsum(axis=1, out=area)))
        return blocks

    def _weighted(self, share: float) -> Floats:
        """Smallest value of each group up to which the share of the area is reached."""
        result = np.empty(len(self._sizes))
        for batch, block, upto in self._cumulated:
            total = upto[:, -1:]
            first = ((upto >= share * total) & (upto > 0)).argmax(axis=1)
            result[batch.groups] = np.where(total[:, 0] > 0, block[np.arange(len(block)), first], np.nan)
        return self._all(result)


class _GroupsOfLikeSize(NamedTuple):
    """Groups of nearly equal size as rows of one array.

    groups: their numbers. sizes: of each. rows: (groups, longest) of their members; beyond the end of a row, that of
    its last member. padding: (groups, longest) mask of these entries; None if there are none.
    """

    groups: Ints
    sizes: Ints
    rows: Ints | None
    padding: Mask | None

    def rows_of(self, values: Floats, fill: float) -> Floats:
        """Values of the members as rows, with a value beyond the end of a row."""
        if self.rows is None:
            return values[None].copy()
        rows = values[self.rows]
        if self.padding is not None:
            rows[self.padding] = fill
        return rows


def _batches(sizes: Ints, starts: Ints) -> Iterator[_GroupsOfLikeSize]:
    """Batches of groups that stand one after the other, none of them empty."""
    if len(sizes) == 1:
        yield _GroupsOfLikeSize(np.zeros(1, np.int64), sizes, None, None)
        return
    by_size = np.argsort(sizes, kind="stable")
    ascending = sizes[by_size]
    first = 0
    while first < len(sizes):
        longest = int(ascending[first]) + int(ascending[first]) // _SLACK
        last = int(np.searchsorted(ascending, longest, side="right"))
        groups = by_size[first:last]
        place = np.arange(int(ascending[last - 1]), dtype=np.int32)
        padding = place >= sizes[groups, None]
        rows = starts[groups, None] + np.minimum(place, sizes[groups, None] - 1)
        yield _GroupsOfLikeSize(groups, sizes[groups], rows, padding if padding.any() else None)
        first = last

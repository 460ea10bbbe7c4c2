"""Statistics of a column over groups of elements (the whole, components, regions) by segment reductions.

Nulls are left out and counted. `mean`, `std` and percentiles give every value the same weight; the `area_` statistics
weigh each value by the area of its element. No step loops over groups.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import cached_property

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
    Each statistic is (G,), NaN for a group without a value; an `area_` statistic is NaN where the area is 0. Sums are
    pairwise, in units of a power of two near the largest value of the group, so that no square leaves the range of
    doubles. Percentiles interpolate linearly between ordered values (`numpy.quantile`, method `linear`);
    weighted ones are the smallest value up to which the share of the area is reached (method `inverted_cdf`).
    """

    def __init__(self, values: Floats, area: Floats, segments: Segments, used: Mask | None = None) -> None:
        known = ~np.isnan(values)
        if used is not None:
            known &= used
        members = segments.members()
        self.groups = segments.count
        if segments.label is None:
            self._values, self._area = (values, area) if known.all() else (values[known], area[known])
            self._members = np.array([len(self._values)])
        else:
            order = segments.order
            if not known.all():
                order = order[known[order]]
            self._values, self._area = values[order], area[order]
            self._members = segments.count_true(known)
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
        found: Floats | Ints = getattr(self, name)
        return found

    def _reduced(self, ufunc: np.ufunc, values: Floats) -> Floats:
        """Reduction over each group that has values."""
        return np.asarray(ufunc.reduceat(values, self._starts) if len(values) else np.empty(0))

    def _spread(self, each: Floats) -> Floats:
        """Value of a group at each of its members; a scalar for a single group."""
        return each if len(each) == 1 else np.repeat(each, self._sizes)

    def _all(self, each: Floats) -> Floats:
        """(G,) from the groups that have values; NaN for the others."""
        found = np.full(self.groups, np.nan)
        found[self._full] = each
        return found

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

    def _batches(self) -> Iterator[tuple[Ints, Ints, Mask | None]]:
        """Groups of nearly equal size as rows of one array.

        Yields their numbers among the groups that have values, the places (rows, longest) of their members, and the
        mask of the places beyond a row's end, which repeat its last member; None if there are none.
        """
        by_size = np.argsort(self._sizes, kind="stable")
        sizes = self._sizes[by_size]
        first = 0
        while first < len(sizes):
            longest = int(sizes[first]) + int(sizes[first]) // _SLACK
            last = int(np.searchsorted(sizes, longest, side="right"))
            rows = by_size[first:last]
            place = np.arange(int(sizes[last - 1]))
            beyond = place >= self._sizes[rows, None]
            places = self._starts[rows, None] + np.minimum(place, self._sizes[rows, None] - 1)
            yield rows, places, beyond if beyond.any() else None
            first = last

    @cached_property
    def _ordered(self) -> Floats:
        """Values, ascending within each group."""
        if len(self._sizes) == 1:
            return np.sort(self._values)
        ordered = np.empty_like(self._values)
        for _, places, beyond in self._batches():
            block = self._values[places]
            if beyond is None:
                ordered[places] = np.sort(block, axis=1)
            else:
                block[beyond] = np.inf
                block.sort(axis=1)
                ordered[places[~beyond]] = block[~beyond]
        return ordered

    def _quantile(self, share: float) -> Floats:
        """Value below which a share of the ordered values of each group lies, interpolated linearly."""
        place = share * (self._sizes - 1)
        below = place.astype(np.int64)
        above = np.minimum(below + 1, self._sizes - 1)
        first, second = (self._ordered[self._starts + rank] / self._size for rank in (below, above))
        return self._all((first + (second - first) * (place - below)) * self._size)

    @cached_property
    def _cumulated(self) -> tuple[Floats, Floats]:
        """Values, ascending within each group, and the area up to and with each."""
        ordered, upto = np.empty_like(self._values), np.empty_like(self._values)
        for _, places, beyond in self._batches():
            block, area = self._values[places], self._area[places]
            if beyond is not None:
                block[beyond], area[beyond] = np.inf, 0.0
            order = np.argsort(block, axis=1, kind="stable")
            block, area = (np.take_along_axis(part, order, axis=1) for part in (block, area))
            area.cumsum(axis=1, out=area)
            inside = slice(None) if beyond is None else ~beyond
            ordered[places[inside]], upto[places[inside]] = block[inside], area[inside]
        return ordered, upto

    def _weighted(self, share: float) -> Floats:
        """Smallest value of each group up to which the share of the area is reached."""
        ordered, upto = self._cumulated
        total = upto[self._starts + self._sizes - 1] if len(ordered) else np.empty(0)
        reached = (upto >= self._spread(share * total)) & (upto > 0)
        rank = np.where(reached, np.arange(len(upto)), len(upto))
        first = self._reduced(np.minimum, rank).astype(np.int64)
        return self._all(np.where(total > 0, ordered[np.minimum(first, max(len(ordered) - 1, 0))], np.nan))

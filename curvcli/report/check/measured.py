"""Numbers that assertions compare: a statistic of a column, or a value of the whole, a region or a component."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol, get_args, get_type_hints

import numpy as np

from ...analysis.statistics import GroupedColumn
from ...checks.area_fractions import area_fractions
from ...curvatures.derived import derived
from ...curvatures.quantity import Quantity
from ...curvatures.registry import passes
from ...errors import UsageError
from ...mesh.groups import Segments
from ...support.arrays import Floats
from ..build import topology_of
from ..model import Topology
from .scopes import ScopedStatistics

_PLURALS = {"vertex": "vertices", "edge": "edges", "face": "faces"}
_EXTREMES = ("min", "max", "absmax")


class Measured(Protocol):
    """A number of each group of a part of the surface.

    call: its text. passes: the quantities that it is computed from.
    """

    @property
    def call(self) -> str: ...
    @property
    def passes(self) -> list[str]: ...
    def values(self, part: ScopedStatistics) -> Floats: ...
    def undefined(self, part: ScopedStatistics, group: int) -> str: ...
    def place(self, part: ScopedStatistics, group: int) -> str: ...


@dataclass(frozen=True)
class StatisticOfColumn:
    """A statistic of one scalar column; nulls are left out. axis: the component of a vector."""

    statistic: str
    quantity: Quantity
    column: str

    @property
    def call(self) -> str:
        """Text as after --assert."""
        return f"{self.statistic}({self.column})"

    @property
    def passes(self) -> list[str]:
        """The column, where it is one of vertices; others are computed on demand."""
        return [self.quantity.name] if self.quantity.on == "vertex" else []

    @property
    def _axis(self) -> int | None:
        return "xyz".index(self.column[-1]) if self.quantity.vector else None

    def _grouped(self, part: ScopedStatistics) -> tuple[GroupedColumn, Floats]:
        return part.column(self.quantity, self._axis)

    def values(self, part: ScopedStatistics) -> Floats:
        """(G,) statistic of each group; NaN where it is undefined or beyond the range of doubles."""
        grouped, _ = self._grouped(part)
        values = grouped.statistic(self.statistic).astype(np.float64)
        if self.statistic == "sum":
            values = np.where(grouped.count > 0, values, np.nan)
        return np.where(np.isfinite(values), values, np.nan)

    def undefined(self, part: ScopedStatistics, group: int) -> str:
        """Reason for a missing statistic."""
        on = self.quantity.on
        if self._grouped(part)[0].count[group]:
            return f"it is beyond the range of doubles, or its {_PLURALS[on]} have no area"
        return f"no {on} has a value"

    def place(self, part: ScopedStatistics, group: int) -> str:
        """Place of an extreme value."""
        if self.statistic not in _EXTREMES:
            return ""
        members = part.members(self.quantity.on, group)
        values = self._grouped(part)[1][members]
        values = np.abs(values) if self.statistic == "absmax" else values
        place = np.nanargmin(values) if self.statistic == "min" else np.nanargmax(values)
        return f" at {part.place(self.quantity.on, int(members[place]))}"


@dataclass(frozen=True)
class ValueOfPart:
    """A value of the whole, a region or a component by the name of its column in their tables, or of its box."""

    key: str
    needs: tuple[str, ...]
    section: str

    @property
    def call(self) -> str:
        """Text as after --assert."""
        return self.key

    @property
    def passes(self) -> list[str]:
        """The quantities that it is computed from."""
        return list(self.needs)

    def values(self, part: ScopedStatistics) -> Floats:
        """(G,) value of each group, NaN where undefined.

        Errors: UsageError for a value that this analysis does not compute.
        """
        values = _SECTIONS[self.section](part, self.key)
        if values is None:
            raise UsageError(f"assertion on {self.key}: it is not computed; a parameter of its pass has to be set")
        return values

    def undefined(self, part: ScopedStatistics, group: int) -> str:
        """Reason for a missing value."""
        return f"it is null in the report of the {part.groups.kind}"

    def place(self, part: ScopedStatistics, group: int) -> str:
        """No place: the value is that of all elements."""
        return ""


def _topology(part: ScopedStatistics, key: str) -> Floats:
    counts = topology_of(part.analysis, part.groups)[key]
    return np.array([np.nan if count is None else count for count in counts], np.float64)


def _component(values: dict[str, Floats], key: str) -> Floats | None:
    if key in values and values[key].ndim == 1:
        return values[key]
    stem, axis = key[:-2], key[-1:]
    return values[stem][:, "xyz".index(axis)] if stem in values and axis in "xyz" else None


def _total(part: ScopedStatistics, key: str) -> Floats | None:
    return _component(part.analysis.totals_of(part.groups), key)


def _share(part: ScopedStatistics, key: str) -> Floats | None:
    return _component(part.whole.shares_of_regions(), key.removeprefix("share_"))


def _fraction(part: ScopedStatistics, key: str) -> Floats | None:
    fractions = area_fractions(part.analysis.surface, part.groups, part.analysis.columns)
    return fractions.get(key.removeprefix("fractions_"))


def _box(part: ScopedStatistics, key: str) -> Floats:
    """Bounding box of the referenced vertices, in the file's unit."""
    surface = part.analysis.surface
    measure, _, axis = key.partition("_")
    no_area = np.zeros(surface.n_vertices)
    vertices = part.groups.vertices
    used = surface.referenced if vertices.label is None else None

    def ends(k: int) -> tuple[Floats, Floats]:
        segments = Segments(vertices.label, vertices.count, vertices.size)
        grouped = GroupedColumn(surface.xyz_given[k], no_area, segments, used)
        return grouped.min, grouped.max

    with np.errstate(over="ignore"):
        if measure == "diagonal":
            x, y, z = (high - low for low, high in map(ends, range(3)))
            return np.hypot(np.hypot(x, y), z)  # no square leaves the range of doubles
        low, high = ends("xyz".index(axis))
        return {"min": low, "max": high, "extent": high - low}[measure]


_SECTIONS: dict[str, Callable[[ScopedStatistics, str], Floats | None]] = {
    "topology": _topology,
    "total": _total,
    "share": _share,
    "fraction": _fraction,
    "box": _box,
}


def values_of_parts(quantities: Sequence[Quantity], regions: bool) -> dict[str, ValueOfPart]:
    """Every value of a part that an assertion may name. regions: with the shares, which regions have."""
    known: dict[str, ValueOfPart] = {}
    for key, declared in get_type_hints(Topology).items():
        if declared is not bool:
            assert declared is int or int in get_args(declared)
            known[key] = ValueOfPart(key, (), "topology")
    known["area"], known["volume"] = ValueOfPart("area", (), "total"), ValueOfPart("volume", (), "total")
    for quantity in (*passes.quantities(public=False), *quantities):
        if quantity.total:
            needs = (quantity.name,) if quantity.public else ()
            for key in [f"{quantity.total}_{axis}" for axis in "xyz"] if quantity.vector else [quantity.total]:
                known.setdefault(key, ValueOfPart(key, needs, "total"))
    for name, each in derived.items():
        known[name] = ValueOfPart(name, (each.beside,) if each.beside else (), "total")
    if regions:
        shares = [each for each in known.values() if each.section == "total" and each.key != "volume"]
        shared = [f"share_{each.key}" for each in shares if each.key not in derived]
        needs_of = {f"share_{each.key}": each.needs for each in shares}
        known |= {key: ValueOfPart(key, needs_of[key], "share") for key in shared}
    for sign in ("positive", "negative", "zero"):
        for name, needs in (("K", ()), ("H", ("h_signed",))):
            known[f"fractions_{name}_{sign}"] = ValueOfPart(f"fractions_{name}_{sign}", needs, "fraction")
    for key in ("diagonal", *(f"{measure}_{axis}" for measure in ("extent", "min", "max") for axis in "xyz")):
        known[key] = ValueOfPart(key, (), "box")
    return known

"""Scopes of assertions: the whole surface, each region or component, or one of them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...analysis.result import Result
from ...analysis.statistics import GroupedColumn
from ...curvatures.quantity import Quantity
from ...errors import LackingError, UsageError
from ...mesh.groups import Segments
from ...support.arrays import Floats
from ...support.words import suggestion

_EACH = re.compile(r"\s*each\s+(region|component)\s*:(.*)", re.DOTALL)
# The label ends at the last `):`, and may have any characters.
_ONE = re.compile(r"\s*(region|component)\s*\((.+)\)\s*:(.*)", re.DOTALL)
_KINDS = ("region", "component")


@dataclass(frozen=True)
class AssertedScope:
    """kind: `whole`, `region` or `component`. label: of the one region or component; None for each of them."""

    kind: str = "whole"
    label: str | None = None

    @property
    def prefix(self) -> str:
        """Text before the assertion."""
        if self.kind == "whole":
            return ""
        return f"each {self.kind}: " if self.label is None else f"{self.kind}({self.label}): "

    def chosen(self, part: ScopedStatistics) -> list[int]:
        """Numbers of its groups.

        Errors: LackingError for a region or a component that the mesh has not, with the nearest.
        """
        groups = part.groups
        if self.label is None:
            return list(range(groups.count))
        labels = groups.names or tuple(map(str, range(groups.count)))
        if self.label not in labels:
            count = f"it has {groups.count:,}"
            way_out = suggestion(self.label, labels, count) if groups.names else f"; {count}, numbered from 0"
            raise LackingError(f"assertion on {self.kind}({self.label}): the mesh has no such {self.kind}{way_out}")
        return [labels.index(self.label)]


def parse_scope(text: str) -> tuple[AssertedScope, str]:
    """Scope of an assertion, and the rest of its text.

    Errors: UsageError for a word before a colon that is no scope.
    """
    if match := _EACH.fullmatch(text):
        return AssertedScope(match[1]), match[2]
    if match := _ONE.fullmatch(text):
        return AssertedScope(match[1], match[2].strip()), match[3]
    before, colon, _ = text.rpartition(":")
    if colon:
        scopes = ("each region", "each component", "region(LABEL)", "component(NUMBER)")
        raise UsageError(
            f"assertion {text!r}: expected one of {', '.join(scopes)} before the colon, found {before.strip()!r}"
        )
    return AssertedScope(), text


class ScopedStatistics:
    """The analysis and the groups of one kind of scope, with the statistics computed so far."""

    def __init__(self, analysis: Result, kind: str) -> None:
        self.whole, self.analysis, self.groups = analysis, analysis, analysis.surface.whole
        if kind == "component":
            self.groups = analysis.surface.components
        elif kind == "region":
            assert analysis.cut is not None
            self.analysis, self.groups = analysis.cut, analysis.cut_groups
        self._columns: dict[tuple[str, int | None], tuple[GroupedColumn, Floats]] = {}

    def column(self, quantity: Quantity, axis: int | None) -> tuple[GroupedColumn, Floats]:
        """Statistics of a column in each group, and its values; of a vector, one component."""
        key = quantity.name, axis
        if key not in self._columns:
            column = self.analysis.shown(quantity.name)
            values = (column if axis is None else column[:, axis]).astype(np.float64)
            grouped = GroupedColumn(values, self._area(quantity.on, len(values)), self._segments(quantity.on))
            self._columns[key] = grouped, values
        return self._columns[key]

    def _area(self, on: str, count: int) -> Floats:
        if on == "vertex":
            area: Floats = self.analysis.columns["star_area"]
            return area
        return self.analysis.shown("area_of_face") if on == "face" else np.ones(count)

    def _segments(self, on: str) -> Segments:
        """Elements by group; unreferenced vertices are in none."""
        segments, referenced = self.groups.of(self.analysis.surface, on), self.analysis.surface.referenced
        if on != "vertex" or segments.label is not None or referenced.all():
            return segments
        return Segments(np.where(referenced, 0, -1).astype(np.int32), 1, len(referenced))

    def members(self, on: str, group: int) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
        """Elements of one group."""
        return self._segments(on).members_of(group)

    def place(self, on: str, element: int) -> str:
        """Name of an element in the file: `vertex 7`, `edge 3-9`, `face 2`; those of a region are copies."""
        surface, cut = self.analysis.surface, self.analysis.surface.cut_from
        if on == "face":
            return f"face {element if cut is None else self._labelled[element]}"
        ends = [element] if on == "vertex" else [surface.edges.a[element], surface.edges.b[element]]
        numbers = [int(end if cut is None else cut.vertex[end]) for end in ends]
        return f"{on} {'-'.join(map(str, sorted(numbers)))}"

    @cached_property
    def _labelled(self) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
        """Faces of the whole that are in a region."""
        assert self.whole.regions is not None
        return np.flatnonzero(self.whole.regions.face >= 0)

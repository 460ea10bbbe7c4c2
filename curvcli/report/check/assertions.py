"""Assertions on a column: `absmax(h_signed) <= 50`."""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...analysis.result import Result
from ...curvatures.catalogue import at_scales
from ...curvatures.quantity import AT_SCALE, Quantity
from ...curvatures.registry import passes
from ...errors import UsageError
from ...mesh.scale import EstimatorSettings, Scale
from ...support.words import format_number, format_rounded, suggestion
from ..quantities import public
from ..statistics import statistics

STATISTICS = ("min", "max", "absmax", "mean", "area_mean", "sum", "p02", "p98")

OPERATORS: dict[str, Callable[[float, float], bool]] = {
    "<=": operator.le,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    ">": operator.gt,
}

_SHAPE = re.compile(r"\s*(\w+)\s*\(\s*(\w+)\s*\)\s*([<>=!]+)\s*([^\s<>=!]+)\s*", re.ASCII)
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)

_PLURALS = {"vertex": "vertices", "edge": "edges", "face": "faces"}


@dataclass(frozen=True)
class Assertion:
    """A statistic of one scalar column, compared with a number; nulls are left out of the statistic."""

    statistic: str
    quantity: Quantity
    column: str
    comparison: str
    bound: float

    @property
    def name(self) -> str:
        """Text of the assertion as after --assert."""
        return f"{self.statistic}({self.column}) {self.comparison} {format_number(self.bound)}"

    def judge(self, analysis: Result) -> tuple[bool, float | None, str]:
        """True if it holds, the statistic's value (None where undefined), and a message with both."""
        values, area, used = self._values(analysis)
        value = self._value(values, area, used)
        call = f"{self.statistic}({self.column})"
        if value is None:
            known = used & ~np.isnan(values)
            some = f"it is beyond the range of doubles, or its {_PLURALS[self.quantity.on]} have no area"
            none = f"no {self.quantity.on} has a value"
            return False, None, f"{call} is undefined: {some if known.any() else none}"
        held = OPERATORS[self.comparison](value, self.bound)
        return held, value, f"{call} = {format_rounded(value)}{self._place(analysis, values, used)}"

    def _values(self, analysis: Result) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
        """Values of the column, weights for area_mean, and the elements that count."""
        surface = analysis.surface
        shown = analysis.shown(self.quantity.name)
        if self.quantity.vector:
            shown = shown[:, "xyz".index(self.column[-1])]
        values = shown.astype(np.float64)
        if self.quantity.on == "vertex":
            return values, analysis.columns["star_area"], surface.referenced
        area = analysis.shown("area_of_face") if self.quantity.on == "face" else np.ones(len(values))
        return values, area, np.ones(len(values), bool)

    def _value(self, values: NDArray[np.float64], area: NDArray[np.float64], used: NDArray[np.bool_]) -> float | None:
        summary = statistics(self.quantity, values, area, used, "")
        value: float | None
        if self.statistic == "sum":
            known = values[used & ~np.isnan(values)]
            with np.errstate(over="ignore", invalid="ignore"):
                value = float(known.sum()) if len(known) else None
        elif self.statistic == "absmax":
            value = None if summary.min is None or summary.max is None else max(-summary.min, summary.max)
        else:
            value = getattr(summary, self.statistic)
        return value if value is not None and math.isfinite(value) else None

    def _place(self, analysis: Result, values: NDArray[np.float64], used: NDArray[np.bool_]) -> str:
        """Place of the extreme value."""
        if self.statistic not in ("min", "max", "absmax"):
            return ""
        shown = np.abs(values) if self.statistic == "absmax" else values
        shown = np.where(used, shown, np.nan)
        where = int(np.nanargmin(shown) if self.statistic == "min" else np.nanargmax(shown))
        edges = analysis.surface.edges
        name = f"{edges.a[where]}-{edges.b[where]}" if self.quantity.on == "edge" else str(where)
        return f" at {self.quantity.on} {name}"


def columns(scales: tuple[Scale, ...] = ()) -> dict[str, Quantity]:
    """Every scalar column by its name; where two elements share one, the vertices' comes first."""
    quantities: dict[str, Quantity] = {}
    for quantity in _at(scales):
        alone = () if quantity.vector or AT_SCALE in quantity.name else (quantity.name,)
        for column in (*quantity.columns, *alone, *(f"{quantity.name}_{x}" for x in "xyz" if quantity.vector)):
            quantities.setdefault(column, quantity)
    return quantities


def _at(scales: tuple[Scale, ...]) -> list[Quantity]:
    """All public quantities, those that depend on the scale at each of several."""
    if len(scales) < 2:
        return public()
    return [passes.quantity(name) for name in at_scales((q.name for q in public()), EstimatorSettings(scales))]


def parse(text: str, scales: tuple[Scale, ...] = ()) -> Assertion:
    """An assertion from `STAT(COLUMN) OP NUMBER`.

    Errors: UsageError that names the invalid part, with the nearest names.
    """
    match = _SHAPE.fullmatch(text)
    if match is None:
        raise UsageError(f"assertion {text!r}: expected STAT(COLUMN) OP NUMBER, such as 'absmax(h_signed) <= 50'")
    statistic, column, comparison, bound = match.groups()
    _known(text, "statistic", statistic, STATISTICS)
    if comparison not in OPERATORS:
        raise UsageError(f"assertion {text!r}: no comparison {comparison!r}, expected one of {' '.join(OPERATORS)}")
    if not _NUMBER.fullmatch(bound) or not math.isfinite(float(bound)):
        raise UsageError(f"assertion {text!r}: {bound!r} is not a number in the range of doubles")
    quantity = _quantity(text, column, scales)
    if statistic == "area_mean" and quantity.on == "edge":
        raise UsageError(f"assertion {text!r}: edges have no area to weigh {column} by; use mean")
    return Assertion(statistic, quantity, column, comparison, float(bound))


def _quantity(text: str, column: str, scales: tuple[Scale, ...]) -> Quantity:
    known = columns(scales)
    vectors = {stem: q for q in reversed(_at(scales)) if q.vector for stem in (q.name, q.stem)}
    if column in vectors:
        components = ", ".join(f"{column}_{axis}" for axis in "xyz")
        raise UsageError(f"assertion {text!r}: {column} is a vector; name one of its components {components}")
    _known(text, "column", column, known)
    if known[column].labels:
        raise UsageError(f"assertion {text!r}: {column} has words, not numbers")
    return known[column]


def _known(text: str, what: str, name: str, known: Any) -> None:
    if name not in known:
        way_out = suggestion(name, known, "`curvcli passes` lists them")
        raise UsageError(f"assertion {text!r}: unknown {what} {name!r}{way_out}")

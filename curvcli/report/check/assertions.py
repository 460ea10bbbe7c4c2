"""Assertions: `absmax(h_signed) <= 50`, `each region: area_mean(K_density) > 0`, `volume >= 100`."""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...analysis.result import LISTED_GROUPS, Result
from ...analysis.statistics import STATISTICS, is_statistic
from ...curvatures.catalogue import at_scales
from ...curvatures.quantity import AT_SCALE, Quantity
from ...curvatures.registry import passes
from ...errors import UsageError
from ...mesh.scale import EstimatorSettings, Scale
from ...support.words import format_number, format_rounded, suggestion
from ..quantities import public
from .measured import Measured, StatisticOfColumn, values_of_parts
from .scopes import AssertedScope, ScopedStatistics, parse_scope

OPERATORS: dict[str, Callable[[Any, float], Any]] = {
    "<=": operator.le,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    ">": operator.gt,
}

_SHAPE = re.compile(r"\s*(?:([\w.]+)\s*\(\s*(\w+)\s*\)|([A-Za-z_]\w*))\s*([<>=!]+)\s*([^\s<>=!]+)\s*", re.ASCII)
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)


class AssertionVerdict(NamedTuple):
    """Verdict of an assertion on one group.

    held: True if it holds. value: the number compared, None where undefined. message: with both, and the place.
    """

    held: bool
    value: float | None
    message: str
    scope: str = "whole"


@dataclass(frozen=True)
class Assertion:
    """A number of the whole, of regions or of components, compared with a bound."""

    scope: AssertedScope
    measured: Measured
    comparison: str
    bound: float

    @property
    def name(self) -> str:
        """Text of the assertion as after --assert."""
        return f"{self.scope.prefix}{self.measured.call} {self.comparison} {format_number(self.bound)}"

    def judge(self, analysis: Result, by_scope: dict[str, ScopedStatistics] | None = None) -> list[AssertionVerdict]:
        """Verdict on each group; of very many groups, those that fail and one for the others.

        parts: the statistics of earlier assertions, by kind of scope.
        Errors: LackingError for a region that the mesh has not; UsageError for a value that is not computed.
        """
        known = {} if by_scope is None else by_scope
        part = known.setdefault(self.scope.kind, ScopedStatistics(analysis, self.scope.kind))
        chosen = self.scope.chosen(part)
        values = self.measured.values(part)[chosen]
        with np.errstate(invalid="ignore"):
            held = OPERATORS[self.comparison](values, self.bound) & ~np.isnan(values)
        if len(chosen) <= LISTED_GROUPS:
            return [self._verdict(part, chosen[k], values[k], held[k]) for k in range(len(chosen))]
        verdicts = [self._verdict(part, chosen[k], values[k], False) for k in np.flatnonzero(~held)]
        if held.any():
            low, high = (format_rounded(float(x)) for x in (values[held].min(), values[held].max()))
            message = f"{self.measured.call} is between {low} and {high} on {int(held.sum()):,} {self.scope.kind}s"
            verdicts.append(AssertionVerdict(True, None, message, f"{self.scope.kind}s"))
        return verdicts

    def _verdict(self, part: ScopedStatistics, group: int, value: float, held: bool) -> AssertionVerdict:
        scope, call = part.groups.scope(group), self.measured.call
        if np.isnan(value):
            return AssertionVerdict(False, None, f"{call} is undefined: {self.measured.undefined(part, group)}", scope)
        message = f"{call} = {format_rounded(float(value))}{self.measured.place(part, group)}"
        return AssertionVerdict(bool(held), float(value), message, scope)


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


def parse(text: str, scales: tuple[Scale, ...] = (), regions: bool = True) -> Assertion:
    """An assertion from `[SCOPE:] STAT(COLUMN) OP NUMBER` or `[SCOPE:] VALUE OP NUMBER`.

    regions: the mesh is divided into regions. Errors: UsageError that names the invalid part, with the nearest names.
    """
    try:
        return _parse(text, scales, regions)
    except UsageError as error:
        if str(error).startswith("assertion "):
            raise
        raise UsageError(f"assertion {text!r}: {error}") from None


def _parse(text: str, scales: tuple[Scale, ...], regions: bool) -> Assertion:
    scope, rest = parse_scope(text)
    if scope.kind == "region" and not regions:
        raise UsageError(f"assertion {text!r}: there are no regions without --regions")
    match = _SHAPE.fullmatch(rest)
    if match is None:
        raise UsageError(
            f"assertion {text!r}: expected STAT(COLUMN) OP NUMBER, such as 'absmax(h_signed) <= 50', or VALUE OP "
            "NUMBER, such as 'volume >= 100'"
        )
    statistic, column, value, comparison, bound = match.groups()
    if comparison not in OPERATORS:
        raise UsageError(f"assertion {text!r}: no comparison {comparison!r}, expected one of {' '.join(OPERATORS)}")
    if not _NUMBER.fullmatch(bound) or not math.isfinite(float(bound)):
        raise UsageError(f"assertion {text!r}: {bound!r} is not a number in the range of doubles")
    measured = _statistic(text, statistic, column, scales) if value is None else _value(text, value, scales, scope)
    return Assertion(scope, measured, comparison, float(bound))


def _statistic(text: str, statistic: str, column: str, scales: tuple[Scale, ...]) -> Measured:
    if not is_statistic(statistic):
        names = [*STATISTICS, "pNN", "area_pNN"]
        _known(text, "statistic", statistic, names, f"known: {', '.join(names)}")
    quantity = _quantity(text, column, scales)
    if statistic.startswith("area_") and quantity.on == "edge":
        raise UsageError(f"assertion {text!r}: edges have no area to weigh {column} by; use {statistic[5:]}")
    return StatisticOfColumn(statistic, quantity, column)


def _value(text: str, value: str, scales: tuple[Scale, ...], scope: AssertedScope) -> Measured:
    known = values_of_parts(_at(scales), scope.kind == "region")
    if value not in known and value in columns(scales):
        raise UsageError(f"assertion {text!r}: {value} is a column; expected a statistic of it, such as max({value})")
    _known(text, "value", value, known, "")
    return known[value]


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


def _known(text: str, what: str, name: str, known: Any, listing: str = "`curvcli passes` lists them") -> None:
    if name not in known:
        way_out = suggestion(name, known, listing) if listing else suggestion(name, known)
        raise UsageError(f"assertion {text!r}: unknown {what} {name!r}{way_out}")

"""Check: an identity with both sides, residual and a derived error bound as tolerance."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from ..mesh.groups import Groups
from ..mesh.triangles import EPSILON, NO_AREA
from ..support.arrays import Floats, Mask, Value, or_none

if TYPE_CHECKING:
    from ..mesh.surface import Surface

# The parameter of a check of the shares of regions, which runs once, on the whole surface.
SHARES = "shares"

# One text for all groups, or a text per group.
Words = str | Callable[[int], str]

# The numbers of a check, in the order of its fields.
_PARTS = ("value", "expected value", "residual", "tolerance")


@dataclass(frozen=True)
class Check:
    """One identity on one scope: its status is `pass`, `fail` or `not_applicable` with the reason in `detail`.

    name: of its function. scope: `whole`, or a component or region with its number or name.
    value, expected: both sides, numbers or vectors. residual: |value − expected|. tolerance: the largest residual that
    rounding can explain.
    """

    name: str
    scope: str
    status: str
    value: Value
    expected: Value
    residual: float | None
    tolerance: float | None
    detail: str


@dataclass
class IdentityValues:
    """An identity on every group at once.

    value, expected: (G,) or (G, 3). tolerance: (G,). length_exponent: of value, expected, residual and tolerance.
    excluded: reasons with masks of the groups they exclude. detail: a remark on a tested group.
    residual: (G,) if it differs from the length of value − expected.
    """

    value: Floats
    expected: Floats
    tolerance: Floats
    length_exponent: int = 0
    detail: Words = ""
    residual: Floats | None = None
    excluded: list[tuple[Mask, Words]] = field(default_factory=list)

    def exclude(self, mask: Mask, reason: Words) -> None:
        """Exclude the groups of a mask; the first reason of a group stands."""
        self.excluded.append((mask, reason))


@dataclass(frozen=True)
class CheckRule:
    """A registered check: a function of the surface, the groups and the quantities that its parameters name.

    needs: the quantities among its parameters. statement: the identity. gap: the residual as failures name it.
    applies: the condition for a test. bound: the derivation of the tolerance. failure: the meaning of a failure.
    of_shares: it compares the shares of all regions with the totals of the whole, and runs only where there are
    regions. after: the check that it follows in the report, "" for the first; None comes last.
    """

    name: str
    function: Callable[..., IdentityValues]
    needs: tuple[str, ...]
    statement: str
    gap: str = ""
    applies: str = ""
    bound: str = ""
    failure: str = ""
    of_shares: bool = False
    after: str | None = None

    def __reduce__(self) -> tuple[Callable[[str, str], CheckRule], tuple[str, str]]:
        """Pickle a rule by its name."""
        return _rule_of, (self.function.__module__, self.name)

    def run(self, surface: Surface, groups: Groups, columns: Mapping[str, Any]) -> list[Check]:
        """Evaluate the check on every group."""
        evaluated = self.evaluate(surface, groups, columns)
        return [evaluated.check(group) for group in range(groups.count)]

    def evaluate(self, surface: Surface, groups: Groups, columns: Mapping[str, Any]) -> EvaluatedCheck:
        """Evaluate both sides on every group at once."""
        given = [columns[name] for name in ((SHARES,) if self.of_shares else self.needs)]
        outcome = self.function(surface, groups, *given)
        with np.errstate(invalid="ignore"):  # infinite sides
            gap = outcome.value - outcome.expected
        residual = outcome.residual
        if residual is None:
            residual = np.abs(gap) if gap.ndim == 1 else np.sqrt((gap * gap).sum(axis=1))
        passed = residual <= outcome.tolerance  # NaN fails
        sides = (outcome.value, outcome.expected, residual, outcome.tolerance)
        shown = tuple(np.asarray(surface.in_file_unit(side, outcome.length_exponent)) for side in sides)
        return EvaluatedCheck(self.name, groups, outcome, passed, shown)


@dataclass(frozen=True)
class EvaluatedCheck:
    """One check on every group.

    passed: (G,) mask of the groups on which both sides agree. shown: value, expected value, residual and tolerance,
    (G,) or (G, 3), in the file's unit.
    """

    name: str
    groups: Groups
    outcome: IdentityValues
    passed: Mask
    shown: tuple[Floats, ...]

    @property
    def excluded(self) -> Mask:
        """(G,) mask of the groups to which the check does not apply."""
        mask = np.zeros(self.groups.count, bool)
        for excluded, _ in self.outcome.excluded:
            mask |= excluded
        return mask

    @property
    def in_range(self) -> Mask:
        """(G,) mask of the groups whose numbers a double holds in the file's unit."""
        finite = [np.isfinite(side).reshape(self.groups.count, -1).all(axis=1) for side in self.shown]
        return np.asarray(np.logical_and.reduce(finite))

    def check(self, group: int) -> Check:
        """The check on one group."""
        scope = self.groups.scope(group)
        for mask, reason in self.outcome.excluded:
            if mask[group]:
                return Check(self.name, scope, "not_applicable", None, None, None, None, _said(reason, group))
        detail = _said(self.outcome.detail, group)
        sides = [side[group].tolist() for side in self.shown]
        value, expected, residual, tolerance = map(_plain, sides)
        if not self.passed[group]:
            return Check(self.name, scope, "fail", value, expected, residual, tolerance, detail)
        null = [part for part, side in zip(_PARTS, sides, strict=True) if not np.isfinite(side).all()]
        if null:
            reason = f"no double holds its {', '.join(null)} in the file's unit"
            return Check(self.name, scope, "not_applicable", None, None, None, None, reason)
        return Check(self.name, scope, "pass", value, expected, residual, tolerance, detail)


# By name; `catalogue.identities` gives the order of the report.
registered: dict[str, CheckRule] = {}


def _rule_of(module: str, name: str) -> CheckRule:
    """The registered check with a name."""
    import_module(module)
    return registered[name]


def check(
    *, gap: str, applies: str, bound: str, failure: str, after: str | None = None
) -> Callable[[Callable[..., IdentityValues]], CheckRule]:
    """Register a check under its function's name; its parameters after surface and groups are the quantities it needs.

    The keywords are fields of `CheckRule`; the function's docstring is the identity.
    """

    def register(function: Callable[..., IdentityValues]) -> CheckRule:
        parameters = tuple(inspect.signature(function).parameters)[2:]
        of_shares = SHARES in parameters
        needs = () if of_shares else parameters
        statement = inspect.cleandoc(function.__doc__ or "")
        rule = CheckRule(function.__name__, function, needs, statement, gap, applies, bound, failure, of_shares, after)
        registered[rule.name] = rule
        return rule

    return register


def rounding(surface: Surface, absolute: Floats) -> Floats:
    """The error bound of a pairwise sum over the mesh: (16 + log₂ N) ε times the sum of the absolute terms.

    absolute: (G,) or (G, 3) sums of the absolute terms of each group; the result has the same shape and unit.
    The underflow of every face is added, which is negligible in the unit of computation.
    """
    lost = surface.n_faces * NO_AREA * 2**16
    return (16 + math.log2(3 * surface.n_faces + surface.n_vertices)) * EPSILON * absolute + lost


def exclude_null(outcome: IdentityValues, groups: Groups, surface: Surface, null: Mask, what: str) -> None:
    """Exclude the groups in which a term of the identity is null at a referenced vertex.

    null: (V,) mask. what: the name of the term, for the reason.
    """
    where = np.flatnonzero(null & surface.referenced)
    if not len(where):
        return
    label = groups.vertices.label
    group = np.zeros(len(where), np.int64) if label is None else label[where]
    count, first = np.bincount(group, minlength=groups.count), np.full(groups.count, -1)
    first[group[::-1]] = where[::-1]

    def reason(g: int) -> str:
        # The vertices of a region are copies, without numbers in the file.
        known = groups.kind != "region"
        if count[g] == 1:
            return f"{what} is undefined at {f'vertex {first[g]}' if known else 'one vertex'}"
        return f"{what} is undefined at {count[g]} vertices" + (f", the first is {first[g]}" if known else "")

    outcome.exclude(count > 0, reason)


def _said(text: Words, group: int) -> str:
    return text if isinstance(text, str) else text(group)


def _plain(value: Any) -> Any:
    """A number or a list of numbers; None for NaN and infinity."""
    if isinstance(value, list):
        return [_plain(x) for x in value]
    return or_none(value)

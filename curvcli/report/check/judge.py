"""Verdict of `curvcli check`: the identities, requirements and assertions that a mesh has to pass, and the outcomes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from ...analysis.result import Result
from ...checks.base import Check
from ...checks.catalogue import identities
from ...checks.requirements.base import Required
from ...checks.requirements.catalogue import defaults, parse, parse_sets, requirements
from ...checks.requirements.faults import FaultyElements, elements_of
from ...checks.requirements.topology import manifold
from ...curvatures.catalogue import load_passes
from ...curvatures.engine import evaluate
from ...curvatures.registry import passes
from ...errors import FAILED_CHECK, OK, UsageError
from ...mesh.scale import Scale
from ...mesh.surface import Surface
from ...support.arrays import or_none
from ...support.words import escape_text, format_rounded, suggestion
from ..model import CONVENTIONS
from . import assertions
from .assertions import Assertion
from .model import ASSERTION, FAIL, IDENTITY, INPUT, PASS, REQUIREMENT, CheckedMesh, FaultPlace, Outcome, Rule
from .scopes import ScopedStatistics

# FaultyElements named for each kind of fault of a requirement.
_PLACES = 10

READABLE = "The mesh can be read and is a surface"


@dataclass(frozen=True)
class Plan:
    """Checks of every mesh."""

    identities: tuple[str, ...]
    requirements: tuple[Required, ...]
    assertions: tuple[Assertion, ...]

    @property
    def passes(self) -> list[str]:
        """The columns that the assertions need."""
        return [name for assertion in self.assertions for name in assertion.measured.passes]

    @property
    def rules(self) -> list[Rule]:
        """Every check, with the meaning of a pass."""
        return [
            Rule("input", INPUT, READABLE),
            *(Rule(name, IDENTITY, _statement(name)) for name in self.identities),
            *(
                Rule(requirement.name, REQUIREMENT, requirement.requirement.statement)
                for requirement in self.requirements
            ),
            *(Rule(assertion.name, ASSERTION, f"{assertion.name}, nulls left out") for assertion in self.assertions),
        ]


def plan(
    require: Iterable[str] = (),
    allow: Iterable[str] = (),
    asserted: Iterable[str] = (),
    scales: tuple[Scale, ...] = (),
    regions: bool = False,
    sets: Iterable[str] = (),
) -> Plan:
    """All identities and the default requirements, plus `require` and `asserted`, without those in `allow`.

    require, allow: names or comma lists of names. asserted: `STAT(COLUMN) OP NUMBER`. scales: at which estimates are
    made; of several, each has columns of its own. regions: the meshes are divided into regions. sets: of requirements,
    `NAME=REQUIREMENT,…`, beside the built-in ones.
    Errors: UsageError for an unknown name, with the nearest.
    """
    load_passes()  # plug-ins may bring identities of their own
    known = [*requirements(), *identities()]
    allowed = {part.strip() for text in allow for part in text.split(",")}
    for name in sorted(allowed.difference(known)):
        way_out = suggestion(name, known, "`curvcli help checks` lists them")
        raise UsageError(f"cannot allow {name!r}: no such requirement or identity{way_out}")
    wanted = parse([*defaults(), *require], parse_sets(sets))
    return Plan(
        tuple(name for name, rule in identities().items() if name not in allowed and (regions or not rule.of_shares)),
        tuple(required for required in wanted if required.requirement.name not in allowed),
        tuple(dict.fromkeys(assertions.parse(text, scales, regions) for text in asserted)),
    )


def judge(
    analysis: Result, chosen: Plan, path: str, failing: list[tuple[str, FaultyElements]] | None = None
) -> CheckedMesh:
    """Run every check of the plan on an analysis that tested the plan's identities.

    failing: takes the elements that fail each requirement.
    """
    flaw = manifold(analysis.surface)
    given = _given(analysis, chosen)
    problems = [(required, required.problem(analysis.surface, given)) for required in chosen.requirements]
    if failing is not None:
        failing += [(required.name, each) for required, problem in problems for each in elements_of(problem)]
    outcomes = [
        *(_of_identity(check, flaw) for check in analysis.checks),
        *(_of_requirement(required, problem, analysis.surface) for required, problem in problems),
        *_of_assertions(chosen.assertions, analysis),
    ]
    failed = any(outcome.status == FAIL for outcome in outcomes)
    file, conventions = analysis.surface.file, analysis.conventions
    return CheckedMesh(
        path,
        file.sha256 if file is not None else None,
        FAIL if failed else PASS,
        FAILED_CHECK if failed else OK,
        {key: getattr(conventions, key) for key in CONVENTIONS},
        outcomes,
        analysis.notices,
    )


def _of_identity(check: Check, flaw: str) -> Outcome:
    """Outcome of an identity. flaw: the defect of the mesh that a failure may come from."""
    match check.status:
        case "pass":
            message = _statement(check.name)
        case "fail":
            message = "; ".join(part for part in (gap(check), check.detail, flaw) if part)
        case _:
            message = check.detail
    return Outcome(
        check.name,
        IDENTITY,
        escape_text(check.scope),
        check.status,
        escape_text(message),
        check.value,
        check.expected,
        check.residual,
        check.tolerance,
    )


def gap(check: Check) -> str:
    """Residual of a failing identity: `ΣK + Σκ_g − 2πχ = 3.1416 (allowed 2e-11)`."""
    rule = identities().get(check.name)
    name = rule.gap if rule and rule.gap else "residual"
    residual, sides = check.residual, (check.value, check.expected)
    if isinstance(sides[0], float) and isinstance(sides[1], float) and abs(sides[0] - sides[1]) == residual:
        residual = sides[0] - sides[1]
    elif name != "residual":
        name = f"|{name}|"
    return f"{name} = {format_rounded(residual, 5)} (allowed {format_rounded(check.tolerance, 1)})"


def _statement(name: str) -> str:
    return identities()[name].statement.split("\n\n")[0].replace("\n", " ").rstrip(".")


def _given(analysis: Result, chosen: Plan) -> dict[str, Any]:
    """Quantities that the requirements need, and the convention for H."""
    needs = {need for requirement in chosen.requirements for need in requirement.requirement.needs} - {"mean"}
    area, known = analysis.request.area, analysis.columns
    return {**evaluate(passes, analysis.surface, needs, area=area, known=known), "mean": analysis.request.mean}


def _of_requirement(required: Required, problem: str, surface: Surface) -> Outcome:
    status, message = (FAIL, str(problem)) if problem else (PASS, required.requirement.statement)
    elements = elements_of(problem)
    return Outcome(
        required.name,
        REQUIREMENT,
        "whole",
        status,
        message,
        elements=sum(len(each.numbers) for each in elements),
        places=_places(surface, elements),
    )


def _places(surface: Surface, elements: Iterable[FaultyElements]) -> list[FaultPlace]:
    """The first elements of each kind, with their positions."""
    fault_places = []
    for each in elements:
        first = FaultyElements(each.kind, each.numbers[:_PLACES])
        positions = first.positions(surface).tolist()
        fault_places += [
            FaultPlace(name, [or_none(x) for x in position])
            for name, position in zip(first.names(surface), positions, strict=True)
        ]
    return fault_places


def _of_assertions(chosen: Iterable[Assertion], analysis: Result) -> Iterator[Outcome]:
    """Outcomes of every assertion on the whole, or on each of its regions or components."""
    by_scope: dict[str, ScopedStatistics] = {}
    for assertion in chosen:
        for verdict in assertion.judge(analysis, by_scope):
            status, scope = PASS if verdict.held else FAIL, escape_text(verdict.scope)
            yield Outcome(assertion.name, ASSERTION, scope, status, verdict.message, verdict.value, assertion.bound)

"""Failures and warnings of a check as lines: the first of each kind, then a count."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from ...errors import Notice
from ...support.words import counted, escape_text
from .model import FAIL, PASS, CheckedMesh, Outcome, sentence

# Limits without -v: failures of one check of one mesh, failures in all, and warnings in all.
FIRST, MOST, WARNINGS = 5, 100, 20

# Words for the pieces of a mesh, by the first word of a scope.
_PIECES = {"component": "component", "region": "region"}


@dataclass(frozen=True)
class Failure:
    """One line about a mesh: its first outcome, the sentence, and the number of outcomes it stands for."""

    mesh: CheckedMesh
    outcome: Outcome
    text: str
    count: int = 1


def failures(mesh: CheckedMesh, first: int | None = FIRST) -> Iterator[Failure]:
    """Failures and errors; of each check the first few, and one line for the others (None: all)."""
    for outcomes in by_name(mesh.trouble):
        # A count is no shorter than one more failure.
        most = len(outcomes) if first is None or len(outcomes) <= first + 1 else first
        for outcome in outcomes[:most]:
            yield Failure(mesh, outcome, sentence(mesh, outcome))
        if rest := outcomes[most:]:
            text = f"{escape_text(mesh.path)}: {escape_text(rest[0].name)} fails on {scopes(rest, 'more ')}"
            yield Failure(mesh, rest[0], text, len(rest))


def all_failures(
    meshes: Iterable[CheckedMesh], first: int | None = FIRST, most: int | None = MOST
) -> tuple[list[Failure], str]:
    """Failures of several meshes, and a sentence about those beyond the first `most` lines (None: all)."""
    lines = [line for mesh in meshes for line in failures(mesh, first)]
    if most is None or len(lines) <= most:
        return lines, ""
    rest = lines[most:]
    count, files = sum(line.count for line in rest), len({id(line.mesh) for line in rest})
    return lines[:most], f"{counted(count, 'more failure')} in {counted(files, 'mesh', 'meshes')}"


def by_name(outcomes: Iterable[Outcome]) -> list[list[Outcome]]:
    """Outcomes by check, in the order of the first of each."""
    groups: dict[tuple[str, str], list[Outcome]] = {}
    for outcome in outcomes:
        groups.setdefault((outcome.name, outcome.status), []).append(outcome)
    return list(groups.values())


def scopes(outcomes: Sequence[Outcome], more: str = "") -> str:
    """Scopes of the outcomes of one check: `whole, 100 components`."""
    kinds: dict[str, int] = {}
    whole = []
    for outcome in outcomes:
        if outcome.scope == "whole":
            whole = ["whole"]
        else:
            word = _PIECES.get(outcome.scope.split(" ", 1)[0], "other scope")
            kinds[word] = kinds.get(word, 0) + 1
    if len(outcomes) == 1 and not whole and not more:
        return outcomes[0].scope
    return ", ".join([*whole, *(f"{number:,} {more}{word}{'s' * (number > 1)}" for word, number in kinds.items())])


def warnings(
    meshes: Sequence[CheckedMesh], most: int | None = WARNINGS
) -> tuple[list[tuple[CheckedMesh, Notice]], int]:
    """Warnings of a lone mesh, or of several meshes that fail (None: of all), and the number left out."""
    chosen = [mesh for mesh in meshes if most is None or len(meshes) == 1 or mesh.status == FAIL]
    remarks = [(mesh, remark) for mesh in chosen for remark in mesh.warnings]
    kept = remarks if most is None else remarks[:most]
    return kept, len(remarks) - len(kept)


def warning(mesh: CheckedMesh, remark: Notice) -> str:
    """Warning in one line, with the first places and the hint."""
    first = (
        f" (first: {', '.join(escape_text(str(place)) for place in remark.examples[:3])})" if remark.examples else ""
    )
    hint = f"; {escape_text(remark.hint)}" if remark.hint else ""
    return f"{escape_text(mesh.path)}: {remark.code}: {remark.count:,} {escape_text(remark.message)}{first}{hint}"


def meshes_pass(meshes: Sequence[CheckedMesh]) -> str:
    """Number of meshes that pass, in words."""
    passed = sum(mesh.status == PASS for mesh in meshes)
    if len(meshes) > 1:
        return f"{passed:,} of {len(meshes):,} meshes pass"
    return f"the mesh {'passes' if passed else 'does not pass'}"

"""Meshes through the gate without the command line, and as files for it."""

from __future__ import annotations

from typing import Any

from curvcli.api import analyze
from curvcli.report.check.judge import judge, plan
from curvcli.report.check.model import CheckedMesh, CheckReport, Outcome, report_of
from tests.helpers.meshes import Mesh


def judged(given: Any, require: str = "", allow: str = "", path: str = "mesh.obj", **options: Any) -> CheckedMesh:
    """A Mesh or a path, judged. options: `asserted`, or those of analyze."""
    asserted = options.pop("asserted", ())
    chosen = plan([require] if require else [], [allow] if allow else [], asserted)
    surface = (given.points, given.faces) if isinstance(given, Mesh) else given
    return judge(analyze(surface, chosen.passes or ["topology"], checks=chosen.identities, **options), chosen, path)


def outcome(mesh: CheckedMesh, name: str, scope: str = "whole") -> Outcome:
    """The one outcome of that name."""
    (found,) = (one for one in mesh.outcomes if one.name == name and one.scope == scope)
    return found


def report(*meshes: CheckedMesh, exit_code: int = 1, require: str = "", asserted: tuple[str, ...] = ()) -> CheckReport:
    return report_of(plan([require] if require else [], [], asserted).rules, list(meshes), exit_code)

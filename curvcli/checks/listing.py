"""Names of checks, and a summary of the checks of very many groups."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from ..errors import UsageError
from ..support.words import suggestion
from .base import Check, rules


def summarise_checks(checks: list[Check], scope: str) -> list[Check]:
    """Keep the failed checks of very many groups, and summarise the rest in one line."""
    failed = [check for check in checks if check.status == "fail"]
    if failed or not checks:
        return failed
    passed = sum(check.status == "pass" for check in checks)
    worst = max((check for check in checks if check.status == "pass"), key=_strain, default=None)
    if worst is None:
        return [Check(checks[0].name, scope, "not_applicable", None, None, None, None, checks[0].detail)]
    detail = f"{passed} of {len(checks)} {scope} pass, the others are not applicable; {worst.scope} is the closest call"
    return [replace(worst, scope=scope, detail=detail)]


def _strain(check: Check) -> float:
    return check.residual / check.tolerance if check.residual and check.tolerance else 0.0


def known_checks(names: str | Iterable[str]) -> list[str]:
    """Parse names of identities, also in comma lists, into the order of the report.

    Errors: UsageError for an unknown name, with similar ones.
    """
    entries = [names] if isinstance(names, str) else names
    wanted = {name.strip() for entry in entries for name in entry.split(",")}
    for name in sorted(wanted - rules.keys()):
        raise UsageError(f"unknown check {name!r}{suggestion(name, rules, '`curvcli help checks` lists them')}")
    return [name for name in rules if name in wanted]

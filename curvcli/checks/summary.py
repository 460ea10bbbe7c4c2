"""Summary of a check over very many groups."""

from __future__ import annotations

from dataclasses import replace

from .base import Check


def summarise_checks(checks: list[Check], scope: str) -> list[Check]:
    """Keep the failed checks of very many groups, or summarise all in one line where none fails."""
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

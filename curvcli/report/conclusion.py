"""Meaning of a report's identities: properties of the mesh that they prove, and properties that they cannot prove."""

from __future__ import annotations

from ..checks.base import Check
from .model import Report


def conclusion(report: Report) -> str:
    """One or two sentences for people: identities that hold, fail or are not tested, and their limits."""
    failed = [row for row in report.checks if row.status == "fail"]
    if failed:
        return _distrust(failed)
    flaws = len(report.warnings)
    mind = f"mind the {flaws} warnings above" if flaws > 1 else "mind the warning above"
    limits = (
        f"they hold on flawed meshes too: {mind}" if flaws else "none can tell whether the mesh is the one you meant"
    )
    main = next((row for row in report.checks if row.name == "gauss_bonnet" and row.scope == "whole"), None)
    if main is not None and main.status == "pass":
        return f"Gauss–Bonnet certifies ΣK and χ, the other identities the columns they sum; {limits}."
    why = f": {main.detail}" if main is not None else ", it is not tested"
    return f"Gauss–Bonnet certifies nothing here{why}. Identities that pass certify the columns they sum; {limits}."


def holds(report: Report) -> bool:
    """True if no identity fails."""
    return all(row.status != "fail" for row in report.checks)


def _distrust(failed: list[Check]) -> str:
    """Sentence on failures: they exceed the rounding bound, so the numbers are wrong."""
    names = sorted({row.name for row in failed})
    scopes = sorted({row.scope for row in failed} - {"whole"})
    where = f" on {scopes[0]}" if len(scopes) == 1 else f" on {len(scopes):,} pieces" if scopes else ""
    verb = "does" if len(names) == 1 else "do"
    return (
        f"{', '.join(names)} {verb} not hold{where}, more than rounding explains: do not trust the columns they sum. "
        "No flaw of a mesh does that, only numbers at the limits of doubles or a defect of curvcli: please report it."
    )

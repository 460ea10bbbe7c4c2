"""Lookup of one value of a report by its path, for shell scripts."""

from __future__ import annotations

from typing import Any

from ..curvatures.derived import derived
from ..errors import LackingError
from ..support.words import escape_json, escape_text, suggestion
from .model import Piece, one_line
from .quantities import asked_by, public, smallest_preset


def look_up(report: dict[str, Any], path: str) -> str:
    """Value at a dotted path as text: numbers in their shortest form, `null` where undefined, JSON for the rest.

    Words are on one line, with characters that cannot be printed escaped; JSON has them as they are.

    Members of lists are named by index, or by a `name` or `code` that is no index: `checks.gauss_bonnet.status`,
    `components.0`.
    Errors: LackingError for a path without a value, with the existing keys, or the passes that a key needs.
    """
    value: Any = report
    walked = ""
    for key in path.split("."):
        members = _members(value)
        if key not in members:
            raise LackingError(f"--get {path}: {_why_not(report, value, walked, key)}")
        value = members[key]
        walked = f"{walked}.{key}" if walked else key
    return escape_text(value) if isinstance(value, str) else escape_json(one_line(value)).decode()


def _members(value: Any) -> dict[str, Any]:
    if isinstance(value, dict):
        return value
    if not isinstance(value, list):
        return {}
    members: dict[str, Any] = {}
    for member in reversed(value):
        if isinstance(member, dict) and (name := member.get("name", member.get("code"))) is not None:
            members[name] = member
    return members | {str(index): member for index, member in enumerate(value)}


def _why_not(report: dict[str, Any], value: Any, walked: str, key: str) -> str:
    """Message for a missing key: the existing keys, or the passes that add it."""
    if value in ([], {}):
        return f"{walked} is empty"
    members = _members(value)
    if not members:
        return f"{walked} is a single value"
    # Only the report of analyze depends on chosen passes.
    if "topology" in report and (added := _added_by(key, members, walked)):
        return f"is not computed; {added} adds it"
    listing = f"`--get {walked}` shows them" if walked else "`--json` shows them"
    return f"no {key!r} {f'in {walked}' if walked else 'in the report'}{suggestion(key, members, listing)}"


def _added_by(key: str, members: dict[str, Any], walked: str) -> str | None:
    """Passes that add a key to a report; None for a key that no pass adds."""
    if "topology" in members:
        return "-p paper" if key in Piece.__struct_fields__ and key != "name" else None
    for quantity in public():
        keys = {"totals": (quantity.total,), "columns": quantity.columns if quantity.on == "vertex" else ()}
        if key in keys.get(walked.rpartition(".")[2], ()):
            return f"-p {smallest_preset(quantity)} or -p {quantity.name}"
    if walked.rpartition(".")[2] == "totals" and key in derived:
        return asked_by(derived[key])
    return None

"""One value of a report by its path, for shell scripts."""

from __future__ import annotations

from difflib import get_close_matches
from typing import Any

import msgspec

from ..errors import UsageError


def look_up(report: dict[str, Any], path: str) -> str:
    """The value at a dotted path as text: numbers in their shortest form, `null` where undefined, JSON for the rest.

    Members of lists are named by index, or by their `name` or `code`: `checks.gauss_bonnet.status`, `components.0`.
    Errors: UsageError for a path that leads nowhere, with the keys there are.
    """
    value: Any = report
    walked = ""
    for key in path.split("."):
        members = _members(value)
        if key not in members:
            near = get_close_matches(key, members, 3, 0.4) or list(members)[:12]
            place = f"in {walked}" if walked else "in the report"
            if not near:
                raise UsageError(f"--get {path}: {walked} is a single value")
            raise UsageError(f"--get {path}: no {key!r} {place}, expected one of {', '.join(near)}")
        value = members[key]
        walked = f"{walked}.{key}" if walked else key
    if isinstance(value, str):
        return value
    return msgspec.json.encode(value).decode()


def _members(value: Any) -> dict[str, Any]:
    if isinstance(value, dict):
        return value
    if not isinstance(value, list):
        return {}
    members = {str(index): member for index, member in enumerate(value)}
    for member in reversed(value):
        if isinstance(member, dict) and (name := member.get("name", member.get("code"))) is not None:
            members[name] = member
    return members

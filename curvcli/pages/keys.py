"""The keys of the report, from its JSON Schema."""

from __future__ import annotations

import json
from typing import Any

from ..report.model import schema


def page_part() -> str:
    """One table per object of the report: keys and the types of their values."""
    parts = []
    for name, one in json.loads(schema())["$defs"].items():
        parts += [f"### {name}\n", f"{one.get('description', '')}\n", "| key | value |", "|---|---|"]
        for key, value in one["properties"].items():
            absent = "" if key in one.get("required", ()) else ", or absent"
            parts.append(f"| `{key}` | {_type(value)}{absent} |")
        parts.append("")
    return "\n".join(parts)


def _type(value: dict[str, Any]) -> str:
    """A type in words."""
    if "$ref" in value:
        name = value["$ref"].rpartition("/")[2]
        return f"[{name}](#{name.lower()})"
    if "anyOf" in value:
        return " or ".join(dict.fromkeys(_type(one) for one in value["anyOf"]))
    kind = str(value.get("type", "any"))
    if kind == "array":
        each = _type(value["items"])
        return f"list ({each})" if " or " in each else f"list of {each}"
    if kind == "object" and isinstance(value.get("additionalProperties"), dict):
        return f"by name, {_type(value['additionalProperties'])}"
    return kind

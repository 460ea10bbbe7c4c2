"""The page of the JSON outputs: the keys of every object, from the schemas."""

from __future__ import annotations

import json
from typing import Any

from curvcli.commands.schemas import SCHEMAS

_INTRODUCTION = """\
# Schemas

The package has the JSON Schemas in `curvcli/commands/data/schemas/`. `--schema` of a command prints them with the names
of all columns. A value that was not computed is absent; an undefined value is null. `schema_version` counts
incompatible changes: see [compatibility](compatibility.md).
"""


def page() -> str:
    """One section per schema, one table per object: keys and the types of their values."""
    parts = [_INTRODUCTION]
    for name, written in SCHEMAS.items():
        schema = json.loads(written.stored())
        tops = " or ".join(_type(one, name) for one in schema.get("oneOf", [schema]))
        parts.append(f"## {name}\n\n{written.command}: {tops}.\n")
        for kind, one in schema["$defs"].items():
            parts += [f"### {name}: {kind}\n", f"{one.get('description', '')}\n", "| key | value |", "|---|---|"]
            for key, value in one["properties"].items():
                absent = "" if key in one.get("required", ()) else ", or absent"
                parts.append(f"| `{key}` | {_type(value, name)}{absent} |")
            parts.append("")
    return "\n".join(parts)


def _link(schema: str, kind: str) -> str:
    return f"[{kind}](#{schema}-{kind.lower()})"


def _type(value: dict[str, Any], schema: str) -> str:
    """A type in words."""
    if "$ref" in value:
        return _link(schema, value["$ref"].rpartition("/")[2])
    if "anyOf" in value:
        return " or ".join(dict.fromkeys(_type(one, schema) for one in value["anyOf"]))
    if "enum" in value:
        return " or ".join(f"`{one}`" for one in value["enum"])
    kind = str(value.get("type", "any"))
    if kind == "array" and value.get("items"):
        each = _type(value["items"], schema)
        return f"list ({each})" if " or " in each else f"list of {each}"
    if kind == "object" and isinstance(value.get("additionalProperties"), dict):
        return f"{{name: {_type(value['additionalProperties'], schema)}}}"
    return {"array": "list", "null": "null"}.get(kind, kind)

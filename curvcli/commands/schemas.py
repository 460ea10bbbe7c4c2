"""JSON Schemas of all JSON output; `python -m curvcli.commands.schemas` writes the files.

The files in `curvcli/commands/data/schemas` leave the names of columns open, since plug-ins add their own. `--schema`
prints the names.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from inspect import cleandoc
from pathlib import Path
from typing import Any

import msgspec

from .._version import __version__
from ..batch.model import Row
from ..report.accuracy import Accuracy
from ..report.check.model import CheckReport
from ..report.compare.model import Comparison
from ..report.curves import CurveReport
from ..report.groups.model import GroupComparison
from ..report.groups.vertexwise import VertexwiseReport
from ..report.maps import MapReport
from ..report.model import Report, encode, require_all_keys
from ..report.model import schema as report_schema
from ..report.quantities import Facts
from ..support.words import escape_json
from .talk import put

DRAFT = "https://json-schema.org/draft/2020-12/schema"
FOLDER = Path(__file__).parent / "data" / "schemas"


@dataclass(frozen=True)
class Described:
    """command: the command that writes it. types: its types. full: the printed schema, where the file has less."""

    command: str
    types: tuple[Any, ...]
    full: Callable[[], bytes] | None = None

    def stored(self) -> bytes:
        """Content of the schema file."""
        alternatives, definitions = msgspec.json.schema_components(self.types)
        require_all_keys(definitions)
        for definition in definitions.values():
            if "description" in definition:
                # as Python keeps docstrings from 3.13 on
                definition["description"] = cleandoc(definition["description"])
            for value in definition.get("properties", {}).values():
                if value.get("default") == __version__:
                    del value["default"]  # defaults apply only to the writer
        body = alternatives[0] if len(alternatives) == 1 else {"oneOf": list(alternatives)}
        return encode({"$schema": DRAFT, "title": self.command, **body, "$defs": definitions})

    def printed(self) -> bytes:
        """Schema as printed by --schema."""
        return self.full() if self.full is not None else self.stored()


SCHEMAS: dict[str, Described] = {
    "analyze": Described("curvcli analyze --json, -o FILE.json", (Report,), report_schema),
    "check": Described("curvcli check --format json", (CheckReport,)),
    "compare": Described(
        "curvcli compare --json, also with --map, exact values or groups",
        (Comparison, Accuracy, MapReport, GroupComparison, VertexwiseReport),
    ),
    "curves": Described("curvcli curves --json", (CurveReport,)),
    "passes": Described("curvcli passes --json, a list; with NAME one of it", (list[Facts], Facts)),
    "batch": Described("a line of manifest.jsonl, by curvcli batch", (Row,)),
}


def path_of(name: str) -> Path:
    """Path of a schema file."""
    return FOLDER / f"{name}.schema.json"


def write() -> None:
    """Write all schema files."""
    FOLDER.mkdir(exist_ok=True)
    for name, schema in SCHEMAS.items():
        path_of(name).write_bytes(schema.stored())


def say(name: str) -> None:
    """Print one schema on stdout."""
    text = json.dumps(json.loads(SCHEMAS[name].printed()), indent=2, ensure_ascii=False)
    put(escape_json(text.encode("utf-8")).decode("utf-8") + "\n")


if __name__ == "__main__":
    write()

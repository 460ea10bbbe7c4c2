"""Cases on disk: one line of JSON that says how curvcli was called, then the bytes of the file."""

from __future__ import annotations

import json
from pathlib import Path

from tests.fuzz.cases import Case

FOLDER = Path(__file__).parent / "corpus"


def store(case: Case, path: Path) -> None:
    """Write a case."""
    head = {"name": case.name, "command": case.command, "options": case.options, "outputs": case.outputs}
    path.write_bytes(json.dumps(head).encode() + b"\n" + case.data)


def load(path: Path) -> Case:
    """Read a case."""
    line, _, data = path.read_bytes().partition(b"\n")
    head = json.loads(line)
    outputs = tuple((option, name) for option, name in head["outputs"])
    return Case(head["name"], data, head["command"], tuple(head["options"]), outputs)

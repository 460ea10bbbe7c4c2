"""Tables of the formats of inputs and outputs, and the pattern of the pre-commit hook."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path

from curvcli.loading.registry import InputFormat, input_formats, suffixes
from curvcli.output.registry import output_formats

_HOLDS = {
    "table": "rows and columns",
    "mesh": "the surface with its columns",
    "triangles": "the surface alone, of `curvcli sample` only",
    "overlay": "columns of vertices, to lay over the surface that was read",
    "report": "the report",
    "page": "the report, to be read",
    "picture": "a picture",
}

# CPU seconds of each reader per million vertices, by `python -m benchmarks.reading --save`.
_MEASURED = Path(__file__).parent.parent / "validation" / "reading.json"

_READERS: dict[str, Callable[[InputFormat], str]] = {
    "suffix": lambda one: ", ".join(f"`.{ending}`" for ending in one.endings),
    "encodings": lambda one: one.encodings,
    "library": lambda one: one.library or "none",
    "extra": lambda one: f"`{one.extra}`" if one.extra else "none",
    "CPU seconds per million vertices": lambda one: _seconds(one.name),
}
_CONTENT: dict[str, Callable[[InputFormat], str]] = {
    "rows of the vertex table": lambda one: one.rows,
    "digits": lambda one: one.digits,
    "merged by default": lambda one: "equal positions" if one.separate_corners or one.seams else "nothing",
    "kept beside the results": lambda one: one.keeps,
    "labels for `--regions`": lambda one: one.labels,
    "polygons": lambda one: one.polygons,
    "curves": lambda one: one.curves,
}


def outputs() -> str:
    """The suffixes of outputs, with content and format."""
    rows = [f"| `{one.suffix}` | {_HOLDS[one.kind]} | {one.description} |" for one in output_formats().values()]
    return "\n".join(["| suffix | holds | format |", "|---|---|---|", *rows]) + "\n"


def inputs() -> str:
    """The formats of inputs, a row each: their readers, then their content."""
    return "\n".join([_table(_READERS), _table(_CONTENT)])


def _table(cells: dict[str, Callable[[InputFormat], str]]) -> str:
    head = ["", *cells]
    rows = [[f"**{one.title}**", *(cell(one) for cell in cells.values())] for one in input_formats().values()]
    lines = [" | ".join(head).strip(), *(" | ".join(row) for row in rows)]
    return f"| {lines[0]} |\n{'|---' * len(head)}|\n" + "".join(f"| {line} |\n" for line in lines[1:])


@cache
def _measured() -> dict[str, dict[str, float]]:
    measured: dict[str, dict[str, float]] = json.loads(_MEASURED.read_text(encoding="utf-8"))
    return measured


def _seconds(name: str) -> str:
    """The seconds of curvcli, and of the other readers."""
    seconds = _measured().get(name, {})
    others = ", ".join(f"{reader} {value:g}" for reader, value in seconds.items() if reader != "curvcli")
    ours = f"{seconds['curvcli']:g}" if "curvcli" in seconds else "not measured"
    return f"{ours} ({others})" if others else ours


def hook(text: str) -> str:
    """The hooks of pre-commit with the pattern of the names of meshes."""
    return re.sub(r"(?m)^  files: .*$", lambda _: rf"  files: (?i)\.({'|'.join(suffixes())})(\.gz)?$", text)

"""Tables of the formats of inputs and outputs, and the pattern of the pre-commit hook."""

from __future__ import annotations

import re
from collections.abc import Callable

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

_ROWS: dict[str, Callable[[InputFormat], str]] = {
    "suffix": lambda one: ", ".join(f"`.{ending}`" for ending in one.endings),
    "encodings": lambda one: one.encodings,
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
    """The formats of inputs, a column each."""
    formats = input_formats().values()
    head = ["", *(one.title for one in formats)]
    rows = [[row, *(cell(one) for one in formats)] for row, cell in _ROWS.items()]
    return (
        "\n".join(["| " + " | ".join(head).strip() + " |", "|---" * len(head) + "|"])
        + "\n"
        + "".join(f"| {' | '.join(cells)} |\n" for cells in rows)
    )


def hook(text: str) -> str:
    """The hooks of pre-commit with the pattern of the names of meshes."""
    return re.sub(r"(?m)^  files: .*$", lambda _: rf"  files: (?i)\.({'|'.join(suffixes())})(\.gz)?$", text)

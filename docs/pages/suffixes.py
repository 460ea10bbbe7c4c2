"""The formats of outputs as a table."""

from __future__ import annotations

from curvcli.output.formats import FORMATS

_HOLDS = {
    "table": "rows and columns",
    "mesh": "the surface with its columns",
    "triangles": "the surface alone, of `curvcli sample` only",
    "report": "the report",
    "page": "the report, to be read",
    "picture": "a picture",
}


def page_part() -> str:
    """The suffixes of outputs, what they hold and how."""
    rows = [f"| `{one.suffix}` | {_HOLDS[one.kind]} | {one.description} |" for one in FORMATS.values()]
    return "\n".join(["| suffix | holds | format |", "|---|---|---|", *rows]) + "\n"

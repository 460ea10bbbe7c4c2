"""Output formats by suffix: the one list that every option and every message uses."""

from __future__ import annotations

import os
from collections.abc import Collection
from dataclasses import dataclass
from typing import Literal

from ..errors import UsageError
from ..support.words import escape_text, suggestion

Kind = Literal["table", "mesh", "triangles", "report", "page", "picture"]


@dataclass(frozen=True)
class Format:
    """One kind of file: its suffix with the dot, its content (`triangles`: no columns), and a line for the help."""

    suffix: str
    kind: Kind
    description: str


FORMATS: dict[str, Format] = {
    format.suffix: format
    for format in (
        Format(".csv", "table", "table, comma-separated"),
        Format(".tsv", "table", "table, tab-separated"),
        Format(".parquet", "table", "table, Apache Parquet"),
        Format(".npz", "table", "table, numpy arrays"),
        Format(".ply", "mesh", "mesh with every column as a property, binary"),
        Format(".obj", "mesh", "mesh with vertex colours, text"),
        Format(".vtp", "mesh", "mesh with every column as an array, VTK polygons"),
        Format(".vtu", "mesh", "mesh with every column as an array, VTK unstructured grid"),
        Format(".glb", "mesh", "mesh with vertex colours, binary glTF, float32"),
        Format(".stl", "triangles", "triangles, binary, float32"),
        Format(".json", "report", "report, JSON"),
        Format(".html", "page", "report as one page with a 3D view of the surface, HTML"),
        Format(".md", "page", "report for pull requests, Markdown"),
        Format(".png", "picture", "picture of the coloured surface"),
        Format(".hist.png", "picture", "histogram and area-weighted distribution of columns"),
    )
}


def suffixes(kinds: Collection[Kind] | None = None) -> tuple[str, ...]:
    """Suffixes of these kinds, or of all, in the order of the documentation."""
    return tuple(suffix for suffix, format in FORMATS.items() if kinds is None or format.kind in kinds)


def format_of(path: str, *, name: str | None = None, kinds: Collection[Kind] | None = None) -> Format:
    """Format of an output: `name` (as in `--format csv`) if given, else by the suffix of the path.

    Errors: UsageError for an unknown suffix or name, with the known ones.
    """
    promised = suffixes(kinds)
    given = name if name is not None else _suffix(path)
    if name is None and path == "-":
        raise UsageError(f"-: a stream has no suffix; give --format one of {_listed(promised, dot=False)}")
    suffix = "." + given.lower().lstrip(".")
    if suffix in promised:
        return FORMATS[suffix]
    where = f"--format {name}" if name is not None else escape_text(path)
    problem = f"unknown format {given!r}" if given else "a name without a suffix"
    known = promised if name is None else [one.removeprefix(".") for one in promised]
    written = suffix if name is None else given
    way_out = suggestion(written, known, f"known here are {_listed(promised, dot=name is None)}")
    raise UsageError(f"{where}: {problem}{way_out}")


def _suffix(path: str) -> str:
    """Suffix of a path: the longest known one, such as `.hist.png`, else the text behind the last dot."""
    stem, last = os.path.splitext(path)
    both = os.path.splitext(stem)[1] + last
    return both if both.lower() in FORMATS else last


def _listed(promised: tuple[str, ...], *, dot: bool) -> str:
    return " ".join(promised if dot else (suffix.removeprefix(".") for suffix in promised))

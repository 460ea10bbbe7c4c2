"""Report of a comparison, as JSON and as a table."""

from __future__ import annotations

import math
from typing import Any

import msgspec
import numpy as np

from ..._version import __version__
from ...analysis.configuration import Configured
from .cells import MovedColumn
from .values import Difference, Tolerance


class Side(msgspec.Struct):
    """One side: its path and whether it is a mesh, a report or a table."""

    path: str
    kind: str
    sha256: str | None = None


class Comparison(msgspec.Struct):
    """The report of `curvcli compare`; equal if no value moved beyond tolerance."""

    schema_version: int
    curvcli: str
    a: Side
    b: Side
    rtol: float
    atol: float
    equal: bool
    compared: int
    differences: list[Difference]
    columns: list[MovedColumn]
    notes: list[str]
    configuration: Configured = msgspec.UNSET


def model(
    a: Side,
    b: Side,
    tolerance: Tolerance,
    compared: int,
    differences: list[Difference],
    columns: list[MovedColumn],
    notes: list[str],
) -> Comparison:
    """The report of a comparison."""
    return Comparison(
        schema_version=1,
        curvcli=__version__,
        a=a,
        b=b,
        rtol=tolerance.rtol,
        atol=tolerance.atol,
        equal=not differences and not columns,
        compared=compared,
        differences=differences,
        columns=columns,
        notes=notes,
    )


def rows(comparison: Comparison) -> list[tuple[str, str, str, str, float | None, float | None]]:
    """Key, status, both values as text, move and allowance: one row per difference, columns of cells last."""
    listed = [(d.key, d.status, as_text(d.a), as_text(d.b), d.moved, d.allowed) for d in comparison.differences]
    for c in comparison.columns:
        status = "changed" if c.moved is None else "moved"
        listed.append((f"vertices.{c.name}.{c.vertex}", status, as_text(c.a), as_text(c.b), c.moved, c.allowed))
    return listed


def table(comparison: Comparison) -> dict[str, Any]:
    """The rows as columns of a table file."""
    from ...mesh.file import Labels

    listed = rows(comparison)
    columns: dict[str, Any] = {}
    for place, name in enumerate(("key", "status", "a", "b")):
        names = tuple(dict.fromkeys(str(row[place]) for row in listed))
        codes = {text: code for code, text in enumerate(names)}
        columns[name] = Labels(np.array([codes[str(row[place])] for row in listed], np.int32), names)
    for place, name in enumerate(("moved", "allowed"), start=4):
        columns[name] = np.array([math.nan if row[place] is None else row[place] for row in listed], np.float64)
    return columns


def as_text(value: Any) -> str:
    """A value of either side as text with every digit."""
    if value is None:
        return "null"
    if isinstance(value, list):
        return "(" + ", ".join(map(as_text, value)) + ")"
    if isinstance(value, bool):
        return str(value).lower()
    return repr(value) if isinstance(value, float) else str(value)

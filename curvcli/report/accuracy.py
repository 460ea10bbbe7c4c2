"""Errors of columns against exact values: the report, as JSON and as a table."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import msgspec
import numpy as np

from .._version import __version__
from ..analysis.configuration import Configured
from .compare.exact import ErrorNorms
from .compare.model import Side

_NUMBERS = ("relative_l2", "linf", "rms", "bias", "relative_bias")


class ColumnErrors(msgspec.Struct):
    """Error norms of one computed column against the exact one, weighted by the areas of the vertices."""

    exact: str
    relative_l2: float | None
    linf: float | None
    vertex: int | None
    rms: float | None
    bias: float | None
    relative_bias: float | None
    nulls: int
    compared: int


class Accuracy(msgspec.Struct):
    """The report of `curvcli compare` of a mesh with a table of exact values; errors by column.

    equal: whether every relative L2 error is within rtol; true if rtol is not given.
    """

    schema_version: int
    curvcli: str
    mesh: Side
    exact: Side
    scale: str | None
    rtol: float | None
    equal: bool
    errors: dict[str, ColumnErrors]
    unmatched: list[str]
    notes: list[str]
    configuration: Configured = msgspec.UNSET


def model(
    mesh: Side,
    exact: Side,
    scale: str | None,
    rtol: float | None,
    errors: Sequence[ErrorNorms],
    unmatched: list[str],
    notes: list[str],
) -> Accuracy:
    """Build the report; rtol: bound on relative L2 errors, None for no bound."""
    names = ColumnErrors.__struct_fields__
    columns = {error.column: ColumnErrors(*(getattr(error, name) for name in names)) for error in errors}
    equal = rtol is None or all(column.relative_l2 is None or column.relative_l2 <= rtol for column in columns.values())
    return Accuracy(1, __version__, mesh, exact, scale, rtol, equal, columns, unmatched, notes)


def table(accuracy: Accuracy) -> dict[str, Any]:
    """One row per column as columns of a table file."""
    from ..mesh.file import Labels

    columns: dict[str, Any] = {}
    rows = list(accuracy.errors.items())
    for header, names in (("column", [name for name, _ in rows]), ("exact", [row.exact for _, row in rows])):
        known = tuple(dict.fromkeys(names))
        columns[header] = Labels(np.array([known.index(name) for name in names], np.int32), known)
    for key in _NUMBERS:
        values = [getattr(row, key) for _, row in rows]
        columns[key] = np.array([math.nan if value is None else value for value in values], np.float64)
    for key in ("nulls", "compared"):
        columns[key] = np.array([getattr(row, key) for _, row in rows], np.int32)
    return columns

"""What is told of columns set against exact values: as JSON, as a table, and as a summary for the terminal."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import msgspec
import numpy as np
from rich.table import Table

from .._version import __version__
from ..analysis.configuration import Configured
from .compare.exact import ErrorNorms
from .compare.model import Side
from .terminal.console import escape, report_console, show_configuration
from .terminal.fitting import add_numbers, fitting, plain_table, roomy_table

_NUMBERS = ("relative_l2", "linf", "rms", "bias", "relative_bias")


class ColumnErrors(msgspec.Struct):
    """One computed column against the exact one: norms of the error, weighted by the areas of the vertices."""

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

    equal: whether every relative L2 error is within rtol; true where none was asked for.
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
    """The report; rtol: what relative L2 errors may be, None for whatever they are."""
    names = ColumnErrors.__struct_fields__
    found = {one.column: ColumnErrors(*(getattr(one, name) for name in names)) for one in errors}
    equal = rtol is None or all(one.relative_l2 is None or one.relative_l2 <= rtol for one in found.values())
    return Accuracy(1, __version__, mesh, exact, scale, rtol, equal, found, unmatched, notes)


def table(found: Accuracy) -> dict[str, Any]:
    """One row per column as columns of a table file."""
    from ..mesh.file import Labels

    columns: dict[str, Any] = {}
    rows = list(found.errors.items())
    for header, names in (("column", [name for name, _ in rows]), ("exact", [row.exact for _, row in rows])):
        known = tuple(dict.fromkeys(names))
        columns[header] = Labels(np.array([known.index(name) for name in names], np.int32), known)
    for key in _NUMBERS:
        values = [getattr(row, key) for _, row in rows]
        columns[key] = np.array([math.nan if value is None else value for value in values], np.float64)
    for key in ("nulls", "compared"):
        columns[key] = np.array([getattr(row, key) for _, row in rows], np.int32)
    return columns


def show(found: Accuracy) -> None:
    """Print the summary to stdout; rich where it is a terminal, plain text in a pipe."""
    console = report_console(120)
    console.print(f"mesh [bold]{escape(found.mesh.path)}[/bold], exact values [bold]{escape(found.exact.path)}[/bold]")
    for note in found.notes:
        console.print(f"[yellow]note[/yellow] {escape(note)}")
    show_configuration(console, found.configuration)
    console.print(fitting(console, _errors(found)))
    if found.unmatched:
        console.print(f"[dim]without an exact value: {', '.join(map(escape, found.unmatched))}[/dim]")
    if not found.equal:
        console.print(f"[bold red]FAIL[/bold red]: a relative L2 error is above {found.rtol:g}")


def _errors(found: Accuracy) -> Iterator[Table]:
    """The norms of each column; fewer of them where the terminal is narrow."""
    every = ("relative L2", "Linf", "at vertex", "RMS", "bias", "relative", "null", "compared")
    both = ("column", "against")
    for make, names, numbers in (
        (roomy_table, both, every),
        (plain_table, both, every),
        (plain_table, both, every[:6]),
        (plain_table, both, every[:3]),
        (plain_table, both[:1], every[:3]),
        (plain_table, both[:1], every[:1]),
    ):
        table = make(*names)
        add_numbers(table, *numbers)
        for name, row in found.errors.items():
            late = found.rtol is not None and row.relative_l2 is not None and row.relative_l2 > found.rtol
            relative = _number(row.relative_l2)
            told = {
                "column": name,
                "against": row.exact,
                "relative L2": f"[bold red]{relative}[/bold red]" if late else relative,
                "Linf": _number(row.linf),
                "at vertex": "" if row.vertex is None else str(row.vertex),
                "RMS": _number(row.rms),
                "bias": _number(row.bias),
                "relative": _number(row.relative_bias),
                "null": f"{row.nulls:,}" if row.nulls else "",
                "compared": f"{row.compared:,}",
            }
            table.add_row(*(told[key] for key in (*names, *numbers)))
        yield table


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.3g}"

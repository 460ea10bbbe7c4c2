"""What is told of a comparison: as JSON, as a table, and as a summary for the terminal."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import msgspec
import numpy as np
from rich.table import Table

from ..._version import __version__
from ...analysis.configuration import Configured
from ..terminal.console import escape, report_console, show_configuration
from ..terminal.fitting import fitting, plain_table, roomy_table
from .cells import MovedColumn
from .values import Difference, Tolerance

# Rows of the summary; all with -v.
_SHOWN = 40
# The least width of a column of names.
_NAME = 24
_ABSENT = {"absent_in_a": "only in B", "absent_in_b": "only in A"}


class Side(msgspec.Struct):
    """One of the two: its path and whether it is a mesh, a report or a table."""

    path: str
    kind: str
    sha256: str | None = None


class Change(msgspec.Struct):
    """One value that is not the same, by its dotted key: moved, changed, absent_in_a or absent_in_b."""

    key: str
    status: str
    a: Any
    b: Any
    moved: float | None
    allowed: float | None


class ChangedColumn(msgspec.Struct):
    """A column of the vertex tables with cells that differ, and the cell that moved most."""

    name: str
    rows: int
    differing: int
    vertex: int
    a: float | str | None
    b: float | str | None
    moved: float | None
    allowed: float | None


class Comparison(msgspec.Struct):
    """The report of `curvcli compare`; equal where no value moved beyond tolerance."""

    schema_version: int
    curvcli: str
    a: Side
    b: Side
    rtol: float
    atol: float
    equal: bool
    compared: int
    differences: list[Change]
    columns: list[ChangedColumn]
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
        differences=[Change(**vars(one)) for one in differences],
        columns=[ChangedColumn(**vars(one)) for one in columns],
        notes=notes,
    )


def rows(found: Comparison) -> list[tuple[str, str, str, str, float | None, float | None]]:
    """Key, status, both values as text, move and allowance: one row per difference, columns of cells last."""
    listed = [(d.key, d.status, _text(d.a), _text(d.b), d.moved, d.allowed) for d in found.differences]
    for c in found.columns:
        status = "changed" if c.moved is None else "moved"
        listed.append((f"vertices.{c.name}.{c.vertex}", status, _text(c.a), _text(c.b), c.moved, c.allowed))
    return listed


def table(found: Comparison) -> dict[str, Any]:
    """The rows as columns of a table file."""
    from ...mesh.file import Labels

    listed = rows(found)
    columns: dict[str, Any] = {}
    for place, name in enumerate(("key", "status", "a", "b")):
        names = tuple(dict.fromkeys(str(row[place]) for row in listed))
        codes = {text: code for code, text in enumerate(names)}
        columns[name] = Labels(np.array([codes[str(row[place])] for row in listed], np.int32), names)
    for place, name in enumerate(("moved", "allowed"), start=4):
        columns[name] = np.array([math.nan if row[place] is None else row[place] for row in listed], np.float64)
    return columns


def show(found: Comparison, verbose: int = 0) -> None:
    """Print the summary to stdout; rich where it is a terminal, plain text in a pipe."""
    console = report_console(120)
    console.print(f"A [bold]{escape(found.a.path)}[/bold] ({found.a.kind})")
    console.print(f"B [bold]{escape(found.b.path)}[/bold] ({found.b.kind})")
    for note in found.notes:
        console.print(f"[yellow]note[/yellow] {escape(note)}")
    show_configuration(console, found.configuration)
    limits = f"rtol {found.rtol:g}, atol {found.atol:g}"
    if found.equal:
        console.print(f"[green]same[/green]: {found.compared:,} values compared, none differs beyond {limits}")
        return
    console.print(fitting(console, _moved(found, verbose)))
    count = len(found.differences) + len(found.columns)
    console.print(f"[bold red]DIFFERENT[/bold red]: {count:,} of {found.compared:,} values compared, beyond {limits}")


def _moved(found: Comparison, verbose: int) -> Iterator[Table]:
    """A row for each difference; with little room the values stand below its name, so that no digit is lost."""
    wide, narrow = roomy_table(), plain_table("value", fold=_NAME)
    for header in ("value", "A", "B", "moved", "allowed"):
        wide.add_column(header, overflow="fold")
    for header in ("moved", "allowed"):
        narrow.add_column(header, no_wrap=True)

    def add(name: str, a: str, b: str, moved: str, allowed: str) -> None:
        wide.add_row(name, a, b, moved, allowed)
        narrow.add_row(f"{name}\n  A {a}\n  B {b}", moved, allowed)

    for d in found.differences[: None if verbose else _SHOWN]:
        cells = (_ABSENT[d.status], "") if d.status in _ABSENT else (_number(d.moved, "changed"), _number(d.allowed))
        add(escape(d.key), escape(_text(d.a)), escape(_text(d.b)), *cells)
    hidden = len(found.differences) - _SHOWN
    if hidden > 0 and not verbose:
        for table in (wide, narrow):
            table.add_row(f"[dim]… {hidden:,} more: -v[/dim]")
    for c in found.columns:
        where = f"vertices.{c.name}: {c.differing:,} of {c.rows:,}, most at vertex {c.vertex}"
        add(escape(where), escape(_text(c.a)), escape(_text(c.b)), _number(c.moved, "changed"), _number(c.allowed))
    yield wide
    yield narrow


def _text(value: Any) -> str:
    if value is None:
        return "null"
    if isinstance(value, list):
        return "(" + ", ".join(map(_text, value)) + ")"
    if isinstance(value, bool):
        return str(value).lower()
    return repr(value) if isinstance(value, float) else str(value)


def _number(value: float | None, otherwise: str = "") -> str:
    return otherwise if value is None else f"{value:.2g}"

"""The summary for the terminal: what the mesh is, what holds, what it adds up to."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from rich import box
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from ..plurals import counted
from ..settings import in_words
from .model import CheckRow, Report, model
from .proof import holds, proof

if TYPE_CHECKING:
    from ..analysis import Analysis

_MARKS = {"pass": "[green]pass[/green]", "fail": "[bold red]FAIL[/bold red]", "not_applicable": "[dim]n/a[/dim]"}
_ORDER = {"fail": 0, "pass": 1, "not_applicable": 2}


def show(analysis: Analysis, verbose: int = 0) -> None:
    """Print the summary of an analysis to stdout; rich where it is a terminal, plain text in a pipe."""
    report = model(analysis)
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = max(console.width, 100)
    console.print(
        f"[bold]{escape(report.input.path or 'arrays in memory')}[/bold]  {_shape(report)}",
        soft_wrap=not console.is_terminal,
    )
    for remark in report.warnings:
        hint = f"; {remark.hint}" if remark.hint else ""
        first = f" (first: {', '.join(map(str, remark.examples[:3]))})" if remark.examples else ""
        console.print(
            f"[yellow]warning[/yellow] {remark.code}: {remark.count:,} {escape(remark.message)}{first}{escape(hint)}",
            soft_wrap=not console.is_terminal,
        )
    console.print(_checks(report.checks, verbose))
    console.print(escape(proof(report)), style="red" if not holds(report) else "dim", soft_wrap=True)
    console.print(_totals(report))
    if report.regions:
        console.print(_regions(report))
    if report.columns:
        console.print(_columns(report))
    console.print(f"[dim]{_conventions(report)}[/dim]")


def _shape(report: Report) -> str:
    topology = report.topology
    parts = [f"V {topology.vertices:,}  E {topology.edges:,}  F {topology.faces:,}  χ {topology.euler_characteristic}"]
    words = [
        "closed" if topology.closed else counted(topology.boundary_edges, "boundary edge"),
        "manifold" if topology.manifold else "not manifold",
        "orientable" if topology.orientable else "not orientable",
    ]
    if topology.components > 1:
        words.insert(0, counted(topology.components, "component"))
    if topology.genus is not None:
        words.append(f"genus {topology.genus}")
    for count, name in ((topology.crosscaps, "crosscap"), (topology.boundary_loops, "boundary loop")):
        if count:
            words.append(counted(count, name))
    return "  ".join([*parts, ", ".join(words)])


def _checks(rows: list[CheckRow], verbose: int) -> Table:
    table = _table("check", "scope", "status")
    for header in ("residual", "allowed"):
        table.add_column(header, justify="right", no_wrap=True)
    table.add_column("detail", overflow="fold")
    listed = [row for row in rows if row.scope == "whole" or row.status == "fail" or verbose]
    for row in sorted(listed, key=lambda row: _ORDER[row.status]):
        tested = row.status != "not_applicable"
        numbers = (_number(row.residual), _number(row.tolerance)) if tested else ("", "")
        table.add_row(row.name, row.scope, _MARKS[row.status], *numbers, escape(row.detail))
    hidden = len(rows) - len(listed)
    if hidden:
        pieces = "regions" if any(row.scope.startswith("region") for row in rows) else "components"
        table.add_row("[dim]…[/dim]", pieces, _MARKS["pass"], "", "", f"[dim]{hidden:,} more, none failed; -v[/dim]")
    return table


def _totals(report: Report) -> Table:
    table = _table("total")
    table.add_column("value", justify="left", overflow="fold")
    for key, value in report.totals.items():
        table.add_row(key, _value(value))
    return table


def _regions(report: Report) -> Table:
    table = _table("region")
    for header in ("faces", "χ", "area", "ΣK", "Σκ_g", "willmore"):
        table.add_column(header, justify="right", no_wrap=True)
    for region in report.regions[:20]:
        topology = region.topology
        totals = (_number(_scalar(region.totals.get(key)), 6) for key in ("area", "K", "kappa_g", "willmore"))
        table.add_row(str(region.name), f"{topology.faces:,}", str(topology.euler_characteristic), *totals)
    if len(report.regions) > 20:
        table.add_row(f"[dim]… {len(report.regions) - 20:,} more: --table regions=PATH[/dim]")
    return table


def _scalar(value: Any) -> float | None:
    return None if isinstance(value, list) else value


def _columns(report: Report) -> Table:
    table = _table("column", "unit")
    for header in ("min", "median", "max", "mean", "undefined"):
        table.add_column(header, justify="right", no_wrap=True)
    for name, column in report.columns.items():
        numbers = (_number(x, 4) for x in (column.min, column.median, column.max, column.mean))
        table.add_row(name, column.unit, *numbers, f"{column.nulls:,}" if column.nulls else "")
    return table


def _conventions(report: Report) -> str:
    chosen = report.conventions
    mean = "κ₁ + κ₂" if chosen["mean"] == "sum" else "(κ₁ + κ₂)/2"
    rest = "; ".join(f"{key} {chosen[key]}" for key in ("area", "orient", "weld"))
    if chosen["scale"] is not None:
        rest += f"; estimates at {in_words(chosen['scale'])}"
    if chosen["normals"] is not None:
        rest += f", normals of the {chosen['normals']}"
    return f"H = {mean}, positive where convex; {rest}"


def _table(*headers: str) -> Table:
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for header in headers:
        table.add_column(header, no_wrap=True)
    return table


def _value(value: Any) -> str:
    if isinstance(value, Iterable):
        return "(" + ", ".join(_number(x, 12) for x in value) + ")"
    return _number(value, 15)


def _number(value: float | None, digits: int = 2) -> str:
    return "undefined" if value is None else f"{value:.{digits}g}"

"""Summary for the terminal: shape of the mesh, checks, totals and columns."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

from rich.table import Table

from ...checks.base import Check
from ...mesh.scale import describe_scales
from ...support.words import format_rounded
from ..build import model
from ..conclusion import conclusion, holds
from ..model import Report
from ..phrases import failing_first, shape
from .console import MARKS, escape, report_console, show_configuration
from .tables import add_numbers, fitting, plain_table

if TYPE_CHECKING:
    from ...analysis.result import Result

# Minimum widths of a column of sentences, and of one of names that are folded.
_DETAIL, _NAME = 20, 14


def show(analysis: Result, verbose: int = 0) -> None:
    """Print the summary of an analysis to stdout; rich where it is a terminal, plain text in a pipe."""
    report = model(analysis)
    console = report_console()
    console.print(
        f"[bold]{escape(report.input.path or 'arrays in memory')}[/bold]  {_shape(report)}",
        soft_wrap=not console.is_terminal,
    )
    for remark in report.warnings:
        hint = f"; {remark.hint}" if remark.hint else ""
        first = f" (first: {', '.join(map(escape, remark.examples[:3]))})" if remark.examples else ""
        console.print(
            f"[yellow]warning[/yellow] {remark.code}: {remark.count:,} {escape(remark.message)}{first}{escape(hint)}",
            soft_wrap=not console.is_terminal,
        )
    console.print(fitting(console, _checks(report.checks, verbose)))
    failed = not holds(report)
    console.print(escape(conclusion(report)), style="red" if failed else "dim", soft_wrap=not console.is_terminal)
    show_configuration(console, report.configuration)
    console.print(_totals(report))
    if report.regions:
        console.print(fitting(console, (_regions(report, digits) for digits in (6, 4, 3))))
    if report.columns:
        console.print(fitting(console, _columns(report)))
    console.print(f"[dim]{_conventions(report)}[/dim]")


def _shape(report: Report) -> str:
    topology = report.topology
    counts = f"V {topology.vertices:,}  E {topology.edges:,}  F {topology.faces:,}  χ {topology.euler_characteristic}"
    return f"{counts}  {shape(topology)}"


def _checks(rows: list[Check], verbose: int) -> Iterator[Table]:
    """Failures first, with the detail beside the numbers, or below the name where the terminal is narrow."""
    listed = failing_first(row for row in rows if row.scope == "whole" or row.status == "fail" or verbose)
    hidden = len(rows) - len(listed)
    scoped = any(row.scope != "whole" for row in listed)
    pieces = "regions" if any(row.scope.startswith("region") for row in rows) else "components"
    for wide in (True, False):
        table = plain_table("check")
        if scoped:
            table.add_column("scope", overflow="fold", min_width=12)
        table.add_column("status", no_wrap=True)
        add_numbers(table, "residual", "allowed")
        if wide:
            table.add_column("detail", overflow="fold", min_width=_DETAIL)
        for row in listed:
            tested = row.status != "not_applicable"
            numbers = (format_rounded(row.residual, 2), format_rounded(row.tolerance, 2)) if tested else ("", "")
            name = row.name if wide or row.status == "pass" else f"{row.name}\n  {escape(row.detail)}"
            scope = (escape(row.scope),) if scoped else ()
            table.add_row(name, *scope, MARKS[row.status], *numbers, *((escape(row.detail),) if wide else ()))
        if hidden:
            more = f"[dim]{hidden:,} more on {pieces}, none failed; -v[/dim]"
            first = "[dim]…[/dim]" if wide else more
            table.add_row(first, *(("",) if scoped else ()), MARKS["pass"], "", "", *((more,) if wide else ()))
        if not wide:
            table.columns[0].no_wrap, table.columns[0].min_width = False, _NAME
        yield table


def _totals(report: Report) -> Table:
    table = plain_table("total")
    table.add_column("value", justify="left", overflow="fold")
    for key, value in report.totals.items():
        table.add_row(escape(key), _value(value))
    return table


def _regions(report: Report, digits: int) -> Table:
    table = plain_table("region", fold=_NAME)
    add_numbers(table, "faces", "χ", "area", "ΣK", "Σκ_g", "willmore")
    for region in report.regions[:20]:
        topology = region.topology
        totals = (
            format_rounded(_scalar(region.totals.get(key)), digits) for key in ("area", "K", "kappa_g", "willmore")
        )
        table.add_row(escape(region.name), f"{topology.faces:,}", str(topology.euler_characteristic), *totals)
    if len(report.regions) > 20:
        table.add_row(f"[dim]… {len(report.regions) - 20:,} more: --table regions=PATH[/dim]")
    return table


def _scalar(value: Any) -> float | None:
    return None if isinstance(value, list) else value


def _columns(report: Report) -> Iterator[Table]:
    """Statistics of every column; fewer digits, then fewer statistics, where the terminal is narrow."""
    for digits, unit, statistics in (
        (4, True, ("min", "median", "max", "mean")),
        (3, True, ("min", "median", "max", "mean")),
        (2, True, ("min", "median", "max", "mean")),
        (3, False, ("min", "median", "max", "mean")),
        (3, False, ("min", "median", "max")),
        (2, False, ("min", "max")),
    ):
        table = plain_table("column", *(("unit",) if unit else ()))
        add_numbers(table, *statistics, "null")
        for name, column in report.columns.items():
            numbers = (format_rounded(getattr(column, key), digits, "") for key in statistics)
            nulls = f"{column.nulls:,}" if column.nulls else ""
            table.add_row(escape(name), *((escape(column.unit),) if unit else ()), *numbers, nulls)
        yield table


def _conventions(report: Report) -> str:
    chosen = report.conventions
    mean = "κ₁ + κ₂" if chosen["mean"] == "sum" else "(κ₁ + κ₂)/2"
    rest = "; ".join(f"{key} {chosen[key]}" for key in ("area", "orient", "weld"))
    if chosen["scale"] is not None:
        rest += f"; estimates at {describe_scales(chosen['scale'])}"
    if chosen["normals"] is not None:
        rest += f", normals of the {chosen['normals']}"
    if chosen["noise"] is not None:
        rest += f"; noise {format_rounded(float(chosen['noise']), 2)}"
    if chosen["settings"] is not None:
        rest += f"; {chosen['settings']}"
    if chosen["bending_rigidity"] is not None:
        rest += f"; κ = {chosen['bending_rigidity']}"
    return escape(f"H = {mean}, positive where convex; {rest}")


def _value(value: Any) -> str:
    if isinstance(value, Iterable):
        return "(" + ", ".join(format_rounded(x, 12) for x in value) + ")"
    return format_rounded(value, 15)

"""The summary of curves for the terminal."""

from __future__ import annotations

from rich import box
from rich.markup import escape
from rich.table import Table

from ..plurals import counted
from .console import MARKS, report_console
from .curves import CurveReport, CurveRow
from .model import CheckRow

# Curves that are shown unless more is asked for with -v.
SHOWN = 20


def show(report: CurveReport, verbose: int = 0) -> None:
    """Print a table of the curves and what holds along them; rich where stdout is a terminal, plain in a pipe."""
    console = report_console(120)
    boundary = sum(row.kind == "boundary" for row in report.curves)
    words = f"{counted(boundary, 'boundary curve')}, {counted(len(report.curves) - boundary, 'polyline')}"
    console.print(f"[bold]{escape(report.input.path or 'arrays in memory')}[/bold]  {words}")
    for remark in report.warnings:
        hint = f"; {remark.hint}" if remark.hint else ""
        console.print(f"[yellow]warning[/yellow] {remark.code}: {remark.count:,} {escape(remark.message + hint)}")
    console.print(_curves(report.curves if verbose else report.curves[:SHOWN]))
    if len(report.curves) > SHOWN and not verbose:
        more = counted(len(report.curves) - SHOWN, "more curve")
        console.print(f"[dim]{more}; -v shows all, --json tells all of each[/dim]")
    console.print(_checks(report.checks, verbose))
    told = "Σψ: total curvature; writhe in turns; holonomy ≡ 2π · writhe. "
    proves = "unknotted: Σψ ≤ 4π proves it of a curve that does not cross itself; more proves nothing."
    console.print(f"[dim]{told}{proves}[/dim]")


def _curves(rows: list[CurveRow]) -> Table:
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for header in ("curve", "kind", "closed"):
        table.add_column(header, no_wrap=True)
    for header in ("vertices", "length", "Σψ", "turns", "Σκ_g", "writhe", "holonomy"):
        table.add_column(header, justify="right", no_wrap=True)
    table.add_column("knot", no_wrap=True)
    for row in rows:
        numbers = (row.length, row.total_curvature, row.turning_number, row.sum_kappa_g, row.writhe, row.holonomy)
        closed = "closed" if row.closed else "open"
        knot = "unknotted" if row.unknotted else ""
        table.add_row(str(row.curve), row.kind, closed, f"{row.vertices:,}", *map(_number, numbers), knot)
    return table


def _checks(checks: list[CheckRow], verbose: int) -> Table:
    """Each identity once, by its closest call, and whatever failed."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for header in ("check", "scope", "status"):
        table.add_column(header, no_wrap=True)
    for header in ("residual", "allowed"):
        table.add_column(header, justify="right", no_wrap=True)
    table.add_column("detail", overflow="fold")
    listed = checks if verbose else [row for name in dict.fromkeys(c.name for c in checks) for row in _of(checks, name)]
    for row in listed:
        numbers = (_number(row.residual, 2), _number(row.tolerance, 2))
        table.add_row(row.name, row.scope, MARKS[row.status], *numbers, escape(row.detail))
    return table


def _of(checks: list[CheckRow], name: str) -> list[CheckRow]:
    """The rows of one identity that are worth a line: all that fail, else the closest call, else the first reason."""
    mine = [row for row in checks if row.name == name]
    failed = [row for row in mine if row.status == "fail"]
    tested = [row for row in mine if row.status == "pass"]
    return failed or sorted(tested, key=_strain)[-1:] or mine[:1]


def _strain(row: CheckRow) -> float:
    return row.residual / row.tolerance if row.residual and row.tolerance else 0.0


def _number(value: float | None, digits: int = 6) -> str:
    return "" if value is None else f"{value:.{digits}g}"

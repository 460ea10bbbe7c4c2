"""Summary of curves for the terminal."""

from __future__ import annotations

from collections.abc import Iterator

from rich.table import Table

from ...checks.base import Check
from ...support.words import counted, format_rounded
from ..curves import CurveReport, CurveRow
from .console import MARKS, escape, report_console, show_configuration
from .tables import add_numbers, fitting, plain_table, roomy_table, with_sentences

# Curves shown without -v.
SHOWN = 20


def show(report: CurveReport, verbose: int = 0) -> None:
    """Print a table of the curves and their identities; rich where stdout is a terminal, plain in a pipe."""
    console = report_console(120)
    boundary = sum(row.kind == "boundary" for row in report.curves)
    counts = f"{counted(boundary, 'boundary curve')}, {counted(len(report.curves) - boundary, 'polyline')}"
    console.print(f"[bold]{escape(report.input.path or 'arrays in memory')}[/bold]  {counts}")
    for remark in report.warnings:
        hint = f"; {remark.hint}" if remark.hint else ""
        console.print(f"[yellow]warning[/yellow] {remark.code}: {remark.count:,} {escape(remark.message + hint)}")
    console.print(fitting(console, _curves(report.curves if verbose else report.curves[:SHOWN])))
    if len(report.curves) > SHOWN and not verbose:
        more = counted(len(report.curves) - SHOWN, "more curve")
        console.print(f"[dim]{more}; -v shows all, --json has every value[/dim]")
    linked = [f"{row.a} and {row.b} ({row.linking:+d})" for row in report.links if row.linking]
    if linked:
        shown = linked if verbose else linked[:SHOWN]
        more = f" and {len(linked) - len(shown)} more" if len(linked) > len(shown) else ""
        console.print(f"linked curves: {', '.join(shown)}{more}")
    console.print(fitting(console, _checks(report.checks, verbose)))
    show_configuration(console, report.configuration)
    symbols = "Σψ: total curvature; writhe in turns; holonomy ≡ 2π · writhe. "
    proves = "unknotted: Σψ ≤ 4π proves it for a curve that does not cross itself; a larger Σψ proves nothing."
    console.print(f"[dim]{symbols}{proves}[/dim]")


def _curves(rows: list[CurveRow]) -> Iterator[Table]:
    """Row for each curve; fewer digits, then fewer numbers, where the terminal is narrow."""
    numbers = ("vertices", "length", "Σψ", "turns", "Σκ_g", "writhe", "holonomy")
    for digits, names, chosen, knots in (
        (6, ("curve", "kind", "closed"), numbers, True),
        (4, ("curve", "kind", "closed"), numbers, True),
        (4, ("curve", "kind"), numbers, False),
        (3, ("curve", "kind"), ("vertices", "length", "Σψ", "Σκ_g", "writhe"), False),
        (3, ("curve",), ("vertices", "length", "Σψ"), False),
    ):
        table = roomy_table(*names) if digits == 6 else plain_table(*names)
        add_numbers(table, *chosen)
        if knots:
            table.add_column("knot", no_wrap=True)
        for row in rows:
            cells = {"curve": str(row.curve), "kind": row.kind, "closed": "closed" if row.closed else "open"}
            values = {
                "length": row.length,
                "Σψ": row.total_curvature,
                "turns": row.turning_number,
                "Σκ_g": row.sum_kappa_g,
                "writhe": row.writhe,
                "holonomy": row.holonomy,
            }
            cells |= {"vertices": f"{row.vertices:,}"} | {
                key: format_rounded(value, digits, "") for key, value in values.items()
            }
            knot = ("unknotted" if row.unknotted else "",) if knots else ()
            table.add_row(*(cells[name] for name in (*names, *chosen)), *knot)
        yield table


def _checks(checks: list[Check], verbose: int) -> Iterator[Table]:
    """Each identity once, by its closest call, and every failure."""
    listed = checks if verbose else [row for name in dict.fromkeys(c.name for c in checks) for row in _of(checks, name)]
    rows = [
        (
            (
                row.name,
                row.scope,
                MARKS[row.status],
                format_rounded(row.residual, 2, ""),
                format_rounded(row.tolerance, 2, ""),
            ),
            escape(row.detail),
            row.status != "pass",
        )
        for row in listed
    ]
    return with_sentences(("check", "scope", "status"), ("residual", "allowed"), "detail", rows)


def _of(checks: list[Check], name: str) -> list[Check]:
    """Rows of one identity to print: all that fail, else the closest call, else the first reason."""
    mine = [row for row in checks if row.name == name]
    failed = [row for row in mine if row.status == "fail"]
    tested = [row for row in mine if row.status == "pass"]
    return failed or sorted(tested, key=_strain)[-1:] or mine[:1]


def _strain(row: Check) -> float:
    return row.residual / row.tolerance if row.residual and row.tolerance else 0.0

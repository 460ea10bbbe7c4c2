"""The errors of columns against exact values, for the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich.table import Table

from ...support.words import format_rounded
from .console import escape, report_console, show_configuration
from .tables import add_numbers, fitting, plain_table, roomy_table

if TYPE_CHECKING:
    from ..accuracy import Accuracy


def show(accuracy: Accuracy) -> None:
    """Print the summary to stdout; rich where it is a terminal, plain text in a pipe."""
    console = report_console(120)
    console.print(
        f"mesh [bold]{escape(accuracy.mesh.path)}[/bold], exact values [bold]{escape(accuracy.exact.path)}[/bold]"
    )
    for note in accuracy.notes:
        console.print(f"[yellow]note[/yellow] {escape(note)}")
    show_configuration(console, accuracy.configuration)
    console.print(fitting(console, _errors(accuracy)))
    if accuracy.unmatched:
        console.print(f"[dim]without an exact value: {', '.join(map(escape, accuracy.unmatched))}[/dim]")
    if not accuracy.equal:
        console.print(f"[bold red]FAIL[/bold red]: a relative L2 error is above {accuracy.rtol:g}")


def _errors(accuracy: Accuracy) -> Iterator[Table]:
    """Error norms of each column; fewer of them where the terminal is narrow."""
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
        for name, row in accuracy.errors.items():
            late = accuracy.rtol is not None and row.relative_l2 is not None and row.relative_l2 > accuracy.rtol
            relative = format_rounded(row.relative_l2, 3, "")
            cells = {
                "column": name,
                "against": row.exact,
                "relative L2": f"[bold red]{relative}[/bold red]" if late else relative,
                "Linf": format_rounded(row.linf, 3, ""),
                "at vertex": "" if row.vertex is None else str(row.vertex),
                "RMS": format_rounded(row.rms, 3, ""),
                "bias": format_rounded(row.bias, 3, ""),
                "relative": format_rounded(row.relative_bias, 3, ""),
                "null": f"{row.nulls:,}" if row.nulls else "",
                "compared": f"{row.compared:,}",
            }
            table.add_row(*(cells[key] for key in (*names, *numbers)))
        yield table

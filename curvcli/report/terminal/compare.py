"""The differences of a comparison, for the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich.table import Table

from ...support.words import format_rounded
from ..compare.model import as_text
from .console import escape, report_console, show_configuration
from .tables import fitting, plain_table, roomy_table

if TYPE_CHECKING:
    from ..compare.model import Comparison

# Rows of the summary; all with -v.
_SHOWN = 40
# Minimum width of a column of names.
_NAME = 24
_ABSENT = {"absent_in_a": "only in B", "absent_in_b": "only in A"}


def show(comparison: Comparison, verbose: int = 0) -> None:
    """Print the summary to stdout; rich where it is a terminal, plain text in a pipe."""
    console = report_console(120)
    console.print(f"A [bold]{escape(comparison.a.path)}[/bold] ({comparison.a.kind})")
    console.print(f"B [bold]{escape(comparison.b.path)}[/bold] ({comparison.b.kind})")
    for note in comparison.notes:
        console.print(f"[yellow]note[/yellow] {escape(note)}")
    show_configuration(console, comparison.configuration)
    limits = f"rtol {comparison.rtol:g}, atol {comparison.atol:g}"
    if comparison.equal:
        console.print(f"[green]same[/green]: {comparison.compared:,} values compared, none differs beyond {limits}")
        return
    console.print(fitting(console, _moved(comparison, verbose)))
    count = len(comparison.differences) + len(comparison.columns)
    console.print(
        f"[bold red]DIFFERENT[/bold red]: {count:,} of {comparison.compared:,} values compared, beyond {limits}"
    )


def _moved(comparison: Comparison, verbose: int) -> Iterator[Table]:
    """A row for each difference; on a narrow terminal the values are below its name, so that no digit is lost."""
    wide, narrow = roomy_table(), plain_table("value", fold=_NAME)
    for header in ("value", "A", "B", "moved", "allowed"):
        wide.add_column(header, overflow="fold")
    for header in ("moved", "allowed"):
        narrow.add_column(header, no_wrap=True)

    def add(name: str, a: str, b: str, moved: str, allowed: str) -> None:
        wide.add_row(name, a, b, moved, allowed)
        narrow.add_row(f"{name}\n  A {a}\n  B {b}", moved, allowed)

    for d in comparison.differences[: None if verbose else _SHOWN]:
        cells = (
            (_ABSENT[d.status], "")
            if d.status in _ABSENT
            else (format_rounded(d.moved, 2, "changed"), format_rounded(d.allowed, 2, ""))
        )
        add(escape(d.key), escape(as_text(d.a)), escape(as_text(d.b)), *cells)
    hidden = len(comparison.differences) - _SHOWN
    if hidden > 0 and not verbose:
        for table in (wide, narrow):
            table.add_row(f"[dim]… {hidden:,} more: -v[/dim]")
    for c in comparison.columns:
        where = f"vertices.{c.name}: {c.differing:,} of {c.rows:,}, most at vertex {c.vertex}"
        add(
            escape(where),
            escape(as_text(c.a)),
            escape(as_text(c.b)),
            format_rounded(c.moved, 2, "changed"),
            format_rounded(c.allowed, 2, ""),
        )
    yield wide
    yield narrow

"""The differences of a comparison, for the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich.table import Table

from ...support.words import format_rounded
from ..compare.model import as_text
from .console import escape, report_console, show_configuration
from .fitting import fitting, plain_table, roomy_table

if TYPE_CHECKING:
    from ..compare.model import Comparison

# Rows of the summary; all with -v.
_SHOWN = 40
# Minimum width of a column of names.
_NAME = 24
_ABSENT = {"absent_in_a": "only in B", "absent_in_b": "only in A"}


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
    """A row for each difference; on a narrow terminal the values are below its name, so that no digit is lost."""
    wide, narrow = roomy_table(), plain_table("value", fold=_NAME)
    for header in ("value", "A", "B", "moved", "allowed"):
        wide.add_column(header, overflow="fold")
    for header in ("moved", "allowed"):
        narrow.add_column(header, no_wrap=True)

    def add(name: str, a: str, b: str, moved: str, allowed: str) -> None:
        wide.add_row(name, a, b, moved, allowed)
        narrow.add_row(f"{name}\n  A {a}\n  B {b}", moved, allowed)

    for d in found.differences[: None if verbose else _SHOWN]:
        cells = (
            (_ABSENT[d.status], "")
            if d.status in _ABSENT
            else (format_rounded(d.moved, 2, "changed"), format_rounded(d.allowed, 2, ""))
        )
        add(escape(d.key), escape(as_text(d.a)), escape(as_text(d.b)), *cells)
    hidden = len(found.differences) - _SHOWN
    if hidden > 0 and not verbose:
        for table in (wide, narrow):
            table.add_row(f"[dim]… {hidden:,} more: -v[/dim]")
    for c in found.columns:
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

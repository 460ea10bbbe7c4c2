"""Tables for a terminal of any width: cells that do not fit are left out or shortened, never cut off."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from rich import box
from rich.console import Console
from rich.measure import Measurement
from rich.table import Table

# Minimum widths of a column of sentences, and of one of names that are folded.
_SENTENCE, _NAME = 20, 14


def fitting(console: Console, variants: Iterable[Table]) -> Table:
    """First table that fits the console without a cell cut off, else the last, whose cells are folded."""
    table, boundless = None, console.options.update(max_width=10**6)
    for table in variants:
        for column in table.columns:
            if column.no_wrap:
                # Otherwise cells of several words are measured by the longest word.
                cells = (column.header, *column.cells)
                column.min_width = max(Measurement.get(console, boundless, cell).maximum for cell in cells)
        if Measurement.get(console, boundless, table).minimum <= console.width:
            return table
    if table is None:
        raise ValueError("no table to choose from")
    for column in table.columns:
        column.no_wrap, column.overflow, column.min_width = False, "fold", None
    return table


def plain_table(*headers: str, fold: int | None = None) -> Table:
    """Empty table without frame whose columns are as wide as they need; fold: the least width to fold them to."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    for header in headers:
        table.add_column(header, no_wrap=fold is None, overflow="fold", min_width=fold)
    return table


def roomy_table(*headers: str) -> Table:
    """Empty table without frame, with two blanks or more between columns, for wide terminals."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for header in headers:
        table.add_column(header, no_wrap=True)
    return table


def with_sentences(
    headers: Sequence[str], numbers: Sequence[str], last: str, rows: Sequence[tuple[Sequence[str], str, bool]]
) -> Iterator[Table]:
    """Tables whose last column has sentences; the narrow one has the needed ones below the first cell instead.

    rows: the cells but for the last, the sentence, and whether a narrow table needs it.
    """
    wide = roomy_table(*headers)
    add_numbers(wide, *numbers)
    wide.add_column(last, overflow="fold", min_width=_SENTENCE)
    narrow = plain_table(*headers)
    add_numbers(narrow, *numbers)
    narrow.columns[0].no_wrap, narrow.columns[0].min_width = False, _NAME
    for (first, *cells), sentence, needed in rows:
        wide.add_row(first, *cells, sentence)
        narrow.add_row(f"{first}\n  {sentence}" if needed else first, *cells)
    yield wide
    yield narrow


def add_numbers(table: Table, *headers: str) -> None:
    """Add columns of numbers, right-aligned."""
    for header in headers:
        table.add_column(header, justify="right", no_wrap=True)

"""LaTeX tables: of `--table`, and with -o of the totals."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, BinaryIO

from ..registry import TableFormat, register

if TYPE_CHECKING:
    from collections.abc import Mapping
    from threading import Event

    from ...analysis.result import Result
    from ..appearance import Appearance


def write(stream: BinaryIO, columns: Mapping[str, Any], precision: str | int, stop: Event | None) -> None:
    """Write the rows with readable digits."""
    from ..latex.table import write_table

    write_table(stream, columns, precision)


def write_totals(stream: BinaryIO, analysis: Result, appearance: Appearance) -> None:
    """Write the totals, in place of a table of vertices."""
    from ..latex.table import write_totals

    write_totals(stream, analysis, appearance)


register(
    TableFormat(
        suffix=".tex",
        description="LaTeX tabular without packages: the totals, or the table that --table names",
        place=5,
        write=write,
        totals=write_totals,
        brief=True,
    )
)

"""Catalogue of test surfaces, for the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rich import box
from rich.table import Table

from ...samples import specs
from ...support.words import format_rounded
from .console import escape, report_console

if TYPE_CHECKING:
    from ...samples.model import Sample, SampleSpec


def listing() -> None:
    """Print all surfaces with their descriptions."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("name", no_wrap=True)
    table.add_column("surface")
    for spec in specs():
        table.add_row(spec.name, escape(spec.summary))
    console = report_console()
    console.print(table)
    console.print("[dim]`curvcli sample NAME` prints the exact values of one; -o FILE writes it[/dim]")


def describe(spec: SampleSpec, made: Sample) -> None:
    """Print one surface: its parameters and exact values."""
    table = Table(box=None, show_header=False, pad_edge=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    table.add_row(spec.name, escape(spec.summary))
    table.add_row("mesh", f"{len(made.points):,} vertices, {len(made.faces):,} faces")
    given = ", ".join(f"{p.name}={p.default}" for p in spec.parameters)
    table.add_row("parameters", f"{given}  (--set NAME=VALUE)" if given else "none")
    table.add_row("known", escape(spec.exact))
    table.add_row("per vertex", ", ".join(made.exact) or "nothing")
    for label, known in (("of this mesh", made.facts), ("of the limit", made.limit)):
        for key, value in known.items():
            table.add_row(label, f"{key} = {_shown(value)}")
            label = ""
    report_console().print(table)


def _shown(value: Any) -> str:
    return format_rounded(value, 15) if isinstance(value, float) else str(value)

"""The table of all quantities, and everything about one, for the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rich.table import Table

from ..advice import as_text
from ..quantities import facts, facts_named, parameter_sentence, public
from .console import escape, report_console
from .tables import fitting, plain_table

# Minimum width of a column of formulas.
_FORMULA = 24


def listing() -> None:
    """Print a table of all quantities."""
    headers = ("name", "symbol", "on", "kind", "unit")
    tables = [_listed(headers[:count]) for count in (5, 4, 3, 2)]
    console = report_console()
    console.print(fitting(console, tables))
    console.print("[dim]+ beyond the core preset; `curvcli passes NAME` explains one[/dim]\n")
    advice = as_text(console.width) if console.is_terminal else as_text()
    console.print(escape(advice), soft_wrap=True, end="")


def _listed(headers: Sequence[str]) -> Table:
    """Table of all quantities with some of their facts and their folded formulas."""
    table = plain_table(*headers)
    table.add_column("formula", overflow="fold", min_width=_FORMULA)
    for quantity in public():
        shown: dict[str, Any] = {**facts(quantity)}
        marked = f"{quantity.name}{'' if shown['preset'] == 'core' else ' +'}"
        cells = [marked, *(shown[header] for header in headers[1:]), shown["formula"]]
        table.add_row(*(escape(cell) for cell in cells))
    return table


def describe(name: str) -> None:
    """Print all facts of one quantity."""
    shown: dict[str, Any] = {**facts_named(name)}
    table = Table(box=None, show_header=False, pad_edge=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    labels = {
        "symbol": "symbol",
        "description": "description",
        "formula": "formula",
        "kind": "kind",
        "unit": "unit",
        "columns": "columns",
        "boundary": "boundary",
        "preserves": "preserves",
        "total": "sum",
        "source": "source",
        "needs": "needs",
    }
    table.add_row(shown["name"], f"on every {shown['on']}")
    for key, label in labels.items():
        value = ", ".join(shown[key]) if isinstance(shown[key], list) else shown[key]
        if value:
            table.add_row(label, escape(" ".join(value.split())))
    for knob in shown["parameters"]:
        table.add_row("--set", escape(f"{knob['name']}=VALUE: {parameter_sentence(knob)}"))
    report_console().print(table)

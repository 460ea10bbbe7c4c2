"""The console that reports are printed on, and how it marks what passed and what did not."""

from __future__ import annotations

from typing import TextIO

import rich.console
from rich.markup import escape

from .configuration import Configured, sentence

# By the status of a check.
MARKS = {
    "pass": "[green]pass[/green]",
    "fail": "[bold red]FAIL[/bold red]",
    "error": "[bold red]ERROR[/bold red]",
    "not_applicable": "[dim]n/a[/dim]",
}


class Console(rich.console.Console):
    """A console that lets a closed pipe through as the BrokenPipeError it is.

    rich would end the program with a SystemExit, which does not tell that the work was done and its outputs are whole.
    """

    def on_broken_pipe(self) -> None:
        """Called while the BrokenPipeError is handled."""
        raise


def show_configuration(console: rich.console.Console, field: Configured) -> None:
    """A line below the verdict where a configuration file has to do with it."""
    if told := sentence(field):
        console.print(escape(told), style="yellow", soft_wrap=True)


def report_console(least: int = 0, stream: TextIO | None = None) -> Console:
    """A console on stdout, or on a stream; least: how wide it is at least where no terminal folds what it prints."""
    console = Console(file=stream, highlight=False)
    if least and not console.is_terminal:
        console.width = max(console.width, least)
    return console

"""Console of the reports, and its marks for passes and failures."""

from __future__ import annotations

import re
from typing import Any, TextIO

import rich.console
import rich.markup
from rich.text import Text

from ...analysis.configuration import Configured, sentence
from ...support.words import escape_text

# Marks by the status of a check.
MARKS = {
    "pass": "[green]pass[/green]",
    "fail": "[bold red]FAIL[/bold red]",
    "error": "[bold red]ERROR[/bold red]",
    "not_applicable": "[dim]n/a[/dim]",
}


# Workflow commands: a GitHub runner runs these at the beginning of a line of a log.
_COMMAND = re.compile(r"^(\s*):(?=:)")


def escape(text: object) -> str:
    """Text from outside for a line or a cell of a terminal, without markup, control sequences or line ends.

    All data printed on a console passes through this function. Names that look like a workflow command cannot begin a
    line as one.
    """
    return rich.markup.escape(_COMMAND.sub(r"\1\\x3a", escape_text(str(text))))


class Console(rich.console.Console):
    """Console of plain characters: no emoji by names between colons, no control sequences but rich's own.

    A closed pipe raises BrokenPipeError. rich would raise SystemExit, which hides that the work was done and its
    outputs are whole.
    """

    def __init__(self, *, stderr: bool = False, file: TextIO | None = None) -> None:
        super().__init__(stderr=stderr, file=file, highlight=False, emoji=False)

    def render_str(self, text: str, *arguments: Any, **settings: Any) -> Text:
        """Text of cells and lines; text that bypassed `escape` is still harmless."""
        if not text.isprintable():
            text = "\n".join(map(escape_text, text.split("\n")))
        return super().render_str(text, *arguments, **settings)

    def on_broken_pipe(self) -> None:
        """Re-raise the BrokenPipeError being handled."""
        raise


def show_configuration(console: rich.console.Console, field: Configured) -> None:
    """Line below the verdict if a configuration file affects it."""
    if text := sentence(field):
        console.print(escape(text), style="yellow", soft_wrap=True)


def report_console(least: int = 0, stream: TextIO | None = None) -> Console:
    """Console on stdout, or on a stream; least: minimum width where no terminal folds the lines."""
    console = Console(file=stream)
    if least and not console.is_terminal:
        console.width = max(console.width, least)
    return console

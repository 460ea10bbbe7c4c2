"""The console that reports are printed on, and how it marks what passed and what did not."""

from __future__ import annotations

import re
from typing import Any, TextIO

import rich.console
import rich.markup
from rich.text import Text

from ...analysis.configuration import Configured, sentence
from ...support.words import escape_text

# By the status of a check.
MARKS = {
    "pass": "[green]pass[/green]",
    "fail": "[bold red]FAIL[/bold red]",
    "error": "[bold red]ERROR[/bold red]",
    "not_applicable": "[dim]n/a[/dim]",
}


# What a runner of GitHub obeys at the beginning of a line of a log.
_COMMAND = re.compile(r"^(\s*):(?=:)")


def escape(text: object) -> str:
    """Text from outside for a line or a cell of a terminal: it is no markup, no control sequence, no second line.

    This is the one way from data to what a console prints. Names that begin as a workflow command does not begin a line
    as one either.
    """
    return rich.markup.escape(_COMMAND.sub(r"\1\\x3a", escape_text(str(text))))


class Console(rich.console.Console):
    """A console of plain characters: no emoji by names between colons, no control sequence but rich's own.

    A closed pipe passes as the BrokenPipeError it is. rich would end the program with a SystemExit, which does not tell
    that the work was done and its outputs are whole.
    """

    def __init__(self, *, stderr: bool = False, file: TextIO | None = None) -> None:
        super().__init__(stderr=stderr, file=file, highlight=False, emoji=False)

    def render_str(self, text: str, *arguments: Any, **settings: Any) -> Text:
        """Text of cells and lines; what went round `escape` is still harmless here."""
        if not text.isprintable():
            text = "\n".join(map(escape_text, text.split("\n")))
        return super().render_str(text, *arguments, **settings)

    def on_broken_pipe(self) -> None:
        """Called while the BrokenPipeError is handled."""
        raise


def show_configuration(console: rich.console.Console, field: Configured) -> None:
    """A line below the verdict where a configuration file has to do with it."""
    if told := sentence(field):
        console.print(escape(told), style="yellow", soft_wrap=True)


def report_console(least: int = 0, stream: TextIO | None = None) -> Console:
    """A console on stdout, or on a stream; least: how wide it is at least where no terminal folds what it prints."""
    console = Console(file=stream)
    if least and not console.is_terminal:
        console.width = max(console.width, least)
    return console

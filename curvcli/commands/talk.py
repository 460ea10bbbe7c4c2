"""Output on stdout, and messages on stderr: one line at a time, printable whatever they quote."""

from __future__ import annotations

import re
import sys
import traceback

import click

from ..errors import defect
from ..support.words import escape_text

# Characters kept at either end of a message that quotes something very long.
_SHOWN = 1000


def say(message: str) -> None:
    """Print one line on stderr; if stderr is closed, the exit code remains."""
    click.echo(f"curvcli: {one_line(message)}", err=True)


def put(data: str | bytes) -> None:
    """Print text or bytes on stdout; every command prints by this function or by the console of `report/terminal`."""
    click.echo(data, nl=False)


def one_line(text: str) -> str:
    """Text on one line; the middle of a very long one is left out."""
    if len(text) > 2 * _SHOWN:
        text = f"{text[:_SHOWN]} … {text[-_SHOWN:]}"
    return escape_text(" ".join(text.split("\n")))


def internal(error: BaseException) -> str:
    """One line for a defect of the program; -vv prints the traceback."""
    # From the typed words: the defect may precede, or interrupt, the reading of options.
    typed = [word for word in sys.argv[1:] if re.fullmatch(r"-[qv]+", word)]
    if "".join(typed).count("v") + sys.argv.count("--verbose") > 1:
        lines = "".join(traceback.format_exception(error)).split("\n")
        click.echo("\n".join(map(escape_text, lines)), err=True, nl=False)
    return f"{one_line(defect(error))}; -vv shows the traceback"

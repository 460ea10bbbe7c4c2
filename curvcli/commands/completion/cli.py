"""`curvcli completion`: the shell completes commands, options, files and names."""

from __future__ import annotations

import click

from ...support.words import escape_text
from . import shells

_SHELL = click.argument("name", metavar="[SHELL]", required=False, type=click.Choice(shells.SHELLS))


@click.group("completion", short_help="Let the shell complete commands, options and names.")
def command() -> None:
    """Let bash, zsh or fish complete commands, options, files and names of quantities.

    SHELL is that of $SHELL if it is not named. What is written, and where, is said; a start-up file of the
    shell gets one marked block at its end and is otherwise left as it is.

    \b
      curvcli completion install     write what the shell needs; again is harmless
      curvcli completion show zsh    the script itself
      curvcli completion remove      take everything away again
    """


@command.command("install", short_help="Write the script and the lines that load it.")
@_SHELL
def install(name: str | None) -> int:
    """Write the script where the shell finds it and, for bash and zsh, the lines that load it."""
    one = shells.shell(name)
    for path, changed in shells.install(one):
        click.echo(f"{'written' if changed else 'unchanged'}: {escape_text(str(path))}")
    click.echo(f"new {one.name} shells complete `curvcli`; `curvcli completion remove {one.name}` takes it away")
    return 0


@command.command("remove", short_help="Take away what `install` wrote.")
@_SHELL
def remove(name: str | None) -> int:
    """Take away the script and the lines that load it."""
    one = shells.shell(name)
    for path, changed in shells.remove(one):
        did = "nothing to remove" if not changed else "removed" if path == one.script else "block removed"
        click.echo(f"{did}: {escape_text(str(path))}")
    return 0


@command.command("show", short_help="Print the script of a shell.")
@_SHELL
def show(name: str | None) -> int:
    """Print the script, for those who keep their own start-up files."""
    click.echo(shells.source(shells.shell(name).name), nl=False)
    return 0

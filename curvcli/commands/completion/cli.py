"""`curvcli completion`: complete commands, options, files and names in the shell."""

from __future__ import annotations

import click

from ...support.words import escape_text
from ..talk import put
from . import shells

_SHELL = click.argument("name", metavar="[SHELL]", required=False, type=click.Choice(shells.SHELLS))


@click.group("completion", short_help="Install shell completion for commands, options and names.")
def command() -> None:
    """Complete commands, options, files and names of quantities in bash, zsh or fish.

    SHELL defaults to $SHELL. Every file written is printed; a start-up file of the shell gets one marked block
    at its end and is otherwise unchanged.

    \b
      curvcli completion install     write the script and start-up lines
      curvcli completion show zsh    print the script
      curvcli completion remove      remove everything that install wrote
    """


@command.command("install", short_help="Write the script and the lines that load it.")
@_SHELL
def install(name: str | None) -> int:
    """Write the script to the completion folder of the shell and, for bash and zsh, the lines that load it."""
    target = shells.shell(name)
    for path, changed in shells.install(target):
        put(f"{'written' if changed else 'unchanged'}: {escape_text(str(path))}\n")
    put(f"new {target.name} shells complete `curvcli`; to undo: `curvcli completion remove {target.name}`\n")
    return 0


@command.command("remove", short_help="Remove the files and lines of `install`.")
@_SHELL
def remove(name: str | None) -> int:
    """Remove the script and the lines that load it."""
    target = shells.shell(name)
    for path, changed in shells.remove(target):
        did = "nothing to remove" if not changed else "removed" if path == target.script else "block removed"
        put(f"{did}: {escape_text(str(path))}\n")
    return 0


@command.command("show", short_help="Print the script of a shell.")
@_SHELL
def show(name: str | None) -> int:
    """Print the script, for a start-up file that you manage yourself."""
    put(shells.source(shells.shell(name).name))
    return 0

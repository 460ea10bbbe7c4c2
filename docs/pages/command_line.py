"""The page of the command line: what `--help` says of every command."""

from __future__ import annotations

import click

from curvcli.commands.main import cli
from curvcli.commands.names import COMMANDS

# As wide as a block of code on a page.
_WIDTH = 88

_INTRODUCTION = """\
# The command line

Made from `curvcli --help` and `curvcli COMMAND --help`. Options may stand before or after meshes. Their defaults may be
set in a file: see [formats](formats.md#configuration). What the exit codes mean stands there too.
"""


def page() -> str:
    """The help of every command, in Markdown."""
    root = click.Context(cli, info_name="curvcli", terminal_width=_WIDTH, help_option_names=["-h", "--help"])
    parts = [_INTRODUCTION, _block("## `curvcli`", cli.get_help(root))]
    for name in COMMANDS:
        command = cli.get_command(root, name)
        assert command is not None
        context = click.Context(command, root, name, terminal_width=_WIDTH, help_option_names=["-h", "--help"])
        parts.append(_block(f"## `curvcli {name}`", command.get_help(context)))
    return "\n".join(parts)


def _block(heading: str, text: str) -> str:
    return f"{heading}\n\n```text\n{text.rstrip()}\n```\n"

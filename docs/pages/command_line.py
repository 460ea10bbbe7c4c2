"""The page of the command line, from the help of every command."""

from __future__ import annotations

import click

from curvcli.commands.main import cli
from curvcli.commands.names import COMMANDS

# As wide as a block of code on a page.
_WIDTH = 88

_INTRODUCTION = """\
# The command line

This page is the output of `curvcli --help` and `curvcli COMMAND --help`. Options may precede or follow meshes. A
[configuration file](formats.md#configuration) may set their defaults. The [exit codes](formats.md#exit-codes) are on
another page.
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

"""`curvcli help`: print topics beyond the options of the commands."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from .topics import Topic
from . import candidates
from .talk import put


@click.command("help", short_help="Explain a topic or a command; without one, list the topics.")
@click.argument("topic", required=False, shell_complete=candidates.topics)
def command(topic: str | None) -> int:
    """Explain TOPIC: conventions, checks, formats, exit codes and more, or a command. Without it, list the topics.

    \b
      curvcli help
      curvcli help conventions
      curvcli help analyze            the same as `curvcli analyze --help`
    """
    from .topics import TOPICS

    if topic is None:
        overview(TOPICS)
        return 0
    key = topic.lower().replace("_", "-")
    if key in TOPICS:
        put(TOPICS[key].text())
        return 0
    of_command(topic, TOPICS)
    return 0


def overview(topics: dict[str, Topic]) -> None:
    """Print the list of topics."""
    formatter = click.HelpFormatter(width=100)
    with formatter.section("Topics, `curvcli help TOPIC`"):
        formatter.write_dl([(name, topic.summary) for name, topic in topics.items()])
    put(
        formatter.getvalue()
        + "\nOptions of a command: `curvcli COMMAND --help`; one quantity: `curvcli passes NAME`.\n"
    )


def of_command(name: str, topics: dict[str, Topic]) -> None:
    """Print the help of a command.

    Errors: click.UsageError, with a suggestion, for a name that is neither a topic nor a command.
    """
    from ..support.words import suggestion
    from .main import cli
    from .names import COMMANDS

    context = click.get_current_context().find_root()
    command = cli.get_command(context, name)
    if command is None:
        way_out = suggestion(name, [*topics, *COMMANDS], "`curvcli help` lists them")
        raise click.UsageError(f"no topic or command is called {name!r}{way_out}", click.get_current_context())
    with click.Context(command, info_name=name, parent=context, max_content_width=100) as inner:
        put(command.get_help(inner) + "\n")

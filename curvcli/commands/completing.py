"""What the shell is offered for a parameter: files, folders, or names that belong there."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from copy import copy

import click
from click.shell_completion import CompletionItem


class Names(click.ParamType[str]):
    """Names of which only the program knows; the last of a comma list, or behind a prefix, is completed."""

    name = "text"

    def __init__(self, known: Callable[[], Iterable[str]]) -> None:
        self.known = known

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem[str]]:
        """Those that begin as what was typed."""
        before, comma, last = incomplete.rpartition(",")
        return [CompletionItem(f"{before}{comma}{name}") for name in self.known() if name.startswith(last)]


def _passes() -> list[str]:
    from ..declare import passes
    from ..pipeline import load_passes

    load_passes()
    return ["topology", "core", "paper", "all", *(quantity.name for quantity in passes.quantities("vertex"))]


def _quantities() -> list[str]:
    from ..report.quantities import public

    return [quantity.name for quantity in public()]


def _columns() -> list[str]:
    from ..declare import passes
    from ..pipeline import load_passes

    load_passes()
    return [column for quantity in passes.quantities("vertex") for column in quantity.columns]


def _requirements() -> list[str]:
    from ..requirements import kinds

    return [f"{kind.name}=" if kind.number else kind.name for kind in kinds.values()]


def _allowed() -> list[str]:
    from ..checks import rules
    from ..requirements import DEFAULT

    return [*DEFAULT, *rules]


def _samples() -> Iterable[str]:
    from ..samples.catalogue import names

    return names()


def _tables() -> list[str]:
    from ..tables import TABLES

    return [f"{kind}=" for kind in TABLES]


def _topics() -> list[str]:
    from .main import COMMANDS
    from .topics import TOPICS

    return [*TOPICS, *COMMANDS]


_KNOWN: dict[tuple[str, str], Callable[[], Iterable[str]]] = {
    ("*", "passes"): _passes,
    ("*", "color_by"): _columns,
    ("*", "tables"): _tables,
    ("check", "require"): _requirements,
    ("check", "allow"): _allowed,
    ("help", "topic"): _topics,
    ("passes", "name"): _quantities,
    ("sample", "name"): _samples,
}

_FILES = ("MESH", "FILE", "PATH", "PATTERN", "LIST", "A", "B")


def completing(command: click.Command) -> click.Command:
    """A copy of the command whose parameters know what may stand there; what it runs with stays plain text."""
    command = copy(command)
    command.params = [copy(param) for param in command.params]
    for param in command.params:
        if not isinstance(param.type, click.types.StringParamType) or param.name is None:
            continue
        known = _KNOWN.get((command.name or "", param.name)) or _KNOWN.get(("*", param.name))
        first = (param.metavar or "").split("|")[0].rstrip(".")
        if known is not None:
            param.type = Names(known)
        elif first == "DIR":
            param.type = click.Path(file_okay=False)
        elif first in _FILES:
            param.type = click.Path()
    return command

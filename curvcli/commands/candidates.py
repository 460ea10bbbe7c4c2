"""Words that complete the value of an option or an argument in a shell, for `shell_complete` of its declaration."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from copy import copy
from functools import wraps
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

Completions = Callable[[click.Context, click.Parameter, str], "list[CompletionItem[str]]"]

_FILES = ("MESH", "FILE", "PATH", "PATTERN", "LIST", "A", "B")


def _listed(choices: Callable[[click.Context], Iterable[str]]) -> Completions:
    """Complete the last item of a comma list from the choices that a function returns."""

    @wraps(choices)
    def complete(context: click.Context, parameter: click.Parameter, incomplete: str) -> list[CompletionItem[str]]:
        from click.shell_completion import CompletionItem

        before, comma, last = incomplete.rpartition(",")
        return [CompletionItem(f"{before}{comma}{choice}") for choice in choices(context) if choice.startswith(last)]

    return complete


def _with_files(choices: Callable[[click.Context], Iterable[str]]) -> Completions:
    """Complete from the choices that a function returns, or else a file, also behind `=`."""

    @wraps(choices)
    def complete(context: click.Context, parameter: click.Parameter, incomplete: str) -> list[CompletionItem[str]]:
        from click.shell_completion import CompletionItem

        _, equals, behind = incomplete.rpartition("=")
        if equals:
            return [CompletionItem(behind, type="file")]
        near = [CompletionItem(choice) for choice in choices(context) if choice.startswith(incomplete)]
        return near or [CompletionItem(incomplete, type="file")]

    return complete


@_listed
def passes(context: click.Context) -> Iterable[str]:
    """Presets and quantities of vertices."""
    from ..curvatures.catalogue import presets
    from ..curvatures.registry import passes

    return [*presets(), *(quantity.name for quantity in passes.quantities("vertex"))]


@_listed
def quantities(context: click.Context) -> Iterable[str]:
    """Quantities of all elements."""
    from ..report.quantities import public

    return [quantity.name for quantity in public()]


@_listed
def columns(context: click.Context) -> Iterable[str]:
    """Columns of vertices."""
    from ..curvatures.catalogue import load_passes
    from ..curvatures.registry import passes

    load_passes()
    return [column for quantity in passes.quantities("vertex") for column in quantity.columns]


@_listed
def requirements(context: click.Context) -> Iterable[str]:
    """Requirements and their sets; those with a number end with `=`."""
    from ..checks.requirements.catalogue import SETS, requirements

    return [*(f"{each.name}=" if each.number else each.name for each in requirements().values()), *SETS]


@_listed
def tests(context: click.Context) -> Iterable[str]:
    """Requirements of every mesh, and identities."""
    from ..checks.catalogue import identities
    from ..checks.requirements.catalogue import defaults
    from ..curvatures.catalogue import load_passes

    load_passes()
    return [*defaults(), *identities()]


@_listed
def samples(context: click.Context) -> Iterable[str]:
    """Sample surfaces."""
    from ..samples.catalogue import names

    return names()


@_listed
def sample_parameters(context: click.Context) -> Iterable[str]:
    """Parameters of all samples: while an option waits for its value, click has not read the arguments yet."""
    from ..samples.catalogue import specs

    return dict.fromkeys(f"{parameter.name}=" for spec in specs() for parameter in spec.parameters)


@_listed
def topics(context: click.Context) -> Iterable[str]:
    """Topics of the help, and commands."""
    from .names import COMMANDS
    from .topics import TOPICS

    return [*TOPICS, *COMMANDS]


@_listed
def formats(context: click.Context) -> Iterable[str]:
    """Output formats of a command."""
    from ..output.registry import OutputKind, suffixes

    kinds: dict[str | None, tuple[OutputKind, ...]] = {
        "compare": ("table", "report"),
        "curves": ("table", "report"),
        "sample": ("table", "mesh", "triangles"),
    }
    every: tuple[OutputKind, ...] = ("table", "mesh", "overlay", "report", "page", "picture")
    return [suffix[1:] for suffix in suffixes(kinds.get(context.command.name, every))]


def tables(kinds: Callable[[], Iterable[str]]) -> Completions:
    """Complete `KIND=PATH` by these kinds of tables."""
    return _with_files(lambda context: [f"{kind}=" for kind in kinds()])


def completing(command: click.Command) -> click.Command:
    """A copy of the command whose parameters complete what their metavars name; the original keeps plain text."""
    command = copy(command)
    command.params = [copy(param) for param in command.params]
    for param in command.params:
        if isinstance(param.type, click.types.StringParamType) and param.name is not None:
            param.type = _Metavar(param.metavar or "")
    return command


class _Metavar(click.types.StringParamType):
    """Text that is completed by its metavar: capitals mean files or folders, lower-case words are choices."""

    def __init__(self, metavar: str) -> None:
        self.choices = metavar.rstrip(".").split("|")

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem[str]]:
        """Choices that begin with the typed text, or a file or a folder."""
        from click.shell_completion import CompletionItem

        if self.choices[0] == "DIR":
            return [CompletionItem(incomplete, type="dir")]
        names = [word for word in self.choices if word.islower() and word.isalpha()]
        if self.choices[0] in _FILES:
            return _with_files(lambda context: names)(ctx, param, incomplete)
        return _listed(lambda context: names)(ctx, param, incomplete)

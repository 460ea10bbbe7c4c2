"""Completions of a parameter for the shell: files, folders or names."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from copy import copy

import click
from click.shell_completion import CompletionItem

Known = Callable[[], Iterable[str]]


class Names(click.ParamType[str]):
    """Names that only the program knows; in a comma list the last one is completed.

    files: also complete files, alone or behind the `=` of a name that ends with one.
    """

    name = "text"

    def __init__(self, known: Known, files: bool = False) -> None:
        self.known, self.files = known, files

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem[str]]:
        """Names that begin with the typed text."""
        _, equals, behind = incomplete.rpartition("=")
        if equals:
            return [CompletionItem(behind, type="file")] if self.files else []
        before, comma, last = incomplete.rpartition(",")
        items = [CompletionItem(f"{before}{comma}{name}") for name in self.known() if name.startswith(last)]
        return items or ([CompletionItem(incomplete, type="file")] if self.files else [])


def _passes() -> list[str]:
    from ...curvatures.catalogue import presets
    from ...curvatures.registry import passes

    return [*presets(), *(quantity.name for quantity in passes.quantities("vertex"))]


def _quantities() -> list[str]:
    from ...report.quantities import public

    return [quantity.name for quantity in public()]


def _columns() -> list[str]:
    from ...curvatures.catalogue import load_passes
    from ...curvatures.registry import passes

    load_passes()
    return [column for quantity in passes.quantities("vertex") for column in quantity.columns]


def _requirements() -> list[str]:
    from ...checks.requirements.catalogue import SETS, requirements

    return [*(f"{each.name}=" if each.number else each.name for each in requirements().values()), *SETS]


def _allowed() -> list[str]:
    from ...checks.catalogue import identities
    from ...checks.requirements.catalogue import defaults
    from ...curvatures.catalogue import load_passes

    load_passes()
    return [*defaults(), *identities()]


def _samples() -> Iterable[str]:
    from ...samples.catalogue import names

    return names()


def _tables() -> list[str]:
    from ...output.tables.columns import TABLES

    return [f"{kind}=" for kind in TABLES]


def _tables_of_maps() -> list[str]:
    from ..compare import TABLES

    return [f"{kind}=" for kind in TABLES]


def _tables_of_curves() -> list[str]:
    from ..curves import TABLES

    return [f"{kind}=" for kind in TABLES]


def _parameters() -> Iterable[str]:
    from ...samples.catalogue import specs

    # Of all samples: while an option waits for its value, click has not read the arguments yet.
    return dict.fromkeys(f"{parameter.name}=" for spec in specs() for parameter in spec.parameters)


def _formats() -> list[str]:
    from ...output.registry import suffixes

    return [suffix[1:] for suffix in suffixes(("table", "mesh", "overlay", "report", "page", "picture"))]


def _plain_formats() -> list[str]:
    from ...output.registry import suffixes

    return [suffix[1:] for suffix in suffixes(("table", "report"))]


def _sample_formats() -> list[str]:
    from ...output.registry import suffixes

    return [suffix[1:] for suffix in suffixes(("table", "mesh", "triangles"))]


def _topics() -> list[str]:
    from ..names import COMMANDS
    from ..topics import TOPICS

    return [*TOPICS, *COMMANDS]


# Completions by parameter, in one command or in all.
_KNOWN: dict[tuple[str, str], Known] = {
    ("*", "passes"): _passes,
    ("*", "color_by"): _columns,
    ("*", "histograms"): _columns,
    ("analyze", "stream_format"): _formats,
    ("analyze", "tables"): _tables,
    ("batch", "save"): _formats,
    ("check", "allow"): _allowed,
    ("check", "require"): _requirements,
    ("compare", "stream_format"): _plain_formats,
    ("compare", "tables"): _tables_of_maps,
    ("curves", "stream_format"): _plain_formats,
    ("curves", "tables"): _tables_of_curves,
    ("help", "topic"): _topics,
    ("passes", "name"): _quantities,
    ("sample", "name"): _samples,
    ("sample", "settings"): _parameters,
    ("sample", "stream_format"): _sample_formats,
}

_FILES = ("MESH", "FILE", "PATH", "PATTERN", "LIST", "A", "B")


def completing(command: click.Command) -> click.Command:
    """A copy of the command whose parameters have completions; the original keeps plain text parameters."""
    command = copy(command)
    command.params = [copy(param) for param in command.params]
    for param in command.params:
        if isinstance(param.type, click.types.StringParamType) and param.name is not None:
            param.type = _type(command.name or "", param.name, param.metavar or "")
    return command


def _type(command: str, name: str, metavar: str) -> click.ParamType[str]:
    """Completion type from the table, or from the metavar: capitals mean files, lower-case words are choices."""
    known = _KNOWN.get((command, name)) or _KNOWN.get(("*", name))
    if known is not None:
        return Names(known, files=name == "tables")
    choices = metavar.rstrip(".").split("|")
    if choices[0] == "DIR":
        return click.Path(file_okay=False)
    choices_listed = [word for word in choices if word.islower() and word.isalpha()]
    files = choices[0] in _FILES
    if choices_listed:
        return Names(lambda: choices_listed, files)
    return click.Path() if files else click.STRING

"""Streams and outputs of a command, from its meshes, -o, --table, --format, --json and --get."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from ..errors import UsageError
from ..support.words import suggestion
from .talk import put

if TYPE_CHECKING:
    from ..output.registry import Format, OutputKind


@dataclass(frozen=True)
class OutputSpec:
    """path: `-` is stdout. kind: `report`, or the name of a table. suffix: of its format."""

    path: str
    kind: str
    suffix: str


def table_option(text: str, known: Collection[str]) -> tuple[str, str]:
    """Kind and path of --table KIND=PATH.

    Errors: UsageError for an unknown kind, with the known ones.
    """
    kind, equals, path = text.partition("=")
    if not equals or not path:
        raise UsageError(f"--table {text}: expected KIND=PATH with KIND one of {', '.join(known)}")
    if kind not in known:
        raise UsageError(f"--table {text}: there is no table {kind!r}{suggestion(kind, known)}")
    return kind, path


def tables_and_reports(
    outputs: tuple[str, ...], tables: tuple[str, ...], known: Collection[str], stream_format: str | None
) -> list[OutputSpec]:
    """Outputs of a command that writes tables and a report; -o writes the table of vertices.

    known: the kinds of tables. Errors: UsageError for a suffix or a kind that is not known.
    """
    from ..output.registry import format_of

    def named(path: str, *kinds: OutputKind) -> Format:
        return format_of(path, name=stream_format if path == "-" else None, kinds=kinds)

    specs = []
    for path in outputs:
        format = named(path, "table", "report")
        specs.append(OutputSpec(path, "vertices" if format.kind == "table" else "report", format.suffix))
    for text in tables:
        kind, path = table_option(text, known)
        specs.append(OutputSpec(path, kind, named(path, "table").suffix))
    return specs


def one_stdout(paths: Iterable[str], as_json: bool, get: tuple[str, ...], stream_format: str | None) -> bool:
    """True if an output goes to stdout.

    Errors: click.UsageError for two outputs on stdout, or a format without `-o -`.
    """
    context = click.get_current_context()
    taken = "-" in paths
    if as_json and get:
        raise click.UsageError("--json and --get both write to stdout; choose one", context)
    if taken and (as_json or get):
        raise click.UsageError("-o - and --json or --get both write to stdout; choose one", context)
    if not taken and context.get_parameter_source("stream_format") is ParameterSource.COMMANDLINE:
        raise click.UsageError(f"--format {stream_format} names the format of `-o -`, which is not given", context)
    return taken


def stdin_once(meshes: Sequence[str]) -> None:
    """Errors: click.UsageError where `-` stands for several meshes: stdin can be read only once."""
    if meshes.count("-") > 1:
        raise click.UsageError("`-` is given twice, but stdin can be read once only", click.get_current_context())


def print_report(
    report: Callable[[], Any], summary: Callable[[], None], as_json: bool, get: tuple[str, ...], quiet: bool
) -> None:
    """Print the report as JSON, some values of it, or the summary."""
    if as_json:
        from ..report.model import encode

        put(encode(report()))
    elif get:
        from ..report.lookup import look_up

        tree = report()
        put("".join([f"{look_up(tree, key)}\n" for key in get]))
    elif not quiet:
        summary()

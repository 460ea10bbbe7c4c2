"""Which outputs a command is to write, from -o, --table and --format."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import TYPE_CHECKING

import click

from ..errors import UsageError

if TYPE_CHECKING:
    from ..output.formats import Format, Kind


@dataclass(frozen=True)
class Wanted:
    """path: `-` is stdout. kind: `report`, or the name of a table. suffix: of its format."""

    path: str
    kind: str
    suffix: str


def table_option(text: str, known: Collection[str]) -> tuple[str, str]:
    """The kind and the path of --table KIND=PATH.

    Errors: UsageError for an unknown kind, with those there are.
    """
    kind, equals, path = text.partition("=")
    if not equals or not path or kind not in known:
        raise UsageError(f"--table {text}: expected KIND=PATH with KIND one of {', '.join(known)}")
    return kind, path


def tables_and_reports(
    outputs: tuple[str, ...], tables: tuple[str, ...], known: Collection[str], stream_format: str | None
) -> list[Wanted]:
    """Every output of a command that writes tables and a report; -o writes the table of vertices.

    known: the kinds of tables. Errors: UsageError for a suffix or a kind that is not known.
    """
    from ..output.formats import format_of

    def named(path: str, *kinds: Kind) -> Format:
        return format_of(path, name=stream_format if path == "-" else None, kinds=kinds)

    found = []
    for path in outputs:
        one = named(path, "table", "report")
        found.append(Wanted(path, "vertices" if one.kind == "table" else "report", one.suffix))
    for text in tables:
        kind, path = table_option(text, known)
        found.append(Wanted(path, kind, named(path, "table").suffix))
    return found


def one_stdout(wanted: list[Wanted], as_json: bool, get: str | None) -> bool:
    """Whether an output goes to stdout.

    Errors: click.UsageError when --json or --get wants it too.
    """
    taken = any(one.path == "-" for one in wanted)
    if taken and (as_json or get is not None):
        raise click.UsageError("-o - and --json or --get both want stdout; choose one", click.get_current_context())
    return taken

"""`curvcli compare` of two groups of reports: find and read the reports, test the differences, write and print them."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

import click

from ..errors import FAILED_CHECK, OK, InputError, NoMatchError, UsageError
from ..support.words import escape_text
from . import options
from .outputs import one_stdout, print_report

if TYPE_CHECKING:
    from ..report.groups.means import TestOptions
    from ..report.groups.members import Member

# Options of groups alone, and all that a comparison of groups uses.
GROUP_OPTIONS = ("test", "alpha", "correction", "resamples", "seed", "stat", "strict")
USED = (
    *GROUP_OPTIONS,
    *("only", "ignore", "outputs", "as_json", "get", "stream_format", "precision", "force", "quiet", "verbose"),
    "max_bytes",
)
_WILD = "*?["
_REPORTS = os.path.join("**", "*.json")


group_options = options.together(
    click.option(
        "--test",
        type=click.Choice(["welch", "permutation"]),
        default="welch",
        show_default=True,
        help="Groups: Welch's t test, or permutations of the difference of means.",
    ),
    click.option(
        "--alpha",
        type=options.Finite(0, 1, min_open=True, max_open=True),
        default=0.05,
        show_default=True,
        help="Groups: level of significance; intervals have the level 1 − alpha.",
    ),
    click.option(
        "--correction",
        type=click.Choice(["bh", "by", "none"]),
        default="bh",
        show_default=True,
        help="Groups: false discovery rate by Benjamini-Hochberg or Benjamini-Yekutieli.",
    ),
    click.option(
        "--resamples",
        type=click.IntRange(99, 1_000_000),
        default=9999,
        show_default=True,
        help="Groups: permutations; all of them where there are fewer.",
    ),
    click.option("--seed", type=click.IntRange(0), default=0, show_default=True, help="Groups: seed of permutations."),
    click.option(
        "--stat",
        metavar="NAME[,NAME]",
        multiple=True,
        help="Groups: statistics of columns to compare, such as mean,p98,share.  [default: area_mean]",
    ),
    click.option("--strict", is_flag=True, help="Groups: exit with 1 if a difference is significant."),
)


def is_group(path: str) -> bool:
    """True for a folder, and for a pattern that is not the name of a file."""
    return os.path.isdir(path) or (any(sign in path for sign in _WILD) and not os.path.exists(path))


def are_groups(a: str, b: str) -> bool:
    """True if both are groups, or one is and holds reports: a folder of meshes beside a mesh is no group."""
    return (is_group(a) and is_group(b)) or any(is_group(path) and _holds_reports(path) for path in (a, b))


def _holds_reports(path: str) -> bool:
    return not os.path.isdir(path) or any(glob.iglob(os.path.join(glob.escape(path), _REPORTS), recursive=True))


def compare_groups(
    a: str,
    b: str,
    *,
    test: TestOptions,
    stat: tuple[str, ...],
    only: tuple[str, ...],
    ignore: tuple[str, ...],
    strict: bool,
    outputs: tuple[str, ...],
    as_json: bool,
    get: tuple[str, ...],
    stream_format: str | None,
    precision: str,
    force: bool,
    quiet: bool,
    verbose: int,
    max_bytes: int | None,
) -> int:
    """Compare two groups; the exit code, 1 with `strict` where a difference is significant.

    Errors: UsageError for a mesh, a report or a table beside a group; NoMatchError for a group without reports.
    """
    from ..analysis.configuration import configured
    from ..curvatures.catalogue import load_passes
    from ..output.atomic import Outputs
    from ..output.registry import format_of
    from ..output.tables.write import parse_precision, write_table
    from ..report.compare.values import selector
    from ..report.groups import model
    from ..report.model import as_dict, encode
    from ..report.terminal.groups import show
    from .config_notes import configuration

    for path, other in ((a, b), (b, a)):
        if not is_group(path):
            raise UsageError(
                f"{path}: {other} is a group of reports; expected another folder, or a pattern in quotes such as "
                "'reports/*.json'"
            )
    formats = [
        format_of(path, name=stream_format if path == "-" else None, kinds=("table", "report", "picture"))
        for path in outputs
    ]
    _check_pictures([format.suffix for format in formats if format.kind == "picture"])
    to_stdout = one_stdout(outputs, as_json, get, stream_format)
    parse_precision(precision)
    load_passes()
    with Outputs(list(outputs), force) as files:
        sides = [(path, read_group(path, max_bytes)) for path in (a, b)]
        names = [name.strip() for text in stat for name in text.split(",") if name.strip()]
        report = model.compare_groups(sides[0], sides[1], test, selector(only, ignore), names)
        report.configuration = configured(configuration())
        for path, format in zip(outputs, formats, strict=True):
            with files.open(path) as stream:
                if format.kind == "report":
                    stream.write(encode(as_dict(report)))
                elif format.kind == "picture":
                    from ..output.pictures.forest import write_forest

                    write_forest(stream, report, format.suffix)
                else:
                    write_table(stream, model.group_table(report), format.suffix, precision=precision)
        print_report(partial(as_dict, report), partial(show, report, verbose), as_json, get, quiet or to_stdout)
    return FAILED_CHECK if strict and report.significant else OK


def _check_pictures(suffixes: list[str]) -> None:
    from ..output.pictures.options import require_pictures

    if suffixes:
        require_pictures(surface=False)
        if any(suffix.count(".") > 1 for suffix in suffixes):
            raise UsageError("a comparison of groups is drawn as .png, .pdf or .svg; it has no histogram")


def read_group(path: str, max_bytes: int | None) -> list[Member]:
    """Members of a group: the reports (.json) in a folder and below it or of a pattern, or the meshes of a batch.

    A batch without reports is read from its manifest: the statistics of --long, else the totals.
    Errors: NoMatchError where there are none; InputError for a file that is no report.
    """
    from ..batch.model import MANIFEST

    folder = os.path.isdir(path)
    manifest = os.path.join(path, MANIFEST) if folder else None
    rows = list(_batch(manifest)) if manifest is not None and os.path.isfile(manifest) else []
    pattern = os.path.join(glob.escape(path), _REPORTS) if folder else path
    reports = sorted(name for name in glob.glob(pattern, recursive=True) if os.path.isfile(name))
    if rows and (not reports or any(row.values.keys() - _totals_of(row) for row in rows)):
        return rows
    members = [_report(name, max_bytes) for name in reports]
    if not members:
        problem = f"{escape_text(path)}: no report (.json)"
        raise NoMatchError(f"{problem} there; `curvcli batch MESHES -o DIR --save json` or --long writes some")
    return members


def _totals_of(row: Member) -> set[tuple[str | None, str, str]]:
    from ..report.entries import TOTAL

    return {key for key in row.values if key[0] is None and key[2] == TOTAL}


def _report(path: str, max_bytes: int | None) -> Member:
    from ..report.compare.stored import read_report
    from ..report.entries import entries
    from ..report.groups.members import member

    report = read_report(path, max_bytes=max_bytes)
    return member(path, entries(report), report, report["conventions"])


def _batch(manifest: str) -> Iterator[Member]:
    """The finished meshes of a batch, in the order of their paths."""
    import msgspec

    from ..batch.model import Row
    from ..report.entries import Entry, entries
    from ..report.groups.members import member

    rows: dict[str, Row] = {}
    with open(manifest, "rb") as stream:
        for number, line in enumerate(stream, 1):
            try:
                row = msgspec.json.decode(line, type=Row)
            except (msgspec.MsgspecError, UnicodeDecodeError) as error:
                if not line.endswith(b"\n"):
                    break  # torn off by an interruption
                raise InputError(f"line {number}: no row of a batch: {error}", path=manifest) from None
            rows[row.path] = row
    for path, row in sorted(rows.items()):
        if not row.topology:
            continue  # an error, with no result
        whole = {"topology": row.topology, "totals": row.totals, "regions": []}
        listed = [
            Entry(part.region, column, statistic, value)
            for part in row.statistics
            for column, statistics in part.columns.items()
            for statistic, value in statistics.items()
        ]
        yield member(path, listed or entries(whole), whole)

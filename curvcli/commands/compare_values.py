"""`curvcli compare` without --map: read both sides, compare them, write and print the differences."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from ..errors import FAILED_CHECK, OK, UsageError
from ..loading.limits import parse_weld
from ..report.compare.values import Difference, Tolerance, compare_reports, selector
from .compare_exact import accuracy, is_exact
from .compare_inputs import LoadedSide, both_sides, kind_of, stored_side
from .outputs import one_stdout, print_report
from .settings import merge_settings

if TYPE_CHECKING:
    from ..report.accuracy import Accuracy
    from ..report.compare.model import Comparison


def compare(
    a: str,
    b: str,
    *,
    given: set[str],
    rtol: float,
    atol: float,
    only: tuple[str, ...],
    ignore: tuple[str, ...],
    common: bool,
    exact: bool,
    outputs: tuple[str, ...],
    as_json: bool,
    get: tuple[str, ...],
    stream_format: str | None,
    precision: str,
    force: bool,
    quiet: bool,
    verbose: int,
    input_format: str | None,
    max_faces: int | None,
    max_bytes: int | None,
    **conventions: Any,
) -> int:
    """Return the exit code: 1 if anything differs. given: conventions that override those of a stored side."""
    from ..analysis.configuration import configured
    from ..output.atomic import Outputs
    from ..output.registry import format_of
    from ..output.tables.write import parse_precision, write_table
    from ..report import accuracy as errors
    from ..report.compare import model as differences
    from ..report.model import as_dict, encode
    from ..report.terminal import accuracy as error_summary
    from ..report.terminal import compare as difference_summary
    from .config_notes import configuration

    formats = [format_of(p, name=stream_format if p == "-" else None, kinds=("table", "report")) for p in outputs]
    to_stdout = one_stdout(outputs, as_json, get, stream_format)
    parse_precision(precision)
    conventions["weld"] = parse_weld(conventions["weld"])
    merge_settings(conventions)
    given = given | ({"parameters"} if "spontaneous_curvature" in given else set())
    limits = {"input_format": input_format, "max_faces": max_faces, "max_bytes": max_bytes}
    with Outputs(list(outputs), force) as files:
        comparison: Comparison | Accuracy
        table: Callable[[], dict[str, Any]]
        summary: Callable[[], None]
        mesh, known = _exact(a, b, limits, exact)
        if known is not None:
            limit = rtol if "rtol" in given else None
            comparison = accuracy(mesh, known, conventions, limits, selector(only, ignore), limit, quiet)
            table, summary = partial(errors.table, comparison), partial(error_summary.show, comparison)
        else:
            sides = both_sides(a, b, given, conventions, limits, quiet)
            comparison = _compare(sides, Tolerance(rtol, atol), only, ignore, common)
            table, summary = (
                partial(differences.table, comparison),
                partial(difference_summary.show, comparison, verbose),
            )
        comparison.configuration = configured(configuration())
        for path, output_format in zip(outputs, formats, strict=True):
            with files.open(path) as stream:
                if output_format.kind == "report":
                    stream.write(encode(as_dict(comparison)))
                else:
                    write_table(stream, table(), output_format.suffix, precision=precision)
        print_report(partial(as_dict, comparison), summary, as_json, get, quiet or to_stdout)
    return OK if comparison.equal else FAILED_CHECK


def _compare(
    sides: tuple[LoadedSide, LoadedSide],
    tolerance: Tolerance,
    only: tuple[str, ...],
    ignore: tuple[str, ...],
    common: bool,
) -> Comparison:
    from ..report.compare.cells import MovedColumn, compare_cells
    from ..report.compare.model import model

    a, b = sides
    wanted = selector(only, ignore)
    differing: list[Difference] = []
    columns: list[MovedColumn] = []
    notes: list[str] = []
    compared = 0
    if a.report is not None and b.report is not None:
        differing, compared = compare_reports(a.report, b.report, tolerance, wanted, common=common)
        if any(difference.key.startswith("conventions.") for difference in differing):
            notes.append("the conventions differ, so the numbers mean different things")
    if a.cells is not None and b.cells is not None and (only or wanted("vertices")):
        counts = [len(next(iter(side.cells.values()))) for side in (a, b)]  # type: ignore[union-attr]
        if counts[0] == counts[1]:
            columns, lacking, more = compare_cells(a.cells, b.cells, tolerance, wanted, common=common)
            differing, compared = [*differing, *lacking], compared + more
        elif wanted("vertices.count"):
            differing.append(Difference("vertices.count", "changed", counts[0], counts[1], None, None))
            compared += 1
            notes.append("tables of different lengths: the columns are not compared cell by cell")
    if not compared and not differing:
        raise UsageError("nothing is left to compare; --only or --ignore leaves no value that both sides have")
    return model(a.side, b.side, tolerance, compared, differing, columns, notes)


def _exact(a: str, b: str, limits: dict[str, Any], exact: bool) -> tuple[str, LoadedSide | None]:
    """A mesh and the table of exact values to compare it with; no table if the two sides are something else.

    exact: accept any table as exact values. Errors: UsageError where there is none.
    """
    for mesh, table in ((a, b), (b, a)):
        if (kind_of(mesh), kind_of(table)) == ("mesh", "table"):
            known = stored_side(table, limits["max_bytes"])
            if exact or is_exact(known.cells or {}):
                return mesh, known
    if exact:
        raise UsageError("--exact needs a mesh and a table (.csv .tsv .parquet) of exact values")
    return a, None

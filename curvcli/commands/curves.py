"""`curvcli curves`: measure boundary loops and polylines as space curves."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import click

from ..errors import FAILED_CHECK, OK
from ..loading.limits import parse_weld
from . import candidates, options
from .limits import bounded
from .meshes import input_of
from .outputs import one_stdout, print_report, tables_and_reports

if TYPE_CHECKING:
    from ..curves.measure import CurveMeasures
    from ..report.curves import CurveReport

TABLES = ("curves", "vertices", "links")


@click.command("curves", short_help="Measure boundary loops and OBJ polylines as space curves.")
@click.argument("file", metavar="FILE")
@click.option(
    "-o",
    "--output",
    "outputs",
    metavar="PATH",
    multiple=True,
    help="Write .csv .tsv .parquet .npz (a row per vertex of each curve) or .json (report); repeatable. `-` is stdout.",
)
@click.option(
    "--table",
    "tables",
    metavar="KIND=PATH",
    shell_complete=candidates.tables(lambda: TABLES),
    multiple=True,
    help="Write a table, KIND curves (a row per curve), links (a row per pair of closed "
    "curves) or vertices (as -o); repeatable.",
)
@options.as_json
@options.get("curves.0.writhe")
@options.stream_format
@click.option(
    "--max-writhe",
    metavar="N",
    type=click.IntRange(0),
    default=20_000,
    show_default=True,
    help="Largest double sum, in edges: writhe and linking beyond it are left undefined, largest curves first.",
)
@options.precision
@options.weld
@options.unit
@options.input_format
@options.max_faces
@options.max_bytes
@options.force
@options.strict
@options.schema
@options.talking
@bounded
def command(file: str, **settings: Any) -> int:
    """Measure the boundary loops and `l` records of FILE: length, turning, torsion, writhe, linking, holonomy.

    Records that share ends are joined, in any order and direction; curves end where more than two edges meet.
    A polyline whose last index is its first is closed. Boundary loops run with the surface on their left and
    also have geodesic and normal curvature. Exits with 3 when FILE has neither loops nor records.

    \b
      curvcli curves mesh.obj
      curvcli curves knot.obj --get curves.0.writhe
      curvcli curves mesh.ply -o points.csv --table curves=loops.csv
    """
    return measure(file, **settings)


def measure(
    file: str,
    *,
    outputs: tuple[str, ...],
    tables: tuple[str, ...],
    as_json: bool,
    get: tuple[str, ...],
    stream_format: str | None,
    max_writhe: int,
    precision: str,
    weld: str,
    unit: str | None,
    force: bool,
    strict: bool,
    quiet: bool,
    verbose: int,
    **limits: Any,
) -> int:
    """Check the options, read the file, measure its curves, write and print them; return the exit code."""
    from ..analysis.configuration import configured
    from ..output.atomic import Outputs
    from ..output.tables.write import parse_precision
    from ..report.model import as_dict
    from .config_notes import configuration

    specs = tables_and_reports(outputs, tables, TABLES, stream_format)
    to_stdout = one_stdout([spec.path for spec in specs], as_json, get, stream_format)
    parse_precision(precision)
    welding = parse_weld(weld)

    # Outputs are checked before the file is read.
    with Outputs([spec.path for spec in specs], force) as files:
        measures = _read(file, welding, max_writhe, quiet, limits)
        report = _report(measures, welding, unit)
        report.configuration = configured(configuration())
        for spec in specs:
            with files.open(spec.path) as stream:
                _write(stream, measures, report, spec.kind, spec.suffix, precision)
        summary = partial(_show, report, verbose)
        print_report(partial(as_dict, report), summary, as_json, get, quiet or to_stdout)
    return FAILED_CHECK if strict and any(check.status == "fail" for check in report.checks) else OK


def _read(file: str, weld: str | float, max_writhe: int, quiet: bool, limits: dict[str, Any]) -> CurveMeasures:
    from ..curves.collect import curves_of_file
    from ..curves.measure import CurveMeasures
    from ..loading.read import read_mesh_file
    from .progress import phase

    with phase(f"reading {file}", quiet):
        curves = curves_of_file(read_mesh_file(input_of(file), weld=weld, **limits))
    with phase(f"computing {file}", quiet):
        measures = CurveMeasures(curves, max_writhe=max_writhe)
        _ = measures.identities
    return measures


def _report(measures: CurveMeasures, weld: str | float, unit: str | None) -> CurveReport:
    from ..report.curves import model

    file = measures.curve_set.file
    return model(
        measures,
        weld=file.weld if file is not None else str(weld),
        unit=unit or (file.unit if file is not None else None),
    )


def _show(report: CurveReport, verbose: int) -> None:
    from ..report.terminal.curves import show

    show(report, verbose)


def _write(stream: Any, measures: CurveMeasures, report: CurveReport, kind: str, suffix: str, precision: str) -> None:
    if kind == "report":
        from ..report.model import as_dict, encode

        stream.write(encode(as_dict(report)))
    else:
        from ..output.tables.write import write_table

        tables = {"curves": lambda: measures.totals, "links": measures.links_table, "vertices": measures.points}
        write_table(stream, tables[kind](), suffix, precision=precision)

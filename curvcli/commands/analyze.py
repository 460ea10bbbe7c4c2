"""`curvcli analyze`: write passes as tables, coloured meshes and reports."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import TYPE_CHECKING, Any

import click

from ..errors import FAILED_CHECK, OK, UsageError, worst
from ..loading.limits import parse_weld
from ..output.registry import listed
from . import candidates, options
from .config_notes import configuration
from .drawing import appearance_of, drawing
from .limits import bounded
from .meshes import each_mesh, input_of
from .outputs import one_stdout, print_report, stdin_once, table_option
from .settings import merge_settings, setting
from .shared_outputs import SharedOutputs
from .stems import check_apart, expand
from .talk import put, say

if TYPE_CHECKING:
    from ..analysis.result import Result
    from ..output.appearance import Appearance
    from ..output.atomic import Outputs
    from ..output.registry import OutputKind
    from ..report.model import Report


def _tables() -> Iterable[str]:
    from ..output.tables.columns import TABLES

    return TABLES


@click.command("analyze", short_help="Compute curvatures: tables, coloured meshes, the report.")
@click.argument("meshes", metavar="MESH...", nargs=-1)
@click.option(
    "-o",
    "--output",
    "outputs",
    metavar="PATH",
    multiple=True,
    help=f"Write {listed('table')} (table), {listed('mesh')} (coloured mesh), {listed('picture')} (picture), "
    f"{listed('report')} (report), or {listed('page')} (report to be read); repeatable. "
    "With several meshes, {stem} stands for each one's name. `-` is stdout.",
)
@click.option(
    "--table",
    "tables",
    metavar="KIND=PATH",
    shell_complete=candidates.tables(_tables),
    multiple=True,
    help="Write another table: edges, faces, loops, regions, components, statistics, intersections or "
    "histogram; repeatable.",
)
@options.passes
@options.regions
@options.stat
@options.reading
@options.estimating
@setting
@options.as_json
@options.get("totals.K")
@options.schema
@options.stream_format
@drawing
@options.precision
@options.force
@options.strict
@options.talking
@bounded
def command(meshes: tuple[str, ...], as_json: bool, get: tuple[str, ...], **settings: Any) -> int:
    """Compute the curvatures of each MESH and check the identities they keep.

    Without -o, --json or --get, a summary goes to stdout. Outputs appear whole or not at all.

    \b
      curvcli analyze bunny.obj
      curvcli analyze bunny.obj --get totals.K
      curvcli analyze bunny.obj -o k.csv -o k.ply -o k.json
      curvcli analyze scans/*.ply -o 'out/{stem}.csv'
      curvcli analyze - --input-format ply -o - --format csv < bunny.ply
    """
    if not meshes:
        raise click.UsageError("no MESH given", click.get_current_context())
    stdin_once(meshes)
    return AnalyzeRun(meshes, as_json, get, **settings).all()


class AnalyzeRun:
    """One call of `analyze`: check its options before any work, then analyse mesh after mesh."""

    def __init__(
        self,
        meshes: tuple[str, ...],
        as_json: bool,
        get: tuple[str, ...],
        *,
        outputs: tuple[str, ...],
        tables: tuple[str, ...],
        passes: tuple[str, ...],
        weld: str,
        force: bool,
        strict: bool,
        quiet: bool,
        verbose: int,
        stream_format: str | None,
        precision: str,
        input_format: str | None,
        max_faces: int | None,
        max_bytes: int | None,
        **conventions: Any,
    ) -> None:
        from ..analysis.statistics import parse_statistics
        from ..output.appearance import REGION
        from ..output.registry import format_of
        from ..output.tables.columns import HISTOGRAM, TABLES
        from ..output.write import check_appearance, needs

        self.meshes, self.as_json, self.get, self.conventions = meshes, as_json, get, conventions
        self.weld, self.configuration = parse_weld(weld), configuration()
        self.limits: dict[str, Any] = {"input_format": input_format, "max_faces": max_faces, "max_bytes": max_bytes}
        merge_settings(conventions)
        self.passes, at_scale = options.chosen(passes, conventions)
        parse_statistics(conventions["stat"])
        self.force, self.strict, self.quiet, self.verbose = force, strict, quiet, verbose
        self.stream_format = stream_format
        self.appearance: Appearance = appearance_of(conventions, precision)
        kinds = [table_option(table, TABLES) for table in tables]
        self.shared = SharedOutputs(meshes, outputs, kinds)
        own = [output for output in outputs if output not in self.shared.pictures]
        own_tables = [(kind, path) for kind, path in kinds if kind != HISTOGRAM or path not in self.shared.tables]
        self.paths = [[expand(output, mesh, len(meshes)) for output in own] for mesh in meshes]
        self.tables = [[(kind, expand(path, mesh, len(meshes))) for kind, path in own_tables] for mesh in meshes]
        check_apart(meshes, self.paths)
        check_apart(meshes, [[path for _, path in each] for each in self.tables])
        kinds_of_output: tuple[OutputKind, ...] = ("table", "mesh", "overlay", "report", "page", "picture")
        formats = [
            format_of(path, name=stream_format if path == "-" else None, kinds=kinds_of_output)
            for path in [*self.paths[0], *self.shared.pictures]
        ]
        check_appearance(self.appearance, at_scale, [format.suffix for format in formats])
        if REGION in self.appearance.color_by and conventions["regions"] is None:
            raise UsageError("--color-by region: there are none without --regions")
        if any(format.kind == "overlay" for format in formats):
            from ..output.overlays import check_overlays

            check_overlays(self.paths[0], self.appearance, at_scale, stream_format)
        self.besides = needs(formats, [kind for kind, _ in kinds], self.appearance, at_scale)
        for kind, path in [*self.tables[0], *((HISTOGRAM, path) for path in self.shared.tables)]:
            format_of(path, name=stream_format if path == "-" else None, kinds=["table"])
            if kind == "regions" and conventions["regions"] is None:
                raise UsageError("--table regions: there are none without --regions")
        self.to_stdout = one_stdout([*outputs, *(path for _, path in kinds)], as_json, get, stream_format)

    def all(self) -> int:
        """Analyse every mesh; one bad mesh does not stop the rest."""
        from ..output.atomic import Outputs

        # Every output of every mesh is checked before the first mesh is read.
        wanted = [path for paths in self.paths for path in paths]
        wanted += [path for tables in self.tables for _, path in tables] + self.shared.paths
        with Outputs(wanted, self.force) as everything:
            ended = each_mesh(
                self.meshes, lambda number: self.done(number, everything), lambda mesh, message, code: (None, code)
            )
            for line in self.shared.write(everything, self.appearance):
                if not self.quiet:
                    say(line)
        if self.as_json:
            from ..report.model import encode

            reports = [report for report, _ in ended if report is not None]
            put(encode(reports[0] if len(self.meshes) == 1 else reports))
        return worst([code for _, code in ended])

    def done(self, number: int, outputs: Outputs) -> tuple[Report | None, int]:
        """Analyse one mesh, then free the analysis; return its report, if it is printed later, and the exit code."""
        analysis = self.analyze_mesh(self.meshes[number], self.paths[number], self.tables[number], outputs)
        self.shared.collect(analysis, self.appearance, number)
        return self.print_result(analysis), FAILED_CHECK if self.strict and not analysis.passed else OK

    def analyze_mesh(self, mesh: str, paths: list[str], tables: list[tuple[str, str]], outputs: Any) -> Result:
        """Load, compute, write."""
        from ..analysis.request import Request
        from ..analysis.result import Result, compute
        from ..loading.load import load
        from ..output.write import write_into
        from ..report.phrases import shell_quoted
        from .progress import phase

        with phase(f"reading {mesh}", self.quiet) as reading:
            asked = {key: self.conventions[key] for key in ("orient", "normals")}
            surface = load(input_of(mesh), weld=self.weld, **asked, **self.limits)
        with phase(f"computing {mesh}", self.quiet) as computing:
            request = Request(passes=self.passes, weld=self.weld, besides=self.besides, **self.conventions)
            analysis = compute(surface, request, Result)
        analysis.configuration = self.configuration
        analysis.timings |= {"read": reading.seconds, "compute": computing.seconds}

        def check() -> None:
            if not self.needs_checks(paths):
                return
            from ..report.build import model

            with phase("", quiet=True) as checking:
                _ = analysis.checks
            analysis.timings["check"] = checking.seconds
            model(analysis)  # caches the parts of the report that are printed later

        with phase(f"{'checking and writing' if paths or tables else 'checking'} {mesh}", self.quiet):
            if not (paths or tables):
                check()
                return analysis
            command = shell_quoted(["curvcli", *sys.argv[1:]])
            with ThreadPoolExecutor(1) as pool:
                checked = pool.submit(check)
                notices, ranges = write_into(
                    outputs, analysis, paths, self.appearance, self.stream_format, tables, command, checked
                )
            analysis.extra_notices += notices
            for line in ranges if not self.quiet else ():
                say(line)
        return analysis

    def needs_checks(self, paths: list[str]) -> bool:
        """True if an output, the summary or the exit code depends on the checks."""
        from ..output.registry import format_of

        said = self.as_json or bool(self.get) or self.strict or not (self.quiet or self.to_stdout)
        name = self.stream_format
        kinds = {format_of(path, name=name if path == "-" else None).kind for path in paths}
        return said or not kinds <= {"table", "mesh", "overlay", "picture"}

    def print_result(self, analysis: Result) -> Report | None:
        """Print one analysis on stdout; return its report if it is printed later."""
        from ..report.build import build, model

        def summary() -> None:
            from ..report.terminal.summary import show

            show(analysis, self.verbose)

        if self.as_json:
            return model(analysis)
        print_report(partial(build, analysis), summary, False, self.get, self.quiet or self.to_stdout)
        return None

"""`curvcli check`: check identities, requirements and assertions; write an exit code and a report for CI systems."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import click

from ..errors import LackingError, UsageError, worst
from ..loading.limits import parse_weld
from . import candidates, options
from .config_notes import configuration
from .limits import bounded
from .meshes import each_mesh, input_of
from .outputs import stdin_once
from .settings import merge_settings, setting
from .stems import check_apart, expand
from .talk import put, say

if TYPE_CHECKING:
    from ..checks.requirements.faults import FaultyElements
    from ..output.atomic import Outputs
    from ..report.check.model import CheckedMesh, CheckReport

FORMATS = ("text", "json", "junit", "sarif", "github", "gitlab")

# Format by the suffix of -o where --format is not given.
_SUFFIXES = {".json": "json", ".xml": "junit", ".sarif": "sarif"}

# Number of failures printed on stderr while the report goes to a file.
_TOLD = 20


class _Requirements(click.Option):
    """`--require`, with the names of all requirements and sets in its help."""

    def get_help_record(self, ctx: click.Context) -> tuple[str, str] | None:
        from ..checks.requirements.catalogue import SETS, requirements

        more = ", ".join(each.usage for each in requirements().values() if not each.default)
        default = ", ".join(each.usage for each in requirements().values() if each.default)
        names, _ = super().get_help_record(ctx) or ("", "")
        sets = "; ".join(f"{name} ({', '.join(members)})" for name, members in SETS.items())
        return names, f"Additional requirements: {more}; sets of them: {sets}; repeatable. By default: {default}."


@click.command("check", short_help="Check identities and requirements for CI, by exit code.")
@click.argument("meshes", metavar="MESH...", nargs=-1)
@click.option(
    "--require",
    metavar="NAME[,NAME]",
    shell_complete=candidates.requirements,
    multiple=True,
    cls=_Requirements,
    help="Additional requirements; repeatable.",
)
@click.option(
    "--sets",
    metavar="NAME=REQUIREMENT[,REQUIREMENT]",
    multiple=True,
    help="Define a set of requirements for --require; repeatable. A configuration has them in a table `sets`.",
)
@click.option(
    "--allow",
    metavar="NAME[,NAME]",
    shell_complete=candidates.tests,
    multiple=True,
    help="Skip a requirement or an identity; repeatable.",
)
@click.option(
    "--assert",
    "asserted",
    metavar="'[SCOPE:] STAT(COLUMN) OP NUMBER'",
    multiple=True,
    help="Compare a column's min, max, absmax, mean, area_mean, std, sum, median, p02 or another statistic of --stat, "
    "by < <= > >= == or != with a number; or a total, a count or an extent: 'volume >= 100', 'extent_x <= 250'. SCOPE "
    "is `region(LABEL)`, `each region` or `each component`; repeatable.",
)
@options.regions
@options.reading
@options.estimating
@setting
@click.option(
    "--format",
    "report_format",
    type=click.Choice(FORMATS),
    help="Format of the report on stdout or of one -o; by default from the suffix (.json, .xml: junit, .sarif), else "
    "text.",
)
@options.as_json
@click.option(
    "-o",
    "--output",
    "outputs",
    metavar="FILE",
    multiple=True,
    help="Write the report to a file instead of stdout, or, with the suffix of a table or a mesh, the failing elements "
    "alone, coloured by rule; repeatable. With several meshes, {stem} stands for each one's name.",
)
@options.schema
@options.force
@options.talking
@bounded
def command(meshes: tuple[str, ...], **settings: Any) -> int:
    """Check each MESH; exit with 0 if everything holds and with 1 if something fails.

    The checks are the identities that curvatures keep, on the whole surface and on every component, and the
    requirements on the mesh. A mesh that cannot be read does not stop the rest.

    \b
      curvcli check bunny.ply
      curvcli check parts/*.stl --require closed,outward -o check.xml
      curvcli check torus.obj --require genus=1 --assert 'absmax(h_signed) <= 50'
      curvcli check scan.ply --allow manifold,no-degenerate
      curvcli check part.stl --require printable -o check.sarif -o failures.ply
    """
    if not meshes:
        raise click.UsageError("no MESH given", click.get_current_context())
    stdin_once(meshes)
    return CheckRun(meshes, **settings).all()


class CheckOutputs:
    """Files of one call of `check`. reports: path and format of each; failures: path and suffix for each mesh.

    given: the format of stdout, and of a lone report. as_json: one more report on stdout. Without a report among the
    outputs, one goes to stdout.
    Errors: UsageError for one file of failures of several meshes, or two reports on stdout.
    """

    def __init__(self, meshes: Sequence[str], outputs: Sequence[str], given: str | None, as_json: bool) -> None:
        from ..output.registry import suffixes

        ends = [(path, os.path.splitext(path)[1].lower()) for path in outputs]
        own = [(path, end) for path, end in ends if end not in _SUFFIXES and end in suffixes(("table", "mesh"))]
        reports = [(path, end) for path, end in ends if (path, end) not in own]
        lone = len(reports) == 1
        self.reports = [
            (path, given if given and (lone or path == "-") else _SUFFIXES.get(end, "text")) for path, end in reports
        ]
        if as_json:
            self.reports.append(("-", "json"))
        elif not reports:
            self.reports.append(("-", given or "text"))
        if sum(path == "-" for path, _ in self.reports) > 1 or (as_json and given not in (None, "json") and not lone):
            raise UsageError("two reports would go to stdout; name a file for one of them by -o")
        self.failures = [[(expand(path, mesh, len(meshes)), end) for path, end in own] for mesh in meshes]
        check_apart(meshes, [[path for path, _ in each] for each in self.failures])
        self.paths = [path for path, _ in self.reports if path != "-"]
        self.paths += [path for each in self.failures for path, _ in each]


class CheckRun:
    """One call of `check`: check its options before any work, then mesh after mesh."""

    def __init__(
        self,
        meshes: tuple[str, ...],
        *,
        require: tuple[str, ...],
        sets: tuple[str, ...],
        allow: tuple[str, ...],
        asserted: tuple[str, ...],
        report_format: str | None,
        as_json: bool,
        outputs: tuple[str, ...],
        weld: str,
        force: bool,
        quiet: bool,
        verbose: int,
        input_format: str | None,
        max_faces: int | None,
        max_bytes: int | None,
        **conventions: Any,
    ) -> None:
        from ..mesh.scale import parse_scales
        from ..report.check.judge import plan

        self.meshes, self.conventions = meshes, conventions
        self.limits: dict[str, Any] = {"input_format": input_format, "max_faces": max_faces, "max_bytes": max_bytes}
        merge_settings(conventions)
        self.weld = parse_weld(weld)
        self.force, self.quiet, self.verbose = force, quiet, verbose
        self.outputs = CheckOutputs(meshes, outputs, report_format, as_json)
        scales = parse_scales(conventions["rings"], conventions["radius"])
        self.plan = plan(require, allow, asserted, scales, conventions["regions"] is not None, sets)

    def all(self) -> int:
        """Check every mesh and write the report; return the exit code."""
        from ..output.atomic import Outputs
        from ..report.check.model import failed_input, report_of

        with Outputs(self.outputs.paths, self.force) as outputs:
            results = each_mesh(
                self.meshes, lambda number: self.judged(number, outputs), failed_input, alone=LackingError
            )
            code = worst([mesh.exit_code for mesh in results])
            report = report_of(self.plan.rules, results, code, configuration())
            for path, format in self.outputs.reports:
                if path != "-":
                    with outputs.open(path) as stream:
                        stream.write(_writer(format, self.verbose)(report))
            self.show(report)
        return report.exit_code

    def judged(self, number: int, outputs: Outputs) -> CheckedMesh:
        """Load the mesh, compute its columns, judge it, and write its failing elements."""
        from ..analysis.request import Request
        from ..analysis.result import Result, compute
        from ..loading.load import load
        from ..report.check.judge import judge
        from .progress import phase

        mesh = self.meshes[number]
        with phase(f"reading {mesh}", self.quiet):
            asked = {key: self.conventions[key] for key in ("orient", "normals")}
            surface = load(input_of(mesh), weld=self.weld, **asked, **self.limits)
        with phase(f"checking {mesh}", self.quiet):
            request = Request(
                passes=self.plan.passes or ["topology"],
                weld=self.weld,
                checks=self.plan.identities,
                **self.conventions,
            )
            analysis = compute(surface, request, Result)
            failing: list[tuple[str, FaultyElements]] = []
            checked = judge(analysis, self.plan, mesh, failing)
        if self.outputs.failures[number]:
            from ..output.failures import write_failures

            for path, suffix in self.outputs.failures[number]:
                with outputs.open(path) as stream:
                    write_failures(stream, suffix, analysis.surface, failing)
        return checked

    def show(self, report: CheckReport) -> None:
        """Print the report on stdout; with -q, not as text; without a report on stdout, the failures on stderr."""
        format = next((format for path, format in self.outputs.reports if path == "-"), None)
        if format is None:
            self.print_failures(report)
        elif format != "text":
            put(_writer(format, self.verbose)(report))
        elif not self.quiet and any(mesh.status != "error" for mesh in report.meshes):
            from ..report.terminal.check import show

            show(report, self.verbose)

    def print_failures(self, report: CheckReport) -> None:
        """Print failures and warnings on stderr while the report goes to a file."""
        from ..report.check.lines import all_failures, warning, warnings

        if self.quiet:
            return
        # The error of a mesh that cannot be read has been printed already.
        failed, others = all_failures([mesh for mesh in report.meshes if mesh.status != "error"], most=_TOLD)
        for line in failed:
            say(line.text)
        if others:
            say(f"{others}; {self.outputs.reports[0][0]} has all of them")
        shown_warnings, _ = warnings([mesh for mesh in report.meshes if mesh.status == "fail"], _TOLD)
        for mesh, remark in shown_warnings:
            say(f"warning: {warning(mesh, remark)}")


def _writer(report_format: str, verbose: int) -> Callable[[CheckReport], bytes]:
    """Function that writes a report in a format."""
    match report_format:
        case "json":
            from ..report.check.model import write_json as writer
        case "junit":
            from ..report.check.junit import write_junit as writer
        case "sarif":
            from ..report.check.sarif import write_sarif as writer
        case "github":
            from ..report.check.github import write_github as writer
        case "gitlab":
            from ..report.check.gitlab import write_gitlab as writer
        case _:
            from ..report.terminal.check import write_text

            return lambda report: write_text(report, verbose)
    return writer

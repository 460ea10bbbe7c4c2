"""`curvcli check`: check identities, requirements and assertions; write an exit code and a report for CI systems."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click

from ..errors import LackingError, worst
from ..loading.limits import parse_weld
from . import candidates, options
from .config_notes import configuration
from .limits import bounded
from .meshes import each_mesh, input_of
from .outputs import stdin_once
from .settings import merge_settings, setting
from .talk import put, say

if TYPE_CHECKING:
    from ..report.check.model import CheckedMesh, CheckReport

FORMATS = ("text", "json", "junit", "sarif", "github")

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
    help="Format of the report; by default from -o's suffix (.json, .xml: junit, .sarif), else text.",
)
@click.option("-o", "--output", metavar="FILE", default="-", help="Write the report to a file instead of stdout.")
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
      curvcli check part.stl --require printable
    """
    if not meshes:
        raise click.UsageError("no MESH given", click.get_current_context())
    stdin_once(meshes)
    return CheckRun(meshes, **settings).all()


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
        output: str,
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
        self.output, self.force, self.quiet, self.verbose = output, force, quiet, verbose
        self.format = report_format or _SUFFIXES.get(os.path.splitext(output)[1].lower(), "text")
        scales = parse_scales(conventions["rings"], conventions["radius"])
        self.plan = plan(require, allow, asserted, scales, conventions["regions"] is not None, sets)

    def all(self) -> int:
        """Check every mesh and write the report; return the exit code."""
        from ..output.atomic import Outputs
        from ..report.check.model import failed_input, report_of

        with Outputs([] if self.output == "-" else [self.output], self.force) as outputs:
            results = each_mesh(
                self.meshes, lambda number: self.judged(self.meshes[number]), failed_input, alone=LackingError
            )
            code = worst([mesh.exit_code for mesh in results])
            report = report_of(self.plan.rules, results, code, configuration())
            if self.output == "-":
                self.show(report)
            else:
                with outputs.open(self.output) as stream:
                    stream.write(self.written(report))
                self.print_failures(report)
        return report.exit_code

    def judged(self, mesh: str) -> CheckedMesh:
        """Load the mesh, compute its columns and judge it."""
        from ..analysis.request import Request
        from ..analysis.result import Result, compute
        from ..loading.load import load
        from ..report.check.judge import judge
        from .progress import phase

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
            return judge(analysis, self.plan, mesh)

    def show(self, report: CheckReport) -> None:
        """Print the report on stdout; with -q, not as text."""
        if self.format != "text":
            put(self.written(report))
        elif not self.quiet and any(mesh.status != "error" for mesh in report.meshes):
            from ..report.terminal.check import show

            show(report, self.verbose)

    def written(self, report: CheckReport) -> bytes:
        """The report as bytes in the chosen format."""
        return _writer(self.format, self.verbose)(report)

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
            say(f"{others}; {self.output} has all of them")
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
        case _:
            from ..report.terminal.check import write_text

            return lambda report: write_text(report, verbose)
    return writer

"""`curvcli batch`: analyse many meshes on this machine or on a Dask cluster, and write a summary with one row each."""

from __future__ import annotations

import os
import sys
from collections import Counter
from collections.abc import Sequence
from contextlib import AbstractContextManager, ExitStack
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import click

from ..errors import UsageError, worst
from ..loading.limits import parse_weld
from ..support.words import counted
from . import candidates, options
from .batch_pictures import draw_plots, planned_plots, with_common_ranges
from .config_notes import configuration
from .drawing import appearance_of, drawing
from .settings import merge_settings, setting
from .talk import say

if TYPE_CHECKING:
    from ..batch.batch import Batch
    from ..batch.model import BatchItem, BatchSettings, Engine, Limits


@click.command("batch", short_help="Analyse many meshes: workers, timeouts, resume, a summary.")
@click.argument("patterns", metavar="PATTERN...", nargs=-1)
@click.option("-o", "--output", "folder", metavar="DIR", required=True, help="Folder of the outputs and the summary.")
@click.option(
    "--save",
    metavar="SUFFIX[,SUFFIX]",
    shell_complete=candidates.formats,
    multiple=True,
    help="Outputs per mesh, by suffix as for `analyze -o`, such as csv,ply,png,json, or a table, such as edges.csv. "
    "By default only the summary is written.",
)
@click.option(
    "--long",
    is_flag=True,
    help="Also write DIR/statistics.csv and .parquet: a row per mesh, region, column and statistic. --stat chooses the "
    "statistics.",
)
@click.option(
    "--plot",
    "plots",
    metavar="KEY[,KEY][=NAME]",
    multiple=True,
    help="Draw DIR/NAME (series.png): a panel per KEY over the meshes in order, such as willmore, totals.area, "
    "topology.genus, or with --long columns.h.mean and 'regions.*.totals.area'; repeatable. With --resume nothing is "
    "computed again.",
)
@click.option("--files-from", metavar="LIST|-", help="Read more meshes from a list, one per line or NUL-terminated.")
@click.option("-j", "--jobs", type=click.IntRange(1), help="Meshes at a time.  [default: one per processor]")
@click.option(
    "--scheduler",
    metavar="ADDRESS|local:N",
    help="Work on a Dask cluster, such as tcp://host:8786, or on N Dask workers here.",
)
@click.option("--resume", is_flag=True, help="Continue in DIR: skip meshes that are done and unchanged.")
@click.option(
    "--timeout",
    metavar="SECONDS",
    type=options.Finite(0, 1e9, min_open=True),
    help="Stop a mesh that takes longer.",
)
@click.option(
    "--max-memory",
    metavar="MB",
    type=click.IntRange(512, 1 << 40),
    help="Stop a mesh that needs more memory than this. Linux only.",
)
@options.passes
@click.option("--regions", metavar="groups|objects|materials|solids|PROPERTY", help="Labels within each mesh.")
@options.stat
@options.reading
@options.estimating
@setting
@drawing
@click.option("--force", is_flag=True, help="Start again in a DIR that is not empty and replace its outputs.")
@options.strict
@options.talking
def command(patterns: tuple[str, ...], **settings: Any) -> int:
    """Analyse every mesh matched by a PATTERN or named in a list. One bad mesh never stops the rest.

    Quote patterns to have `**` expanded here. Paths below DIR mirror the tree that the meshes are in, with the whole
    name of each: scans/a/b.ply by 'scans/**/*.ply' becomes DIR/a/b.ply.csv. DIR/summary.csv and .parquet have one row
    per mesh in the order of the inputs, DIR/manifest.jsonl one line per mesh as it ends. With --long,
    DIR/statistics.csv and .parquet have a row per number: mesh, region (empty for the whole), column or total,
    statistic, value. With curvcli[remote], a PATTERN may be any URL of fsspec.

    \b
      curvcli batch 'scans/**/*.ply' -o out --save csv,json -j 8
      curvcli batch 'scans/**/*.ply' -o out --save csv,json -j 8 --resume
      curvcli batch 'subjects/*.gii' -o out --regions parcel --long
      find . -name '*.stl' -print0 | curvcli batch -o out --files-from -
      curvcli batch 's3://bucket/scans/*.obj' -o out --scheduler tcp://host:8786
    """
    if not patterns and settings["files_from"] is None:
        raise click.UsageError("no PATTERN and no --files-from given", click.get_current_context())
    return run(patterns, **settings)


def run(
    patterns: tuple[str, ...],
    *,
    folder: str,
    save: tuple[str, ...],
    files_from: str | None,
    jobs: int | None,
    scheduler: str | None,
    resume: bool,
    force: bool,
    timeout: float | None,
    max_memory: int | None,
    plots: tuple[str, ...],
    strict: bool,
    quiet: bool,
    verbose: int,
    **conventions: Any,
) -> int:
    """Check the options, plan, work, summarise; the exit code.

    Errors: UsageError for options that do not fit; those of the plan and of the manifest.
    """
    from ..batch.model import Limits
    from ..batch.plan import plan, saves

    if not folder:
        raise UsageError("-o: expected a folder")
    if resume and force:
        raise UsageError("--resume keeps what --force would replace; choose one")
    if max_memory is not None and not sys.platform.startswith("linux"):
        raise UsageError("--max-memory: only Linux bounds the memory of a process")
    wanted = saves(save)
    limits = Limits(timeout, None if max_memory is None else max_memory << 20)
    items = plan(patterns, files_from, folder, wanted)
    drawn = planned_plots(plots, folder, items, conventions["long"])
    with ExitStack() as workers:
        # Workers start while this process imports; the number of meshes left by a resumed batch is not known yet.
        ready = scheduler is None and not resume
        engine = workers.enter_context(_here(limits, jobs, len(items))) if ready else None
        how = _settings(wanted, **conventions)
        # If the scheduler does not answer, no folder is created.
        engine = engine or workers.enter_context(_engine(scheduler, jobs, limits))
        from ..batch.batch import Batch
        from ..batch.manifest import Manifest

        with Manifest(folder, resume=resume, force=force) as manifest:
            if how.common:
                how = with_common_ranges(items, how, engine, manifest.rows, quiet)
            batch = Batch(items, how, folder, manifest, strict)
            todo = batch.todo()
            try:
                _work(batch, engine, todo, quiet)
            finally:
                workers.close()
                batch.finish()
                draw_plots(drawn, batch)
                if not quiet:
                    _print_summary(batch, len(todo))
    return worst([row.exit_code for row in batch.rows])


def _settings(save: tuple[str, ...], *, passes: tuple[str, ...], weld: str, **conventions: Any) -> BatchSettings:
    """Settings of the analysis and outputs of each mesh.

    Errors: UsageError for options that do not fit.
    """
    from ..analysis.request import Request
    from ..analysis.statistics import parse_statistics
    from ..batch.model import BatchSettings
    from ..output.appearance import COMMON
    from ..output.write import check_appearance
    from ..report.phrases import shell_quoted

    merge_settings(conventions)
    names, at_scale = options.chosen(passes, conventions)
    conventions["stat"] = parse_statistics(conventions["stat"])
    if any(suffix.startswith("regions.") for suffix in save) and conventions["regions"] is None:
        raise UsageError("--save regions: there are none without --regions")
    common = (conventions["value_range"] or "").strip().lower() == COMMON
    if common:
        conventions["value_range"] = None
    appearance = appearance_of(conventions)
    check_appearance(appearance, at_scale, [f".{suffix}" for suffix in save])
    if common:
        from ..batch.ranges import shown

        if not shown(save, appearance, at_scale):
            raise UsageError("--range common: no output of --save has colours; add one, such as --save png")
    requested = {field.name for field in fields(Request)}
    asked = {name: conventions.pop(name) for name in list(conventions) if name in requested}
    return BatchSettings(
        passes=tuple(names),
        save=save,
        options={"weld": parse_weld(weld), **asked},
        appearance=appearance,
        common=common,
        command=shell_quoted(["curvcli", *sys.argv[1:]]),
        configuration=configuration(),
        **conventions,
    )


def _here(limits: Limits, jobs: int | None, soon: int = 0) -> AbstractContextManager[Engine]:
    from ..batch.processes import here

    return here(limits, jobs or _processors(), soon)


def _engine(scheduler: str | None, jobs: int | None, limits: Limits) -> AbstractContextManager[Engine]:
    if scheduler is None:
        return _here(limits, jobs)
    if jobs is not None:
        raise UsageError("-j counts workers here, --scheduler has its own; choose one")
    from ..batch.dask import connect

    return connect(scheduler, limits)


def _processors() -> int:
    """Number of processors that this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity else os.cpu_count() or 1


def _work(batch: Batch, engine: Engine, todo: Sequence[BatchItem], quiet: bool) -> None:
    """Run the meshes with a progress bar on a terminal, and print a line for every mesh that fails."""
    if quiet or not sys.stderr.isatty():
        for row in batch.work(engine, todo):
            if row.error is not None:
                say(row.error)
        return
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    from ..report.terminal.console import Console

    columns = (
        *(TextColumn("meshes"), BarColumn(), MofNCompleteColumn()),
        *(TextColumn("{task.fields[rate]}"), TimeRemainingColumn(), TextColumn("{task.fields[failures]}")),
    )
    with Progress(*columns, console=Console(stderr=True)) as progress:
        bar = progress.add_task("", total=len(todo), rate="", failures="")
        failed = 0
        for row in batch.work(engine, todo):
            if row.error is not None:
                failed += 1
                progress.update(bar, failures=f"[red]{failed} failed[/red]")
                progress.console.print(f"curvcli: {row.error}", markup=False, highlight=False, soft_wrap=True)
            speed = progress.tasks[bar].speed
            progress.update(bar, advance=1, rate=f"{speed:.1f}/s" if speed else "")


def _print_summary(batch: Batch, begun: int) -> None:
    """Print on stdout the number of meshes per status."""
    from rich import box
    from rich.table import Table

    from ..analysis.configuration import configured
    from ..report.terminal.console import Console, escape, show_configuration

    counts = Counter((row.status, row.exit_code) for row in batch.rows)
    table = Table(box=box.SIMPLE_HEAD)
    table.add_column("status")
    table.add_column("exit code", justify="right")
    table.add_column("meshes", justify="right")
    for (status, code), count in sorted(counts.items()):
        table.add_row(status.replace("_", " "), str(code), f"{count:,}")
    console = Console()
    console.print(table)
    show_configuration(console, configured(batch.settings.configuration))
    missing = len(batch.items) - len(batch.rows)
    kept = len(batch.items) - begun
    phrases = [f"{len(batch.rows):,} of {counted(len(batch.items), 'mesh', 'meshes')}"]
    phrases += [f"{kept:,} unchanged since an earlier run"] * bool(kept)
    phrases += [f"{missing:,} left for --resume"] * bool(missing)
    console.print(f"{', '.join(phrases)}; {escape(os.path.join(batch.folder, 'summary.csv'))}", soft_wrap=True)

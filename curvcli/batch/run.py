"""One mesh: read, compute, check, write; and its row. Every engine calls `run`."""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import time
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import msgspec

from ..analysis.request import Request
from ..analysis.result import Result, compute
from ..errors import InputError, OutputError
from ..loading.read import read_mesh_file
from ..loading.recognise import format_of_name
from ..mesh.polygons import from_file
from ..output.atomic import Outputs
from ..output.registry import format_of
from ..output.write import needs, write_into
from ..report.build import pieces
from ..report.entries import entries, measured
from ..support.memory import is_out_of_memory, trim_heap
from ..support.words import escape_text
from .locations import hash_of, is_url, length_of, read_url
from .model import BatchItem, BatchSettings, Limits, Row, RowStatistics, Written
from .outcome import explained
from .ranges import ranges_of

if TYPE_CHECKING:
    from ..mesh.surface import Surface

_WORST = ("fail", "pass", "not_applicable")


def run(item: BatchItem, settings: BatchSettings, limits: Limits) -> tuple[Row, bool]:
    """Analyse one mesh and write its outputs whole or not at all; return its row, and whether memory ran out."""
    start = time.perf_counter()
    trim_heap()  # of the mesh before
    _forget_peak()
    spent = False
    try:
        analysis = _analysed(item, settings)
        row = _row(item, analysis, settings.long)
        if settings.common:
            row.ranges = ranges_of(analysis, settings)
        _write(analysis, item, settings)
        row.outputs = _written(item)
    except Exception as error:
        # The error is not kept: its traceback refers to the analysis.
        spent = is_out_of_memory(error)
        row = explained(item.path, error, limits)
        row.sha256 = _hash(item)
    row.seconds, row.memory = round(time.perf_counter() - start, 4), _peak()
    return row, spent


def _analysed(item: BatchItem, settings: BatchSettings) -> Result:
    timings: dict[str, float] = {}
    request = Request(passes=settings.passes, **settings.options)
    with _timed(timings, "read"):
        surface = _surface(item, settings, request)
    with _timed(timings, "compute"):
        formats = [format_of(path) for kind, path in item.outputs if not kind]
        tables = [kind for kind, _ in item.outputs if kind]
        if settings.common:
            formats += [format_of(f"x.{text}") for text in settings.save if not text.startswith("histogram.")]
            tables += ["histogram"] * any(text.startswith("histogram.") for text in settings.save)
        besides = needs(formats, tables, settings.appearance, request.chosen)
        analysis = compute(surface, replace(request, besides=besides), Result)
    with _timed(timings, "check"):
        _ = analysis.checks
    analysis.timings |= timings
    analysis.configuration = settings.configuration
    return analysis


def _surface(item: BatchItem, settings: BatchSettings, request: Request) -> Surface:
    """Surface of a file or a URL; messages use the name given."""
    asked: dict[str, Any] = {key: getattr(request, key) for key in ("weld", "normals")}
    asked |= {key: getattr(settings, key) for key in ("max_faces", "max_bytes")}
    wanted = settings.input_format
    try:
        if item.content is None and not is_url(item.place):
            file = read_mesh_file(item.place, input_format=wanted, **asked)
        else:
            content = item.content if item.content is not None else read_url(item.place, settings.max_bytes)
            file = read_mesh_file(io.BytesIO(content), input_format=wanted or format_of_name(item.place), **asked)
        return from_file(replace(file, path=item.path), request.orient or "file")
    except InputError as error:
        error.path = item.path
        raise


def _write(analysis: Result, item: BatchItem, settings: BatchSettings) -> None:
    paths = [path for kind, path in item.outputs if not kind]
    tables = [(kind, path) for kind, path in item.outputs if kind]
    for folder in {os.path.dirname(path) for _, path in item.outputs}:
        _make(folder)
    # The folder belongs to the batch and was checked at the start: existing files are of an earlier run.
    with Outputs([path for _, path in item.outputs], force=True, durable=True) as outputs:
        notices, _ = write_into(outputs, analysis, paths, settings.appearance, tables=tables, command=settings.command)
        analysis.extra_notices += notices


def _written(item: BatchItem) -> list[Written]:
    """Lengths and hashes of the outputs, by which a later run recognises them.

    Errors: OutputError for one that was removed already.
    """
    records = []
    for _, path in item.outputs:
        length, digest = length_of(path), hash_of(path)
        if length is None or digest is None:
            raise OutputError(f"{escape_text(path)}: was written and is gone")
        records.append(Written(escape_text(path), length, digest))
    return records


def _make(folder: str) -> None:
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{escape_text(folder)}: cannot be made: {error.strerror or error}") from error


def _row(item: BatchItem, analysis: Result, long: bool) -> Row:
    whole = pieces(analysis, analysis.surface.whole)[0]
    checks: dict[str, Any] = {}
    for check in analysis.checks:
        # One cell per identity: the worst of the whole, the components and the regions.
        known = checks.setdefault(check.name, {"status": check.status, "residual": check.residual})
        if _WORST.index(check.status) < _WORST.index(known["status"]):
            checks[check.name] = {"status": check.status, "residual": check.residual}
    return Row(
        path=item.path,
        sha256=analysis.surface.file.sha256 if analysis.surface.file else None,
        status="ok" if analysis.passed else "failed_checks",
        topology=msgspec.to_builtins(whole.topology),
        totals=whole.totals,
        checks=checks,
        statistics=_statistics(analysis) if long else [],
    )


def _statistics(analysis: Result) -> list[RowStatistics]:
    by_region: dict[str | None, RowStatistics] = {}
    for region, column, statistic, value in entries(measured(analysis)):
        name = None if region is None else escape_text(region)
        part = by_region.setdefault(name, RowStatistics(name, {}))
        part.columns.setdefault(column, {})[statistic] = value
    return list(by_region.values())


def _hash(item: BatchItem) -> str | None:
    """Hash of a file that could not be analysed, None if it cannot be read."""
    if item.content is not None:
        return hashlib.sha256(item.content).hexdigest()
    return None if is_url(item.place) else hash_of(item.place)


@contextlib.contextmanager
def _timed(timings: dict[str, float], name: str) -> Iterator[None]:
    start = time.perf_counter()
    yield
    timings[name] = time.perf_counter() - start


def _forget_peak() -> None:
    """Reset the system's peak of memory, so that it is that of this mesh; Linux only."""
    with contextlib.suppress(OSError), open("/proc/self/clear_refs", "w", encoding="ascii") as stream:
        stream.write("5")


def _peak() -> int | None:
    """Peak memory of the process in bytes; None if the system does not provide it."""
    with contextlib.suppress(OSError), open("/proc/self/status", encoding="ascii") as stream:
        for line in stream:
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) * 1024
    with contextlib.suppress(ImportError):
        import resource
        import sys

        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
    return None

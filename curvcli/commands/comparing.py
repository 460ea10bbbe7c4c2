"""What `curvcli compare` does without --map: both sides read, set against each other, and told."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import click

from ..differences import Difference, Tolerance, compare_reports, selector
from ..errors import UsageError
from . import options
from .against_exact import accuracy, is_exact

if TYPE_CHECKING:
    from ..analysis import Analysis
    from ..report.accuracy import Accuracy
    from ..report.differences import Comparison, Side


@dataclass
class Read:
    """One side: its report and its cells by column, as far as it has them."""

    side: Side
    report: dict[str, Any] | None = None
    cells: dict[str, Any] | None = None


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
    get: str | None,
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
    """The exit code: 1 if anything differs. given: the conventions that stand whatever a stored side was made with."""
    import msgspec

    from ..output.atomic import Outputs
    from ..output.formats import format_of
    from ..output.tables import parse_precision, write_table
    from ..report import accuracy as errors
    from ..report import differences
    from ..report.lookup import look_up
    from ..report.model import encode

    formats = [format_of(p, name=stream_format if p == "-" else None, kinds=("table", "report")) for p in outputs]
    if "-" in outputs and (as_json or get is not None):
        raise UsageError("-o - and --json or --get both want stdout; choose one")
    parse_precision(precision)
    conventions["weld"] = options.welding(conventions["weld"])
    limits = {"input_format": input_format, "max_faces": max_faces, "max_bytes": max_bytes}
    with Outputs(list(outputs), force) as files:
        found: Comparison | Accuracy
        report: Any = errors
        mesh, known = _exact(a, b, limits, exact)
        if known is not None:
            limit = rtol if "rtol" in given else None
            found = accuracy(mesh, known, conventions, limits, selector(only, ignore), limit, quiet)
        else:
            sides = _read(a, b, given, conventions, limits, quiet)
            found, report = _compare(sides, Tolerance(rtol, atol), only, ignore, common), differences
        for path, one in zip(outputs, formats, strict=True):
            with files.open(path) as stream:
                if one.kind == "report":
                    stream.write(encode(msgspec.to_builtins(found)))
                else:
                    write_table(stream, report.table(found), one.suffix, precision=precision)
        if as_json:
            sys.stdout.buffer.write(encode(msgspec.to_builtins(found)))
        elif get is not None:
            click.echo(look_up(msgspec.to_builtins(found), get))
        elif not quiet and "-" not in outputs:
            report.show(found, verbose)
    return 0 if found.equal else 1


def _compare(
    sides: tuple[Read, Read], tolerance: Tolerance, only: tuple[str, ...], ignore: tuple[str, ...], common: bool
) -> Comparison:
    from ..cell_differences import MovedColumn, compare_cells
    from ..report.differences import model

    a, b = sides
    wanted = selector(only, ignore)
    found: list[Difference] = []
    columns: list[MovedColumn] = []
    notes: list[str] = []
    compared = 0
    if a.report is not None and b.report is not None:
        found, compared = compare_reports(a.report, b.report, tolerance, wanted, common=common)
        if any(one.key.startswith("conventions.") for one in found):
            notes.append("the conventions differ, and with them what the numbers mean")
    if a.cells is not None and b.cells is not None and (only or wanted("vertices")):
        counts = [len(next(iter(side.cells.values()))) for side in (a, b)]  # type: ignore[union-attr]
        if counts[0] == counts[1]:
            columns, lacking, more = compare_cells(a.cells, b.cells, tolerance, wanted, common=common)
            found, compared = [*found, *lacking], compared + more
        elif wanted("vertices.count"):
            found.append(Difference("vertices.count", "changed", *counts))
            compared += 1
            notes.append("tables of different lengths: the columns are not compared cell by cell")
    if not compared and not found:
        raise UsageError("nothing is left to compare; --only or --ignore leaves no value that both sides have")
    return model(a.side, b.side, tolerance, compared, found, columns, notes)


def _exact(a: str, b: str, limits: dict[str, Any], exact: bool) -> tuple[str, Read | None]:
    """The mesh and the table of exact values that it is set against, if that is what the two are.

    exact: whatever the table looks like. Errors: UsageError where there is none.
    """
    for mesh, table in ((a, b), (b, a)):
        if (_kind(mesh), _kind(table)) == ("mesh", "table"):
            stored = _stored(table, limits["max_bytes"])
            if exact or is_exact(stored.cells or {}):
                return mesh, stored
    if exact:
        raise UsageError("--exact wants a mesh and a table (.csv .tsv .parquet) of exact values")
    return a, None


def _read(
    a: str, b: str, given: set[str], conventions: dict[str, Any], limits: dict[str, Any], quiet: bool
) -> tuple[Read, Read]:
    kinds = {_kind(a), _kind(b)}
    if kinds == {"report", "table"}:
        raise UsageError("a report and a table have no values in common; compare the mesh with each of them")
    # What is stored comes first: it says how to analyse the mesh.
    stored = {path: _stored(path, limits["max_bytes"]) for path in (a, b) if _kind(path) != "mesh"}
    for side in stored.values():
        conventions |= {name: value for name, value in _made_with(side).items() if name not in given}
    first, second = (stored.get(path) or analysed(path, conventions, limits, quiet)[0] for path in (a, b))
    return first, second


def _kind(path: str) -> str:
    from ..loading.stored import SUFFIXES

    suffix = os.path.splitext(path)[1].lower()
    return "report" if suffix == ".json" else "table" if suffix in SUFFIXES else "mesh"


def _stored(path: str, max_bytes: int | None) -> Read:
    from ..loading.stored import read_stored_table
    from ..report.differences import Side
    from ..report.stored import read_report

    if _kind(path) == "report":
        report = read_report(path, max_bytes=max_bytes)
        return Read(Side(path, "report", report["input"]["sha256"]), report)
    return Read(Side(path, "table"), cells=read_stored_table(path, max_bytes=max_bytes))


def _made_with(side: Read) -> dict[str, Any]:
    """The passes and conventions that make a mesh's report or table comparable with this one."""
    from ..declare import passes
    from ..pipeline import load_passes
    from ..settings import options_of

    load_passes()
    columns = {column: q.name for q in passes.quantities("vertex") for column in q.columns}
    scales = (side.report or {}).get("conventions", {}).get("scale") or ""
    columns |= {f"{column}_{scale}": name for column, name in columns.items() for scale in scales.split(",")}
    if side.report is None:
        return {"passes": tuple(dict.fromkeys(columns[name] for name in side.cells or () if name in columns))}
    # Totals of vertex columns may stem from what other columns need; chosen, they would add columns.
    totals = {q.total: q.name for q in passes.quantities() if q.total and q.on != "vertex"}
    names = [columns[name] for name in side.report["columns"] if name in columns]
    names += [totals[name] for name in side.report["totals"] if name in totals]
    made: dict[str, Any] = {key: side.report["conventions"].get(key) for key in ("mean", "area", "orient", "unit")}
    made = {key: value for key, value in made.items() if value is not None or key == "unit"}
    if side.report["conventions"].get("scale") is not None:
        made |= options_of(side.report["conventions"]["scale"])
    if side.report["conventions"].get("normals") is not None:
        made["normals"] = side.report["conventions"]["normals"]
    if side.report["conventions"].get("noise") is not None:
        made["noise"] = float(side.report["conventions"]["noise"])
    if side.report["conventions"].get("weld") not in (None, "none"):
        made["weld"] = options.welding(side.report["conventions"]["weld"])
    if side.report["conventions"].get("regions") not in (None, "array"):
        made["regions"] = side.report["conventions"]["regions"]
    return {**made, "passes": tuple(dict.fromkeys(names))}


def analysed(path: str, conventions: Mapping[str, Any], limits: dict[str, Any], quiet: bool) -> tuple[Read, Analysis]:
    """A mesh with its report and its columns as a stored table would have them."""
    from ..analysis import analyze
    from ..loading.surfaces import load
    from ..report.differences import Side
    from ..tables import vertex_table
    from .progress import phase

    settings = dict(conventions)
    names = settings.pop("passes")
    with phase(f"reading {path}", quiet):
        source = sys.stdin.buffer if path == "-" else path
        asked = {key: settings[key] for key in ("weld", "orient", "normals") if key in settings}
        surface = load(source, **asked, **limits)
    with phase(f"computing {path}", quiet):
        analysis = analyze(surface, names or ("core",), **settings)
        report = analysis.report()
    sha256 = surface.file.sha256 if surface.file is not None else None
    cells = {name: _plain(column) for name, column in vertex_table(analysis).items() if name != "vertex"}
    return Read(Side(path, "mesh", sha256), report, cells), analysis


def _plain(column: Any) -> Any:
    """A column of a table as floats with NaN or words with None for null, as a stored table is read."""
    import numpy as np

    from ..loading.model import Labels

    if isinstance(column, Labels):
        return np.array([*column.names, None], object)[np.asarray(column.codes)]
    if isinstance(column, np.ma.MaskedArray):
        return np.ma.filled(column.astype(np.float64), np.nan)
    return column

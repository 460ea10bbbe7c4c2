"""The two sides of `curvcli compare`: meshes that are analysed, stored reports, and tables."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..errors import InputError, UsageError
from ..loading.limits import parse_weld
from .meshes import input_of
from .progress import phase

if TYPE_CHECKING:
    from ..analysis.result import Result
    from ..report.compare.model import Side


@dataclass
class LoadedSide:
    """One side: its report and its cells by column, as far as it has them."""

    side: Side
    report: dict[str, Any] | None = None
    cells: dict[str, Any] | None = None


def both_sides(
    a: str, b: str, given: set[str], conventions: dict[str, Any], limits: dict[str, Any], quiet: bool
) -> tuple[LoadedSide, LoadedSide]:
    """Read both sides; a mesh is analysed with the settings of a stored side.

    given: conventions that override those of a stored side.
    Errors: UsageError for a report and a table; InputError for what cannot be read.
    """
    kinds = {kind_of(a), kind_of(b)}
    if kinds == {"report", "table"}:
        raise UsageError("a report and a table have no values in common; compare the mesh with each of them")
    # The stored side is read first: it has the settings for the mesh.
    stored = {path: stored_side(path, limits["max_bytes"]) for path in (a, b) if kind_of(path) != "mesh"}
    for side in stored.values():
        conventions |= {name: value for name, value in _made_with(side).items() if name not in given}
    first, second = (stored.get(path) or analysed_side(path, conventions, limits, quiet)[0] for path in (a, b))
    return first, second


def kind_of(path: str) -> str:
    """Kind of a side, `mesh`, `report` or `table`, by its suffix."""
    from ..loading.tables import SUFFIXES

    suffix = os.path.splitext(path)[1].lower()
    return "report" if suffix == ".json" else "table" if suffix in SUFFIXES else "mesh"


def stored_side(path: str, max_bytes: int | None) -> LoadedSide:
    """Read a stored report or table."""
    from ..loading.tables import read_stored_table
    from ..report.compare.model import Side
    from ..report.compare.stored import read_report

    if kind_of(path) == "report":
        report = read_report(path, max_bytes=max_bytes)
        return LoadedSide(Side(path, "report", report["input"]["sha256"]), report)
    return LoadedSide(Side(path, "table"), cells=read_stored_table(path, max_bytes=max_bytes))


def _made_with(side: LoadedSide) -> dict[str, Any]:
    """Passes and conventions that make a mesh comparable with this stored side."""
    from ..curvatures.catalogue import load_passes
    from ..curvatures.registry import passes
    from ..curvatures.setting_values import parse_described
    from ..mesh.scale import options_of

    load_passes()
    columns = {column: q.name for q in passes.quantities("vertex") for column in q.columns}
    conventions: dict[str, Any] = {} if side.report is None else side.report["conventions"]
    scales = conventions.get("scale") or ""
    columns |= {f"{column}_{scale}": name for column, name in columns.items() for scale in scales.split(",")}
    if side.report is None:
        return {"passes": tuple(dict.fromkeys(columns[name] for name in side.cells or () if name in columns))}
    # Totals of vertex columns may stem from what other columns need; chosen, they would add columns.
    totals = {q.total: q.name for q in passes.quantities() if q.total and q.on != "vertex"}
    names = [columns[name] for name in side.report["columns"] if name in columns]
    names += [totals[name] for name in side.report["totals"] if name in totals]
    made = {key: conventions[key] for key in ("mean", "area", "orient", "normals") if conventions.get(key) is not None}
    made |= {"unit": conventions.get("unit"), "passes": tuple(dict.fromkeys(names))}
    if conventions.get("scale") is not None:
        made |= options_of(conventions["scale"])
    if conventions.get("noise") is not None:
        made["noise"] = float(conventions["noise"])
    if conventions.get("settings") is not None:
        made["parameters"] = parse_described(conventions["settings"])
    if conventions.get("bending_rigidity") is not None:
        made["bending_rigidity"] = conventions["bending_rigidity"]
    if conventions.get("weld") not in (None, "none"):
        made["weld"] = parse_weld(conventions["weld"])
    if conventions.get("regions") not in (None, "array"):
        made["regions"] = conventions["regions"]
    return made


def analysed_side(
    path: str, conventions: Mapping[str, Any], limits: Mapping[str, Any], quiet: bool
) -> tuple[LoadedSide, Result]:
    """Analyse a mesh: its report, and its columns in the form of a stored table."""
    from ..analysis.request import Request
    from ..analysis.result import Result, compute
    from ..loading.load import load
    from ..output.tables.columns import vertex_table
    from ..report.build import build
    from ..report.compare.model import Side

    settings = dict(conventions)
    names = settings.pop("passes")
    with phase(f"reading {path}", quiet):
        if path != "-" and limits["input_format"] is None:
            _check_suffix(path)
        asked = {key: settings[key] for key in ("weld", "orient", "normals") if key in settings}
        surface = load(input_of(path), **asked, **limits)
    with phase(f"computing {path}", quiet):
        analysis = compute(surface, Request(passes=names or ("core",), **settings), Result)
        report = build(analysis)
    sha256 = surface.file.sha256 if surface.file is not None else None
    cells = {name: _as_stored(column) for name, column in vertex_table(analysis).items() if name != "vertex"}
    return LoadedSide(Side(path, "mesh", sha256), report, cells), analysis


def _check_suffix(path: str) -> None:
    """Errors: InputError for an unknown suffix, with all known ones."""
    from ..loading.hints import is_url
    from ..loading.recognise import format_of_name
    from ..loading.tables import SUFFIXES

    if is_url(path) or os.path.isdir(path):
        return  # the reader raises a more exact error
    try:
        format_of_name(path)
    except InputError as error:
        stored = ", ".join((".json", *SUFFIXES))
        raise InputError(f"{error.problem}, or {stored}", path=path, hint=error.hint) from None


def _as_stored(column: Any) -> Any:
    """Column in the form of a stored table: floats with NaN for null, or words with None for null."""
    import numpy as np

    from ..mesh.file import Labels

    if isinstance(column, Labels):
        return np.array([*column.names, None], object)[np.asarray(column.codes)]
    if isinstance(column, np.ma.MaskedArray):
        return np.ma.filled(column.astype(np.float64), np.nan)
    return column

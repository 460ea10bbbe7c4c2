"""The report as JSON: one typed model from which encoding, decoding and the JSON Schema follow."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from msgspec.structs import replace

from .._version import __version__
from ..census import census, classify, duplicate_faces, duplicate_vertices
from ..declare import passes
from ..groups import Groups
from ..surface import Surface
from ..totals import competing_normals, constant_mean_curvature, steiner
from .quantities import public
from .statistics import ColumnStatistics, statistics

if TYPE_CHECKING:
    from ..analysis import Analysis

Value = float | list[float | None] | None

# Of the analysis, in the order of the report.
CONVENTIONS = ("mean", "area", "orient", "weld", "unit", "regions", "scale", "normals", "noise")


class Input(msgspec.Struct):
    """Where the mesh came from; null for arrays made in memory."""

    path: str | None
    sha256: str | None
    format: str | None
    vertices: int
    polygons: int


class Topology(msgspec.Struct):
    """Counts of the triangulated surface, referenced vertices only."""

    vertices: int
    edges: int
    faces: int
    euler_characteristic: int
    components: int
    boundary_loops: int | None
    boundary_edges: int
    genus: int | None
    crosscaps: int | None
    closed: bool
    manifold: bool
    orientable: bool
    consistent_winding: bool
    nonmanifold_edges: int
    nonmanifold_vertices: int
    degenerate_faces: int
    duplicate_faces: int
    unreferenced_vertices: int
    duplicate_vertices: int


class Cmc(msgspec.Struct):
    """Nearness to constant mean curvature."""

    H: float | None
    residual_max: float | None


class Minimal(msgspec.Struct):
    """Nearness to a minimal surface."""

    H_vec_max: float | None


class Steiner(msgspec.Struct):
    """Steiner's polynomial, lowest power first; exact for convex bodies."""

    coefficients: list[float | None] | None
    convex: bool


class Normals(msgspec.Struct):
    """The angle between the two competing normals, H_vec and A_vec, in radians."""

    angle_max: float | None
    angle_mean: float | None


class Piece(msgspec.Struct, omit_defaults=True):
    """The whole surface, one component or one region of it; `name` of a region."""

    topology: Topology
    totals: dict[str, Value]
    steiner: Steiner | msgspec.UnsetType = msgspec.UNSET
    cmc: Cmc | msgspec.UnsetType = msgspec.UNSET
    minimal: Minimal | msgspec.UnsetType = msgspec.UNSET
    normals: Normals | msgspec.UnsetType = msgspec.UNSET
    name: str | msgspec.UnsetType = msgspec.UNSET


class CheckRow(msgspec.Struct):
    """One identity on one scope: `pass`, `fail` or `not_applicable` with the reason in `detail`."""

    name: str
    scope: str
    status: str
    value: Value
    expected: Value
    residual: float | None
    tolerance: float | None
    detail: str


class Remark(msgspec.Struct):
    """Something accepted but worth knowing."""

    code: str
    count: int
    message: str
    hint: str | None
    examples: list[int]


class Report(msgspec.Struct, omit_defaults=True, kw_only=True):
    """The report of `curvcli analyze`; what was not computed is absent, what is undefined is null."""

    schema_version: int
    curvcli: str
    input: Input
    conventions: dict[str, str | None]
    topology: Topology
    totals: dict[str, Value]
    steiner: Steiner | msgspec.UnsetType = msgspec.UNSET
    cmc: Cmc | msgspec.UnsetType = msgspec.UNSET
    minimal: Minimal | msgspec.UnsetType = msgspec.UNSET
    normals: Normals | msgspec.UnsetType = msgspec.UNSET
    components: list[Piece]
    loops: list[dict[str, str | int | bool | Value]]
    regions: list[Piece]
    columns: dict[str, ColumnStatistics]
    checks: list[CheckRow]
    warnings: list[Remark]
    timings: dict[str, float]


def build(analysis: Analysis) -> dict[str, Any]:
    """The report as plain Python values."""
    found: dict[str, Any] = msgspec.to_builtins(model(analysis))
    return found


def encode(report: Report | list[Report] | dict[str, Any]) -> bytes:
    """JSON text; numbers are the shortest that read back to the same double."""
    return msgspec.json.format(msgspec.json.encode(report), indent=2) + b"\n"


def schema() -> bytes:
    """The JSON Schema of the report."""
    found = {"$schema": "https://json-schema.org/draft/2020-12/schema", **msgspec.json.schema(Report)}
    properties = found["$defs"]["Report"]["properties"]
    quantities = [quantity for quantity in public() if quantity.on == "vertex" and quantity.kind != "label"]
    properties["columns"]["properties"] = {
        column: {"$ref": "#/$defs/ColumnStatistics", "description": f"{quantity.description} {quantity.formula}"}
        for quantity in quantities
        for column in quantity.columns
    }
    for piece in (found["$defs"]["Report"], found["$defs"]["Piece"]):
        piece["properties"]["totals"]["properties"] = {
            quantity.total: {"description": f"Σ {quantity.name}: {quantity.description}"}
            for quantity in passes.quantities(public=False)
            if quantity.total
        }
    return encode(found)


def model(analysis: Analysis) -> Report:
    """The report of an analysis."""
    surface, file = analysis.surface, analysis.surface.file
    whole = analysis.once("whole", lambda: pieces(analysis, surface.whole)[0])
    conventions = analysis.conventions
    return Report(
        schema_version=1,
        curvcli=__version__,
        input=Input(
            path=file.path if file else None,
            sha256=file.sha256 if file else None,
            format=file.format if file else None,
            vertices=surface.n_vertices,
            polygons=file.polygons if file else surface.n_faces,
        ),
        conventions={key: getattr(conventions, key) for key in CONVENTIONS},
        topology=whole.topology,
        totals=whole.totals,
        steiner=whole.steiner,
        cmc=whole.cmc,
        minimal=whole.minimal,
        normals=whole.normals,
        components=analysis.once("components", lambda: _components(analysis, whole)),
        loops=analysis.once("loops", lambda: loops(analysis)),
        regions=analysis.once("regions", lambda: _regions(analysis)),
        columns=analysis.once("columns", lambda: _columns(analysis)),
        checks=[CheckRow(**vars(check)) for check in analysis.checks],
        warnings=[Remark(n.code, n.count, n.message, n.hint, list(n.examples)) for n in analysis.notices],
        timings=analysis.timings,
    )


def pieces(analysis: Analysis, groups: Groups) -> list[Piece]:
    """Topology, totals and the rest for each group of a surface."""
    counts = _counts(analysis, groups)
    totals = {key: _plain(values) for key, values in analysis.totals_of(groups).items()}
    extras = _extras(analysis, groups)
    return [
        Piece(
            Topology(**{key: values[group] for key, values in counts.items()}),
            {key: values[group] for key, values in totals.items()},
            name=groups.names[group] if groups.names else msgspec.UNSET,
            **{key: make(group) for key, make in extras.items()},
        )
        for group in range(groups.count)
    ]


def _components(analysis: Analysis, whole: Piece) -> list[Piece]:
    """The components of a surface; a single one from the surface itself, but for the vertices that no face uses."""
    if analysis.surface.components.count == 1:
        return [replace(whole, topology=replace(whole.topology, unreferenced_vertices=0))]
    return pieces(analysis, analysis.surface.components)


def _regions(analysis: Analysis) -> list[Piece]:
    return [] if analysis.cut is None else pieces(analysis.cut, analysis.cut_groups)


def loops(analysis: Analysis) -> list[dict[str, Any]]:
    """One row per boundary loop, vectors as lists."""
    if not analysis.surface.boundary_edges.any():
        return []
    from ..curves.loops import loop_table

    columns = {
        key: _plain(column) if column.dtype.kind == "f" else column.tolist()
        for key, column in loop_table(analysis.surface).items()
    }
    for stem in ("vector_area", "force", "torque"):
        axes = [columns.pop(f"{stem}_{axis}") for axis in "xyz"]
        columns[stem] = [list(vector) for vector in zip(*axes, strict=True)]
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def _extras(analysis: Analysis, groups: Groups) -> dict[str, Callable[[int], Any]]:
    """What only some passes allow: for each key a function from the group to its value."""
    surface, columns = analysis.surface, analysis.columns
    factor = 0.5 if analysis.conventions.mean == "average" else 1.0
    found: dict[str, Callable[[int], Any]] = {}
    if columns.keys() >= {"H_vec", "A_vec"}:
        bent = constant_mean_curvature(surface, groups, columns)
        exponents = {"H": -1, "residual_max": 1, "H_vec_max": 1}
        shown = {key: _plain(surface.in_file_unit(values, exponents[key]) * factor) for key, values in bent.items()}
        found["cmc"] = lambda group: Cmc(shown["H"][group], shown["residual_max"][group])
        found["minimal"] = lambda group: Minimal(shown["H_vec_max"][group])
    if columns.keys() >= {"H_vec", "star_vector"}:
        angles = {key: _plain(values) for key, values in competing_normals(surface, groups, columns).items()}
        found["normals"] = lambda group: Normals(angles["angle_max"][group], angles["angle_mean"][group])
    if columns.keys() >= {"face_area", "H_theta", "K", "K_minus"}:
        polynomial = steiner(surface, groups, columns)
        rows = _plain(polynomial["coefficients"])
        found["steiner"] = lambda group: Steiner(rows[group], bool(polynomial["convex"][group]))
    return found


def _counts(analysis: Analysis, groups: Groups) -> dict[str, list[Any]]:
    """The columns of the topology table, one entry per group."""
    surface = analysis.surface
    kinds = classify(surface, groups)
    classified = {
        key: [None if math.isnan(value) else round(value) for value in getattr(kinds, key)]
        for key in ("boundary_loops", "genus", "crosscaps")
    }
    counted = {key: column.tolist() for key, column in vars(census(surface, groups)).items()}
    counted |= {"components": kinds.components.tolist()} | classified | _defects(analysis, groups)
    return {key: counted[key] for key in Topology.__struct_fields__}


def _defects(analysis: Analysis, groups: Groups) -> dict[str, list[int]]:
    """Counts per group that need more than the edges."""
    surface = analysis.surface
    faces, vertices = np.zeros(surface.n_faces, bool), np.zeros(surface.n_vertices, bool)
    faces[duplicate_faces(surface)] = True
    vertices[duplicate_vertices(surface)] = True
    loose = surface.n_vertices - int(np.count_nonzero(surface.referenced)) - merged(surface)
    return {
        "degenerate_faces": groups.faces.count_true(analysis.columns["degenerate_face"]).tolist(),
        "duplicate_faces": groups.faces.count_true(faces).tolist(),
        "unreferenced_vertices": [loose if groups.kind == "whole" else 0] * groups.count,
        "duplicate_vertices": groups.vertices.count_true(vertices).tolist(),
    }


def merged(surface: Surface) -> int:
    """Rows whose values stand in the row they were welded to."""
    welded = surface.file.welded_to if surface.file is not None else None
    return 0 if welded is None else int(np.count_nonzero(welded >= 0))


def _columns(analysis: Analysis) -> dict[str, ColumnStatistics]:
    surface = analysis.surface
    area = analysis.columns["star_area"]
    found: dict[str, ColumnStatistics] = {}
    for name in analysis.chosen:
        quantity = passes.quantity(name)
        if quantity.on != "vertex" or quantity.kind == "label":
            continue
        shown = analysis.column(name)
        each = shown.T if quantity.vector else [shown]
        for column, values in zip(quantity.columns, each, strict=True):
            found[column] = statistics(
                quantity, values, area, surface.referenced, quantity.unit(analysis.conventions.unit)
            )
    return found


def _plain(values: Any) -> list[Any]:
    """Lists for JSON, with None for what is undefined: a number that is none, a vector without a component."""
    return [_vector(row) if isinstance(row, list) else _number(row) for row in values.tolist()]


def _vector(row: list[float]) -> list[float | None] | None:
    shown = [_number(x) for x in row]
    return None if all(x is None for x in shown) else shown


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None

"""Report as JSON: one typed model from which encoding, decoding and the JSON Schema follow."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Annotated, Any

import msgspec

from ..analysis.configuration import Configured
from ..checks.base import Check
from ..curvatures.derived import derived
from ..curvatures.registry import passes
from ..errors import Notice
from ..support.arrays import Value
from ..support.words import escape_json, escape_text
from .statistics import ColumnStatistics, Statistics

if TYPE_CHECKING:
    from ..mesh.file import MeshFile

# For a polynomial of degree 3, lowest power first.
POWERS = 4
Coefficients = Annotated[list[float | None], msgspec.Meta(min_length=POWERS, max_length=POWERS)]

# Conventions of the analysis, in the order of the report.
CONVENTIONS = (
    *("mean", "area", "orient", "weld", "unit", "regions", "scale", "normals", "noise", "settings"),
    *("bending_rigidity",),
)


def vector(components: Iterable[float | None]) -> list[float | None] | None:
    """Vector from its components; null if a component is."""
    listed = list(components)
    return None if all(part is None for part in listed) else listed


class Input(msgspec.Struct):
    """Source of the mesh; null for arrays made in memory."""

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
    """Nearness to constant mean curvature: the best constant H in the area measure, the largest |H_p + H A_p| and the
    largest |H_p + H A_p|/A_p over interior vertices."""

    H: float | None
    residual_max: float | None
    residual_density_max: float | msgspec.UnsetType | None = msgspec.UNSET  # absent in older reports


class Minimal(msgspec.Struct):
    """Nearness to a minimal surface: the largest |H_p| and the largest |H_p|/A_p over vertices off the boundary."""

    H_vec_max: float | None
    H_vec_density_max: float | msgspec.UnsetType | None = msgspec.UNSET  # absent in older reports


class Steiner(msgspec.Struct):
    """Steiner's polynomial, lowest power first; exact for convex bodies, also where they are wound inside out."""

    coefficients: Coefficients | None
    convex: bool


class Normals(msgspec.Struct):
    """The angle between the two competing normals, H_vec and A_vec, in radians."""

    angle_max: float | None
    angle_mean: float | None


class Fractions(msgspec.Struct, omit_defaults=True):
    """Fractions of the area by the sign of K and of H, over the vertices that have a value; zero is within rounding."""

    K_positive: float | None
    K_negative: float | None
    K_zero: float | None
    H_positive: float | msgspec.UnsetType | None = msgspec.UNSET
    H_negative: float | msgspec.UnsetType | None = msgspec.UNSET
    H_zero: float | msgspec.UnsetType | None = msgspec.UNSET


class Piece(msgspec.Struct, omit_defaults=True):
    """The whole surface, one component or one region of it; `name` of a region.

    columns: the statistics of each column, of up to 1,000 regions, and of any number of regions and components where
    --stat names some. shares: of a region, the parts of the totals of the whole that belong to its faces; they add up
    to the whole, as totals do not.
    """

    topology: Topology
    totals: dict[str, Value]
    steiner: Steiner | msgspec.UnsetType = msgspec.UNSET
    cmc: Cmc | msgspec.UnsetType = msgspec.UNSET
    minimal: Minimal | msgspec.UnsetType = msgspec.UNSET
    normals: Normals | msgspec.UnsetType = msgspec.UNSET
    fractions: Fractions | msgspec.UnsetType = msgspec.UNSET
    shares: dict[str, Value] | msgspec.UnsetType = msgspec.UNSET
    columns: dict[str, Statistics] | msgspec.UnsetType = msgspec.UNSET
    name: str | msgspec.UnsetType = msgspec.UNSET


def input_of(file: MeshFile | None, vertices: int, faces: int) -> Input:
    """Input of the report; vertices: rows of the table, faces: polygons if there is no file."""
    if file is None:
        return Input(None, None, None, vertices, faces)
    return Input(file.path, file.sha256, file.format, vertices, file.polygons)


class Report(msgspec.Struct, omit_defaults=True, kw_only=True):
    """The report of `curvcli analyze`; values not computed are absent, undefined values are null."""

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
    fractions: Fractions | msgspec.UnsetType = msgspec.UNSET
    components: list[Piece]
    loops: list[dict[str, str | int | bool | Value]]
    regions: list[Piece]
    columns: dict[str, ColumnStatistics]
    checks: list[Check]
    warnings: list[Notice]
    timings: dict[str, float]
    configuration: Configured = msgspec.UNSET


def as_dict(report: msgspec.Struct) -> dict[str, Any]:
    """A report as dicts and lists of plain values."""
    values: dict[str, Any] = msgspec.to_builtins(report)
    for warning in values.get("warnings", ()):
        warning["examples"] = list(warning["examples"])
    return values


def encode(report: Report | list[Report] | dict[str, Any]) -> bytes:
    """JSON text; numbers are the shortest that read back to the same double, unprintable characters are escaped."""
    return escape_json(msgspec.json.format(one_line(report), indent=2)) + b"\n"


def one_line(value: Any) -> bytes:
    """JSON text on one line; lone surrogates, from file names that are not UTF-8, are escaped."""
    try:
        return msgspec.json.encode(value)
    except UnicodeEncodeError:
        return msgspec.json.encode(_whole(msgspec.to_builtins(value)))


def _whole(value: Any) -> Any:
    match value:
        case str():
            return value if value.isprintable() else _without_halves(value)
        case list() | tuple():
            return [_whole(item) for item in value]
        case dict():
            return {_whole(key): _whole(entry) for key, entry in value.items()}
    return value


def _without_halves(text: str) -> str:
    return "".join(escape_text(c) if "\ud800" <= c < "\ue000" else c for c in text)


def require_all_keys(definitions: dict[str, Any]) -> None:
    """Require every key of a notice in a schema: defaults are for Python, and JSON has all of them."""
    if notice := definitions.get("Notice"):
        notice["required"] = list(notice["properties"])
        for value in notice["properties"].values():
            value.pop("default", None)


def schema() -> bytes:
    """JSON Schema of the report."""
    from .quantities import public, unmarked

    document = {"$schema": "https://json-schema.org/draft/2020-12/schema", **msgspec.json.schema(Report)}
    require_all_keys(document["$defs"])
    properties = document["$defs"]["Report"]["properties"]
    quantities = [quantity for quantity in public() if quantity.on == "vertex" and quantity.kind != "label"]
    properties["columns"]["properties"] = {
        column: {
            "$ref": "#/$defs/ColumnStatistics",
            "description": unmarked(f"{quantity.description} {quantity.formula}"),
        }
        for quantity in quantities
        for column in quantity.columns
    }
    for piece in (document["$defs"]["Report"], document["$defs"]["Piece"]):
        piece["properties"]["totals"]["properties"] = {
            quantity.total or "": {"description": unmarked(f"Σ {quantity.name}: {quantity.description}")}
            for quantity in passes.totals()
        } | {name: {"description": unmarked(f"{each.symbol}: {each.description}")} for name, each in derived.items()}
    return encode(document)

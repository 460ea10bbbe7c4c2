"""Tables of an analysis as named columns, in the order of the interface."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import TYPE_CHECKING, Any, get_args, get_type_hints

import numpy as np

from ...curvatures.quantity import Element
from ...curvatures.registry import passes
from ...errors import UsageError
from ...mesh.file import Labels
from ...support.words import suggestion
from .statistics import statistics_table

if TYPE_CHECKING:
    from ...analysis.result import Result
    from ...mesh.groups import Groups
    from ...report.model import Piece

Table = dict[str, Any]

# Rows per block given to polars, which copies them; a row group in Parquet.
ROWS_IN_A_FRAME = 1 << 18


def vertex_properties(analysis: Result) -> Table:
    """Computed vertex columns, vectors by component; masked, NaN or -1 where undefined, as in merged rows."""
    surface = analysis.surface
    loose = ~surface.referenced
    welded = surface.file.welded_to if surface.file is not None else None
    table: Table = {}
    for name in analysis.chosen:
        quantity = passes.quantity(name)
        if quantity.on != "vertex":
            continue
        if quantity.labels:
            codes = analysis.columns[name]
            table[name] = Labels(codes if welded is None else np.where(welded < 0, codes, -1), quantity.labels)
            continue
        shown = analysis.column(name)
        if quantity.kind == "count":
            table[name] = np.ma.masked_array(shown, loose) if loose.any() else shown
        else:
            table.update(zip(quantity.columns, shown.T if quantity.vector else [shown], strict=True))
    return table


def vertex_table(analysis: Result) -> Table:
    """One row per vertex of the file: index, position, status, then the columns in the order of the theory."""
    surface = analysis.surface
    table: Table = {"vertex": np.arange(surface.n_vertices, dtype=np.int32)}
    xyz = surface.xyz_given
    # Only a vertex that no face uses may have coordinates that are not finite.
    table |= dict(zip("xyz", xyz if surface.referenced.all() else np.where(np.isfinite(xyz), xyz, np.nan), strict=True))
    computed = vertex_properties(analysis)
    if "status" in computed:
        table["status"] = computed.pop("status")
    welded = surface.file.welded_to if surface.file is not None else None
    if welded is not None:
        table["welded_to"] = np.ma.masked_array(welded, welded < 0)
    return table | computed


def _element_columns(analysis: Result, element: Element) -> Table:
    """Every public quantity of edges or faces."""
    table: Table = {}
    for quantity in passes.quantities(element):
        shown = analysis.column(quantity.name)
        table.update(zip(quantity.columns, shown.T if quantity.vector else [shown], strict=True))
    return table


def edge_table(analysis: Result) -> Table:
    """One row per edge, by its ends in ascending order: number of faces, then every quantity of edges."""
    edges = analysis.surface.edges
    table: Table = {"edge": np.arange(len(edges), dtype=np.int32)}
    return table | {"a": edges.a, "b": edges.b, "faces": edges.valence} | _element_columns(analysis, "edge")


def face_table(analysis: Result) -> Table:
    """One row per triangle: the polygon of the file it came from, its corners, every quantity of faces, its region."""
    surface = analysis.surface
    index = np.arange(surface.n_faces, dtype=np.int32)
    table: Table = {"face": index, "polygon": index if surface.polygon is None else surface.polygon}
    table |= dict(zip("abc", surface.faces.T, strict=True))
    table |= _element_columns(analysis, "face")
    if analysis.regions is not None:
        table["region"] = Labels(analysis.regions.face, analysis.regions.names)
    return table


def component_table(analysis: Result) -> Table:
    """One row per component: topology, totals and the rest of the report."""
    from ...report.build import pieces

    rows = pieces(analysis, analysis.surface.components)
    statistics = _statistics(analysis, analysis.surface.components, analysis.request.statistics)
    return {"component": np.arange(len(rows), dtype=np.int32)} | _piece_columns(rows) | statistics


def region_table(analysis: Result) -> Table:
    """One row per region, by its label: topology, totals and the rest of the report; no rows without `--regions`."""
    from ...report.build import region_pieces

    rows = region_pieces(analysis)
    names = () if analysis.regions is None else analysis.regions.names
    table = {"region": _words(names)} | _piece_columns(rows)
    if analysis.cut is not None:
        table |= _statistics(analysis.cut, analysis.cut_groups, analysis.request.statistics)
    return table


def _statistics(analysis: Result, groups: Groups, names: Sequence[str]) -> Table:
    """The named statistics of every column in each group, as COLUMN_STATISTIC."""
    from ...report.statistics import grouped_statistics

    return {
        f"{column}_{name}": values
        for column, each in (grouped_statistics(analysis, groups, names) if names else {}).items()
        for name, values in each.items()
    }


def loop_table(analysis: Result) -> Table:
    """One row per boundary loop."""
    from ...curves.loops import loop_table as loops

    return loops(analysis.surface)


def intersection_table(analysis: Result) -> Table:
    """One row per pair of faces in contact beyond their common corners and edges: kind, faces, components, a point."""
    from ...mesh.intersections.pairs import KINDS
    from ...mesh.intersections.search import face_contacts

    surface = analysis.surface
    contacts = face_contacts(surface)
    table: Table = {
        "intersection": np.arange(len(contacts.kind), dtype=np.int32),
        "kind": Labels(contacts.kind.astype(np.int32), KINDS),
    }
    for side, faces in (("a", contacts.one), ("b", contacts.other)):
        table[f"face_{side}"] = faces if surface.polygon is None else surface.polygon[faces]
        table[f"component_{side}"] = surface.components.face[faces]
    return table | dict(zip("xyz", contacts.points(surface).T, strict=True))


def _piece_columns(pieces: list[Piece]) -> Table:
    """Values of pieces under the last part of the report's keys; columns and types follow from the computed values."""
    import msgspec

    table: Table = {}
    for section, first in (msgspec.structs.asdict(pieces[0]) if pieces else {}).items():
        each = [getattr(piece, section) for piece in pieces]
        if isinstance(first, str):
            table[section] = _words(each)
        elif section in ("totals", "shares") and isinstance(first, dict):
            vectors = {quantity.total for quantity in passes.totals() if quantity.vector}
            for key in first:
                name = key if section == "totals" else f"share_{key}"
                table |= _numbers(name, [values[key] for values in each], "xyz" if key in vectors else ())
        elif isinstance(first, msgspec.Struct):
            for key, declared in get_type_hints(type(first), include_extras=True).items():
                name = key if section == "topology" else f"{section}_{key}"
                if getattr(first, key) is not msgspec.UNSET:
                    table |= _declared(name, [getattr(part, key) for part in each], declared)
    return table


def _declared(name: str, values: list[Any], declared: Any) -> Table:
    """Column of a key of the report, or its columns, in the declared type."""
    from ...report.model import POWERS, Coefficients

    if declared in (bool, int):
        return {name: np.array(values, declared)}
    if int in get_args(declared):
        nulls = [value is None for value in values]
        return {name: np.ma.masked_array([value or 0 for value in values], nulls, np.int64)}
    return _numbers(name, values, range(POWERS) if Coefficients in get_args(declared) else ())


def _numbers(name: str, values: list[Any], components: Collection[object]) -> Table:
    """Numbers as one column, vectors as one column for each of their parts; NaN for null, whole or in part."""
    if not components:
        return {name: np.array(values, np.float64)}
    nothing = [None] * len(components)
    rows = np.array([nothing if value is None else value for value in values], np.float64)
    return {f"{name}_{part}": column for part, column in zip(components, rows.T, strict=True)}


def _words(values: Sequence[str]) -> Labels:
    names = tuple(dict.fromkeys(values))
    number = {name: code for code, name in enumerate(names)}
    return Labels(np.array([number[value] for value in values], np.int32), names)


def histograms(analysis: Result) -> Table:
    """One row per bin of the histograms of all numbers of vertices."""
    from ..appearance import DEFAULT
    from ..distributions import samples_of
    from .histogram import histogram_table

    return histogram_table(samples_of(analysis, DEFAULT), DEFAULT)


def brief_table(table: Table) -> Table:
    """A table of regions or components without counts of the topology and the parts that few papers show."""
    from ...report.model import Topology

    left_out = {*Topology.__struct_fields__} - {"component"}
    left_out |= {"name"}
    prefixes = ("cmc_", "minimal_", "steiner_", "normals_", "fractions_")
    if not ("region" in table or "component" in table):
        return table
    return {name: each for name, each in table.items() if name not in left_out and not name.startswith(prefixes)}


def chosen_columns(table: Table, names: Sequence[str]) -> Table:
    """The named columns of a table in their order. Errors: UsageError for a name that it does not have."""
    for name in names:
        if name not in table:
            raise UsageError(f"--columns {name}: the table has no such column{suggestion(name, table)}")
    return {name: table[name] for name in names}


HISTOGRAM = "histogram"

TABLES: dict[str, Callable[[Result], Table]] = {
    "vertices": vertex_table,
    "edges": edge_table,
    "faces": face_table,
    "loops": loop_table,
    "regions": region_table,
    "components": component_table,
    "statistics": statistics_table,
    "intersections": intersection_table,
    HISTOGRAM: histograms,
}

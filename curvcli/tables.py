"""The tables of an analysis as named columns, in the order of the interface."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .declare import Element, passes
from .loading.model import Labels

if TYPE_CHECKING:
    from .analysis import Analysis

Table = dict[str, Any]

# Rows that are handed to polars at a time, which copies them; a group of rows in Parquet.
ROWS_IN_A_FRAME = 1 << 18


def vertex_properties(analysis: Analysis) -> Table:
    """The computed vertex columns, vectors by component; masked or NaN where undefined."""
    surface = analysis.surface
    loose = ~surface.referenced
    table: Table = {}
    for name in analysis.chosen:
        quantity = passes.quantity(name)
        if quantity.on != "vertex":
            continue
        if quantity.labels:
            table[name] = Labels(analysis.columns[name], quantity.labels)
            continue
        shown = analysis.column(name)
        if quantity.kind == "count":
            table[name] = np.ma.masked_array(shown, loose) if loose.any() else shown
        else:
            table.update(zip(quantity.columns, shown.T if quantity.vector else [shown], strict=True))
    return table


def vertex_table(analysis: Analysis) -> Table:
    """One row per vertex of the file: index, position, status, then the columns in the order of the theory."""
    surface = analysis.surface
    table: Table = {"vertex": np.arange(surface.n_vertices, dtype=np.int32)}
    xyz = surface.xyz_given
    # Only a vertex that no face uses may have coordinates that are no numbers.
    table |= dict(zip("xyz", xyz if surface.referenced.all() else np.where(np.isfinite(xyz), xyz, np.nan), strict=True))
    computed = vertex_properties(analysis)
    if "status" in computed:
        table["status"] = computed.pop("status")
    welded = surface.file.welded_to if surface.file is not None else None
    if welded is not None:
        table["welded_to"] = np.ma.masked_array(welded, welded < 0)
    return table | computed


def _element_columns(analysis: Analysis, element: Element) -> Table:
    """Every public quantity of edges or faces."""
    table: Table = {}
    for quantity in passes.quantities(element):
        shown = analysis.column(quantity.name)
        table.update(zip(quantity.columns, shown.T if quantity.vector else [shown], strict=True))
    return table


def edge_table(analysis: Analysis) -> Table:
    """One row per edge, by its ends in ascending order: number of faces, then every quantity of edges."""
    edges = analysis.surface.edges
    table: Table = {"edge": np.arange(len(edges), dtype=np.int32)}
    return table | {"a": edges.a, "b": edges.b, "faces": edges.valence} | _element_columns(analysis, "edge")


def face_table(analysis: Analysis) -> Table:
    """One row per triangle: the polygon of the file it came from, its corners, every quantity of faces, its region."""
    surface = analysis.surface
    index = np.arange(surface.n_faces, dtype=np.int32)
    table: Table = {"face": index, "polygon": index if surface.polygon is None else surface.polygon}
    table |= dict(zip("abc", surface.faces.T, strict=True))
    table |= _element_columns(analysis, "face")
    if analysis.regions is not None:
        table["region"] = Labels(analysis.regions.face, analysis.regions.names)
    return table


def component_table(analysis: Analysis) -> Table:
    """One row per component: topology, totals and the rest of the report."""
    from .report.build import pieces

    return _piece_table("component", pieces(analysis, analysis.surface.components))


def region_table(analysis: Analysis) -> Table:
    """One row per region: topology, totals and the rest of the report; no rows without `--regions`."""
    from .report.build import pieces

    return _piece_table("region", pieces(analysis.cut, analysis.cut_groups) if analysis.cut is not None else [])


def loop_table(analysis: Analysis) -> Table:
    """One row per boundary loop."""
    from .curves.loops import loop_table as loops

    return loops(analysis.surface)


def _piece_table(kind: str, pieces: list[Any]) -> Table:
    rows = [_flat(piece) for piece in pieces]
    names: dict[str, None] = {key: None for row in rows for key in row}
    table: Table = {kind: np.arange(len(rows), dtype=np.int32)}
    for name in names:
        table[name] = _column([row.get(name) for row in rows])
    return table


def _flat(piece: Any) -> dict[str, Any]:
    """The values of one piece under the report's last keys; vectors by component."""
    import msgspec

    flat: dict[str, Any] = {}
    for section, value in msgspec.to_builtins(piece).items():
        if not isinstance(value, Mapping):
            flat[section] = value
            continue
        for key, entry in value.items():
            name = key if section in ("topology", "totals") else f"{section}_{key}"
            if isinstance(entry, list):
                suffixes = "xyz" if len(entry) == 3 else [str(power) for power in range(len(entry))]
                flat |= {f"{name}_{suffix}": part for suffix, part in zip(suffixes, entry, strict=True)}
            else:
                flat[name] = entry
    return flat


def _column(values: list[Any]) -> Any:
    known = [value for value in values if value is not None]
    if known and all(isinstance(value, str) for value in known):
        number = {name: code for code, name in enumerate(dict.fromkeys(known))}
        return Labels(np.array([number.get(value, -1) for value in values], np.int32), tuple(number))
    if known and all(isinstance(value, bool) for value in known) and len(known) == len(values):
        return np.array(values, bool)
    if known and all(isinstance(value, int) for value in known):
        filled: NDArray[Any] = np.array([0 if value is None else value for value in values], np.int64)
        return np.ma.masked_array(filled, [value is None for value in values])
    return np.array([np.nan if value is None else value for value in values], np.float64)


TABLES: dict[str, Callable[[Analysis], Table]] = {
    "vertices": vertex_table,
    "edges": edge_table,
    "faces": face_table,
    "loops": loop_table,
    "regions": region_table,
    "components": component_table,
}

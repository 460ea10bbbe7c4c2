"""The tables of an analysis as named columns, in the order of the interface."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from .declare import passes
from .loading.model import Labels

if TYPE_CHECKING:
    from .analysis import Analysis

Table = Mapping[str, Any]


def vertex_properties(analysis: Analysis) -> dict[str, Any]:
    """The computed vertex columns, vectors by component; masked or NaN where undefined."""
    surface = analysis.surface
    loose = ~surface.referenced
    table: dict[str, Any] = {}
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


def vertex_table(analysis: Analysis) -> dict[str, Any]:
    """One row per vertex of the file: index, position, status, then the columns in the order of the theory."""
    surface = analysis.surface
    table: dict[str, Any] = {"vertex": np.arange(surface.n_vertices, dtype=np.int32)}
    table |= dict(zip("xyz", surface.xyz_given, strict=True))
    computed = vertex_properties(analysis)
    if "status" in computed:
        table["status"] = computed.pop("status")
    welded = surface.file.welded_to if surface.file is not None else None
    if welded is not None:
        table["welded_to"] = np.ma.masked_array(welded, welded < 0)
    return table | computed

"""Colours of a mesh: the column that colours it, and the same colours in every output."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..analysis.result import Result
from ..curvatures.quantity import Quantity
from ..curvatures.registry import passes
from ..errors import UsageError
from ..support.words import suggestion

if TYPE_CHECKING:
    from .pictures.colors import ColorScale
    from .pictures.legend import Colored


from .appearance import Appearance
from .distributions import common_scale, sample, vertex_quantities

# Default columns that colour a mesh: the first of these that was computed.
COLOR_BY = ("K_density", "h_signed", "h", "K", "A")


def along_edges() -> dict[str, Quantity]:
    """Numeric columns of edges, each with its quantity."""
    return {column: q for q in passes.quantities("edge") for column in q.columns if not q.vector}


def colored_quantity(name: str, chosen: list[str], option: str = "--color-by") -> Quantity:
    """Quantity whose column colours the mesh or its edges; edge columns are computed with every table of edges."""
    columns = vertex_quantities(chosen)
    along = along_edges()
    if name in along and name not in columns:
        return along[name]
    if name not in columns:
        offered = vertex_quantities([quantity.name for quantity in passes.quantities("vertex")])
        if name in offered:
            raise UsageError(f"{option} {name}: is not computed; -p core,{offered[name].name} adds it")
        way_out = suggestion(name, [*offered, *along], "`curvcli passes` lists them")
        raise UsageError(f"{option} {name}: no such column of vertices{way_out}")
    return columns[name]


def color_needs(name: str, chosen: list[str]) -> set[str]:
    """The quantities that the colours of a column are made from."""
    from .pictures.rounding_floor import floor_needs

    quantity = colored_quantity(name, chosen)
    if quantity.on == "edge":
        return {quantity.name, "theta"}
    return set() if quantity.labels else floor_needs(quantity)


def colored(analysis: Result, name: str, appearance: Appearance) -> Colored:
    """Column with its colours, the same in every output."""
    from .pictures.colors import colorize
    from .pictures.legend import Colored
    from .pictures.rounding_floor import edge_floor

    quantity = colored_quantity(name, analysis.chosen)
    if quantity.on == "edge":
        values, theta = (analysis.edges[key].astype(np.float64) for key in (name, "theta"))
        flat = edge_floor(analysis, theta) if quantity.signed else None
        cmap, value_range = appearance.cmap, appearance.value_range
        scale = colorize(values, cmap=cmap, value_range=value_range, signed=quantity.signed, floor=flat)
        return Colored(name, quantity, scale)
    column = sample(analysis, name, areas=False)
    return Colored(name, quantity, common_scale([column], appearance), column.energy)


def colors(analysis: Result, appearance: Appearance) -> tuple[str, ColorScale] | None:
    """Column that colours the surface, and its colours; None when no column was computed."""
    name = coloring(appearance, analysis.chosen)
    return None if name is None else (name, colored(analysis, name, appearance).scale)


def coloring(appearance: Appearance, chosen: list[str]) -> str | None:
    """The column that colours a mesh."""
    asked = (name for name in appearance.color_by if name in vertex_quantities(chosen))
    return next(asked, next((name for name in COLOR_BY if name in chosen), None))

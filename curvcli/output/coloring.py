"""Colours of a mesh: the column that colours it, and the same colours in every output."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..analysis.result import Result
from ..curvatures.quantity import Quantity
from ..curvatures.registry import passes
from ..errors import UsageError
from ..support.arrays import Index
from ..support.words import suggestion

if TYPE_CHECKING:
    from .pictures.colors import ColorScale
    from .pictures.legend import Colored


from .appearance import REGION, Appearance
from .distributions import common_scale, sample, vertex_quantities

_REGION = Quantity(REGION, kind="label", description="label of --regions")

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
    if name == REGION and option == "--color-by":
        return _REGION
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
    return set() if quantity.labels or quantity is _REGION else floor_needs(quantity)


def colored(analysis: Result, name: str, appearance: Appearance) -> Colored:
    """Column with its colours, the same in every output."""
    from .pictures.colors import categorize, colorize
    from .pictures.legend import Colored
    from .pictures.rounding_floor import edge_floor

    quantity = colored_quantity(name, analysis.chosen)
    if quantity is _REGION:
        names, codes, rgb = _vertex_regions(analysis)
        return Colored(name, replace(quantity, labels=names), categorize(codes, names, rgb))
    if quantity.on == "edge":
        values, theta = (analysis.edges[key].astype(np.float64) for key in (name, "theta"))
        flat = edge_floor(analysis, theta) if quantity.signed else None
        cmap, value_range = appearance.cmap, appearance.range_of(name)
        scale = colorize(values, cmap=cmap, value_range=value_range, signed=quantity.signed, floor=flat)
        return Colored(name, quantity, scale)
    column = sample(analysis, name, areas=False)
    return Colored(name, quantity, common_scale([column], appearance), column.energy)


def _vertex_regions(analysis: Result) -> tuple[tuple[str, ...], Index, NDArray[np.uint8] | None]:
    """Names of the regions, the region (V,) of most faces at each vertex, and the colours of their table, if any.

    Of several regions with equally many faces, the last; -1 for none. Errors: UsageError without --regions.
    """
    regions, surface = analysis.regions, analysis.surface
    if regions is None:
        raise UsageError("--color-by region: there are none without --regions")
    label = np.repeat(regions.face.astype(np.int64), 3)
    at = surface.faces.reshape(-1)[label >= 0] * np.int64(regions.count) + label[label >= 0]
    pair, faces = np.unique(at, return_counts=True)
    pair = pair[np.argsort(faces, kind="stable")]
    codes = np.full(surface.n_vertices, -1, np.int32)
    codes[pair // regions.count] = pair % regions.count
    return regions.names, codes, regions.colors


def colors(analysis: Result, appearance: Appearance) -> tuple[str, ColorScale] | None:
    """Column that colours the surface, and its colours; None when no column was computed."""
    name = coloring(appearance, analysis.chosen)
    return None if name is None else (name, colored(analysis, name, appearance).scale)


def coloring(appearance: Appearance, chosen: list[str]) -> str | None:
    """The column that colours a mesh."""
    asked = (name for name in appearance.color_by if name in vertex_quantities(chosen) or name == REGION)
    return next(asked, next((name for name in COLOR_BY if name in chosen), None))

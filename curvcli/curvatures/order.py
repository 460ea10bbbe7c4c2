"""Order of columns and totals in all tables, reports and pages, independent of the order of imports."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TypeVar

_Item = TypeVar("_Item")

VERTICES = (
    *("status", "degree", "K", "kappa_g", "K_comb", "K_plus", "K_minus", "K_abs", "A", "A_mixed", "A_voronoi", "A_vec"),
    *("H_vec", "area_gradient", "h", "h_signed", "h_hks", "h_perp", "h_normal", "K_density", "kappa_1", "kappa_2"),
    *("kappa_max", "dir_1", "dir_2", "shape_index", "curvedness", "willmore", "willmore_hks", "willmore_perp"),
    *("willmore_normal", "willmore_conformal", "helfrich", "K_ring", "h_ring", "kappa_1_ring", "kappa_2_ring"),
    *("K_corrected", "h_corrected"),
    *("kappa_1_corrected", "kappa_2_corrected", "dir_1_corrected", "dir_2_corrected", "K_fit", "h_fit", "kappa_1_fit"),
    *("kappa_2_fit", "dir_1_fit", "dir_2_fit", "condition_fit", "shape_index_ring", "curvedness_ring"),
    *("shape_index_corrected", "curvedness_corrected", "shape_index_fit", "curvedness_fit"),
    *("willmore_ring", "willmore_corrected", "willmore_fit", "K_sigma", "h_sigma"),
)
EDGES = ("edge_length", "theta", "edge_H_vec", "H_sin", "H_theta", "H_tan", "kappa_across", "beta")
FACES = ("area_of_face", "normal", "dirichlet")
COLUMNS = (*VERTICES, *EDGES, *FACES)

# Keys of the report; `volume` has no column.
TOTALS = (
    *("area", "volume", "K", "kappa_g", "A_vec", "H_vec", "H_sin", "H_theta", "H_tan", "K_plus", "K_minus", "K_abs"),
    *("willmore", "willmore_hks", "willmore_perp", "willmore_normal", "willmore_conformal", "dirichlet"),
    *("helfrich", "willmore_ring", "willmore_corrected", "willmore_fit"),
)


# The position of each name in its order.
COLUMN_PLACES, TOTAL_PLACES = ({name: place for place, name in enumerate(order)} for order in (COLUMNS, TOTALS))


def ordered(
    items: Iterable[_Item], name: Callable[[_Item], str], places: Mapping[str, int] = COLUMN_PLACES
) -> list[_Item]:
    """Sort items by the positions of their names; items without a position follow in their own order."""
    return sorted(items, key=lambda item: places.get(name(item), len(places)))

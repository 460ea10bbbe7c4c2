"""From the names asked for to the columns: what must run, in which order, and what can be let go."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from graphlib import TopologicalSorter
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .declare import CELL_AREA, CELL_AREAS, SURFACE, Pass, Quantity, passes
from .errors import UsageError

if TYPE_CHECKING:
    from .surface import Surface

Array = NDArray[Any]

CORE = (
    ["status", "degree", "K", "kappa_g", "A", "A_vec", "H_vec", "h", "h_signed", "K_density", "kappa_1", "kappa_2", "willmore", "willmore_hks"]
)  # the default preset, interface.md's order


def resolve(names: Iterable[str]) -> list[str]:
    """Quantity names for what a user asked for: names, stems of vectors, comma lists and presets, in registry order.

    Errors: UsageError for an unknown name, with the nearest ones.
    """
    _load()
    public = {quantity.name: quantity for quantity in passes.quantities()}
    presets = {
        "topology": ["status", "degree"],
        "core": CORE,
        "paper": [q.name for q in public.values() if q.source.startswith("Sullivan")],
        "all": list(public),
    }
    stems = {column: quantity.name for quantity in public.values() for column in quantity.columns}
    wanted: set[str] = set()
    for name in (part.strip() for entry in names for part in entry.split(",")):
        if name in presets:
            wanted.update(presets[name])
        elif name in public or name in stems:
            wanted.add(stems.get(name, name))
        else:
            near = get_close_matches(name, [*presets, *public], 3, 0.4) or ["`curvcli passes` lists them"]
            raise UsageError(f"unknown pass {name!r}; nearest: {', '.join(near)}")
    return [name for name in public if name in wanted]


def evaluate(
    surface: Surface, names: Iterable[str], *, area: str = "barycentric", known: Mapping[str, Array] | None = None
) -> dict[str, Array]:
    """Compute the named quantities and only what they need; every pass runs once, intermediates are let go.

    area: which cell area `K_density` and what follows from it use. known: columns that need not be computed again.
    Arrays are frozen, in the surface's `unit` and the sum convention of H.
    """
    _load()
    have: dict[str, Array] = dict(known or {})
    keep = {*names, *have}

    def needs(one: Pass) -> list[str]:
        return [CELL_AREAS[area] if need == CELL_AREA else need for need in one.needs if need != SURFACE]

    graph: dict[str, set[str]] = {}
    todo = [name for name in keep if name not in have]
    while todo:
        one = passes.provider(todo.pop())
        if one.name not in graph:
            missing = [need for need in needs(one) if need not in have]
            graph[one.name] = {passes.provider(need).name for need in missing}
            todo += missing
    order = list(TopologicalSorter(graph).static_order())
    uses = Counter(need for name in order for need in needs(passes[name]))
    for name in order:
        one = passes[name]
        required = iter(needs(one))
        found = one.compute(*(surface if need == SURFACE else have[next(required)] for need in one.needs))
        for quantity, array in zip(one.provides, found if len(one.provides) > 1 else (found,), strict=True):
            array.setflags(write=False)
            have[quantity.name] = array
        for need in [*needs(one), *(quantity.name for quantity in one.provides)]:
            uses[need] -= need in needs(one)
            if uses[need] <= 0 and need not in keep:
                have.pop(need, None)
    return have


def presented(quantity: Quantity, array: Array, unit: float, mean: str = "sum") -> Array:
    """A column as a user sees it: in the file's unit of length and the chosen convention for H, vectors as (n, 3)."""
    factor = unit**quantity.length_exponent if quantity.length_exponent and unit != 1.0 else 1.0
    if mean == "average":
        factor *= 0.5**quantity.mean_degree
    if factor != 1.0:
        with np.errstate(over="ignore"):
            array = array * factor
        array[np.isinf(array)] = np.nan
        array.setflags(write=False)
    return array.T if quantity.vector else array


def _load() -> None:
    """Import the built-in passes and the plug-ins of entry-point group `curvcli.passes`, once."""
    from . import passes as built_in  # noqa: F401  (importing registers)

"""From the names asked for to the columns: what must run, in which order, and what can be let go."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence, Set
from dataclasses import replace
from functools import cache
from graphlib import TopologicalSorter
from itertools import groupby
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .declare import AT_SCALE, CELL_AREA, CELL_AREAS, MASKS, NO_QUANTITIES, SURFACE, Pass, Quantity, passes
from .errors import UsageError
from .nearest import suggestion
from .neighbourhoods import forget
from .settings import DEFAULTS, Settings
from .sheets import on_single_fans, sheets
from .slices import slices
from .threads import for_each

if TYPE_CHECKING:
    from .surface import Surface

Array = NDArray[Any]

# The default preset, in the order of the table.
CORE = (
    *("status", "degree", "K", "kappa_g", "A", "A_vec", "H_vec", "h", "h_signed", "K_density"),
    *("kappa_1", "kappa_2", "willmore", "willmore_hks"),
)


# Passes that look at one vertex at a time have so many of them at once.
_VERTICES = 1 << 16

# What noise of the coordinates makes of K and h.
UNCERTAINTIES = ("K_sigma", "h_sigma")


def defaults(scaled: bool, noisy: bool) -> tuple[str, ...]:
    """What is computed where nothing is named: core, estimates where a scale is asked for, uncertainties with noise."""
    return ("core", *(("estimates",) if scaled else ()), *(UNCERTAINTIES if noisy else ()))


def presets() -> dict[str, Sequence[str]]:
    """The quantities that each preset stands for."""
    load_passes()
    public = passes.quantities()
    return {
        "topology": ["status", "degree"],
        "core": CORE,
        "paper": [q.name for q in public if q.source.startswith("Sullivan")],
        "estimates": [q.name for q in public if _estimates(q)],
        "all": [q.name for q in public],
    }


def _estimates(quantity: Quantity) -> bool:
    """Whether it is a curvature, a shape index or an energy at a scale; directions and conditions are none."""
    return (quantity.kind in ("density", "measure") or quantity.signed) and passes.depends_on_scale(quantity.name)


def resolve(names: Iterable[str]) -> list[str]:
    """Quantity names for what a user asked for: names, stems of vectors, comma lists and presets, in table order.

    Errors: UsageError for an unknown name, with the nearest ones.
    """
    named = presets()
    public = {quantity.name: quantity for quantity in passes.quantities()}
    stems = {column: q.name for q in reversed(public.values()) for column in (q.stem, *q.columns)}
    wanted: set[str] = set()
    for name in (part.strip() for entry in names for part in entry.split(",")):
        if name in named:
            wanted.update(named[name])
        elif name in public or name in stems:
            wanted.add(stems.get(name, name))
        else:
            way_out = suggestion(name, [*named, *public], "`curvcli passes` lists them")
            raise UsageError(f"unknown pass {name!r}{way_out}")
    return [name for name in public if name in wanted]


def needs(one: Pass, area: str) -> list[str]:
    """The quantities a pass needs, the chosen cell area under its own name."""
    return [CELL_AREAS[area] if need == CELL_AREA else need for need in one.needs if need not in NO_QUANTITIES]


def arguments(
    one: Pass, surface: Surface, have: Mapping[str, Array], area: str = "barycentric", settings: Settings = DEFAULTS
) -> list[Any]:
    """What a pass is called with."""
    columns = iter(needs(one, area))

    def answer(need: str) -> Any:
        if need not in NO_QUANTITIES:
            return have[next(columns)]
        return surface if need == SURFACE else getattr(surface if need in MASKS else settings, need)

    return [answer(need) for need in one.needs]


def schedule(names: Iterable[str], area: str, have: Set[str] = frozenset()) -> list[Pass]:
    """The passes that must run for the named quantities, each after what it needs."""
    load_passes()
    graph: dict[str, set[str]] = {}
    todo = list(names)
    while todo:
        one = passes.provider(todo.pop())
        if one.name not in graph:
            missing = [need for need in needs(one, area) if need not in have]
            graph[one.name] = {passes.provider(need).name for need in missing}
            todo += missing
    sorter = TopologicalSorter(graph)
    sorter.prepare()
    order: list[Pass] = []
    ready: list[Pass] = []
    while sorter.is_active():
        ready += map(passes.__getitem__, sorter.get_ready())
        ready.sort(key=lambda one: one.pointwise)  # last, so that they come together
        order.append(ready.pop(0))
        sorter.done(order[-1].name)
    return order


def at_scales(names: Iterable[str], settings: Settings) -> list[str]:
    """The names, those that depend on the scale once for each where there are several: `K_ring@2e`."""
    load_passes()
    if len(settings.scales) == 1:
        return list(names)
    each = [AT_SCALE + scale.name for scale in settings.scales]
    return [name + scale for name in names for scale in (each if passes.depends_on_scale(name) else [""])]


def prepare(surface: Surface, names: Iterable[str], area: str = "barycentric") -> None:
    """Work out the topology, and let go of the edges unless one of the named quantities comes by way of edges."""
    order = schedule((name.partition(AT_SCALE)[0] for name in names), area)
    if any(quantity.on == "edge" for one in order for quantity in one.provides):
        surface.work_out_topology()
    else:
        surface.let_go_of_edges()


def evaluate(
    surface: Surface,
    names: Iterable[str],
    *,
    area: str = "barycentric",
    settings: Settings = DEFAULTS,
    known: Mapping[str, Array] | None = None,
) -> dict[str, Array]:
    """Compute the named quantities and only what they need; every pass runs once, intermediates are let go.

    area: which cell area `K_density` and what follows from it use. settings: what estimators are told; names that
    depend on the scale may say which, `NAME@SCALE`. known: columns that need not be computed again.
    Arrays are frozen, in the unit of computation and the sum convention of H.
    """
    load_passes()
    have = dict(known or {})
    wanted = {name for name in names if name not in have}
    around = {name for name in wanted if passes.looks_around(name)}
    if around and not surface.is_manifold:
        have |= on_single_fans(surface, evaluate(sheets(surface), around, area=area, settings=settings))
        wanted -= around
    plain = {name for name in wanted if AT_SCALE not in name}
    have |= _evaluate(surface, plain | _shared(wanted - plain, area), area, settings, have)
    for scale in settings.scales:
        suffix = AT_SCALE + scale.name
        here = {name.removesuffix(suffix) for name in wanted if name.endswith(suffix)}
        if here:
            same = {k: column for k, column in have.items() if AT_SCALE not in k and not passes.depends_on_scale(k)}
            found = _evaluate(surface, here, area, replace(settings, scales=(scale,)), same)
            have |= {name + suffix: found[name] for name in here}
    forget(surface)
    return have


def _shared(names: Iterable[str], area: str) -> set[str]:
    """What several scales have in common of the way to the names at them."""
    order = schedule((name.partition(AT_SCALE)[0] for name in names), area)
    scaled = [one for one in order if passes.depends_on_scale(one.provides[0].name)]
    return {need for one in scaled for need in needs(one, area) if not passes.depends_on_scale(need)}


def _evaluate(
    surface: Surface, names: Iterable[str], area: str, settings: Settings, known: Mapping[str, Array]
) -> dict[str, Array]:
    """The known columns and the named ones, at one scale."""
    load_passes()
    have: dict[str, Array] = dict(known)
    keep = {*names, *have}

    order = schedule([name for name in keep if name not in have], area, set(have))
    uses = Counter(need for one in order for need in needs(one, area))
    for _, group in groupby(order, key=lambda one: one.pointwise or one.name):
        run = list(group)
        if run[0].pointwise:
            found = _at_vertices(run, surface, have, area)
        else:
            found = _named(run[0], arguments(run[0], surface, have, area, settings))
        for array in found.values():
            array.setflags(write=False)
        have |= found
        for one in run:
            for need in [*needs(one, area), *(quantity.name for quantity in one.provides)]:
                uses[need] -= need in needs(one, area)
                if uses[need] <= 0 and need not in keep:
                    have.pop(need, None)
    return have


def _named(one: Pass, given: Iterable[Any]) -> dict[str, Array]:
    """What a pass provides, by name."""
    found = one.compute(*given)
    names = [quantity.name for quantity in one.provides]
    return dict(zip(names, found if len(names) > 1 else (found,), strict=True))


def _at_vertices(run: Sequence[Pass], surface: Surface, have: Mapping[str, Array], area: str) -> dict[str, Array]:
    """What passes provide that look at one vertex at a time, in blocks of vertices and two threads.

    What one pass finds is still in the cache when the next one needs it.
    """
    n = surface.n_vertices
    columns = {
        quantity.name: np.empty((3, n) if quantity.vector else n, bool if quantity.kind == "flag" else np.float64)
        for one in run
        for quantity in one.provides
    }
    given = {name: have[name] for one in run for name in needs(one, area) if name not in columns}
    masks = {name: getattr(surface, name) for one in run for name in one.needs if name in MASKS}

    def fill(block: slice) -> None:
        here = {name: column[..., block] for name, column in given.items()}
        some: Any = SimpleNamespace(**{name: mask[block] for name, mask in masks.items()})
        for one in run:
            found = _named(one, arguments(one, some, here, area))
            for name, part in found.items():
                columns[name][..., block] = part
            here |= found

    for_each(slices(n, _VERTICES), fill)
    return columns


def presented(quantity: Quantity, array: Array, surface: Surface, mean: str = "sum") -> Array:
    """A column as a user sees it: in the file's unit of length and the chosen convention for H, codes as words.

    Vectors come out as (n, 3).
    """
    if quantity.labels:
        array = np.array(quantity.labels)[array]
    if quantity.length_exponent:
        array = surface.in_file_unit(array, quantity.length_exponent)
    if mean == "average" and quantity.mean_degree:
        array = array * 0.5**quantity.mean_degree
    array.setflags(write=False)
    return array.T if quantity.vector else array


@cache
def load_passes() -> None:
    """Import the built-in passes and the plug-ins of the entry-point group `curvcli.passes`, once.

    Errors: UsageError for a plug-in that cannot be imported or whose declaration does not fit.
    """
    from importlib.metadata import entry_points

    from . import curvatures  # noqa: F401  (importing registers)

    for plug_in in entry_points(group="curvcli.passes"):
        try:
            plug_in.load()
        except Exception as error:
            where = f"plug-in {plug_in.name} ({plug_in.value})"
            raise UsageError(f"{where} cannot be loaded: {type(error).__name__}: {error}") from error

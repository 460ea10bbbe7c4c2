"""Engine: schedule of passes, and evaluation in order."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence, Set
from dataclasses import replace
from graphlib import TopologicalSorter
from itertools import groupby
from types import SimpleNamespace
from typing import Any

import numpy as np

from ..mesh.neighbourhoods import clear_cache
from ..mesh.scale import DEFAULTS, EstimatorSettings
from ..mesh.sheets import on_single_fans, sheets
from ..mesh.surface import Surface
from ..support.arrays import Array
from ..support.blocks import for_each, slices
from .quantity import (
    AT_SCALE,
    CELL_AREA,
    CELL_AREAS,
    MASKS,
    NO_QUANTITIES,
    SURFACE,
    Configurable,
    Provider,
    Quantity,
    Step,
)

# Block size of pointwise passes.
_VERTICES = 1 << 16


def needs(step: Step, area: str) -> list[str]:
    """The quantities that a pass needs, with the name of the chosen cell area for `cell_area`."""
    return [CELL_AREAS[area] if need == CELL_AREA else need for need in step.needs if need not in NO_QUANTITIES]


def arguments(
    step: Step,
    surface: Surface,
    have: Mapping[str, Array],
    area: str = "barycentric",
    settings: EstimatorSettings = DEFAULTS,
) -> list[Any]:
    """The arguments of a pass, in the order of its needs.

    have: the columns computed so far, (n,) or (3, n) each. area: of `cell_area`.
    """
    columns = iter(needs(step, area))

    def answer(need: str) -> Any:
        if need not in NO_QUANTITIES:
            return have[next(columns)]
        return surface if need == SURFACE else getattr(surface if need in MASKS else settings, need)

    return [answer(need) for need in step.needs]


def values_of(step: Configurable, surface: Surface, settings: EstimatorSettings = DEFAULTS) -> dict[str, Any]:
    """The values of the parameters of a pass or a derived total by name, in the unit of computation."""
    values = {each.name: settings.values.get(each.key(step.name), each.default) for each in step.settings}
    if surface.unit_exponent:
        for each in step.settings:
            if each.length_exponent:
                with np.errstate(over="ignore", under="ignore"):
                    scaled = np.ldexp(values[each.name], -each.length_exponent * surface.unit_exponent)
                values[each.name] = scaled if np.ndim(scaled) else float(scaled)
    return values


def parts_of_faces(
    step: Step, surface: Surface, have: Mapping[str, Array], area: str, settings: EstimatorSettings
) -> tuple[Array, Array]:
    """(F,) parts of the faces in a measure that its pass splits, and the sizes of their terms."""
    assert step.of_faces is not None
    return step.of_faces(*arguments(step, surface, have, area, settings), **values_of(step, surface, settings))


def schedule(passes: Provider, names: Iterable[str], area: str, have: Set[str] = frozenset()) -> list[Step]:
    """Order the passes for the named quantities so that each comes after its needs."""
    graph: dict[str, set[str]] = {}
    steps: dict[str, Step] = {}
    todo = list(names)
    while todo:
        step = passes.provider(todo.pop())
        if step.name not in graph:
            steps[step.name] = step
            missing = [need for need in needs(step, area) if need not in have]
            graph[step.name] = {passes.provider(need).name for need in missing}
            todo += missing
    sorter = TopologicalSorter(graph)
    sorter.prepare()
    order: list[Step] = []
    ready: list[Step] = []
    while sorter.is_active():
        ready += map(steps.__getitem__, sorter.get_ready())
        ready.sort(key=lambda step: step.pointwise)  # last, to run them together
        order.append(ready.pop(0))
        sorter.done(order[-1].name)
    return order


def prepare(passes: Provider, surface: Surface, names: Iterable[str], area: str = "barycentric") -> None:
    """Compute the topology, and release the edges unless a named quantity needs them."""
    order = schedule(passes, (name.partition(AT_SCALE)[0] for name in names), area)
    if any(quantity.on == "edge" for step in order for quantity in step.provides):
        surface.compute_topology()
    else:
        surface.release_edges()


def evaluate(
    passes: Provider,
    surface: Surface,
    names: Iterable[str],
    *,
    area: str = "barycentric",
    settings: EstimatorSettings = DEFAULTS,
    known: Mapping[str, Array] | None = None,
) -> dict[str, Array]:
    """Compute the named quantities; every pass on the way to them runs once, and only the named columns are kept.

    area: the cell area of `K_density` and its dependents. settings: scales, normals and noise of estimators; names
    that depend on the scale may include it, `NAME@SCALE`. known: columns computed before.
    Arrays are frozen, in the unit of computation and the sum convention of H.
    """
    have = dict(known or {})
    asked = [*have, *names]
    wanted = {name for name in asked if name not in have}
    around = {name for name in wanted if passes.looks_around(name)}
    if around and not surface.is_manifold:
        have |= on_single_fans(surface, evaluate(passes, sheets(surface), around, area=area, settings=settings))
        wanted -= around
    unscaled = {name for name in wanted if AT_SCALE not in name}
    have |= _evaluate(passes, surface, unscaled | _shared(passes, wanted - unscaled, area), area, settings, have)
    for scale in settings.scales:
        suffix = AT_SCALE + scale.name
        scaled_names = {name.removesuffix(suffix) for name in wanted if name.endswith(suffix)}
        if scaled_names:
            same = {k: column for k, column in have.items() if AT_SCALE not in k and not passes.depends_on_scale(k)}
            scaled = _evaluate(passes, surface, scaled_names, area, replace(settings, scales=(scale,)), same)
            have |= {name + suffix: scaled[name] for name in scaled_names}
    clear_cache(surface)
    return {name: have[name] for name in asked}


def _shared(passes: Provider, names: Iterable[str], area: str) -> set[str]:
    """The quantities that several scales share on the way to the named ones."""
    order = schedule(passes, (name.partition(AT_SCALE)[0] for name in names), area)
    scaled = [step for step in order if passes.depends_on_scale(step.provides[0].name)]
    return {need for step in scaled for need in needs(step, area) if not passes.depends_on_scale(need)}


def _evaluate(
    passes: Provider,
    surface: Surface,
    names: Iterable[str],
    area: str,
    settings: EstimatorSettings,
    known: Mapping[str, Array],
) -> dict[str, Array]:
    """The known columns, the named ones and those on the way to them, at one scale."""
    have: dict[str, Array] = dict(known)
    order = schedule(passes, [name for name in names if name not in have], area, set(have))
    for _, group in groupby(order, key=lambda step: step.pointwise or step.name):
        run = list(group)
        if run[0].pointwise:
            columns = _at_vertices(run, surface, have, area, settings)
        else:
            given = arguments(run[0], surface, have, area, settings)
            columns = _named(run[0], given, values_of(run[0], surface, settings))
        for array in columns.values():
            array.setflags(write=False)
        have |= columns
    return have


def _named(step: Step, given: Iterable[Any], values: Mapping[str, Any]) -> dict[str, Array]:
    """The results of a pass, by name."""
    result = step.compute(*given, **values)
    names = [quantity.name for quantity in step.provides]
    return dict(zip(names, result if len(names) > 1 else (result,), strict=True))


def _at_vertices(
    run: Sequence[Step], surface: Surface, have: Mapping[str, Array], area: str, settings: EstimatorSettings
) -> dict[str, Array]:
    """Run pointwise passes in blocks of vertices, in two threads.

    The results of one pass are still in the cache for the next.
    """
    n = surface.n_vertices
    columns = {
        quantity.name: np.empty((3, n) if quantity.vector else n, bool if quantity.kind == "flag" else np.float64)
        for step in run
        for quantity in step.provides
    }
    given = {name: have[name] for step in run for name in needs(step, area) if name not in columns}
    masks = {name: getattr(surface, name) for step in run for name in step.needs if name in MASKS}
    values = {step.name: values_of(step, surface, settings) for step in run}

    def fill(block: slice) -> None:
        block_columns = {name: column[..., block] for name, column in given.items()}
        some: Any = SimpleNamespace(**{name: mask[block] for name, mask in masks.items()})
        for step in run:
            results = _named(step, arguments(step, some, block_columns, area), values[step.name])
            for name, part in results.items():
                columns[name][..., block] = part
            block_columns |= results

    for_each(slices(n, _VERTICES), fill)
    return columns


def in_file_unit(quantity: Quantity, array: Array, surface: Surface, mean: str = "sum", rigidity: float = 1.0) -> Array:
    """Convert a column to the file's unit of length and the chosen convention for H, with codes as words.

    rigidity: the bending rigidity, which energies are multiplied by. Returns vectors as (n, 3).
    """
    if quantity.labels:
        array = np.array(quantity.labels)[array]
    if quantity.length_exponent:
        array = surface.in_file_unit(array, quantity.length_exponent)
    if mean == "average" and quantity.mean_degree:
        array = array * 0.5**quantity.mean_degree
    if quantity.energy and rigidity != 1:
        array = array * rigidity
    array.setflags(write=False)
    return array.T if quantity.vector else array

"""Integrals over the whole surface and its groups."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ..curvatures.derived import DerivedTotal, compute_derived
from ..curvatures.quantity import AT_SCALE, Quantity
from ..curvatures.registry import passes
from ..mesh.counts import classify, count_groups
from ..mesh.enclosed_volume import volumes
from ..mesh.groups import Groups, Segments
from ..mesh.scale import DEFAULTS, EstimatorSettings
from ..mesh.surface import Surface
from ..support.arrays import Floats
from .by_region import is_odd


def totals(
    surface: Surface,
    groups: Groups,
    columns: Mapping[str, Any],
    mean: str = "sum",
    rigidity: float = 1.0,
    derived: Collection[DerivedTotal] = (),
    settings: EstimatorSettings = DEFAULTS,
) -> dict[str, Floats]:
    """Every total that the given columns provide, (G,) or (G, 3), in the file's unit and the chosen convention for H.

    Totals that are odd under reversal of the orientation are NaN on groups without one; nulls in a column are left out.
    rigidity: the bending rigidity, which energies are multiplied by. derived: totals that follow from others.
    """
    totals_by_key: dict[str, Floats] = {}
    known: dict[str, Floats] = {}
    for key, total, length_exponent, mean_degree, energy in _computed(surface, groups, columns, settings):
        known[key] = total
        shown = surface.in_file_unit(total, length_exponent)
        shown = shown * 0.5**mean_degree if mean == "average" else shown
        totals_by_key[key] = shown * rigidity if energy else shown
    if derived:
        counts = count_groups(surface, groups)
        closed = counts.closed & counts.orientable & (classify(surface, groups).components == 1)
        for each, total in compute_derived(derived, surface, known, closed, settings):
            shown = surface.in_file_unit(total, each.length_exponent)
            totals_by_key[each.name] = shown * rigidity if each.energy else shown
    return totals_by_key


def overflow_counts(surface: Surface, columns: Mapping[str, Any], chosen: Iterable[str]) -> Counter[str]:
    """Number of values of each chosen column and total that are beyond the range of doubles in the file's unit."""
    counts: Counter[str] = Counter()
    if surface.unit_exponent:
        for quantity in map(passes.quantity, chosen):
            if not quantity.labels:
                counts[quantity.stem] += overflows(surface, columns[quantity.name], quantity.length_exponent)
        for key, total, length_exponent, _, _ in _computed(surface, surface.whole, columns):
            counts[key] += overflows(surface, total, length_exponent) > 0
    return counts


def overflows(surface: Surface, values: Floats, length_exponent: int) -> int:
    """Number of values that are defined but beyond the range of doubles in the file's unit."""
    if not surface.unit_exponent * length_exponent:
        return 0
    return int(np.count_nonzero(np.isnan(surface.in_file_unit(values, length_exponent)) & ~np.isnan(values)))


def _computed(
    surface: Surface, groups: Groups, columns: Mapping[str, Any], settings: EstimatorSettings = DEFAULTS
) -> Iterator[tuple[str, Floats, int, int, bool]]:
    """Key, values in the unit of computation, length exponent, degree in H and kind (energy or not) of every total."""
    orientable = count_groups(surface, groups).orientable
    for quantity in summed(columns, settings):
        total = _sum(groups.of(surface, quantity.on), quantity, columns[quantity.name])
        if quantity.parity == "odd":
            total = np.where(orientable if total.ndim == 1 else orientable[:, None], total, np.nan)
        if total.ndim == 1 and passes.depends_on_scale(quantity.name.partition(AT_SCALE)[0]):
            known = groups.of(surface, quantity.on).count_true(~np.isnan(columns[quantity.name]))
            total = np.where(known > 0, total, np.nan)  # no estimate anywhere is no energy of 0
        yield str(quantity.total), total, quantity.length_exponent, quantity.mean_degree, quantity.energy
        if quantity.total == "area":
            yield "volume", volumes(surface, groups), 3, 0, False


def summed(names: Collection[str], settings: EstimatorSettings = DEFAULTS) -> list[Quantity]:
    """Named quantities that have a total, in the order of the report; of several scales, each its own.

    A quantity is odd here if one of its settings changes sign with the orientation and is not 0.
    """
    at: dict[str, list[str]] = {}
    for name in names:
        at.setdefault(name.partition(AT_SCALE)[0], []).append(name)
    named = [passes.quantity(name) for quantity in passes.totals() for name in at.get(quantity.name, ())]
    return [replace(quantity, parity="odd") if is_odd(quantity.name, settings) else quantity for quantity in named]


def columns_for(derived: Iterable[DerivedTotal]) -> list[str]:
    """Quantities whose totals the derived ones need."""
    needs = {need for each in derived for need in each.needs}
    return [quantity.name for quantity in passes.totals() if quantity.total in needs]


def _sum(segments: Segments, quantity: Quantity, column: Any) -> Floats:
    return np.stack([segments.sum(x) for x in column], axis=1) if quantity.vector else segments.sum(column)

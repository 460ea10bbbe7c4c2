"""DerivedTotal: a number of a closed component that is computed from its totals."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from ..mesh.surface import Surface
from ..support.arrays import Floats, Mask
from .engine import values_of
from .quantity import Parity
from .setting import Setting, split_signature


@dataclass(frozen=True)
class DerivedTotal:
    """Declaration of a total that follows from others; null on pieces that are not one closed oriented component.

    name: its key in the report. compute: from the totals it needs, (G,) each in the unit of computation with
    H = κ₁ + κ₂, and its settings. needs: keys of totals. beside: the column with which it is computed; where that is
    empty, a value of one of its settings asks for it. length_exponent, parity, energy, settings: as of a `Quantity`
    and a `Pass`.
    """

    name: str
    compute: Callable[..., Floats]
    needs: tuple[str, ...]
    symbol: str
    formula: str
    source: str
    description: str
    length_exponent: int = 0
    parity: Parity = "even"
    energy: bool = False
    beside: str = ""
    settings: tuple[Setting, ...] = ()

    def __reduce__(self) -> tuple[Callable[[str, str], DerivedTotal], tuple[str, str]]:
        """Pickle a derived total by its name."""
        return _derived_total_of, (self.compute.__module__, self.name)


def _derived_total_of(module: str, name: str) -> DerivedTotal:
    import_module(module)
    return derived[name]


derived: dict[str, DerivedTotal] = {}
"""All derived totals by name, in the order of the report."""


def derived_total(
    *, settings: Mapping[str, Setting] | None = None, **declaration: Any
) -> Callable[[Callable[..., Floats]], DerivedTotal]:
    """Register a function of totals as a derived total; its parameters are keys of totals, or settings."""

    def register(function: Callable[..., Floats]) -> DerivedTotal:
        needs, described = split_signature(function, settings or {})
        text = inspect.cleandoc(function.__doc__ or "")
        new = DerivedTotal(function.__name__, function, needs, description=text, settings=described, **declaration)
        derived[new.name] = new
        return new

    return register


def derived_for(chosen: Collection[str], values: Iterable[str]) -> list[DerivedTotal]:
    """Derived totals of an analysis, each after those that it needs. values: names of the settings given."""
    owners = {name.partition(".")[0] for name in values}
    names = {name for name, each in derived.items() if name in owners or each.beside in chosen}
    for each in reversed(derived.values()):
        if each.name in names:
            names.update(need for need in each.needs if need in derived)
    return [each for name, each in derived.items() if name in names]


def compute_derived(
    chosen: Iterable[DerivedTotal], surface: Surface, known: Mapping[str, Floats], closed: Mask, settings: Any
) -> Iterator[tuple[DerivedTotal, Floats]]:
    """The chosen derived totals from the known totals, null where a piece is not one closed oriented component."""
    totals = dict(known)
    for each in chosen:
        with np.errstate(all="ignore"):
            total = each.compute(*(totals[need] for need in each.needs), **values_of(each, surface, settings))
        totals[each.name] = np.where(closed & np.isfinite(total), total, np.nan)
        yield each, totals[each.name]

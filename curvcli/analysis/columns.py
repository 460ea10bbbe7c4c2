"""Columns of one element of an analysis, by name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Protocol

from ..curvatures.quantity import Element, Quantity
from ..curvatures.registry import passes
from ..support.arrays import Array


class Holder(Protocol):
    """An object that has columns: see `Result`."""

    chosen: list[str]

    def shown(self, name: str) -> Array: ...


def named(analysis: Holder, element: Element) -> dict[str, tuple[Quantity, int | None]]:
    """Quantity of each column of an element that an analysis has, and the component for a column of a vector."""
    columns: dict[str, tuple[Quantity, int | None]] = {}
    names = analysis.chosen if element == "vertex" else [quantity.name for quantity in passes.quantities(element)]
    for quantity in map(passes.quantity, names):
        if quantity.on == element:
            columns[quantity.stem] = (quantity, None)
            if quantity.vector:
                columns |= {column: (quantity, k) for k, column in enumerate(quantity.columns)}
    return columns


class Columns(Mapping[str, Array]):
    """Columns of one element by name, read-only; vectors by their stem as (n, 3) and by their components.

    Vertex columns are those of the chosen passes; edge and face columns are complete, computed on first use.
    """

    def __init__(self, analysis: Holder, quantities: Mapping[str, tuple[Quantity, int | None]]) -> None:
        self._analysis, self._quantities = analysis, quantities

    def __getitem__(self, name: str) -> Array:
        quantity, component = self._quantities[name]
        column = self._analysis.shown(quantity.name)
        return column if component is None else column[:, component]

    def __iter__(self) -> Iterator[str]:
        return iter(self._quantities)

    def __len__(self) -> int:
        return len(self._quantities)

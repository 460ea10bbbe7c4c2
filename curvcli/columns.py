"""Columns: what an analysis computed of one element, by name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from .declare import Element, Quantity, passes

if TYPE_CHECKING:
    from .analysis import Analysis

Array = NDArray[Any]


class Columns(Mapping[str, Array]):
    """Columns of one element by name, read-only; a vector is there by its stem as (n, 3) and by its components.

    Of vertices, the passes chosen; of edges and faces all there are, computed when they are first asked for.
    """

    def __init__(self, analysis: Analysis, element: Element) -> None:
        self._analysis = analysis
        self._quantities: dict[str, tuple[Quantity, int | None]] = {}
        offered = analysis.chosen if element == "vertex" else [quantity.name for quantity in passes.quantities(element)]
        for name in offered:
            quantity = passes.quantity(name)
            if quantity.on == element:
                self._quantities[quantity.stem] = (quantity, None)
                if quantity.vector:
                    self._quantities.update({column: (quantity, k) for k, column in enumerate(quantity.columns)})
        self._shown: dict[str, Array] = {}

    def __getitem__(self, name: str) -> Array:
        quantity, component = self._quantities[name]
        if quantity.name not in self._shown:
            self._shown[quantity.name] = self._analysis.column(quantity.name)
        column = self._shown[quantity.name]
        return column if component is None else column[:, component]

    def __iter__(self) -> Iterator[str]:
        return iter(self._quantities)

    def __len__(self) -> int:
        return len(self._quantities)

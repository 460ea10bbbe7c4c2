"""Columns of one element of an analysis, by name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Protocol

from ..curvatures.quantity import Element, Quantity
from ..curvatures.registry import passes
from ..errors import MissingExtraError
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

    def to_polars(self) -> Any:
        """The columns as a `polars.DataFrame`, vectors by their components; undefined is null, labels are words."""
        import polars as pl

        return pl.DataFrame([pl.Series(name, values, nan_to_null=True) for name, values in self._scalars().items()])

    def to_pandas(self) -> Any:
        """The columns as a `pandas.DataFrame`, vectors by their components; undefined is NaN, labels are words.

        Errors: MissingExtraError without pandas.
        """
        try:
            import pandas
        except ImportError:
            raise MissingExtraError("to_pandas needs pandas: `pip install pandas`") from None
        return pandas.DataFrame(self._scalars())

    def _scalars(self) -> dict[str, Array]:
        """Columns of one value per row."""
        return {
            name: self[name] for name, (quantity, k) in self._quantities.items() if not quantity.vector or k is not None
        }

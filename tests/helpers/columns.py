"""Columns as arrays with NaN for null, and what it means that two of them agree."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

import curvcli
from curvcli.api import Analysis
from curvcli.curvatures.quantity import Quantity
from curvcli.curvatures.registry import passes
from curvcli.mesh.surface import Surface

Array = NDArray[Any]

_ = curvcli.passes  # importing registers them

# What follows from the precision of the coordinates changes with it, as they are moved and scaled.
PUBLIC: dict[str, Quantity] = {q.name: q for q in passes.quantities() if "noise" not in passes.provider(q.name).needs}


def everything(surface: Surface | tuple[Array, Array], mean: str = "sum") -> dict[str, Array]:
    """Every public quantity of a surface as the user sees it, words as numbers."""
    return of(curvcli.analyze(surface, "all", mean=mean))  # type: ignore[arg-type]


def of(result: Analysis) -> dict[str, Array]:
    """Every public quantity of an analysis by its unique name."""
    return {
        name: (result.columns[name] if quantity.labels else result.column(name)).astype(np.float64)
        for name, quantity in PUBLIC.items()
    }


def agree(quantity: Quantity, found: Array, wanted: Array, digits: float = 1e-11, length: float = 1.0) -> None:
    """Nulls in the same places; elsewhere equal up to the given part of the column's largest value.

    length: the size of an edge; a sum whose terms cancel is compared with the size of its terms. Directions agree up
    to their sign.
    """
    assert found.shape == wanted.shape, quantity.name
    np.testing.assert_array_equal(np.isnan(found), np.isnan(wanted), err_msg=quantity.name)
    known = ~np.isnan(wanted)
    if not known.any():
        return
    largest = np.abs(wanted[known]).max()
    if quantity.kind == "measure" or (quantity.kind == "density" and passes.depends_on_scale(quantity.name)):
        largest = max(largest, length**quantity.length_exponent)
    if quantity.mean_degree == 2 and passes.depends_on_scale(quantity.name):
        digits *= 2  # the square of an estimate has twice its relative error
    # A root of a difference that vanishes at umbilics loses half the digits there, and quotients of its values too.
    tolerance = np.sqrt(digits) if quantity.rooted else digits
    gap = np.abs(found - wanted)[known]
    if quantity.line:
        gap = np.minimum(np.abs(found - wanted), np.abs(found + wanted))[known]
    assert gap.max() <= tolerance * max(largest, np.finfo(float).tiny), (quantity.name, gap.max(), largest)


def for_all(names: Iterable[str], hold: Callable[[str], None]) -> None:
    """Try all columns, and tell together which of them fail."""
    failed = []
    for name in names:
        try:
            hold(name)
        except AssertionError as error:
            error.add_note(f"column {name}")
            failed.append(error)
    if failed:
        raise ExceptionGroup(f"{len(failed)} columns fail", failed)


def same(quantity: Quantity, found: Array, wanted: Array) -> None:
    """Bit for bit, nulls included; zeros of either sign are equal."""
    np.testing.assert_array_equal(found, wanted, err_msg=quantity.name)

"""Texts of faults: count and first place."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...mesh.surface import Surface
from ...support.words import counted, format_point
from .faults import ElementKind, Fault, FaultyElements, elements_of


def located(count: int, singular: str, plural: str, first: str, *elements: FaultyElements) -> Fault:
    """A fault with count and first place: `1 edge … (edge 2-7)` or `3 edges … (first: edge 2-7)`."""
    text = f"{counted(count, singular, plural)} ({first if count == 1 else f'first: {first}'})"
    return Fault(text, *elements)


def place(surface: Surface, kind: ElementKind, element: Any) -> str:
    """Name and position of an element: `edge 2-7 at (0.5, 1, 0)`."""
    first = FaultyElements(kind, np.array([element]))
    return f"{first.names(surface)[0]} at {format_point(first.positions(surface)[0])}"


def edges(surface: Surface, mask: NDArray[np.bool_], what: str) -> Fault:
    """The fault of the edges of a mask; empty for none."""
    return _elements(surface, "edge", np.flatnonzero(mask), f"edge {what}", f"edges {what}")


def faces(surface: Surface, where: NDArray[np.integer[Any]], what: str) -> Fault:
    """The fault of the (n,) given faces; empty for none."""
    return _elements(surface, "face", where, f"face {what}", f"faces {what}")


def vertices(surface: Surface, where: NDArray[np.integer[Any]], singular: str, plural: str) -> Fault:
    """The fault of the (n,) given vertices; empty for none."""
    return _elements(surface, "vertex", where, f"vertex {singular}", f"vertices {plural}")


def _elements(
    surface: Surface, kind: ElementKind, where: NDArray[np.integer[Any]], singular: str, plural: str
) -> Fault:
    if not len(where):
        return Fault()
    elements = FaultyElements(kind, np.asarray(where, np.int64))
    return located(len(where), singular, plural, place(surface, kind, where[0]), elements)


def with_explanation(problem: str, explanation: str) -> Fault:
    """A fault with its explanation or remedy; empty without a fault."""
    return Fault(f"{problem}; {explanation}" if problem and explanation else problem, *elements_of(problem))


def join_problems(*problems: str) -> Fault:
    """Join several faults in one line; empty without any."""
    text = ", ".join(problem for problem in problems if problem)
    return Fault(text, *(elements for problem in problems for elements in elements_of(problem)))

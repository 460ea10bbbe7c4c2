"""Fault of a mesh: a text, and the vertices, edges and faces that it speaks of."""

from __future__ import annotations

from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...mesh.surface import Surface
from ...support.arrays import Floats, Ints

ElementKind = Literal["vertex", "edge", "face"]


class FaultyElements(NamedTuple):
    """FaultyElements of a surface. numbers: (n,) in the order of the tables."""

    kind: ElementKind
    numbers: Ints

    def names(self, surface: Surface) -> list[str]:
        """`vertex 5`, `edge 2-7`, `face 3`; faces are named by their polygon of the file."""
        if self.kind == "edge":
            return [f"edge {a}-{b}" for a, b in zip(*self._ends(surface), strict=True)]
        if self.kind == "face" and surface.polygon is not None:
            return [f"polygon {polygon}" for polygon in surface.polygon[self.numbers]]
        return [f"{self.kind} {number}" for number in self.numbers]

    def positions(self, surface: Surface) -> Floats:
        """(n, 3) positions of vertices, midpoints of edges, centroids of faces, in the unit of the file."""
        xyz = surface.xyz_given
        match self.kind:
            case "vertex":
                corners = [self.numbers]
            case "edge":
                corners = self._ends(surface)
            case _:
                corners = list(surface.faces[self.numbers].T)
        # Each is divided before the sum, which could overflow.
        return np.asarray(sum(xyz[:, corner] / len(corners) for corner in corners)).T

    def _ends(self, surface: Surface) -> list[NDArray[Any]]:
        return [surface.edges.a[self.numbers], surface.edges.b[self.numbers]]


class Fault(str):
    """The text of a fault; empty for none. elements: those at fault, as far as they are known."""

    elements: tuple[FaultyElements, ...]

    def __new__(cls, text: str = "", *elements: FaultyElements) -> Fault:
        fault = super().__new__(cls, text)
        fault.elements = elements
        return fault

    def __add__(self, text: str) -> Fault:
        return Fault(str.__add__(self, text), *self.elements)

    def __radd__(self, before: str) -> Fault:
        return Fault(str.__add__(before, self), *self.elements)


def elements_of(problem: str) -> tuple[FaultyElements, ...]:
    """The elements at fault; none for a plain text."""
    return problem.elements if isinstance(problem, Fault) else ()

"""Texts of faults: count and first place."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...mesh.surface import Surface
from ...support.words import counted


def located(count: int, singular: str, plural: str, first: str) -> str:
    """A fault with count and first place: `1 edge … (edge 2-7)` or `3 edges … (first: edge 2-7)`."""
    return f"{counted(count, singular, plural)} ({first if count == 1 else f'first: {first}'})"


def edge_name(surface: Surface, edge: Any) -> str:
    """Name of an edge by its two vertices."""
    return f"edge {surface.edges.a[edge]}-{surface.edges.b[edge]}"


def face_name(surface: Surface, face: Any) -> str:
    """Name of a face by its polygon in the file."""
    return f"face {face}" if surface.polygon is None else f"polygon {surface.polygon[face]}"


def edges(surface: Surface, mask: NDArray[np.bool_], what: str) -> str:
    """The fault of the edges of a mask; empty for none."""
    where = np.flatnonzero(mask)
    return located(len(where), f"edge {what}", f"edges {what}", edge_name(surface, where[0])) if len(where) else ""


def faces(surface: Surface, where: NDArray[np.integer[Any]], what: str) -> str:
    """The fault of the (n,) given faces; empty for none."""
    return located(len(where), f"face {what}", f"faces {what}", face_name(surface, where[0])) if len(where) else ""


def vertices(where: NDArray[np.integer[Any]], singular: str, plural: str) -> str:
    """The fault of the (n,) given vertices; empty for none."""
    return located(len(where), f"vertex {singular}", f"vertices {plural}", f"vertex {where[0]}") if len(where) else ""


def with_explanation(problem: str, explanation: str) -> str:
    """A fault with its explanation or remedy; empty without a fault."""
    return f"{problem}; {explanation}" if problem and explanation else problem


def join_problems(*problems: str) -> str:
    """Join several faults in one line; empty without any."""
    return ", ".join(problem for problem in problems if problem)

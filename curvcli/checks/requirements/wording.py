"""How defects are told: how many, and where the first is."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...mesh.surface import Surface
from ...support.words import counted


def located(count: int, one: str, many: str, first: str) -> str:
    """`1 edge … (edge 2-7)` or `3 edges … (first: edge 2-7)`."""
    return f"{counted(count, one, many)} ({first if count == 1 else f'first: {first}'})"


def edge_name(surface: Surface, edge: Any) -> str:
    """An edge by its two vertices."""
    return f"edge {surface.edges.a[edge]}-{surface.edges.b[edge]}"


def face_name(surface: Surface, face: Any) -> str:
    """A face by its number in the file, which counts polygons."""
    return f"face {face}" if surface.polygon is None else f"polygon {surface.polygon[face]}"


def edges(surface: Surface, mask: NDArray[np.bool_], what: str) -> str:
    """Edges where the mask holds, or nothing."""
    where = np.flatnonzero(mask)
    return located(len(where), f"edge {what}", f"edges {what}", edge_name(surface, where[0])) if len(where) else ""


def faces(surface: Surface, where: NDArray[np.integer[Any]], what: str) -> str:
    """The faces given, or nothing."""
    return located(len(where), f"face {what}", f"faces {what}", face_name(surface, where[0])) if len(where) else ""


def vertices(where: NDArray[np.integer[Any]], one: str, many: str) -> str:
    """The vertices given, or nothing."""
    return located(len(where), f"vertex {one}", f"vertices {many}", f"vertex {where[0]}") if len(where) else ""


def with_explanation(problem: str, explanation: str) -> str:
    """A problem with its explanation or its way out, or nothing without a problem."""
    return f"{problem}; {explanation}" if problem and explanation else problem


def join_problems(*problems: str) -> str:
    """Several problems in one line, or nothing."""
    return ", ".join(problem for problem in problems if problem)

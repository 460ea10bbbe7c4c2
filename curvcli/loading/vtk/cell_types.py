"""Cell types of VTK: number, name, and the role of each in a triangulated surface."""

from __future__ import annotations

VERTEX, POLY_VERTEX, LINE, POLY_LINE, TRIANGLE, STRIP, POLYGON, PIXEL, QUAD = range(1, 10)

CORNERS = {TRIANGLE: 3, PIXEL: 4, QUAD: 4, VERTEX: 1, LINE: 2}
"""Number of corners of the types that have a fixed one."""

FACES = (TRIANGLE, STRIP, POLYGON, PIXEL, QUAD)
LINES = (LINE, POLY_LINE)

_CURVED = (22, 23, 28, 30, 34, 36, 52, 53, 54, 61, 62, 63, 69, 70, 76, 77)
_SOLID = {10: "tetrahedron", 11: "voxel", 12: "hexahedron", 13: "wedge", 14: "pyramid", 42: "polyhedron"}
_PLURALS = {
    "tetrahedron": "tetrahedra",
    "hexahedron": "hexahedra",
    "polyhedron": "polyhedra",
    "vertex": "vertices",
    "curved line": "curved lines",
}


def is_curved(kind: int) -> bool:
    """Test for faces with nodes between their corners, or control points: no polygon of straight edges."""
    return kind in _CURVED


def cell_type_name(kind: int) -> str:
    """The name of a cell type in messages."""
    if kind in (VERTEX, POLY_VERTEX):
        return "vertex"
    if kind in (21, 35, 51, 60, 68, 75):
        return "curved line"
    if is_curved(kind):
        return "curved face"
    return _SOLID.get(kind, "solid" if kind else "empty cell")


def count_of(count: int, name: str) -> str:
    """A number of cells with their name."""
    return f"{count} {name if count == 1 else _PLURALS.get(name, name + 's')}"

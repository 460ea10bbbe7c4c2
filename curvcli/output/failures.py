"""Failing elements of a mesh alone, as a table or as a mesh to open beside it, coloured by rule."""

from __future__ import annotations

from collections.abc import Sequence
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from ..checks.requirements.faults import FaultyElements
from ..mesh.file import Labels
from ..mesh.surface import Surface
from .registry import TableFormat, output_formats
from .tables.columns import Table

# A rule, and elements that fail it.
Failing = Sequence[tuple[str, FaultyElements]]


def write_failures(stream: BinaryIO, suffix: str, surface: Surface, failing: Failing) -> None:
    """Write failing elements in the format of a suffix, of a table or of a mesh; a file without rows if there are none.

    A mesh has the failing faces and the faces at failing edges, each rule on vertices of its own, and the failing
    vertices as points without a face; `rule` and `vertex` or `face` say where each comes from.
    """
    format = output_formats()[suffix]
    if isinstance(format, TableFormat):
        format.write(stream, failure_table(surface, failing), "shortest", None)
        return
    from .meshes.write import write_mesh
    from .pictures.colors import categorize

    points, faces, origin, rule, face_rule = _soup(surface, failing)
    names = _rules(failing)
    write_mesh(
        stream,
        suffix,
        points,
        faces,
        vertex_colors=categorize(rule, names).rgb,
        vertex_properties={"vertex": origin, "rule": Labels(rule, names)},
        face_properties={"rule": Labels(face_rule, names)},
        comments=[f"rule {number}: {name}" for number, name in enumerate(names)],
    )


def failure_table(surface: Surface, failing: Failing) -> Table:
    """One row per rule and failing element: its kind, its name, its number in the tables, and a point of it."""
    names = _rules(failing)
    rows = [len(elements.numbers) for _, elements in failing]
    kinds = ("vertex", "edge", "face")
    elements = [name for _, each in failing for name in each.names(surface)]
    positions = np.concatenate([np.zeros((0, 3)), *(each.positions(surface) for _, each in failing)])
    return {
        "rule": Labels(np.repeat(np.array([names.index(name) for name, _ in failing], np.int32), rows), names),
        "kind": Labels(np.repeat(np.array([kinds.index(e.kind) for _, e in failing], np.int32), rows), kinds),
        "element": Labels(np.arange(len(elements), dtype=np.int32), tuple(elements)),
        "number": np.concatenate([np.zeros(0, np.int64), *(each.numbers for _, each in failing)]),
    } | dict(zip("xyz", positions.T, strict=True))


def _rules(failing: Failing) -> tuple[str, ...]:
    return tuple(dict.fromkeys(name for name, _ in failing))


def _soup(
    surface: Surface, failing: Failing
) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]]:
    """Points (n, 3), faces (m, 3), and the vertex and the rule of each point, and the rule of each face."""
    vertices: list[NDArray[np.int32]] = []
    faces: list[NDArray[np.int32]] = []
    rules: list[NDArray[np.int32]] = []
    face_rules: list[NDArray[np.int32]] = []
    count = 0
    names = _rules(failing)
    for name, elements in failing:
        number = names.index(name)
        corners: NDArray[np.int32] = np.zeros((0, 3), np.int32)
        if elements.kind == "vertex":
            chosen = elements.numbers.astype(np.int32)
        else:
            of = elements.numbers
            if elements.kind == "edge":
                of = np.unique(surface.edges.half_edges(elements.numbers) // 3)
            chosen, place = np.unique(surface.faces[of], return_inverse=True)
            corners = (place.reshape(-1, 3) + count).astype(np.int32)
        vertices.append(chosen)
        faces.append(corners)
        rules.append(np.full(len(chosen), number, np.int32))
        face_rules.append(np.full(len(corners), number, np.int32))
        count += len(chosen)
    nothing = np.zeros(0, np.int32)
    vertex = np.concatenate([nothing, *vertices])
    triangles = np.concatenate([np.zeros((0, 3), np.int32), *faces])
    points = np.ascontiguousarray(surface.points[vertex])
    return points, triangles, vertex, np.concatenate([nothing, *rules]), np.concatenate([nothing, *face_rules])

"""Files written by Gmsh itself and by meshio, in every version of the format."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.helpers.every_format import Shape

GMSH = ("2.2-text", "2.2-binary", "4.0-text", "4.1-text", "4.1-binary")
MESHIO = (*GMSH, "4.0-binary")
"""Versions and modes that Gmsh and meshio write."""


def write_gmsh(shape: Shape, dialect: str, path: Path) -> Shape:
    """Write the shape with Gmsh: polygons in two entities, of the physical groups `rest` and `cap`, and a line.

    Returns the shape that the file has: Gmsh orders elements by type within an entity, and in version 2.2 over all of
    them, without nodes that no element has.
    """
    gmsh = pytest.importorskip("gmsh", reason="Gmsh is not installed: `pip install gmsh`", exc_type=ImportError)
    version, mode = dialect.split("-")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.MshFileVersion", float(version))
        gmsh.option.setNumber("Mesh.Binary", mode == "binary")
        gmsh.model.add("shape")
        for tag in (1, 2):
            gmsh.model.addDiscreteEntity(2, tag)
        gmsh.model.addDiscreteEntity(1, 1)
        nodes = np.arange(1, len(shape.points) + 1)
        gmsh.model.mesh.addNodes(2, 1, nodes, shape.points.reshape(-1))
        order: list[tuple[int, int]] = []
        half = len(shape.polygons) // 2
        for tag, some in ((1, range(half)), (2, range(half, len(shape.polygons)))):
            for kind, size in ((2, 3), (3, 4)):
                chosen = [k for k in some if len(shape.polygons[k]) == size]
                corners = [corner + 1 for k in chosen for corner in shape.polygons[k]]
                if chosen:
                    numbers = [k + 1 for k in chosen]
                    gmsh.model.mesh.addElementsByType(tag, kind, numbers, corners)
                    order += [(size if version == "2.2" else 0, k) for k in chosen]
        gmsh.model.mesh.addElementsByType(1, 1, [len(shape.polygons) + 1], [1, 2])
        for dimension, tag, number, group in ((2, 1, 3, "rest"), (2, 2, 7, "cap"), (1, 1, 7, "edge")):
            gmsh.model.addPhysicalGroup(dimension, [tag], number, group)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    order.sort(key=lambda place: place[0])
    polygons = tuple(shape.polygons[k] for _, k in order)
    if version != "2.2":
        return Shape(shape.points, polygons)
    used = sorted({corner for polygon in polygons for corner in polygon})
    return Shape(shape.points[used], tuple(tuple(used.index(corner) for corner in polygon) for polygon in polygons))


def write_meshio(shape: Shape, dialect: str, path: Path) -> Shape:
    """Write the shape with meshio, a block per run of polygons of one size, each in the physical group of its part.

    Returns the shape that the file has: triangles without groups in version 4.1, of which meshio writes one block only.
    """
    import meshio  # type: ignore[import-untyped]
    from meshio.gmsh import write  # type: ignore[import-untyped]

    version, mode = dialect.split("-")
    if version == "4.1":
        mesh = meshio.Mesh(shape.points, [("triangle", shape.triangles)])
        write(str(path), mesh, fmt_version=version, binary=mode == "binary")
        return shape.halved()
    blocks: list[tuple[str, list[tuple[int, ...]], list[int]]] = []
    for polygon, part in zip(shape.polygons, shape.part.tolist(), strict=True):
        kind = "triangle" if len(polygon) == 3 else "quad"
        if not blocks or blocks[-1][0] != kind or blocks[-1][2][-1] != part + 1:
            blocks.append((kind, [], []))
        blocks[-1][1].append(polygon)
        blocks[-1][2].append(part + 1)
    groups = [np.array(block[2]) for block in blocks]
    data = {"gmsh:physical": groups, "gmsh:geometrical": groups}
    mesh = meshio.Mesh(
        shape.points,
        [(kind, np.array(rows)) for kind, rows, _ in blocks],
        cell_data=data,
        field_data={"ring": np.array([1, 2])},
    )
    write(str(path), mesh, fmt_version=version, binary=mode == "binary")
    return shape

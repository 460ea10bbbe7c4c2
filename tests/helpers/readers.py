"""Other programs' readers of meshes, and the facts by which what they find is compared."""

from __future__ import annotations

import contextlib
import io
import subprocess
import sys
import tempfile
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

import meshio  # type: ignore[import-untyped]
import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray


class Facts(NamedTuple):
    """Of the referenced vertices, equal positions taken as one, and of the triangles with three distinct corners.

    area: the least and the most that the polygons may have, which are the same where they are plane and convex.
    """

    vertices: int
    faces: int
    euler_characteristic: int
    boundary_edges: int
    area: tuple[float, float]


Polygons = list[tuple[int, ...]]


def facts(points: NDArray[np.float64], polygons: Polygons) -> Facts:
    """Counted with sets, each polygon as a fan; its area is at least that of its area vector."""
    place: dict[tuple[float, ...], int] = {}
    number = [place.setdefault(tuple(p + 0.0), len(place)) for p in points]
    faces = [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]
    merged = [(number[a], number[b], number[c]) for a, b, c in faces]
    kept = [face for face in merged if len(set(face)) == 3]
    edges = Counter(tuple(sorted(pair)) for a, b, c in kept for pair in ((a, b), (b, c), (c, a)))
    used = {corner for face in kept for corner in face}
    alike: dict[int, Polygons] = {}
    for polygon in polygons:
        alike.setdefault(len(polygon), []).append(polygon)
    least = most = 0.0
    for each in alike.values():
        corners = points[np.array(each)]
        corners = corners - corners[:, :1]
        fans = np.cross(corners[:, 1:-1], corners[:, 2:]) / 2
        least += float(np.linalg.norm(fans.sum(axis=1), axis=1).sum())
        most += float(np.linalg.norm(fans, axis=2).sum())
    boundary = sum(count == 1 for count in edges.values())
    return Facts(len(used), len(kept), len(used) - len(edges) + len(kept), boundary, (least, most))


@contextlib.contextmanager
def silence() -> Iterator[None]:
    """Silence the output and warnings of other libraries."""
    with contextlib.ExitStack() as stack:
        stack.enter_context(contextlib.redirect_stdout(io.StringIO()))
        stack.enter_context(contextlib.redirect_stderr(io.StringIO()))
        stack.enter_context(np.errstate(all="ignore"))
        stack.enter_context(warnings.catch_warnings())
        warnings.simplefilter("ignore")
        yield


def with_meshio(path: Path) -> tuple[NDArray[np.float64], Polygons]:
    with silence():
        mesh = meshio.read(path)
    kinds = ("triangle", "quad", "polygon")
    return np.asarray(mesh.points, float), [
        tuple(int(i) for i in row) for block in mesh.cells if block.type in kinds for row in block.data
    ]


def with_trimesh(path: Path) -> tuple[NDArray[np.float64], Polygons]:
    """trimesh's own readers, of which curvcli uses none."""
    kind = path.suffix[1:].lower()
    with path.open("rb") as file, silence():
        scene = trimesh.load_scene(file, file_type=kind, process=False, maintain_order=True, skip_materials=True)
    points, polygons, count = [], Polygons(), 0
    for mesh in scene.dump():
        points.append(np.asarray(mesh.vertices, float))
        polygons += [tuple(int(i) + count for i in face) for face in mesh.faces]
        count += len(mesh.vertices)
    return np.concatenate(points), polygons


_VTK = """
import os, sys
import numpy, pyvista
print("ready", flush=True)
for line in sys.stdin:
    source, target = line.rstrip("\\n").split("\\t")
    child = os.fork()
    if child == 0:
        mesh = pyvista.read(source)
        numpy.savez(target, points=mesh.points, faces=mesh.faces)
        os._exit(0)
    print(os.waitpid(child, 0)[1], flush=True)
"""


@cache
def vtk_process() -> subprocess.Popen[str] | None:
    """VTK in a process of its own, which reads each file in a child: some files that it cannot read are its end."""
    process = subprocess.Popen(
        [sys.executable, "-c", _VTK],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    assert process.stdout is not None
    if process.stdout.readline() == "ready\n":
        return process
    process.communicate()
    return None


def with_vtk(path: Path) -> tuple[NDArray[np.float64], Polygons]:
    process = vtk_process()
    if process is None:
        pytest.skip("pyvista is not installed: `pip install pyvista`")
    assert process.stdin is not None
    assert process.stdout is not None
    with tempfile.TemporaryDirectory() as folder:
        process.stdin.write(f"{path}\t{folder}/read.npz\n")
        process.stdin.flush()
        if process.stdout.readline() != "0\n":
            raise ValueError("VTK cannot read it")
        with np.load(f"{folder}/read.npz") as read:
            points, cells = np.asarray(read["points"], float), read["faces"]
    polygons, at = Polygons(), 0
    while at < len(cells):
        polygons.append(tuple(int(i) for i in cells[at + 1 : at + 1 + cells[at]]))
        at += 1 + cells[at]
    return points, polygons


Reader = Callable[[Path], tuple[NDArray[np.float64], Polygons]]
READERS: dict[str, Reader] = {"meshio": with_meshio, "trimesh": with_trimesh, "vtk": with_vtk}

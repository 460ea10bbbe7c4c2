"""Other programs' readers find the same mesh in the same file: counts, topology and area on every format variant."""

from __future__ import annotations

import contextlib
import csv
import io
import re
import struct
import subprocess
import sys
import tempfile
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import meshio  # type: ignore[import-untyped]
import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

import curvcli
from tests.shared import SHARED, needs_shared

# ---------------------------------------------------------------- what is compared


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
    least = most = 0.0
    for polygon in polygons:
        corners = points[list(polygon)] - points[polygon[0]]
        fan = np.cross(corners[1:-1], corners[2:]) / 2
        least += float(np.linalg.norm(fan.sum(axis=0)))
        most += float(np.linalg.norm(fan, axis=1).sum())
    boundary = sum(count == 1 for count in edges.values())
    return Facts(len(used), len(kept), len(used) - len(edges) + len(kept), boundary, (least, most))


def ours(path: Path) -> Facts:
    """The same facts from the report."""
    surface = curvcli.load(path, weld="exact")
    report = curvcli.analyze(surface, "topology", weld="exact").report()
    vertices, faces, chi, boundary = (report["topology"][key] for key in Facts._fields[:4])
    return Facts(vertices, faces, chi, boundary, (report["totals"]["area"],) * 2)


def same(found: Facts, expected: Facts, rel: float = 1e-12) -> None:
    assert found[:4] == expected[:4]
    least, most = (1 - rel) * expected.area[0], (1 + rel) * expected.area[1]
    assert least <= (1 + rel) * found.area[1]
    assert (1 - rel) * found.area[0] <= most


# ---------------------------------------------------------------- other readers


@contextlib.contextmanager
def silence() -> Iterator[None]:
    """What others print and warn of is not ours."""
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


@pytest.fixture(scope="module", autouse=True)
def _vtk_ends() -> Iterator[None]:
    yield
    if vtk_process.cache_info().currsize and (process := vtk_process()) is not None:
        process.communicate()


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

# ---------------------------------------------------------------- shapes and a writer for each variant

Points = list[tuple[float, float, float]]


def prism() -> tuple[Points, Polygons]:
    """A closed body of triangles, quadrilaterals and two pentagons that fit float32; one vertex is not used."""
    ring = [(4.0, 0.0), (2.0, 3.0), (-2.0, 2.0), (-3.0, -1.0), (1.0, -3.0)]
    points = [(x, y, z) for z in (0.0, 2.5) for x, y in ring] + [(9.0, 9.0, 9.0), (0.5, 0.25, 4.0)]
    sides: Polygons = [(k, (k + 1) % 5, 5 + (k + 1) % 5, 5 + k) for k in range(5)]
    return points, [(4, 3, 2, 1, 0), *sides, *((5 + k, 5 + (k + 1) % 5, 11) for k in range(5))]


def sheet() -> tuple[Points, Polygons]:
    """An open strip of quadrilaterals, twisted but each of them plane, and a triangle beside it."""
    points = [(float(k), float(j), 0.5 * k) for k in range(6) for j in (0, 1)]
    strip: Polygons = [(2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1) for k in range(5)]
    return [*points, (20.0, 0.0, 0.0), (21.0, 0.0, 1.0), (20.0, 3.0, 0.0)], [*strip, (12, 13, 14)]


SHAPES = {"prism": prism(), "sheet": sheet()}


def halved(polygons: Polygons) -> Polygons:
    return [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]


def obj(form: str = "{v}", *, relative: bool = False, triangles: bool = False, end: str = "\n") -> Any:
    def write(points: Points, polygons: Polygons) -> bytes:
        lines = ["# made for a test", *("v " + " ".join(map(repr, p)) for p in points)]
        lines += [f"vt {k / 16!r} 0.5" for k in range(len(points))] if "{t}" in form else []
        lines += ["vn 0.0 0.0 1.0" for _ in points] if "{n}" in form else []
        for polygon in halved(polygons) if triangles else polygons:
            numbers = [k - len(points) if relative else k + 1 for k in polygon]
            lines.append("f " + " ".join(form.format(v=k, t=k, n=k) for k in numbers))
        return (end.join(lines) + end).encode()

    return write


def ply(
    order: str,
    number: str = "double",
    length: str = "uchar",
    index: str = "int",
    *,
    extra: bool = False,
    triangles: bool = False,
    name: str = "vertex_indices",
    end: str = "\n",
) -> Any:
    codes = {"uchar": "B", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d", "short": "h"}

    def write(points: Points, polygons: Polygons) -> bytes:
        faces = halved(polygons) if triangles else polygons
        head = ["ply", f"format {order} 1.0", "comment made for a test", f"element vertex {len(points)}"]
        head += [f"property {number} {axis}" for axis in "xyz"]
        head += ["property uchar red", "property uchar green", "property uchar blue", "property float q"] * extra
        head += [f"element face {len(faces)}", f"property list {length} {index} {name}"]
        head += ["property short part"] * extra
        head += ["end_header"]
        vertex = codes[number] * 3 + "BBBf" * extra
        rows = [(vertex, (*p, *(1, 2, 3, 0.5) * extra)) for p in points]
        for k, face in enumerate(faces):
            row = (len(face), *face, *(k,) * extra)
            rows.append((codes[length] + codes[index] * len(face) + "h" * extra, row))
        text = (end.join(head) + end).encode()
        if order == "ascii":
            return text + "".join(" ".join(map(repr, row)) + end for _, row in rows).encode()
        sign = "<" if "little" in order else ">"
        return text + b"".join(struct.pack(sign + code, *row) for code, row in rows)

    return write


def stl(binary: bool, header: bytes = b"made for a test", end: str = "\n") -> Any:
    def write(points: Points, polygons: Polygons) -> bytes:
        faces = [[points[k] for k in face] for face in halved(polygons)]
        if binary:
            body = b"".join(struct.pack("<12fH", 0, 0, 1, *(x for p in face for x in p), 0) for face in faces)
            return header.ljust(80, b"\0") + struct.pack("<I", len(faces)) + body
        lines = ["solid made for a test"]
        for face in faces:
            lines += ["  facet normal 0 0 1", "    outer loop"]
            lines += ["      vertex " + " ".join(map(repr, p)) for p in face]
            lines += ["    endloop", "  endfacet"]
        return (end.join([*lines, "endsolid made for a test"]) + end).encode()

    return write


LITTLE, BIG = "binary_little_endian", "binary_big_endian"
ORDERS, WHOLE = ("ascii", LITTLE, BIG), ("uchar", "int", "uint")
VARIANTS: dict[str, Any] = {
    "v.obj": obj(),
    "v-vt.obj": obj("{v}/{t}"),
    "v--vn.obj": obj("{v}//{n}"),
    "v-vt-vn.obj": obj("{v}/{t}/{n}"),
    "triangles.obj": obj(triangles=True),
    "negative.obj": obj(relative=True),
    "negative-v--vn.obj": obj("{v}//{n}", relative=True),
    "negative-v-vt-vn.obj": obj("{v}/{t}/{n}", relative=True, triangles=True),
    "crlf.obj": obj(end="\r\n"),
    **{f"{order}-{number}.ply": ply(order, number) for order in ORDERS for number in ("float", "double")},
    **{f"{LITTLE}-{n}-{i}.ply": ply(LITTLE, "float", n, i) for n in WHOLE for i in WHOLE},
    **{f"{order}-extra.ply": ply(order, extra=True) for order in ORDERS},
    **{f"{order}-triangles.ply": ply(order, "float", triangles=True) for order in ORDERS},
    "vertex_index.ply": ply(LITTLE, name="vertex_index"),
    "crlf.ply": ply("ascii", end="\r\n"),
    "ascii.stl": stl(False),
    "crlf-ascii.stl": stl(False, end="\r\n"),
    "binary.stl": stl(True),
    "solid-binary.stl": stl(True, b"solid that is none"),
}  # fmt: skip

# What a reader cannot do, and why.
UNABLE = {
    ("meshio", r"negative.*"): "takes negative indices as they stand",
    ("meshio", r"binary.*-extra\.ply"): "does not know the type `short`",
    ("meshio", r"vertex_index\.ply"): "takes a list `vertex_index` for data",
    ("trimesh", r"binary.*(?<!triangles)\.ply|vertex_index\.ply"): "reads lists of one length only in binary PLY",
    ("trimesh", r".*v-vt.*"): "wants Pillow for texture coordinates",
    ("trimesh", r"negative-v--vn\.obj"): "does not know negative indices of normals",
    # files found in the wild
    ("meshio", r"cornell_box\.obj"): "takes negative indices as they stand",
    ("trimesh", r"cornell_box\.obj"): "counts negative indices from the end of the file",
    ("trimesh", r"issue-319-002\.obj"): "cuts polygons that are not convex into fans",
    ("trimesh", r"(fish|spot)_control_mesh\.obj"): "cuts polygons that are not flat along other diagonals",
    ("vtk", r"missingEndsolid\.ascii\.stl"): "finds nothing without `endsolid`",
    ("vtk", r"effector_base\.stl"): "reads text as float32, which makes positions equal",
    ("vtk", r"fish_control_mesh\.obj"): "is compared by fans where polygons are neither plane nor convex",
}


def unable(reader: str, name: str) -> str | None:
    """Why a reader cannot be asked about a file."""
    return next((why for (who, what), why in UNABLE.items() if who == reader and re.fullmatch(what, name)), None)


def test_every_variant_has_a_witness() -> None:
    for variant in VARIANTS:
        assert any(unable(reader, variant) is None for reader in READERS), variant


@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("variant", VARIANTS)
def test_variants(tmp_path: Path, variant: str, shape: str, reader: str) -> None:
    points, polygons = SHAPES[shape]
    path = tmp_path / variant
    path.write_bytes(VARIANTS[variant](points, polygons))
    meant = facts(np.array(points), polygons)
    same(ours(path), meant)
    if reason := unable(reader, variant):
        pytest.skip(f"{reader} {reason}")
    same(facts(*READERS[reader](path)), meant)


def real() -> Iterator[Any]:
    if SHARED is None:
        return
    with (SHARED / "meshes" / "index.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            if row["exit"] == "0":
                yield pytest.param(SHARED / "meshes" / row["file"], id=row["file"])


@needs_shared
@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize("path", list(real()))
def test_real_files(path: Path, reader: str) -> None:
    found = ours(path)
    if reason := unable(reader, path.name):
        pytest.skip(f"{reader} {reason}")
    try:
        other = facts(*READERS[reader](path))
    except Exception as error:
        if isinstance(error, pytest.skip.Exception):
            raise
        pytest.skip(f"{reader} does not read {path.name}: {type(error).__name__}")
    # Others take the numbers of text files for float32, which they are in most.
    same(found, other, 1e-6 if path.suffix != ".obj" else 1e-11)

"""Other programs' readers find the same mesh in the same file: counts, topology and area on every format variant."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import curvcli
from tests.helpers.readers import READERS, Facts, facts, vtk_process
from tests.helpers.shared import SHARED, needs_shared
from tests.helpers.variants import SHAPES, VARIANTS


@pytest.fixture(scope="module", autouse=True)
def _vtk_ends() -> Iterator[None]:
    yield
    if vtk_process.cache_info().currsize and (process := vtk_process()) is not None:
        process.communicate()
    vtk_process.cache_clear()  # the tests of a module may come in several parts


@cache
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
    (
        "meshio",
        r"(catmark_torus_creases0|chair_model|cube_compressed|fish_control_mesh|fuze|ico4|joined_tetrahedra|meshes_cube|"
        r"mug|spot_control_mesh|torus_quads|torus_textured)\.obj",
    ): "wants as many normals and texture coordinates as vertices",
    ("meshio", r"fandisk\.obj"): "wants UTF-8",
    ("meshio", r"hyper_box\.obj"): "takes the numbers after x, y, z for coordinates",
    ("meshio", r"cycloidal\.ply"): "reads no properties of faces in binary PLY",
    ("meshio", r"(embryo_cell_.*|mesh-indices)\.ply"): "takes a list `vertex_index` for data",
    ("meshio", r"platonic_shelf(_ascii)?\.ply"): "wants vertices before faces",
    ("vtk", r"platonic_shelf(_ascii)?\.ply"): "wants vertices before faces",
    ("trimesh", r"(platonic_shelf(_big_endian)?|bunny_poly)\.ply"): "reads lists of one length only in binary PLY",
    ("trimesh", r"missingEndsolid\.ascii\.stl"): "finds nothing without `endsolid`",
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
def test_other_readers_find_the_same_in_each_variant(tmp_path: Path, variant: str, shape: str, reader: str) -> None:
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


@pytest.mark.slow
@needs_shared
@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize("path", list(real()))
def test_other_readers_find_the_same_in_real_files(path: Path, reader: str) -> None:
    found = ours(path)
    if reason := unable(reader, path.name):
        pytest.skip(f"{reader} {reason}")
    # Others take the numbers of text files for float32, which they are in most.
    same(found, facts(*READERS[reader](path)), 1e-6 if path.suffix != ".obj" else 1e-11)

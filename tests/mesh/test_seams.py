"""Boundary vertices that nearly coincide: the hint says which tolerance closes the mesh, and following it does."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import curvcli
from curvcli.mesh.seams import describe_best_welding, near_seam
from tests.helpers import meshes
from tests.helpers.cli.program import curvcli as program
from tests.helpers.meshes import Mesh, mesh, of_sample

BODIES = {
    "sphere": lambda: of_sample("icosphere", size=162),
    "ellipsoid": lambda: of_sample("irregular_ellipsoid", size=300),
    "torus": meshes.torus,
    "block": lambda: of_sample("genus_2", size=1250),
}


def cut(given: Mesh, gap: float, seed: int = 0) -> Mesh:
    """Cut in three, with the rims of the pieces moved by up to the gap, against the diagonal of the bounding box."""
    rng = np.random.default_rng(seed)
    middle = given.points[given.faces].mean(axis=1) - given.points.mean(axis=0)
    piece = np.digitize(middle @ rng.normal(size=3), np.quantile(middle, [0.4, 0.7]))
    own, faces = np.unique(piece[:, None] * len(given.points) + given.faces, return_inverse=True)
    points = given.points[own % len(given.points)]
    made = mesh(points, faces.reshape(-1, 3))
    rim = made.surface().boundary
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    away = rng.uniform(-1, 1, (int(rim.sum()), 3))
    points[rim] += away / np.linalg.norm(away, axis=1)[:, None] * gap / 2 * diagonal
    return made.moved(points)


def boundary_edges(path: Path, *options: str) -> int:
    return int(program("analyze", path, *options, "--get", "topology.boundary_edges").out)


def hints(path: Path) -> dict[str, str]:
    """The hint of each warning of analyze."""
    import json

    report = json.loads(program("analyze", path, "--json", "-p", "topology").out)
    return {one["code"]: one["hint"] for one in report["warnings"]}


@pytest.mark.parametrize("gap", [1e-15, 1e-9, 2e-6, 1e-4])
@pytest.mark.parametrize("name", BODIES)
def test_following_the_hint_closes_the_mesh(name: str, gap: float, tmp_path: Path) -> None:
    for seed, scale in enumerate((1.0, 1e-6, 1e6)):
        made = cut(BODIES[name](), gap, seed)
        surface = made.moved(made.points * scale).surface()
        seam = near_seam(surface)
        assert seam is not None
        boundary = len(surface.boundary_half_edges)
        assert describe_best_welding(surface) == f"--weld {seam.tolerance} closes all {boundary} boundary edges"
        assert float(seam.tolerance) <= max(1.1 * gap, 1e-12)
        path = made.moved(made.points * scale).write(tmp_path / "cut.obj")
        welded = curvcli.load(path, weld=float(seam.tolerance))
        assert not len(welded.boundary_half_edges)
        assert welded.n_faces == surface.n_faces


@pytest.mark.parametrize("seed", range(4))
def test_the_numbers_of_the_hint_are_those_of_the_command(seed: int, tmp_path: Path) -> None:
    """A hole beside the seam, and a second seam a thousand times as wide."""
    narrow, wide = cut(BODIES["ellipsoid"](), 1e-7, seed), cut(BODIES["torus"](), 1e-4, seed)
    made = meshes.joined(narrow, wide.moved(wide.points + 3.0))
    path = made.with_faces(made.faces[1:]).write(tmp_path / "cut.obj")
    hint = hints(path)["near_vertices"]
    told = re.fullmatch(r"--weld (\S+) closes (\d+) of (\d+) boundary edges", hint)
    assert told, hint
    assert boundary_edges(path) == int(told[3])
    assert boundary_edges(path, "--weld", told[1]) == int(told[3]) - int(told[2]) <= 3
    failed = program("check", path, "--require", "closed", "--allow", "manifold")
    assert failed.code == 1
    assert f"with only one face (first: edge 0-1); {hint}" in failed.out or f"; {hint}" in failed.out
    closed = program("check", path, "--require", "closed", "--weld", told[1])
    assert ("closed fails" in closed.out) == (told[2] != told[3])


def test_the_vertices_are_counted() -> None:
    made = cut(BODIES["sphere"](), 1e-8)
    surface = made.surface()
    notice = next(one for one in curvcli.analyze(surface).notices if one.code == "near_vertices")
    assert notice.count == int(surface.boundary.sum())
    assert notice.message == "boundary vertices nearly coincide"


def test_zero_beside_nearly_zero(tmp_path: Path) -> None:
    """As CAD programs write what should be 0; the cube is read with its corners apart."""
    cube = of_sample("cube")
    soup = cube.points[cube.faces.ravel()] - cube.points.min(axis=0)
    soup += (soup == 0) * np.random.default_rng(0).choice([0, 3e-17, -1e-18], soup.shape)
    path = mesh(soup, np.arange(len(soup)).reshape(-1, 3)).write(tmp_path / "cube.obj")
    assert boundary_edges(path) == 3 * len(cube.faces)
    assert hints(path)["near_vertices"] == f"--weld 1e-12 closes all {3 * len(cube.faces)} boundary edges"
    assert boundary_edges(path, "--weld", "1e-12") == 0


def strip(width: float) -> Mesh:
    """A long strip of long quadrilaterals: its two sides are near each other, but no seam."""
    x = np.arange(20.0)
    points = np.concatenate([np.stack([x, 0 * x, 0 * x], 1), np.stack([x, 0 * x + width, 0 * x], 1)])
    k = np.arange(19)
    return mesh(points, np.concatenate([np.stack([k, k + 1, k + 21], 1), np.stack([k, k + 21, k + 20], 1)]))


@pytest.mark.parametrize(
    "make",
    [
        meshes.grid,
        meshes.cap,
        meshes.mobius,
        meshes.icosphere,
        lambda: of_sample("plane", size=40000),
        lambda: strip(0.5),
        lambda: strip(0.01),
        lambda: strip(1e-4),
        lambda: strip(1e-6),
        lambda: strip(1e-12),
        lambda: cut(BODIES["sphere"](), 0.01),
    ],
)
def test_a_mesh_without_a_near_seam_has_no_hint(make: object) -> None:
    assert callable(make)
    assert near_seam(make().surface()) is None


def test_exact_seams_keep_their_own_hint() -> None:
    made = cut(BODIES["sphere"](), 0.0)
    assert near_seam(made.surface()) is None
    assert re.fullmatch(r"--weld exact would close all \d+ boundary edges", describe_best_welding(made.surface()))


def test_a_hole_has_no_hint() -> None:
    found = meshes.grid().surface()
    assert describe_best_welding(found) == ""

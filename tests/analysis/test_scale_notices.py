"""Notices of rough and of creased meshes; none of smooth ones."""

from __future__ import annotations

import numpy as np
import pytest

import curvcli
from curvcli.samples import get, names
from tests.helpers import meshes, parts
from tests.helpers.meshes import Mesh

CREASED = {"genus_2", "closed_cylinder"}
CODES = {"rough_energy", "creased"}


def said(mesh: Mesh, passes: str | list[str] = "core", **options: object) -> dict[str, curvcli.Notice]:
    found = curvcli.analyze((mesh.points, mesh.faces), passes, **options)  # type: ignore[arg-type]
    return {notice.code: notice for notice in found.notices if notice.code in CODES}


def tetrahedra(function: object, n: int) -> Mesh:
    """The zero set of a function over a grid of n³ cubes by marching tetrahedra: slivers of every shape."""
    axis = np.linspace(-1.0, 1.0, n + 1)
    grid = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    value = function(*grid.T)  # type: ignore[operator]
    step = np.array([(n + 1) ** 2, n + 1, 1])
    low = (np.stack(np.meshgrid(*[np.arange(n)] * 3, indexing="ij"), axis=-1).reshape(-1, 3) @ step)[:, None]
    paths = np.array([[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]])
    corners = np.concatenate([low + np.concatenate([[0], np.cumsum(step[path])]) for path in paths])
    inside = value[corners] < 0
    keys, triangles = [], []
    for count in (1, 2, 3):
        some = inside.sum(axis=1) == count
        order = np.argsort(~inside[some], axis=1, kind="stable")
        tetra = np.take_along_axis(corners[some], order, axis=1)
        ends = {1: [(0, 1), (0, 2), (0, 3)], 3: [(0, 3), (1, 3), (2, 3)], 2: [(0, 2), (0, 3), (1, 3), (1, 2)]}[count]
        pairs = np.stack([np.sort(tetra[:, list(pair)], axis=1) for pair in ends], axis=1)
        keys.append(pairs.reshape(-1, len(ends), 2))
        triangles.append([[0, 1, 2]] if count != 2 else [[0, 1, 2], [0, 2, 3]])
    faces = np.concatenate(
        [key[:, each].reshape(-1, 3, 2) for key, some in zip(keys, triangles, strict=True) for each in some]
    )
    number = faces[..., 0] * len(grid) + faces[..., 1]
    unique, index = np.unique(number, return_inverse=True)
    a, b = np.divmod(unique, len(grid))
    share = (value[a] / (value[a] - value[b]))[:, None]
    points = grid[a] + share * (grid[b] - grid[a])
    found = index.reshape(-1, 3)
    return meshes.mesh(points, found[(found != np.roll(found, 1, axis=1)).all(axis=1)])


def gyroid(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    x, y, z = np.pi * x + 0.1, np.pi * y + 0.2, np.pi * z + 0.3
    return np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)


@pytest.mark.parametrize("size", [300, 3000, 20000])
@pytest.mark.parametrize("name", [name for name in names() if name not in CREASED])
def test_nothing_is_said_of_smooth_samples(name: str, size: int) -> None:
    parameters = {"size": size} if "size" in str(get(name).parameters) else {}
    if not parameters and size > 300:
        pytest.skip("has one size")
    assert said(meshes.of_sample(name, **parameters)) == {}


@pytest.mark.parametrize("name", sorted(CREASED))
def test_creased_samples_are_named(name: str) -> None:
    mesh = meshes.of_sample(name, size=3000)
    assert set(said(mesh)) == {"creased"}
    assert set(said(mesh, "K_density")) == {"creased"}
    assert said(mesh, ["K", "A", "H_vec", "theta"]) == {}


def test_parts_are_creased_and_balls_are_not() -> None:
    sharp = parts.ring(parts.filleted(parts.PROFILES["step"], 0, 6))
    count = said(sharp)["creased"].count
    assert count == len(parts.PROFILES["step"]) * 160
    assert said(parts.ring(parts.filleted(parts.PROFILES["step"], 3, 8))) == {}
    assert said(parts.rounded_box([20, 15, 10], 4, 8)) == {}


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize(
    ("name", "noise"), [("torus", 0.01), ("icosphere", 0.01), ("catenoid", 1e-3), ("saddle", 1e-3)]
)
def test_noise_is_recognised_without_a_scale(name: str, noise: float, scale: float) -> None:
    mesh = meshes.of_sample(name, size=3000)
    moved = mesh.points + noise * np.random.default_rng(3).standard_normal(mesh.points.shape)
    found = said(mesh.moved(scale * moved))
    assert set(found) == {"rough_energy"}
    assert "willmore_corrected" in str(found["rough_energy"].hint)
    assert set(said(mesh.moved(moved), "willmore")) == {"rough_energy"}
    assert said(mesh.moved(moved), ["K", "h"]) == {}


def test_level_sets_through_slivers() -> None:
    """The gyroid's level set is nearly minimal: stars see the steps of the grid, an estimate over 2 rings does not."""
    surface = tetrahedra(gyroid, 24)
    alone = said(surface)
    assert set(alone) == {"rough_energy"}
    both = curvcli.analyze((surface.points, surface.faces), ["willmore", "willmore_corrected"], rings=3)
    (told,) = (notice for notice in both.notices if notice.code == "rough_energy")
    assert "willmore_corrected = " in told.message
    assert both.totals["willmore"] > 10 * both.totals["willmore_corrected"]  # type: ignore[operator]


@pytest.mark.parametrize("single", [False, True])
def test_flat_plates_are_not_rough(single: bool) -> None:
    for seed in range(4):
        random = np.random.default_rng(seed)
        flat = meshes.grid(20, seed)
        points = flat.points * [1, 1, 0] @ np.linalg.qr(random.standard_normal((3, 3)))[0] + random.uniform(0, 50, 3)
        assert said(flat.moved(points.astype(np.float32).astype(np.float64) if single else points)) == {}


def energies(name: str, radius: str) -> set[str]:
    mesh = meshes.of_sample(name, size=3000)
    names = ["willmore", "willmore_ring", "willmore_corrected"]
    notices = curvcli.analyze((mesh.points, mesh.faces), names, radius=radius).notices
    (told,) = [notice.message for notice in notices if notice.code == "energy_at_scale"] or [""]
    return {name for name in names[1:] if f" {name}" in told.partition("(")[0]}


@pytest.mark.parametrize(
    "name", ["torus", "ellipsoid", "irregular_torus", "trefoil_tube", "unduloid", "saddle", "enneper"]
)
def test_energies_at_a_fine_scale_agree(name: str) -> None:
    assert energies(name, "2e") == set()


def test_a_scale_as_wide_as_the_tube_is_named() -> None:
    assert energies("trefoil_tube", "10e") == {"willmore_ring"}
    assert energies("ellipsoid", "10e") == set()


def test_no_estimate_anywhere_is_no_energy_of_0() -> None:
    torus = meshes.of_sample("torus", size=3000)
    found = curvcli.analyze((torus.points, torus.faces), ["h_fit", "willmore_fit"], radius="10e")
    assert np.isnan(found.vertices["h_fit"]).all()
    assert found.totals["willmore_fit"] is None

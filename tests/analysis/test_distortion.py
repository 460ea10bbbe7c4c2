"""The notice of distorted stars: the factor behind it on spheres, the stars it names, and meshes that it spares."""

from __future__ import annotations

import numpy as np
import pytest

import curvcli
from curvcli.errors import Notice
from tests.helpers import meshes
from tests.helpers.meshes import Mesh


def factor(mesh: Mesh) -> np.ndarray:
    """A°/A vertex by vertex: cotangents by the law of cosines."""
    points, faces = mesh.points, mesh.faces
    circumcentric, star = np.zeros(len(points)), np.zeros(len(points))
    for face in faces:
        p = points[face]
        double = np.linalg.norm(np.cross(p[1] - p[0], p[2] - p[0]))
        for k in range(3):
            i, j = (k + 1) % 3, (k + 2) % 3
            for one, other in ((i, j), (j, i)):  # the edge from corner k to `one`, by the angle at `other`
                cotangent = (p[k] - p[other]) @ (p[one] - p[other]) / double
                circumcentric[face[k]] += cotangent * ((p[one] - p[k]) @ (p[one] - p[k])) / 8
            star[face[k]] += double / 6
    return circumcentric / star


def shaken(part: float, size: int = 642) -> Mesh:
    """A sphere whose vertices are moved along it by up to a part of an edge."""
    sphere = meshes.of_sample("icosphere", size=size)
    edge = np.sqrt(8 * np.pi / np.sqrt(3) / size)
    moved = sphere.points + part * edge * np.random.default_rng(4).uniform(-1, 1, sphere.points.shape)
    return sphere.moved(moved / np.linalg.norm(moved, axis=1)[:, None])


def said(mesh: Mesh, passes: str = "core") -> list[Notice]:
    return [one for one in curvcli.analyze(mesh.surface(), passes).notices if one.code == "distorted_stars"]


@pytest.mark.parametrize("part", [0.0, 0.2, 0.35])
def test_densities_on_a_sphere_are_wrong_by_the_factor(part: float) -> None:
    """h/2 and K_density against A°/A, at second order in the edge."""
    gaps = []
    for size in (642, 2562):
        mesh = shaken(part, size)
        found, wanted = curvcli.analyze(mesh.surface(), "h_signed,K_density").vertices, factor(mesh)
        pairs = ((found["h_signed"] / 2, wanted), (found["K_density"], wanted))
        known = np.isfinite(found["h_signed"])
        gaps.append([np.median(np.abs(a[known] - b[known])) for a, b in pairs])
    assert max(gaps[1]) < 0.01
    assert all(coarse > 3 * fine for coarse, fine in zip(*gaps, strict=True))


def test_distorted_stars_are_counted_and_named() -> None:
    mesh = shaken(0.5)
    (notice,) = said(mesh)
    surface = mesh.surface()
    wrong = factor(mesh)
    K = np.abs(curvcli.passes.K(surface))
    K[~np.isfinite(curvcli.passes.h_signed(surface))] = 0
    beyond = ~((wrong >= 0.25) & (wrong <= 4)) & (K > 1e-12)
    assert notice.count == beyond.sum()
    assert list(notice.examples) == np.flatnonzero(beyond)[:5].tolist()
    assert f"{K[beyond].sum() / K.sum():.0%} of Σ|K|" in notice.message
    assert said(mesh, "K,A") == []
    for scale in (1e-9, 1e9):
        assert said(mesh.moved(mesh.points * scale)) == [notice]
    assert said(meshes.reversed_faces(mesh)) == [notice]


@pytest.mark.parametrize(
    "name",
    ["irregular_sphere", "irregular_torus", "torus", "cylinder", "uv_sphere", "schwarz_lantern", "saddle", "unduloid"],
)
def test_ordinary_meshes_have_none(name: str) -> None:
    assert said(meshes.of_sample(name)) == []


def test_a_flat_plate_has_none_however_thin_its_triangles() -> None:
    """Its K is the rounding of float32 coordinates."""
    rng = np.random.default_rng(2)
    plate = meshes.of_sample("plane", size=400)
    moved = plate.points * [1, 0.01, 1] + np.array([0.05, 0.0005, 0]) * rng.uniform(-1, 1, plate.points.shape)
    tilted = (moved @ meshes.rotation().T).astype(np.float32).astype(np.float64)
    assert np.abs(np.nan_to_num(curvcli.passes.K(plate.moved(tilted).surface()))).max() > 0
    assert said(plate.moved(tilted)) == []


def test_a_large_mesh_is_sampled_first() -> None:
    """Beyond 16,384 faces: distorted stars are found from a sample, and counted everywhere."""
    (notice,) = said(shaken(0.4, 20000))
    assert notice.count > 100
    assert said(shaken(0.2, 20000)) == []

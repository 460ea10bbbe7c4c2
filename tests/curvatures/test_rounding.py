"""Values within rounding are null: planes have no shape, doubled faces no constant mean curvature."""

from __future__ import annotations

import numpy as np
import pytest

import curvcli

FLAT = [[0, 1, 2], [0, 2, 3], [0, 3, 1]]


@pytest.mark.parametrize("seed", range(40))
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_planes_have_no_shape(seed: int, scale: float) -> None:
    random = np.random.default_rng(seed)
    angle = 2 * np.pi / 3 * (np.arange(3) + random.uniform(-0.2, 0.2, 3))
    rim = random.uniform(0.5, 1.5, 3)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    points = np.column_stack([np.vstack([np.zeros(2), rim]), np.zeros(4)]) * scale
    found = curvcli.analyze((points, FLAT), ["shape_index", "K"])
    assert abs(found.vertices["K"][0]) < 5e-15
    assert np.isnan(found.vertices["shape_index"]).all()


def test_cylinders_have_one() -> None:
    around, along = np.meshgrid(2 * np.pi * np.arange(24) / 24, np.arange(5) / 4, indexing="ij")
    points = np.column_stack([np.cos(around).ravel(), np.sin(around).ravel(), along.ravel()])
    corner = np.arange(24)[:, None] * 5 + np.arange(4)
    across = (corner + 5) % 120
    faces = np.concatenate([np.stack(t, axis=-1).reshape(-1, 3) for t in (
        (corner, across, across + 1), (corner, across + 1, corner + 1))])  # fmt: skip
    index = curvcli.analyze((points, faces), ["shape_index"]).vertices["shape_index"]
    inside = np.isin(np.arange(120) % 5, [1, 2, 3])
    np.testing.assert_allclose(index[inside], 0.5, atol=1e-6)
    assert np.isnan(index[~inside]).all()


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_a_doubled_triangle_has_no_mean_curvature_to_be_constant(seed: int, scale: float) -> None:
    points = np.random.default_rng(seed).normal(size=(3, 3)) * scale
    report = curvcli.analyze((points, [[0, 1, 2], [1, 0, 2]]), "paper").report()
    assert report["cmc"] == {"H": None, "residual_max": None, "residual_density_max": None}
    assert report["normals"] == {"angle_max": None, "angle_mean": None}


def test_vertices_without_a_mean_curvature_are_in_neither_sum() -> None:
    points = np.array([[1.1, 0.2, 0.3], [-1, 0.1, 0], [0.1, 1, 0], [0, -1, 0.1], [0.2, 0, 1], [0, 0, -1.3], [0, 0, 0]])
    points[6] = (points[0] + points[2]) / 2
    faces = [
        [0, 6, 4],
        [6, 2, 4],
        [0, 2, 6],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ]
    found = curvcli.analyze((points, faces), "paper")
    assert found.report()["topology"]["degenerate_faces"] == 1
    H_vec, A_vec = found.vertices["H_vec"], found.vertices["A_vec"]
    known = [row for row in range(7) if np.isfinite(H_vec[row]).all()]
    assert 0 < len(known) < 7
    A = found.vertices["A"]
    H = -sum(H_vec[p] @ A_vec[p] / A[p] for p in known) / sum(A_vec[p] @ A_vec[p] / A[p] for p in known)
    residual = max(np.linalg.norm(H_vec[row] + H * A_vec[row]) for row in known)
    density = max(np.linalg.norm(H_vec[row] + H * A_vec[row]) / A[row] for row in known)
    cmc = found.report()["cmc"]
    assert cmc["H"] == pytest.approx(H, rel=1e-13)
    assert cmc["residual_max"] == pytest.approx(residual, rel=1e-12)
    assert cmc["residual_density_max"] == pytest.approx(density, rel=1e-12)

"""K⁺ of wires and laths: stars so thin that rounding would decide which of their edges are extreme."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

import curvcli
from curvcli.errors import UsageError
from curvcli.samples import names
from tests.helpers import exact_cones, meshes
from tests.helpers.meshes import Mesh

Floats = NDArray[np.float64]
THIN = [1e-2, 1e-5, 1e-8]


@cache
def small(name: str) -> Mesh:
    for size in (40, 60, 100):
        try:
            return meshes.of_sample(name, size=size)
        except UsageError:
            continue
    return meshes.of_sample(name)


def assert_exact(given: Mesh, most: int = 40) -> None:
    """K⁺ of the first vertices that have it, against decisions in integers and angles of 50 digits."""
    surface = given.surface()
    found = np.asarray(curvcli.analyze(surface, "K_plus", checks=[]).vertices["K_plus"])
    edges = surface.edges
    for vertex in np.flatnonzero(np.isfinite(found))[:most].tolist():
        around = np.concatenate([edges.b[edges.a == vertex], edges.a[edges.b == vertex]])
        wanted = float(exact_cones.of_star(given.points[vertex], given.points[around]))
        assert abs(found[vertex] - wanted) <= 1e-14 * len(around), vertex


@pytest.mark.parametrize("name", names())
def test_samples_squeezed_to_wires_and_laths(name: str) -> None:
    given = small(name)
    for s in THIN:
        for squeeze in ([1, s, s], [1, s, s * s], [s, s * s, 1]):
            assert_exact(given.moved(given.points * np.array(squeeze)), most=12)


@pytest.mark.parametrize("s", THIN)
@pytest.mark.parametrize("name", ["irregular_torus", "torus", "irregular_ellipsoid", "genus_2", "klein_bottle"])
def test_wires_and_laths_in_any_position(name: str, s: float) -> None:
    """Turned, so that no scaling of the axes makes the star round again, and far from the origin."""
    given = small(name)
    for squeeze in ([1, s, s], [1, s, s * s]):
        turned = given.points * np.array(squeeze) @ meshes.rotation().T
        assert_exact(given.moved(turned))
        assert_exact(given.moved(turned + 3.0))


def test_the_positive_curvature_of_a_torus_squeezed_to_a_lath() -> None:
    """Two heights of the round torus, less and more: 4π to the thickness, where wrong decisions gave 8π."""
    torus = meshes.of_sample("irregular_torus", size=120)
    lath = torus.moved(torus.points * [1, 1e-5, 1e-10])
    total = curvcli.analyze(lath.surface(), "K_plus").totals["K_plus"]
    assert total == pytest.approx(4 * np.pi, abs=1e-4)
    assert_exact(lath, most=120)


@pytest.mark.parametrize("degree", [5, 12, 30, 90])
def test_thin_stars_of_many_edges(degree: int) -> None:
    """Random stars squeezed along random axes, and with repeated, opposite and coplanar edges."""
    rng = np.random.default_rng(degree)
    for height in (0.0, 1.0, 4.0):
        star = rng.normal(size=(degree, 3))
        star[:, 2] += height
        star[degree // 2] = 2 * star[0]
        star[degree // 2 + 1] = star[1] + star[2]
        if height == 0.0:
            star[degree - 1] = -0.5 * star[0]
        for s in THIN:
            for axes in (np.eye(3), meshes.rotation(degree)):
                thin = np.round(star * 2.0**20) / 2.0**20 * [1, s, s * s] @ axes
                found = curvcli.curvatures.kernels.normal_cones.normal_cone_areas(
                    np.ascontiguousarray(thin.T[:, :, None])
                )
                wanted = float(exact_cones.of_star(np.zeros(3), thin))
                assert abs(found[0] - wanted) <= 1e-14 * degree

"""Total absolute curvature against what the topology demands, of one-sided surfaces too."""

from __future__ import annotations

import numpy as np
import pytest

import curvcli
from curvcli.checks.base import Check
from curvcli.checks.catalogue import identities
from tests.helpers import meshes
from tests.helpers.meshes import Mesh, mesh

PROJECTIVE_PLANE = [
    *([0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5], [0, 5, 1]),
    *([1, 2, 4], [2, 3, 5], [3, 4, 1], [4, 5, 2], [5, 1, 3]),
]
"""With six vertices, each joined to all others: every star has the same hull, and the surface is tight."""


def absolute(given: Mesh) -> Check:
    found = curvcli.analyze((given.points, given.faces), ["K_plus"])
    return next(check for check in found.checks if (check.name, check.scope) == ("total_absolute_curvature", "whole"))


@pytest.mark.parametrize("seed", range(10))
def test_the_projective_plane_of_six_vertices_is_tight(seed: int) -> None:
    check = absolute(mesh(np.random.default_rng(seed).normal(size=(6, 3)), PROJECTIVE_PLANE))
    assert (check.status, check.expected) == ("pass", pytest.approx(6 * np.pi, rel=1e-15))
    assert check.value == pytest.approx(6 * np.pi, rel=1e-14)
    assert check.detail.startswith("tight")


@pytest.mark.parametrize(("name", "chi"), [("klein_bottle", 0), ("projective_plane", 1), ("torus", 0), ("genus_2", -2)])
def test_closed_surfaces_have_at_least_what_their_topology_demands(name: str, chi: int) -> None:
    body = meshes.of_sample(name, size=400)
    check = absolute(body)
    assert (check.status, check.expected) == ("pass", pytest.approx(2 * np.pi * (4 - chi), rel=1e-15))
    assert check.value >= check.expected - check.tolerance
    two = absolute(meshes.joined(body, meshes.tetrahedron().moved(meshes.tetrahedron().points + 50)))
    assert two.expected == pytest.approx(2 * np.pi * (4 - chi + 2), rel=1e-15)


def test_too_little_fails_on_one_sided_surfaces_too() -> None:
    surface = meshes.of_sample("klein_bottle", size=400).surface()
    K = curvcli.passes.K(surface)
    plus = curvcli.passes.absolute_curvature(surface)["K_plus"]
    rule = identities()["total_absolute_curvature"]
    for factor, status in ((1.0, "pass"), (0.1, "fail")):
        columns = {"K_plus": factor * plus, "K_minus": factor * plus - factor * K}
        assert rule.run(surface, surface.whole, columns)[0].status == status

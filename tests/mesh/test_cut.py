"""Invariants of cutting a surface: counts of a region are those of its own faces in the file."""

from __future__ import annotations

import numpy as np
import pytest

import curvcli
from tests.helpers import meshes

OCTAHEDRON = np.array([[1.1, 0.2, 0.3], [-1, 0.1, 0], [0.1, 1, 0], [0, -1, 0.1], [0.2, 0, 1], [0, 0, -1.3]])
FACES = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])


def topologies(points: np.ndarray, faces: np.ndarray, regions: list[int]) -> list[dict[str, object]]:
    report = curvcli.analyze((points, faces), "topology", regions=np.array(regions)).report()
    return [region["topology"] for region in report["regions"]]


def test_vertices_at_the_rim_of_two_regions_are_no_duplicates() -> None:
    found = topologies(OCTAHEDRON, FACES, [0, 0, 0, 0, 1, 1, 1, 1])
    assert [region["duplicate_vertices"] for region in found] == [0, 0]


def test_duplicates_of_the_file_are_those_of_the_region_that_has_them() -> None:
    points, faces = np.vstack([OCTAHEDRON, OCTAHEDRON[5]]), FACES.copy()
    faces[7, 2] = 6
    found = topologies(points, faces, [0, 0, 0, 0, 1, 1, 1, 1])
    assert [region["duplicate_vertices"] for region in found] == [0, 1]


@pytest.mark.parametrize("flipped", [0, 5])
def test_a_region_is_wound_as_the_file_winds_it(flipped: int) -> None:
    faces = FACES.copy()
    faces[flipped] = faces[flipped, ::-1]
    whole = curvcli.analyze((OCTAHEDRON, faces), "topology").report()["topology"]
    assert not whole["consistent_winding"]
    one = topologies(OCTAHEDRON, faces, [0] * 8)
    assert [region["consistent_winding"] for region in one] == [False]
    halves = topologies(OCTAHEDRON, faces, [0, 0, 0, 0, 1, 1, 1, 1])
    assert [region["consistent_winding"] for region in halves] == [flipped > 3, flipped < 4]
    alone = topologies(OCTAHEDRON, faces, [int(face == flipped) for face in range(8)])
    assert [region["consistent_winding"] for region in alone] == [True, True]


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_a_patch_without_volume_is_not_inside_out(seed: int, scale: float) -> None:
    points = np.random.default_rng(seed).normal(size=(3, 3)) * scale
    found = curvcli.Surface(points, [[0, 1, 2], [1, 0, 2]], orient="outward")
    assert not found.inside_out.any()
    assert found.orientation.face_sign is None


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_one_with_volume_is(scale: float, offset: float) -> None:
    given = meshes.torus()
    found = curvcli.Surface((given.points + offset) * scale, given.faces[:, ::-1])
    assert found.inside_out.all()

"""Bobenko's conformal energy is 0 on stars inscribed in spheres and never below."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from scipy.spatial import ConvexHull

import curvcli
from curvcli.samples.catalogue import specs
from tests.helpers.meshes import Mesh, fan, of_sample, rotation
from tests.helpers.strategies import any_mesh


def energies(body: Mesh) -> tuple[np.ndarray, float]:
    found = curvcli.analyze((body.points, body.faces), ["willmore_conformal"], checks=[])
    return found.vertices["willmore_conformal"], found.totals["willmore_conformal"]


def inscribed(seed: int, size: int) -> Mesh:
    """The hull of random points on a sphere somewhere."""
    random = np.random.default_rng(seed)
    points = random.normal(size=(size, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    return Mesh(points * random.uniform(0.1, 10) + random.normal(size=3), ConvexHull(points).simplices.astype(np.int32))


@pytest.mark.parametrize("seed", range(20))
def test_inscribed_polyhedra_have_none_and_never_less(seed: int) -> None:
    each, total = energies(inscribed(seed, 10 + 20 * seed))
    assert each.min() >= 0
    assert each.max() < 1e-6
    assert 0 <= total < 1e-6


@pytest.mark.parametrize("name", [spec.name for spec in specs()])
def test_no_sample_has_less(name: str) -> None:
    each, total = energies(of_sample(name))
    assert not (each < 0).any()
    assert total >= 0
    assert not np.signbit(each[~np.isnan(each)]).any()


@settings(max_examples=60)
@given(any_mesh())
def test_no_mesh_has_less(body: Mesh) -> None:
    each, total = energies(body)
    assert not (each < 0).any()
    assert not total < 0


@pytest.mark.parametrize("degree", [3, 4, 5, 6, 12, 100])
def test_flat_stars_have_none(degree: int) -> None:
    flat = fan(degree, rise=0.0)
    each, _ = energies(flat.moved(flat.points @ rotation(degree).T))
    assert 0 <= each[0] < 1e-12


def test_values_that_are_not_rounding_stay() -> None:
    """A saddle star: the closed polygon that its circles become under an inversion turns by more than 2π."""
    points = fan(6).points
    each, _ = energies(fan(6))
    there = points[1:] / (points[1:] ** 2).sum(axis=1)[:, None]
    edges = np.roll(there, -1, axis=0) - there
    before = np.roll(edges, 1, axis=0)
    turning = np.arctan2(np.linalg.norm(np.cross(before, edges), axis=1), (before * edges).sum(axis=1))
    assert each[0] == pytest.approx((turning.sum() - 2 * np.pi) / 2, rel=1e-12)
    assert each[0] > 0.1

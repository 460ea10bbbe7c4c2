"""The identities hold on every surface there is; where one does not apply, it says why."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings

import curvcli
from curvcli.api import Analysis
from curvcli.samples import get, names
from tests.helpers import exact_values, meshes, strategies
from tests.helpers.brute import Complex
from tests.helpers.meshes import Mesh

SCALES = [2.0**-600, 1e-9, 1.0, 1e9, 2.0**600]


def hold(result: Analysis) -> None:
    """No check fails, and those that do not apply say why."""
    assert result.checks
    for check in result.checks:
        assert check.status in ("pass", "not_applicable"), check
        assert check.detail, check
        if check.status == "not_applicable":
            assert (check.value, check.expected, check.residual, check.tolerance) == (None,) * 4
        else:
            assert check.residual is not None or check.tolerance is None
    assert result.passed


def gauss_bonnet_holds(result: Analysis, chi: int) -> None:
    """2πχ, summed here without rounding."""
    K, kappa_g = result.vertices["K"], result.vertices["kappa_g"]
    total = math.fsum(K[~np.isnan(K)]) + math.fsum(kappa_g[~np.isnan(kappa_g)])
    size = result.surface.n_faces + result.surface.n_vertices
    assert abs(total - 2 * math.pi * chi) <= 16 * 2.0**-52 * size
    assert not (~np.isnan(K) & ~np.isnan(kappa_g)).any()


@cache
def sample(name: str) -> Analysis:
    made = get(name)()
    return curvcli.analyze((made.points, made.faces), "all")


@pytest.mark.parametrize("name", names())
def test_identities_hold_on_every_sample(name: str) -> None:
    result = sample(name)
    hold(result)
    gauss_bonnet_holds(result, int(get(name)().facts["euler_characteristic"] or 0))
    by_name = {check.name: check for check in result.checks if check.scope == "whole"}
    assert {"gauss_bonnet", "area_gradient", "volume", "vector_area", "force_balance"} <= by_name.keys()
    facts = result.report()["topology"]
    assert (
        by_name["gauss_bonnet"].status == by_name["force_balance"].status == by_name["area_gradient"].status == "pass"
    )
    assert (by_name["volume"].status == "pass") == (facts["closed"] and facts["orientable"])
    assert (by_name["vector_area"].status == "pass") == facts["orientable"]


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("name", exact_values.NAMES)
def test_exact_meshes_at_every_scale(name: str, scale: float) -> None:
    surface = curvcli.load(exact_values.MESHES[name])
    result = curvcli.analyze((surface.points * scale, surface.faces), "all")
    hold(result)
    gauss_bonnet_holds(result, exact_values.expected(name)["topology"]["chi"])
    assert {check.scope for check in result.checks} >= {"whole"}


@pytest.mark.parametrize("offset", [0.0, 1e3, 1e6, 1e9, 1e12])
@pytest.mark.parametrize("name", meshes.ZOO)
def test_every_kind_of_surface_far_from_the_origin(name: str, offset: float) -> None:
    given = meshes.zoo(name)
    hold(curvcli.analyze(given.moved(given.points + offset * np.array([1.0, -0.7, 0.4])).surface(), "all"))


@settings(max_examples=150)
@given(strategies.any_mesh())
def test_identities_hold_on_random_meshes(given: Mesh) -> None:
    result = curvcli.analyze(given.surface(), "all")
    hold(result)
    gauss_bonnet_holds(result, Complex(given).facts()["euler_characteristic"])
    assert all(check.status == "pass" for check in result.checks if check.name == "gauss_bonnet")


@settings(max_examples=60)
@given(strategies.complexes())
def test_points_in_few_places(given: Mesh) -> None:
    """Corners that coincide, faces without area, needles: what is undefined is left out and said."""
    result = curvcli.analyze(given.moved(np.round(given.points)).surface(), "all")
    hold(result)


@settings(max_examples=40)
@given(strategies.any_mesh())
def test_sums_of_components_are_those_of_the_whole(given: Mesh) -> None:
    report = curvcli.analyze(given.surface(), "all").report()
    for key, total in report["totals"].items():
        each = [piece["totals"][key] for piece in report["components"]]
        if total is None or None in each or (isinstance(total, list) and None in total):
            continue
        parts = np.array(each, np.float64)
        size = max(np.abs(parts).sum(), 1e-3 * report["totals"]["area"], 1e-3)
        # Each piece's volume is taken about its own base.
        np.testing.assert_allclose(parts.sum(axis=0), total, rtol=1e-9, atol=1e-9 * size, err_msg=key)


def test_checks_are_made_for_every_component() -> None:
    result = curvcli.analyze(meshes.two_bodies().surface(), "all")
    scopes = {(check.name, check.scope) for check in result.checks}
    for name in {name for name, _ in scopes}:
        assert {(name, "whole"), (name, "component 0"), (name, "component 1")} <= scopes


def test_many_components_are_summed_up() -> None:
    """Beyond a hundred components a line per check stands for those that pass."""
    one = meshes.tetrahedron()
    count = 150
    points = np.concatenate([one.points + 10.0 * k for k in range(count)])
    faces = np.concatenate([one.faces + 4 * k for k in range(count)])
    result = curvcli.analyze((points, faces), "all")
    hold(result)
    scopes = [check.scope for check in result.checks if check.name == "gauss_bonnet"]
    assert scopes == ["whole", "components"]

"""Tolerances of checks: the error bounds of the sums they allow for, whatever the unit and the place."""

from __future__ import annotations

import math

import numpy as np
import pytest

import curvcli
from curvcli.checks.catalogue import identities
from curvcli.curvatures.catalogue import loaded
from curvcli.curvatures.engine import evaluate
from tests.helpers import meshes
from tests.helpers.analysed import sample

EPSILON = 2.0**-52


@pytest.mark.parametrize("name", ["ellipsoid", "cap", "two_bodies", "klein_bottle", "soup"])
def test_they_are_the_bounds_that_are_said(name: str) -> None:
    surface = meshes.zoo(name).surface()
    result = curvcli.analyze(surface, "all")
    tolerance = {check.name: check.tolerance for check in result.checks if check.scope == "whole"}
    faces, size = surface.n_faces, surface.n_faces + surface.n_vertices
    assert tolerance["gauss_bonnet"] == 16 * EPSILON * size
    assert tolerance["total_absolute_curvature"] in (None, 16 * EPSILON * size)
    growth = (16 + math.log2(3 * faces + surface.n_vertices)) * EPSILON
    p, q, r = (surface.points[surface.faces[:, k]] for k in range(3))
    half = sum(np.linalg.norm(b - a, axis=1) for a, b in ((p, q), (q, r), (r, p))) / 2
    forces = growth * 3 * half.sum()
    assert tolerance["force_balance"] == pytest.approx(forces, rel=1e-9)
    base = surface.points[surface.faces[0, 0]]
    arm = sum(np.linalg.norm(corner - base, axis=1) for corner in (p, q, r))
    for check in ("torque_balance", "position_balance", "area_gradient"):
        assert tolerance[check] == pytest.approx(growth * (half * arm).sum(), rel=1e-9)
    chi = result.report()["topology"]["euler_characteristic"]
    counted = np.abs(result.vertices["K_comb"]).sum() + 2 * math.pi * abs(chi)
    assert tolerance["gauss_bonnet_combinatorial"] == pytest.approx(growth * counted, rel=1e-9)


def test_less_absolute_curvature_than_there_must_be_is_noticed() -> None:
    """A torus of revolution is tight: a little less at one vertex is too little."""
    surface = sample("torus").surface
    rule = identities()["total_absolute_curvature"]
    found = evaluate(loaded(), surface, rule.needs)
    (check,) = rule.run(surface, surface.whole, found)
    assert (check.status, check.expected) == ("pass", pytest.approx(8 * math.pi))
    values = found["K_plus"].copy()
    values[values.argmax()] -= 1e-9
    (check,) = rule.run(surface, surface.whole, found | {"K_plus": values})
    assert check.status == "fail"
    assert check.residual == pytest.approx(1e-9, rel=1e-3)


def test_tolerances_follow_the_unit_and_not_the_place() -> None:
    """The allowed residual scales with the identity's sides; an offset does not widen it."""
    body = meshes.quantised(meshes.zoo("cap"))
    plain = curvcli.analyze(body.surface(), "all").checks
    large = curvcli.analyze(body.moved(body.points * 1024).surface(), "all").checks
    moved = curvcli.analyze(body.moved(body.points + 4096.0).surface(), "all").checks
    power = {"gauss_bonnet": 0, "gauss_bonnet_combinatorial": 0, "force_balance": 1, "torque_balance": 2}
    power |= {"position_balance": 2, "vector_area": 2, "area_gradient": 2}
    for one, two, three in zip(plain, large, moved, strict=True):
        if one.tolerance is None or one.name not in power:
            continue
        assert two.tolerance == one.tolerance * 1024 ** power[one.name]
        assert three.tolerance == one.tolerance
        assert three.residual == one.residual

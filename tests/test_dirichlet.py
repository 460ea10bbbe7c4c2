"""The identity as a map: its energy is the area, its gradient the gradient of the area, each by its own formula."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import curvcli
from curvcli.checks import Check, rules
from curvcli.cotangents import dirichlet
from curvcli.pipeline import evaluate
from curvcli.surface import Surface
from tests.meshes import ZOO, Mesh, zoo
from tests.strategies import any_mesh


def the_check(surface: Surface, **disturbed: object) -> Check:
    rule = rules["dirichlet"]
    columns = {**evaluate(surface, rule.needs), **disturbed}
    return rule.run(surface, surface.whole, columns)[0]


@pytest.mark.parametrize("name", [name for name in ZOO if name != "with_flat_face"])
def test_total_is_the_area(name: str) -> None:
    analysis = curvcli.analyze(zoo(name).surface(), "dirichlet")
    assert analysis.totals["dirichlet"] == pytest.approx(analysis.totals["area"], rel=1e-14)
    assert {check.status for check in analysis.checks if check.name == "dirichlet"} == {"pass"}


@given(any_mesh(), st.sampled_from([1e-9, 1.0, 1e9]), st.sampled_from([0.0, 1e6]))
def test_check_never_fails(mesh: Mesh, scale: float, offset: float) -> None:
    assert the_check(Surface((mesh.points + offset) * scale, mesh.faces)).status in ("pass", "not_applicable")


def test_right_isosceles_triangle() -> None:
    """Cotangents 0, 1, 1; legs 2, hypotenuse √8."""
    surface = Surface(np.array([[0.0, 0, 0], [2, 0, 0], [0, 2, 0]]), [[0, 1, 2]])
    found = dirichlet(surface, surface.xyz)
    assert found.energy.tolist() == [2.0]
    assert found.gradient.T.tolist() == [[-1, -1, 0], [1, 0, 0], [0, 1, 0]]
    # 1 and √2 are the cosecants.
    np.testing.assert_allclose(found.energy_terms, [(8 + 4 * np.sqrt(2) + 4 * np.sqrt(2)) / 4])
    np.testing.assert_allclose(found.gradient_terms, np.full(3, 2 * np.sqrt(2)))


def test_gradient_against_differences() -> None:
    surface = zoo("cap").surface()
    rng = np.random.default_rng(0)
    f, step = rng.normal(size=surface.xyz.shape), rng.normal(size=surface.xyz.shape)
    change = dirichlet(surface, f + step).energy.sum() - dirichlet(surface, f - step).energy.sum()
    # The energy is quadratic, so central differences are exact.
    assert change / 2 == pytest.approx(float((dirichlet(surface, f).gradient * step).sum()), rel=1e-12)


def test_degenerate_face_is_null() -> None:
    surface = zoo("with_flat_face").surface()
    columns = evaluate(surface, ["dirichlet", "dirichlet_gradient", "degenerate"])
    assert np.flatnonzero(np.isnan(columns["dirichlet"])).tolist() == [surface.n_faces - 1]
    assert (np.isnan(columns["dirichlet_gradient"][0]) == columns["degenerate"]).all()
    told = the_check(surface)
    assert told.status == "not_applicable"
    assert "degenerate" in told.detail


@pytest.mark.parametrize("value", [1e-12, np.nan])
def test_disturbed_values_are_caught(value: float) -> None:
    surface = zoo("torus").surface()
    columns = evaluate(surface, ["dirichlet", "dirichlet_gradient", "star_curvature"])
    assert the_check(surface).status == "pass"
    for name, array in columns.items():
        disturbed = array.copy()
        disturbed[(1, 7) if array.ndim == 2 else 7] += value
        assert the_check(surface, **{name: disturbed}).status == "fail", name

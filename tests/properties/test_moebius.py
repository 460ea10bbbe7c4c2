"""Möbius maps keep the conformal energy, vertex by vertex, and no other Willmore energy."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given as drawn
from hypothesis import strategies as st

import curvcli
from curvcli.api import Analysis
from tests.helpers import meshes
from tests.helpers.meshes import Floats, Mesh, of_sample

OTHERS = ("willmore", "willmore_hks", "willmore_perp", "willmore_normal")


def analyse(given: Mesh) -> Analysis:
    return curvcli.analyze((given.points, given.faces), [*OTHERS, "willmore_conformal"])


def energy(result: Analysis, name: str = "willmore_conformal") -> float:
    value = result.totals[name]
    assert isinstance(value, float)
    return value


def inverted(given: Mesh, centre: Floats, radius: float = 1.0) -> Mesh:
    """Every vertex moved along its ray from the centre, to the distance radius²/old distance; the centre comes to 0.

    So that what is far from the centre, and small afterwards, keeps its digits.
    """
    offset = given.points - centre
    return given.moved(radius**2 * offset / (offset**2).sum(axis=1)[:, None])


def bumpy() -> Mesh:
    """A sphere through random points, moved off it."""
    body = of_sample("irregular_sphere", size=300)
    x, y, z = body.points.T
    return body.moved(body.points * (1 + 0.2 * np.sin(3 * x + 1) * np.cos(2 * y) + 0.1 * z**2)[:, None])


BODIES = {
    "torus": of_sample("torus", size=400),
    "irregular_torus": of_sample("irregular_torus", size=300),
    "irregular_sphere": bumpy(),
    "klein_bottle": of_sample("klein_bottle", size=400),
    "mobius": meshes.mobius(),
    "cap": meshes.cap(),
    "genus_2": of_sample("genus_2", size=400),
    "two_bodies": meshes.two_bodies(),
}
CENTRES = {
    "outside": [3.0, -1.0, 2.0],
    "near": [0.2, 0.1, 0.15],
    "in the tube": [1.01, 0.02, 0.05],
    "far": [-40.0, 7.0, 90.0],
}


@pytest.mark.parametrize("centre", CENTRES)
@pytest.mark.parametrize("name", BODIES)
def test_inversion_keeps_the_conformal_energy(name: str, centre: str) -> None:
    body = BODIES[name]
    before, after = analyse(body), analyse(inverted(body, np.array(CENTRES[centre])))
    assert energy(before) > 0.1
    assert energy(after) == pytest.approx(energy(before), rel=1e-10)
    each = before.vertices["willmore_conformal"]
    np.testing.assert_allclose(after.vertices["willmore_conformal"], each, rtol=0, atol=1e-11)


@pytest.mark.parametrize("name", ["torus", "irregular_torus", "irregular_sphere", "klein_bottle"])
def test_other_energies_change(name: str) -> None:
    body = BODIES[name]
    before, after = analyse(body), analyse(inverted(body, np.array(CENTRES["outside"])))
    for other in OTHERS:
        assert abs(energy(after, other) / energy(before, other) - 1) > 1e-4, other


def test_a_sphere_stays_one() -> None:
    body = of_sample("irregular_sphere", size=400)
    for centre in CENTRES.values():
        assert abs(energy(analyse(inverted(body, np.array(centre))))) < 1e-10


@drawn(
    st.sampled_from(["torus", "irregular_sphere", "klein_bottle", "cap"]),
    st.tuples(*[st.floats(-3, 3)] * 3),
    st.floats(-3, 3),
)
def test_any_centre_and_radius(name: str, centre: tuple[float, ...], power: float) -> None:
    """Also twice in a row, which is a general Möbius map; from centres that are not too close to a vertex."""
    body = BODIES[name]
    first = inverted(body, kept_off(body, np.array(centre)), 10.0**power)
    second = inverted(first, first.points.mean(axis=0) + 3 * np.ptp(first.points), 1.0)
    wanted = energy(analyse(body))
    assert energy(analyse(first)) == pytest.approx(wanted, rel=1e-10)
    assert energy(analyse(second)) == pytest.approx(wanted, rel=1e-10)


def kept_off(body: Mesh, centre: Floats) -> Floats:
    """The centre, or where it is within a tenth of a vertex a point beside the body."""
    near = np.linalg.norm(body.points - centre, axis=1).min() < 0.1
    return body.points.max(axis=0) + 0.5 if near else centre


def test_the_inverted_torus_is_a_cyclide() -> None:
    """The catalogue's cyclide is that inversion of its Clifford torus: the same energy by another road."""
    torus, cyclide = (analyse(of_sample(name, size=600)) for name in ("clifford_torus", "cyclide"))
    assert energy(cyclide) == pytest.approx(energy(torus), rel=1e-11)

"""The identity as a map: its energy is the area, its gradient the gradient of the area, each by its own formula."""

from __future__ import annotations

import mpmath as mp  # type: ignore[import-untyped]
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import curvcli
from curvcli.checks.base import Check
from curvcli.checks.catalogue import identities
from curvcli.curvatures.catalogue import loaded
from curvcli.curvatures.engine import evaluate
from curvcli.curvatures.kernels.cotangents import dirichlet
from curvcli.mesh.surface import Surface
from tests.helpers.meshes import ZOO, Mesh, zoo
from tests.helpers.strategies import any_mesh


def the_check(surface: Surface, **disturbed: object) -> Check:
    rule = identities()["dirichlet"]
    columns = {**evaluate(loaded(), surface, rule.needs), **disturbed}
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
    columns = evaluate(loaded(), surface, ["dirichlet", "dirichlet_gradient", "degenerate"])
    assert np.flatnonzero(np.isnan(columns["dirichlet"])).tolist() == [surface.n_faces - 1]
    assert (np.isnan(columns["dirichlet_gradient"][0]) == columns["degenerate"]).all()
    told = the_check(surface)
    assert told.status == "not_applicable"
    assert "degenerate" in told.detail


@pytest.mark.parametrize("value", [1e-12, np.nan])
def test_disturbed_values_are_caught(value: float) -> None:
    surface = zoo("torus").surface()
    columns = evaluate(loaded(), surface, ["dirichlet", "dirichlet_gradient", "star_curvature"])
    assert the_check(surface).status == "pass"
    for name, array in columns.items():
        disturbed = array.copy()
        disturbed[(1, 7) if array.ndim == 2 else 7] += value
        assert the_check(surface, **{name: disturbed}).status == "fail", name


def exact_energy(face: np.ndarray, image: np.ndarray) -> mp.mpf:
    """¼ Σ cot θ |opposite edge of the image|², coordinates taken as exact, in 80 digits."""
    with mp.workdps(80):
        total = mp.mpf(0)
        for k in range(3):
            p, q, r = (mp.matrix([mp.mpf(float(x)) for x in face[(k + j) % 3]]) for j in range(3))
            edge = [mp.mpf(float(a)) - mp.mpf(float(b)) for a, b in zip(image[k - 2], image[k - 1], strict=True)]
            u, w = q - p, r - p
            cosine = mp.fsum(a * b for a, b in zip(u, w, strict=True))
            squares = [mp.fsum(a * a for a in x) for x in (u, w)]
            sine = mp.sqrt(squares[0] * squares[1] - cosine**2)
            total += cosine / sine * mp.fsum(a * a for a in edge) / 4
        return total


def thin_triangles(seed: int, count: int = 40) -> Mesh:
    """Needles and caps down to a height of 1e-13 of the length, each turned and moved somehow, that share no vertex."""
    random = np.random.default_rng(seed)
    points = []
    for _ in range(count):
        height, foot = 10 ** random.uniform(-13, 0), random.choice([0, 1, random.uniform(-1, 2)])
        triangle = np.array([[0, 0, 0], [1, 0, 0], [foot, height, 0]])[random.permutation(3)]
        q, _ = np.linalg.qr(random.normal(size=(3, 3)))
        points.append(triangle @ q.T * 10 ** random.uniform(-3, 3) + random.normal(size=3) * random.choice([0, 1e-3]))
    return Mesh(np.concatenate(points), np.arange(3 * count, dtype=np.int32).reshape(-1, 3))


@pytest.mark.parametrize("seed", range(4))
def test_energies_of_needles_to_the_last_digits(seed: int) -> None:
    body = thin_triangles(seed)
    analysis = curvcli.analyze(body.surface(), "dirichlet", checks=[])
    found = analysis.faces["dirichlet"]
    wanted = np.array([float(exact_energy(body.points[face], body.points[face])) for face in body.faces])
    kept = ~np.isnan(found)
    assert kept.sum() > 30
    np.testing.assert_allclose(found[kept], wanted[kept], rtol=2e-13)
    assert analysis.totals["dirichlet"] == pytest.approx(wanted[kept].sum(), rel=2e-13)


@pytest.mark.parametrize("seed", range(4))
def test_energies_and_gradients_of_maps_of_needles(seed: int) -> None:
    body = thin_triangles(seed)
    surface = body.surface()
    image = np.random.default_rng(seed).normal(size=body.points.shape)
    found = dirichlet(surface, np.ascontiguousarray(image.T))
    wanted = np.array([float(exact_energy(body.points[face], image[face])) for face in body.faces])
    kept = ~np.isnan(found.energy)
    np.testing.assert_allclose(found.energy[kept], wanted[kept], rtol=1e-13)
    # Euler: a quadratic form is half the sum of its variables times its derivatives.
    products = (found.gradient.T * image)[body.faces].sum(axis=(1, 2)) / 2
    size = (np.linalg.norm(found.gradient.T, axis=1) * np.linalg.norm(image, axis=1))[body.faces].sum(axis=1)
    assert (abs(products - wanted)[kept] <= 1e-13 * size[kept]).all()


def test_a_squeezed_torus_keeps_its_digits() -> None:
    body = zoo("torus")
    flat = body.moved(body.points * [1, 1e-4, 1e-8])
    analysis = curvcli.analyze(flat.surface(), "dirichlet", checks=[])
    np.testing.assert_allclose(analysis.faces["dirichlet"], analysis.faces["area"], rtol=1e-13)

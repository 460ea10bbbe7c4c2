"""Closed forms: what is known of smooth surfaces, how fast meshes approach it, and what they keep exactly."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given as drawn
from hypothesis import settings

from curvcli.api import Analysis
from tests.helpers import strategies
from tests.helpers.analysed import analyse, sample, total
from tests.helpers.meshes import Floats, Mesh

ENERGIES = ("willmore", "willmore_hks", "willmore_perp", "willmore_normal")
SIZES = (250, 1000, 4000)


def orders(errors: list[float], vertices: list[int]) -> list[float]:
    """Observed orders in the length of the edges, which falls with the root of the number of vertices."""
    pairs = itertools.pairwise(zip(errors, vertices, strict=True))
    return [2 * math.log(abs(e / f)) / math.log(m / n) for (e, n), (f, m) in pairs]


def second_order(name: str, key: str, limit: float) -> None:
    found = [sample(name, size=size) for size in SIZES]
    errors = [total(result, key) - limit for result in found]
    assert min(orders(errors, [result.surface.n_vertices for result in found])) >= 1.8
    assert abs(errors[-1]) < 5e-3 * limit


# ---------------------------------------------------------------------------- spheres


@pytest.mark.parametrize("energy", ENERGIES)
@pytest.mark.parametrize("name", ["icosphere", "uv_sphere"])
def test_energies_of_spheres(name: str, energy: str) -> None:
    second_order(name, energy, 16 * math.pi)


@pytest.mark.parametrize("seed", range(3))
def test_spheres_through_random_points(seed: int) -> None:
    """**H**·p = −2 A_voronoi at every vertex, to rounding: over Voronoi's cells the H² energy is four times the area.

    Over the thirds of the faces it is larger by Cauchy's inequality, and stays so under refinement.
    """
    found = [sample("irregular_sphere", size=size, seed=seed) for size in SIZES]
    excess = []
    for result in found:
        column, area = result.vertices, total(result, "area")
        radial = (column["H_vec"] * result.surface.points).sum(axis=1)
        np.testing.assert_allclose(radial, -2 * column["A_voronoi"], rtol=0, atol=1e-12)
        assert math.fsum(radial**2 / column["A_voronoi"]) == pytest.approx(4 * area, rel=1e-12)
        excess.append(total(result, "willmore_hks") / (4 * area) - 1)
    errors = [4 * total(result, "area") - 16 * math.pi for result in found]
    assert min(orders(errors, [result.surface.n_vertices for result in found])) > 1.7
    assert min(excess) > 0.05


@pytest.mark.parametrize("name", ["icosphere", "uv_sphere", "irregular_sphere"])
def test_no_conformal_energy_on_a_sphere(name: str) -> None:
    result = sample(name, size=1000)
    np.testing.assert_allclose(result.vertices["willmore_conformal"], 0, rtol=0, atol=1e-12)
    assert abs(total(result, "willmore_conformal")) < 1e-11


@pytest.mark.parametrize("name", ["ellipsoid", "irregular_ellipsoid", "cube"])
def test_conformal_energy_is_positive_off_the_sphere(name: str) -> None:
    """Except on the cube, whose corners lie on a sphere."""
    result = sample(name)
    assert (result.vertices["willmore_conformal"] > -1e-13).all()
    assert (total(result, "willmore_conformal") > 1e-3) == (name != "cube")


@pytest.mark.parametrize("energy", ENERGIES)
def test_energies_of_the_clifford_torus(energy: str) -> None:
    second_order("clifford_torus", energy, 8 * math.pi**2)


def test_conformal_energy_along_lines_of_curvature() -> None:
    """¼ ∫ (κ₁ − κ₂)² = ¼ 8π² where the edges follow the lines of curvature."""
    second_order("clifford_torus", "willmore_conformal", 2 * math.pi**2)


@settings(max_examples=60)
@drawn(strategies.any_mesh())
def test_energies_are_in_order(given: Mesh) -> None:
    """Σ|H|²/A ≤ Σh²A as |**A**| ≤ A, and h_perp ≤ h ≤ h_normal as **H** and **A** are at an angle."""
    column = analyse(given).vertices
    hks, perp, plain, normal = (
        column[name] for name in ("willmore_hks", "willmore_perp", "willmore", "willmore_normal")
    )
    for low, high in ((hks, plain), (perp, plain), (plain, normal)):
        both = ~np.isnan(low) & ~np.isnan(high)
        assert (low[both] <= high[both] * (1 + 1e-12) + 1e-300).all()


# ---------------------------------------------------------------------------- bending


def folded(strip: Analysis, turn: Floats) -> Mesh:
    """The strip bent about its rulings by the given angles, every row as far from the next as before; 0 is flat."""
    points = strip.surface.points
    row = np.unique(points[:, [0, 2]], axis=0, return_inverse=True)[1]
    order = np.unique(row, return_index=True)[1]
    rank = np.argsort(np.argsort(order))[row]
    line = points[np.sort(order)][:, [0, 2]]
    steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
    heading = np.concatenate([[0.0], np.cumsum(np.resize(turn, len(steps) - 1))])
    moved = np.concatenate(
        [np.zeros((1, 2)), np.cumsum(steps[:, None] * np.stack([np.cos(heading), np.sin(heading)], 1), 0)]
    )
    bent = np.stack([moved[rank, 0], points[:, 1], moved[rank, 1]], axis=1)
    return Mesh(bent, strip.surface.faces)


@pytest.mark.parametrize("turn", [[0.0], [0.05], [0.3, -0.3], np.random.default_rng(0).uniform(-2, 2, 99)])
def test_bending_a_strip_keeps_what_is_intrinsic(turn: Floats) -> None:
    strip = sample("developable_strip", size=600)
    bent = analyse(folded(strip, np.asarray(turn)))
    np.testing.assert_allclose(bent.edges["length"], strip.edges["length"], rtol=1e-13)
    for name, digits in (("K", 5e-14), ("kappa_g", 5e-14), ("A", 1e-14), ("A_mixed", 1e-14), ("A_voronoi", 1e-13)):
        np.testing.assert_allclose(bent.vertices[name], strip.vertices[name], rtol=0, atol=digits, err_msg=name)
    assert total(bent, "area") == pytest.approx(total(strip, "area"), rel=1e-13)
    assert np.nanmax(np.abs(bent.vertices["K"])) < 5e-14
    assert abs(total(bent, "willmore") - total(strip, "willmore")) > 0.1


# ---------------------------------------------------------------------------- revolution


@pytest.mark.parametrize("height", [0.1, 1.0, 10.0])
def test_apex_of_a_cone(height: float) -> None:
    """The mesh's own angle defect exactly, and 2π(1 − sin of half the opening angle) in the limit."""
    limit = 2 * math.pi * (1 - 1 / math.hypot(1.0, height))
    errors, sides = [], []
    for size in SIZES:
        result = sample("cone", size=size, height=height)
        apex = int(result.surface.points[:, 2].argmax())
        n = int(result.vertices["degree"][apex])
        slant = math.hypot(1.0, height)
        exact = 2 * math.pi - 2 * n * math.asin(math.sin(math.pi / n) / slant)
        assert result.vertices["K"][apex] == pytest.approx(exact, abs=1e-13)
        others = np.delete(result.vertices["K"], apex)
        assert np.nanmax(np.abs(others)) < 2e-13
        errors.append(exact - limit)
        sides.append(n**2)
    assert min(orders(errors, sides)) >= 1.8


def test_a_cylinder_has_its_mean_curvature_for_any_n() -> None:
    """n sides: ΣH_theta = 2π·height whatever n, and **H** = −h **A** with the same h everywhere."""
    result = sample("cylinder", size=800, radius=0.5, height=3.0)
    points = result.surface.points
    n = len(np.unique(np.round(np.arctan2(points[:, 1], points[:, 0]), 9)))
    assert total(result, "H_theta") == pytest.approx(2 * math.pi * 3.0, rel=1e-14)
    report = result.report()
    # H_sin = 2 sin(π/n) per length of a ruling, over a width of 2 · radius · sin(π/n) · cos(π/n) along the mean normal.
    assert report["cmc"]["H"] == pytest.approx(1 / (0.5 * math.cos(math.pi / n)), rel=1e-12)
    assert report["cmc"]["residual_max"] < 1e-15
    assert report["normals"]["angle_max"] < 1e-13


def test_the_lantern_keeps_its_identities() -> None:
    """Its area grows beyond that of the cylinder with the folding, while K = 0 and every identity holds."""
    areas = []
    for folding in (0.1, 1.0, 4.0, 16.0):
        result = sample("schwarz_lantern", size=3000, folding=folding)
        assert result.passed
        assert abs(total(result, "K")) + abs(total(result, "kappa_g")) < 1e-10
        limit = 2 * math.pi * math.hypot(2.0, math.pi**2 * folding / 2)
        assert total(result, "area") == pytest.approx(limit, rel=0.1)
        areas.append(total(result, "area") / (4 * math.pi))
    assert areas[0] < 1.1
    assert areas[-1] > 20
    assert areas == sorted(areas)


# ---------------------------------------------------------------------------- constant mean curvature, none, one side


def bending(name: str, size: int) -> dict[str, float]:
    report = sample(name, size=size).report()
    found: dict[str, float] = report["cmc"] | report["minimal"]
    return found


@pytest.mark.parametrize(
    ("name", "mean"), [("unduloid", 2 / 1.4), ("nodoid", 2 / 0.6), ("icosphere", 2.0), ("cylinder", 1.0)]
)
def test_constant_mean_curvature(name: str, mean: float) -> None:
    found = [bending(name, size) for size in SIZES]
    errors = [abs(one["H"] / mean - 1) for one in found]
    assert errors[2] < 0.35 * errors[1] < 0.35**2 * errors[0]
    assert errors[2] < 5e-3
    assert found[2]["residual_max"] < 0.1 * found[2]["H_vec_max"]


@pytest.mark.parametrize("name", ["catenoid", "helicoid", "enneper", "scherk"])
def test_minimal_surfaces_bend_less_with_finer_faces(name: str) -> None:
    largest = [bending(name, size)["H_vec_max"] for size in SIZES]
    assert largest[2] < 0.3 * largest[1] < 0.3**2 * largest[0]
    energy = [total(sample(name, size=size), "willmore") for size in SIZES]
    assert energy[2] < 0.3 * energy[1] < 0.3**2 * energy[0]


ODD = ("volume", "A_vec", "H_theta", "H_sin", "H_tan")


@pytest.mark.parametrize(
    ("name", "chi", "crosscaps"), [("klein_bottle", 0, 2), ("projective_plane", 1, 1), ("mobius", 0, 1)]
)
def test_one_sided_surfaces(name: str, chi: int, crosscaps: int) -> None:
    result = sample(name)
    report = result.report()
    topology, totals = report["topology"], report["totals"]
    assert (topology["euler_characteristic"], topology["crosscaps"], topology["genus"]) == (chi, crosscaps, None)
    assert totals["K"] + totals["kappa_g"] == pytest.approx(2 * math.pi * chi, abs=1e-11)
    for key in ODD:
        assert totals[key] in (None, [None] * 3), key
    assert report["cmc"] == {"H": None, "residual_max": None, "residual_density_max": None}
    assert report["steiner"] == {"coefficients": None, "convex": False}
    for name in ("h_signed", "h_perp", "h_normal", "kappa_1", "kappa_2", "shape_index", "dir_1", "A_vec"):
        assert np.isnan(result.vertices[name]).all(), name
    inside = result.vertices["status"] == "interior"
    for name in ("K", "h", "K_plus", "K_minus", "curvedness", *ENERGIES[:3], "willmore_conformal"):
        assert np.isfinite(result.vertices[name][inside]).all(), name
    assert all(totals[energy] > 0 for energy in (*ENERGIES, "willmore_conformal"))
    assert report["minimal"]["H_vec_max"] > 0

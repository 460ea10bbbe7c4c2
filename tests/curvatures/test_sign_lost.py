"""The sign of H where H_vec and A_vec are at right angles: null instead of rounding, however the faces are wound."""

from __future__ import annotations

import numpy as np
import pytest

import curvcli
from tests.helpers import meshes
from tests.helpers.meshes import Mesh, mesh, of_sample, reversed_faces, rotation

SIGNED = ("h_signed", "kappa_1", "kappa_2", "shape_index")
KEPT = ("h", "curvedness", "h_perp", "willmore", "willmore_hks", "kappa_max")


def rolled(given: Mesh, seed: int) -> Mesh:
    """Every face begun with another of its corners, and in another order."""
    random = np.random.default_rng(seed)
    turn = random.integers(3, size=len(given.faces))
    faces = np.take_along_axis(given.faces, (np.arange(3) + turn[:, None]) % 3, axis=1)
    return given.with_faces(random.permutation(faces))


def folded(seed: int, n: int = 8) -> Mesh:
    """A square sheet of irregular triangles folded flat onto itself along several lines, in a plane turned somehow."""
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0), indexing="ij")
    sheet = meshes.grid(n).points
    sheet[:, 1:] = 0
    sheet[:, 1] = y.ravel() + 0.2 * random.uniform(-1, 1, (n + 1) ** 2)
    sheet[:, 0] = x.ravel()  # folds run along the lines of equal x
    height = sheet[:, 0] % 4
    sheet[:, 0] = np.minimum(height, 4 - height) * random.uniform(0.5, 2)
    return meshes.grid(n).moved(sheet @ rotation(seed).T)


def columns(body: Mesh) -> dict[str, np.ndarray]:
    found = curvcli.analyze((body.points, body.faces), [*SIGNED, *KEPT, "h_normal", "H_vec", "A_vec"], checks=[])
    return {name: found.vertices[name] for name in (*SIGNED, *KEPT, "h_normal", "H_vec", "A_vec")}


@pytest.mark.parametrize("seed", range(8))
def test_rolling_the_corners_of_a_folded_sheet_flips_no_sign(seed: int) -> None:
    sheet = folded(seed)
    first = columns(sheet)
    large = first["h"] > 1e-9 * np.nanmax(first["h"])
    assert large.sum() >= 7
    for name in SIGNED:
        assert np.isnan(first[name][large]).all(), name
    for name in KEPT:
        assert np.isfinite(first[name][large]).all(), name
    assert np.nanmax(abs(first["h_perp"])) < 1e-12 * np.nanmax(first["h"])
    for again in range(5):
        other = columns(rolled(sheet, again))
        for name in (*SIGNED, *KEPT):
            np.testing.assert_array_equal(np.isnan(other[name]), np.isnan(first[name]), err_msg=name)
            scale = max(np.nanmax(first["h"]), 1.0)
            if name != "shape_index":
                np.testing.assert_allclose(other[name], first[name], rtol=1e-12, atol=1e-7 * scale, err_msg=name)
        np.testing.assert_array_equal(np.sign(other["h_signed"]), np.sign(first["h_signed"]))


@pytest.mark.parametrize("size", [100, 1000])
def test_a_symmetric_saddle_has_no_sign_where_its_normals_are_at_right_angles(size: int) -> None:
    body = of_sample("monkey_saddle", size=size)
    found = columns(body)
    product = np.abs((found["H_vec"] * found["A_vec"]).sum(axis=1))
    lengths = np.linalg.norm(found["H_vec"], axis=1) * np.linalg.norm(found["A_vec"], axis=1)
    square = ~np.isnan(found["h"]) & (product < 1e-12 * lengths)
    assert square.sum() > 5
    for name in SIGNED:
        assert np.isnan(found[name][square]).all()
    known = ~np.isnan(found["h_signed"])
    assert known.sum() > 0.7 * (~np.isnan(found["h"])).sum()
    np.testing.assert_allclose(abs(found["h_signed"][known]), found["h"][known], atol=1e-12)
    np.testing.assert_allclose(found["h_perp"][square], 0, atol=1e-12)
    again = columns(rolled(body, 1))
    np.testing.assert_array_equal(np.isnan(again["h_signed"]), ~known)
    np.testing.assert_allclose(again["h_signed"], found["h_signed"], rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("name", ["plane", "disk", "annulus"])
@pytest.mark.parametrize("turn", [None, 3])
def test_flat_surfaces_have_a_mean_curvature_of_zero(name: str, turn: int | None) -> None:
    """H that is rounding is 0, and not null for having no sign, in the plane of the axes and in others."""
    body = of_sample(name, size=400)
    if turn is not None:
        body = body.moved(body.points @ rotation(turn).T)
    found = columns(body)
    for column in ("h_signed", "kappa_1", "kappa_2"):
        np.testing.assert_array_equal(np.isnan(found[column]), np.isnan(found["h"]))
    np.testing.assert_allclose(found["h_signed"][~np.isnan(found["h"])], 0, atol=1e-11)
    again = columns(rolled(body, 1))
    np.testing.assert_array_equal(np.sign(again["h_signed"]), np.sign(found["h_signed"]))


def test_no_mean_curvature_at_all_is_a_mean_curvature_of_zero() -> None:
    star = mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]], [
        [0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])  # fmt: skip
    found = columns(star)
    assert found["h_signed"][0] == found["h"][0] == 0
    assert found["kappa_1"][0] == found["kappa_2"][0] == 0


@pytest.mark.parametrize("name", ["torus", "ellipsoid", "cap", "grid"])
def test_elsewhere_nothing_is_lost_and_reversal_changes_the_sign(name: str) -> None:
    body = meshes.zoo(name)
    found, back = columns(body), columns(reversed_faces(body))
    np.testing.assert_array_equal(np.isnan(found["h_signed"]), np.isnan(found["h"]))
    np.testing.assert_array_equal(abs(found["h_signed"]), found["h"])
    np.testing.assert_allclose(back["h_signed"], -found["h_signed"], rtol=1e-12)


@pytest.mark.parametrize("scale", [2.0**-60, 1.0, 2.0**60])
@pytest.mark.parametrize(("cosine", "lost"), [(0.9e-12, True), (-0.9e-12, True), (1.1e-12, False), (-1.1e-12, False)])
def test_where_the_sign_is_lost(cosine: float, lost: bool, scale: float) -> None:
    ones, none = np.ones(3), np.zeros(3, bool)
    H_vec, A_vec = scale * np.outer([3.0, 0, 0], ones), np.outer([cosine, 1, 0], ones)
    found = curvcli.passes.h_signed.compute(none, 3 * scale * ones, H_vec, A_vec, 1e-6 * scale * ones)
    np.testing.assert_array_equal(found, np.full(3, np.nan if lost else -3 * scale * np.sign(cosine)))


@pytest.mark.parametrize("seed", range(4))
def test_sums_over_rings_of_a_folded_sheet(seed: int) -> None:
    sheet = folded(seed, 12)
    runs = [
        curvcli.analyze((body.points, body.faces), ["h_ring"], rings=1, checks=[]).vertices["h_ring"]
        for body in (sheet, rolled(sheet, 1), rolled(sheet, 2))
    ]
    known = ~np.isnan(runs[0])
    for other in runs[1:]:
        np.testing.assert_array_equal(~np.isnan(other), known)
        np.testing.assert_allclose(other[known], runs[0][known], atol=1e-10)
    flat = of_sample("plane", size=400)
    found = curvcli.analyze((flat.points, flat.faces), ["h_ring", "h"], rings=1, checks=[]).vertices
    np.testing.assert_array_equal(np.isnan(found["h_ring"]), np.isnan(found["h"]))

"""Shape indices, curvednesses and Willmore energies of stars and at a scale; what is said where a scale is missed."""

from __future__ import annotations

import numpy as np
import pytest

import curvcli
from tests.helpers import meshes
from tests.helpers.meshes import Mesh

SUFFIXES = ("ring", "corrected", "fit")


def rough_ball(seed: int, radius: float, noise: float) -> Mesh:
    """An icosphere whose vertices are moved along its normals."""
    ball = meshes.of_sample("icosphere", size=2562)
    random = np.random.default_rng(seed)
    unit = ball.points / np.linalg.norm(ball.points, axis=1)[:, None]
    return Mesh(radius * unit * (1 + noise * random.standard_normal(len(unit)))[:, None], ball.faces)


def inside_out(mesh: Mesh) -> Mesh:
    return Mesh(mesh.points, np.asarray(mesh.faces)[:, ::-1])


@pytest.mark.parametrize("side", [1, -1])
def test_umbilics_are_caps_or_cups(side: int) -> None:
    """Both curvatures are H/2 where H² < 4K."""
    convex = meshes.ellipsoid() if side > 0 else inside_out(meshes.ellipsoid())
    found = curvcli.analyze(convex.surface(), ["kappa_1", "kappa_2", "shape_index"])
    equal = found.vertices["kappa_1"] == found.vertices["kappa_2"]
    assert 0 < equal.sum() < len(equal)
    np.testing.assert_array_equal(found.vertices["shape_index"][equal], float(side))
    assert np.isfinite(found.vertices["shape_index"]).all()


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_a_rough_ball_is_a_cap_at_a_scale(suffix: str, scale: float) -> None:
    ball = rough_ball(1, scale, 0.004)
    names = [f"{name}_{suffix}" for name in ("shape_index", "curvedness", "willmore")]
    found = curvcli.analyze(ball.surface(), ["shape_index", "willmore", *names], radius="8e")
    assert np.median(found.vertices["shape_index"]) < 0.8
    assert np.median(found.vertices[names[0]]) > 0.9
    assert np.median(found.vertices[names[1]]) * scale == pytest.approx(1, rel=0.1)
    assert found.totals["willmore"] > 2 * 16 * np.pi
    assert found.totals[f"willmore_{suffix}"] == pytest.approx(16 * np.pi, rel=0.1)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_shape_and_curvedness_are_koenderinks(suffix: str) -> None:
    found = curvcli.analyze(meshes.of_sample("irregular_torus", size=800).surface(), "all", rings=3).vertices
    larger, smaller = found[f"kappa_1_{suffix}"], found[f"kappa_2_{suffix}"]
    wanted = 2 / np.pi * np.arctan((larger + smaller) / (larger - smaller))
    np.testing.assert_allclose(found[f"shape_index_{suffix}"], wanted, rtol=1e-12)
    np.testing.assert_allclose(found[f"curvedness_{suffix}"], np.sqrt((larger**2 + smaller**2) / 2), rtol=1e-12)
    np.testing.assert_allclose(found[f"willmore_{suffix}"], found[f"h_{suffix}"] ** 2 * found["A"], rtol=1e-12)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("shift", [0.0, 1e5])
def test_a_turned_plane_has_no_shape_at_any_scale(seed: int, scale: float, shift: float) -> None:
    random = np.random.default_rng(seed)
    x, y = (each.ravel() for each in np.meshgrid(np.arange(12.0), np.arange(12.0), indexing="ij"))
    flat = np.column_stack([x, y, 0 * x]) + np.column_stack([*random.uniform(-0.3, 0.3, (2, 144)), 0 * x])
    turned = (flat + shift) @ np.linalg.qr(random.standard_normal((3, 3)))[0] * scale
    corner = (12 * np.arange(11)[:, None] + np.arange(11)).ravel()
    faces = np.concatenate(
        [np.stack([corner, corner + 12, corner + 13], 1), np.stack([corner, corner + 13, corner + 1], 1)]
    )
    found = curvcli.analyze((turned, faces), "all")
    for name in ("shape_index", *(f"shape_index_{suffix}" for suffix in SUFFIXES)):
        assert np.isnan(found.vertices[name]).all(), name
    assert "clamped_radicand" not in {notice.code for notice in found.notices}


def test_energies_are_null_on_the_boundary_and_where_there_is_no_orientation() -> None:
    cap = meshes.cap().surface()
    found = curvcli.analyze(cap, "estimates").vertices
    for suffix in SUFFIXES:
        assert (np.isnan(found[f"willmore_{suffix}"]) >= cap.boundary).all()
        assert np.isfinite(found[f"willmore_{suffix}"]).any()
    band = curvcli.analyze(meshes.of_sample("mobius", size=300).surface(), "estimates")
    for suffix in SUFFIXES:
        assert np.isnan(band.vertices[f"shape_index_{suffix}"]).all()


def test_of_several_scales_each_has_its_total() -> None:
    surface = meshes.of_sample("irregular_sphere", size=600).surface()
    both = curvcli.analyze(surface, ["willmore_corrected", "willmore"], radius="2e,4e").totals
    assert {key for key in both if "willmore_" in key} == {"willmore_corrected_2e", "willmore_corrected_4e"}
    for scale in ("2e", "4e"):
        alone = curvcli.analyze(surface, "willmore_corrected", radius=scale).totals["willmore_corrected"]
        assert both[f"willmore_corrected_{scale}"] == alone
    assert both["willmore"] == curvcli.analyze(surface, "willmore").totals["willmore"]


@pytest.mark.parametrize(
    ("names", "missed"),
    [
        (["shape_index"], "shape_index"),
        (["K_density", "h", "kappa_1", "K_ring"], "h, kappa_1"),
        (["willmore", "curvedness"], "curvedness, willmore"),
        (["shape_index", "shape_index_corrected"], None),
        (["core", "estimates"], None),
        (["K", "A", "H_vec"], None),
        (None, None),
    ],
)
def test_a_scale_that_does_not_apply_is_named(names: list[str] | None, missed: str | None) -> None:
    surface = meshes.cap().surface()
    found = {notice.code: notice for notice in curvcli.analyze(surface, names, radius="3e").notices}
    assert ("not_at_scale" in found) == (missed is not None)
    if missed is not None:
        assert found["not_at_scale"].message.endswith(f"(radius of 3 mean edge lengths): {missed}")
        assert "_corrected" in str(found["not_at_scale"].hint)
    assert "not_at_scale" not in {notice.code for notice in curvcli.analyze(surface, names).notices}


@pytest.mark.parametrize("name", ["book", "pinched", "mobius"])
def test_columns_of_stars_do_not_depend_on_the_number_of_scales(name: str) -> None:
    """At vertices of several fans too, where estimates are null."""
    mesh = meshes.of_sample(name)
    columns = ["K", "A", "H_vec", "willmore", "K_ring"]
    single, several = (curvcli.analyze(mesh.surface(), columns, rings=rings) for rings in (1, [1, 3]))
    for column in ("K", "A", "H_vec", "willmore"):
        np.testing.assert_array_equal(several.vertices[column], single.vertices[column])
    np.testing.assert_array_equal(several.vertices["K_ring_1rings"], single.vertices["K_ring"])
    assert {check.name: check.status for check in several.checks} == {c.name: c.status for c in single.checks}

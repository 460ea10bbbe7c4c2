"""The table of loops against exact values, and curves on surfaces against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings

from curvcli import analyze, load
from curvcli.checks.catalogue import identities
from curvcli.curves import Turning, boundary_loops, loop_table
from curvcli.curves.darboux import Darboux
from tests.helpers import meshes, strategies
from tests.helpers.exact_values import MESHES, expected
from tests.helpers.meshes import Mesh, mesh, of_sample

WITH_LOOPS = [name for name in MESHES if expected(name)["loops"]]

NUMBERS = {
    "length": "length",
    "total_curvature": "total_curvature",
    "sum_kappa_g": "total_geodesic_curvature",
    "holonomy": "normal_holonomy",
    "writhe": "writhe_turns",
    "twist": "darboux_twist",
    "linking": "darboux_linking",
}
VECTORS = {"vector_area": "vector_area", "force": "conormal_force", "torque": "conormal_torque"}


def test_there_are_exact_loops() -> None:
    assert {"annulus", "disk", "mobius", "catenoid_minimal"} <= set(WITH_LOOPS)


@pytest.mark.parametrize("name", MESHES)
def test_the_table_of_loops_has_the_exact_values(name: str) -> None:
    surface = load(MESHES[name])
    known = expected(name)["loops"]
    boundary, table = boundary_loops(surface), loop_table(surface)
    assert len(table["loop"]) == len(known)
    turning, darboux = Turning(boundary.curves), Darboux(boundary)
    for i, loop in enumerate(known):
        rows = slice(boundary.start[i], boundary.start[i + 1])
        corners = boundary.vertex[rows].tolist()
        backwards = corners != loop["vertices"]
        if backwards:
            assert not expected(name)["topology"]["orientable"]
            corners = corners[:1] + corners[:0:-1]
        assert corners == loop["vertices"]
        order = [0, *range(len(corners) - 1, 0, -1)] if backwards else slice(None)
        np.testing.assert_allclose(turning.angle[rows][order], loop["turning_angles"], atol=5e-14)
        np.testing.assert_allclose(darboux.kappa_g[rows][order], loop["geodesic_curvature"], atol=5e-14)
        for ours, theirs in NUMBERS.items():
            assert table[ours][i] == pytest.approx(loop[theirs], abs=1e-12), ours
        for ours, theirs in VECTORS.items():
            found = np.array([table[f"{ours}_{axis}"][i] for axis in "xyz"])
            sign = -1 if backwards and ours == "vector_area" else 1
            np.testing.assert_allclose(sign * found, loop[theirs], atol=1e-12, err_msg=ours)


def test_writhe_is_left_out_of_large_tables() -> None:
    surface = load(MESHES["disk"])
    table = loop_table(surface, max_writhe=35)
    assert np.isnan(table["writhe"][0])
    assert np.ma.getmaskarray(table["linking"])[0]
    assert loop_table(surface, max_writhe=36)["linking"][0] == 0


@pytest.mark.parametrize(("scale", "offset"), [(1e-9, 0.0), (1e9, 0.0), (1.0, 1e6), (1e-150, 0.0), (1e130, 0.0)])
def test_scale_and_place(scale: float, offset: float) -> None:
    base = meshes.quantised(of_sample("annulus", size=60))
    base = base.moved(base.points + [0, 0, 0.25] * np.sin(4 * base.points[:, :1]).round(4))
    base = meshes.quantised(base)
    table = loop_table(base.surface())
    moved = loop_table(base.moved(base.points * scale + offset).surface())
    for key in ("total_curvature", "sum_kappa_g", "holonomy", "writhe", "twist", "linking"):
        np.testing.assert_allclose(moved[key], table[key], atol=1e-12, err_msg=key)
    for key, power in (("length", 1), ("force_x", 1), ("force_z", 1), ("vector_area_z", 2)):
        np.testing.assert_allclose(moved[key] / scale**power, table[key], atol=1e-11, err_msg=key)
    if offset == 0:
        np.testing.assert_allclose(moved["torque_y"] / scale**2, table["torque_y"], atol=1e-11)


def test_linking_counts_the_half_turns_of_a_strip() -> None:
    # The edge of a Möbius strip links itself twice, as it goes round twice; reflection turns the other way.
    strip = of_sample("mobius", size=600)
    number = loop_table(strip.surface())["linking"][0]
    assert abs(number) == 2
    assert loop_table(strip.moved(strip.points * [1, 1, -1]).surface())["linking"][0] == -number


@pytest.mark.parametrize("name", ["mobius", "grid", "cap"])
def test_the_bound_of_the_linking_number_is_small(name: str) -> None:
    table = loop_table(meshes.zoo(name).surface())
    assert (table["writhe_error"] < 1e-10).all()
    assert (table["linking_error"] > table["writhe_error"]).all()
    assert (table["linking_error"] < 1e-10).all()


@pytest.mark.parametrize("seed", range(5))
def test_no_linking_number_where_a_surface_folds_flat_at_its_boundary(seed: int) -> None:
    """A kite folded along its middle: ν turns by π at both ends of the fold, this way or that."""
    turned = meshes.rotation(seed)
    kite = mesh(np.array([[0, 0, 0], [1, 1, 0], [3, 0, 0], [1, 2.0, 0]]) @ turned.T, [[0, 1, 2], [0, 2, 3]])
    table = loop_table(kite.surface())
    assert np.ma.getmaskarray(table["linking"])[0]
    assert table["linking_error"][0] > 0.25
    assert table["writhe"][0] == 0
    lifted = kite.moved(kite.points + np.outer([0, 0, 0, 1], turned @ [0, 0, 1]))
    assert loop_table(lifted.surface())["linking"][0] == 0


@pytest.mark.parametrize("name", ["mobius", "grid", "cap", "with_flat_face"])
def test_the_curvature_vector_in_the_darboux_frame(name: str) -> None:
    """T′ − T = −κ_n ν + κ_η η at every vertex of the boundary where ν has a direction."""
    boundary = boundary_loops(meshes.zoo(name).surface())
    darboux, turning = Darboux(boundary), Turning(boundary.curves)
    tangent = boundary.curves.tangent[:, boundary.curves.preceding] + boundary.curves.tangent
    eta = np.cross(tangent / np.linalg.norm(tangent, axis=0), darboux.vertex_nu, axis=0)
    known = ~np.isnan(darboux.vertex_nu[0])
    assert known.mean() > 0.9
    closed = -darboux.kappa_n * darboux.vertex_nu + darboux.kappa_eta * eta
    np.testing.assert_allclose(closed[:, known], turning.vector[:, known], atol=1e-14)
    np.testing.assert_allclose(np.hypot(darboux.kappa_n, darboux.kappa_eta)[known], turning.sin2[known], atol=1e-14)
    assert np.isnan(darboux.kappa_eta[~known]).all()


def test_the_angle_and_the_component_on_a_flat_disk() -> None:
    """κ_g is the angle ψ, −κ_η its 2 sin(ψ/2): the one has 2π for its sum, the other closes the curvature vector."""
    boundary = boundary_loops(of_sample("disk", size=40).surface())
    darboux, turning = Darboux(boundary), Turning(boundary.curves)
    np.testing.assert_allclose(darboux.kappa_g, turning.angle, atol=1e-14)
    np.testing.assert_allclose(-darboux.kappa_eta, 2 * np.sin(turning.angle / 2), atol=1e-14)
    np.testing.assert_allclose(darboux.kappa_n, 0, atol=1e-14)


def test_darboux_frame_of_a_hemisphere() -> None:
    dome = of_sample("hemisphere", size=4000)
    boundary = boundary_loops(dome.surface())
    darboux = Darboux(boundary)
    position = dome.points[boundary.vertex]
    radius = np.linalg.norm(position, axis=1).mean()
    # The equator is a geodesic, and bends with the sphere: convex seen from outside, so 1/r in all.
    coarse, fine = (
        loop_table(of_sample("hemisphere", size=size).surface())["sum_kappa_g"][0] for size in (1000, 16000)
    )
    assert abs(fine) < 0.1
    assert coarse / fine == pytest.approx(4, rel=0.2), "first order in the edge length, as strips along a curve are"
    assert darboux.kappa_n.sum() == pytest.approx(2 * np.pi, rel=1e-2)
    assert (np.einsum("in,ni->n", darboux.vertex_nu, position) > 0.95 * radius).all()
    # η = T × ν points out of the surface.
    eta = np.cross(boundary.curves.tangent, darboux.nu, axis=0)
    np.testing.assert_allclose(darboux.conormal, eta * boundary.curves.edge_length, atol=1e-12)
    inside = dome.points.mean(axis=0) - position
    assert (np.einsum("in,ni->n", eta, inside) < 0).all()


@pytest.mark.parametrize("name", ["mobius", "grid", "cap"])
def test_vertex_normals_agree_with_the_faces_beside_the_curve(name: str) -> None:
    boundary = boundary_loops(meshes.zoo(name).surface())
    darboux = Darboux(boundary)
    before = darboux.nu[:, boundary.curves.preceding]
    assert ((darboux.vertex_nu * (darboux.nu + before)).sum(axis=0) > 0).all()
    tangent = boundary.curves.tangent + boundary.curves.tangent[:, boundary.curves.preceding]
    np.testing.assert_allclose((darboux.vertex_nu * tangent).sum(axis=0), 0, atol=1e-13)


def test_a_flat_disk_turns_once() -> None:
    table = loop_table(of_sample("disk", size=200).surface())
    assert table["sum_kappa_g"][0] == pytest.approx(2 * np.pi, abs=1e-12)
    assert table["total_curvature"][0] == pytest.approx(2 * np.pi, abs=1e-12)
    assert table["writhe"][0] == pytest.approx(0, abs=1e-13)


# ---------------------------------------------------------------------------- the check


def test_fenchel_tells_the_loop_that_turns_least() -> None:
    check = next(c for c in analyze(load(MESHES["annulus"])).checks if c.name == "fenchel")
    turns = loop_table(load(MESHES["annulus"]))["total_curvature"]
    assert check.status == "pass"
    assert check.value == turns.min()
    assert f"loop {turns.argmin()}" in check.detail


def test_fenchel_needs_a_boundary() -> None:
    check = next(c for c in analyze(meshes.tetrahedron().surface()).checks if c.name == "fenchel")
    assert check.status == "not_applicable"
    assert check.value is None


def test_fenchel_is_tight_on_convex_plane_curves() -> None:
    check = next(c for c in analyze(of_sample("disk", size=500).surface()).checks if c.name == "fenchel")
    assert check.status == "pass"
    assert check.residual is not None
    assert check.tolerance is not None
    assert check.residual <= check.tolerance
    assert check.value == pytest.approx(2 * np.pi, abs=1e-12)


@given(strategies.any_mesh())
@settings(max_examples=100, deadline=None)
def test_fenchel_holds_on_every_surface(given_mesh: Mesh) -> None:
    surface = given_mesh.surface()
    for groups in (surface.whole, surface.components):
        assert {c.status for c in identities()["fenchel"].run(surface, groups, {})} <= {"pass", "not_applicable"}


def test_fenchel_fails_where_angles_are_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    surface = mesh(*of_sample("disk", size=60)).surface()
    whole = Turning.angle.func(Turning(boundary_loops(surface).curves))  # type: ignore[attr-defined]
    spoiled = whole.copy()
    spoiled[3] -= 1e-9
    monkeypatch.setattr(Turning, "angle", spoiled)
    (check,) = identities()["fenchel"].run(surface, surface.whole, {})
    assert check.status == "fail"

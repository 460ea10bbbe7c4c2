"""Polyhedra: integrals in closed form, Steiner's polynomial against volumes of parallel bodies, what is convex."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from tests.helpers import meshes
from tests.helpers.analysed import analyse, sample, total
from tests.helpers.meshes import Mesh, mesh, of_sample


@pytest.mark.parametrize("edge", [1.0, 0.3, 1e-9, 7e9])
def test_mean_curvature_of_a_cube(edge: float) -> None:
    assert total(sample("cube", edge=edge), "H_theta") == pytest.approx(6 * math.pi * edge, rel=1e-14)


@pytest.mark.parametrize("sides", [(1.0, 1.0, 1.0), (1.0, 2.0, 3.0), (1e-3, 1.0, 50.0)])
def test_steiner_polynomial_of_a_box(sides: tuple[float, float, float]) -> None:
    a, b, c = sides
    found = analyse(boxed(of_sample("cube"), sides)).report()["steiner"]
    wanted = [a * b * c, 2 * (a * b + b * c + c * a), math.pi * (a + b + c), 4 * math.pi / 3]
    np.testing.assert_allclose(found["coefficients"], wanted, rtol=1e-14)
    assert found["convex"] is True


def boxed(given: Mesh, sides: tuple[float, float, float]) -> Mesh:
    return given.moved(given.points * np.array(sides))


def test_steiner_polynomial_of_a_tetrahedron() -> None:
    found = sample("tetrahedron", edge=2.0).report()["steiner"]["coefficients"]
    wanted = [8 / math.sqrt(72), 4 * math.sqrt(3), 6 * (math.pi - math.acos(1 / 3)), 4 * math.pi / 3]
    np.testing.assert_allclose(found, wanted, rtol=1e-14)


@pytest.mark.parametrize("make", [lambda: of_sample("cube"), meshes.tetrahedron, meshes.ellipsoid])
def test_steiner_polynomial_of_a_body_wound_inside_out(make: Callable[[], Mesh]) -> None:
    """It is the polynomial of the body, with the warning, alone and as a component beside the body itself."""
    body = make()
    right, wrong = analyse(body), analyse(meshes.reversed_faces(body))
    known, found = right.report()["steiner"], wrong.report()["steiner"]
    assert found["convex"] is known["convex"] is True
    np.testing.assert_allclose(found["coefficients"], known["coefficients"], rtol=1e-14)
    assert min(found["coefficients"]) > 0
    assert wrong.totals["volume"] == -right.totals["volume"]
    assert "inside_out" in [notice.code for notice in wrong.notices]
    pair = meshes.joined(meshes.reversed_faces(body), body.moved(body.points + 100))
    for piece in analyse(pair).report()["components"]:
        np.testing.assert_allclose(piece["steiner"]["coefficients"], known["coefficients"], rtol=1e-11)


def test_steiner_polynomial_of_a_cube_wound_inside_out() -> None:
    found = analyse(meshes.reversed_faces(of_sample("cube"))).report()["steiner"]
    np.testing.assert_allclose(found["coefficients"], [1, 6, 3 * math.pi, 4 * math.pi / 3], rtol=1e-15)


def test_steiner_polynomial_of_what_is_not_convex_keeps_its_signs() -> None:
    body = meshes.torus()
    right, wrong = (analyse(one).report()["steiner"]["coefficients"] for one in (body, meshes.reversed_faces(body)))
    np.testing.assert_allclose(wrong, [-right[0], right[1], -right[2], right[3]], rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("distance", [0.05, 0.5, 3.0])
@pytest.mark.parametrize("name", ["tetrahedron", "box", "ellipsoid"])
def test_steiner_polynomial_is_the_volume_of_the_parallel_body(name: str, distance: float) -> None:
    """Between the sums of the body with a polyhedron inside the ball of that radius and with one outside it."""
    body = {"box": boxed(of_sample("cube"), (1.0, 2.0, 0.5)), "tetrahedron": meshes.tetrahedron()}.get(
        name, meshes.ellipsoid()
    )
    ball = of_sample("icosphere", size=400).points
    nearest = float((-ConvexHull(ball).equations[:, 3]).min())
    inner, outer = (
        ConvexHull((body.points[:, None] + radius * ball).reshape(-1, 3)).volume
        for radius in (distance, distance / nearest)
    )
    polynomial = np.polynomial.Polynomial(analyse(body).report()["steiner"]["coefficients"])
    assert inner < polynomial(distance) < outer < 1.05 * inner


def test_what_is_convex() -> None:
    cube, sphere = of_sample("cube"), of_sample("irregular_sphere", size=100)
    dented = sphere.points.copy()
    dented[7] *= 0.9
    hollow = meshes.joined(cube, meshes.reversed_faces(cube.moved(cube.points / 2)))
    kinds = {
        True: [cube, sphere, meshes.tetrahedron()],
        False: [sphere.moved(dented), hollow, meshes.torus(), meshes.cap()],
    }
    kinds[False] += [cube.with_faces(cube.faces[1:]), meshes.joined(cube, cube.moved(cube.points + 3.0))]
    for convex, bodies in kinds.items():
        assert [analyse(body).report()["steiner"]["convex"] for body in bodies] == [convex] * len(bodies)


def test_a_block_with_two_holes() -> None:
    """K is ±π/2 at the corners alone: K⁺ = 8 · π/2 and K⁻ = 16 · π/2, tight, 6 critical points to a height function."""
    result = sample("genus_2")
    assert total(result, "K") == pytest.approx(-4 * math.pi, rel=1e-13)
    assert total(result, "K_plus") == pytest.approx(4 * math.pi, rel=1e-13)
    assert total(result, "K_minus") == pytest.approx(8 * math.pi, rel=1e-13)
    (tight,) = [check for check in result.checks if check.name == "total_absolute_curvature" and check.scope == "whole"]
    assert tight.status == "pass"
    assert total(result, "K_abs") == pytest.approx(2 * math.pi * (2 + 2 * 2), rel=1e-13)


@pytest.mark.parametrize("name", ["torus", "clifford_torus"])
def test_tori_of_revolution_are_tight(name: str) -> None:
    assert total(sample(name), "K_abs") == pytest.approx(2 * math.pi * 4, rel=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_a_flat_triangle_seen_from_both_sides(seed: int) -> None:
    corners = np.random.default_rng(seed).normal(size=(3, 3))
    result = analyse(mesh(corners, [[0, 1, 2], [0, 2, 1]]))
    assert total(result, "K") == pytest.approx(4 * math.pi, rel=1e-14)
    np.testing.assert_allclose(np.abs(result.edges["theta"]), math.pi, rtol=1e-14)
    np.testing.assert_allclose(result.vertices["K"].sum(), 4 * math.pi, rtol=1e-14)
    assert np.isnan(result.edges["H_tan"]).all()
    assert [notice.count for notice in result.notices if notice.code == "folded_edges"] == [3]


@pytest.mark.parametrize("seed", range(8))
def test_folds_are_convex(seed: int) -> None:
    """θ = +π from both sides, in spite of rounding, where a surface folds onto itself."""
    corners = np.random.default_rng(seed).normal(size=(4, 3))
    corners[3] = corners[2] + 0.25 * (corners[1] - corners[0])
    for faces in ([[0, 1, 2], [1, 0, 3]], [[1, 0, 2], [0, 1, 3]], [[0, 1, 2], [0, 1, 3]]):
        theta = analyse(mesh(corners, faces)).edges["theta"]
        np.testing.assert_allclose(theta[~np.isnan(theta)], [math.pi], rtol=1e-15)


@pytest.mark.parametrize(("depth", "convex"), [(0.0, True), (1e-8, True), (5e-7, False), (1e-3, False), (-1e-3, True)])
def test_a_dent_that_is_more_than_rounding(depth: float, convex: bool) -> None:
    """A cube with a pit in the middle of one side, or a roof on it; ΣK⁻ is of the order of the depth squared."""
    box = of_sample("cube")
    lid = np.isclose(box.points[box.faces][:, :, 2], box.points[:, 2].max()).all(axis=1)
    rim = box.faces[lid]
    edges = [(a, b) for face in rim.tolist() for a, b in zip(face, face[1:] + face[:1], strict=True)]
    around = [[a, b, 8] for a, b in edges if (b, a) not in edges]
    middle = box.points[rim].mean(axis=(0, 1)) * [0, 0, 1] + box.points[np.unique(rim)].mean(axis=0) * [1, 1, 0]
    dented = mesh(np.vstack([box.points, middle - [0, 0, depth]]), [*box.faces[~lid].tolist(), *around])
    result = analyse(dented)
    assert result.report()["steiner"]["convex"] is convex
    if depth > 0:
        assert 0.1 * depth**2 < total(result, "K_minus") + 1e-15 < 10 * depth**2 + 2e-15


def test_a_membrane_inside_leaves_no_volume() -> None:
    """Two tetrahedra with a common face: closed, each patch orientable, and yet the faces at the rim do not cancel."""
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, 1], [0.2, 0.2, -1]]
    sides = [[a, b, top] for a, b in ((0, 1), (1, 2), (2, 0)) for top in (3, 4)]
    result = analyse(mesh(points, [*sides, [0, 1, 2]]))
    report = result.report()
    assert (report["topology"]["closed"], report["topology"]["orientable"]) == (True, True)
    assert result.totals["volume"] is report["steiner"]["coefficients"] is None
    (check,) = [check for check in result.checks if check.name == "volume"]
    assert (check.status, check.detail) == ("not_applicable", "the oriented faces do not cancel at every edge")
    assert analyse(mesh(points, sides)).totals["volume"] == pytest.approx(1 / 3)


def test_where_principal_curvatures_are_equal_there_is_a_cap() -> None:
    """A radicand that is clamped at 0 makes an umbilic."""
    column = analyse(meshes.ellipsoid()).vertices
    equal = column["kappa_1"] == column["kappa_2"]
    assert 0 < equal.sum() < len(equal)
    np.testing.assert_array_equal(column["shape_index"] == 1, equal)

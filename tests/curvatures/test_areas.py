"""Mixed cells: closed forms, the sum, and random surfaces against sums in 50 digits."""

from __future__ import annotations

import mpmath as mp  # type: ignore[import-untyped]
import numpy as np
import pytest
from hypothesis import given
from numpy.typing import NDArray

import curvcli
from curvcli.curvatures.areas import A_mixed
from tests.helpers import strategies
from tests.helpers.meshes import ZOO, Mesh, mesh, of_sample, torus, zoo

Floats = NDArray[np.float64]


def cells(given: Mesh) -> Floats:
    return np.asarray(A_mixed(given.surface()))


def slow_cells(given: Mesh) -> Floats:
    """The definition, face by face: circumcentre and edge midpoints where no angle is obtuse."""
    with mp.workdps(50):
        area = [mp.mpf(0)] * len(given.points)
        points = [mp.matrix([mp.mpf(float(x)) for x in point]) for point in given.points]
        for face in given.faces:
            for k in range(3):
                p, q, r = (points[face[(k + j) % 3]] for j in range(3))
                area[face[k]] += _cell(q - p, r - p)
        found = np.array([float(x) for x in area])
    found[np.setdiff1d(np.arange(len(found)), given.faces)] = np.nan
    return found


def _cell(u: mp.matrix, w: mp.matrix) -> mp.mpf:
    """The cell of a triangle's corner with edges u and w."""
    uu, ww, uw = (sum(a * b for a, b in zip(x, y, strict=True)) for x, y in ((u, u), (w, w), (u, w)))
    cross = [u[i] * w[j] - u[j] * w[i] for i, j in ((1, 2), (2, 0), (0, 1))]
    twice = mp.sqrt(sum(x * x for x in cross))
    if uw < 0:
        return twice / 4
    if uu < uw or ww < uw or twice == 0:
        return twice / 8
    # The circumcentre lies at distance |u| cot / 2 from the middle of u, where cot belongs to the angle opposite u.
    return (uu * (ww - uw) + ww * (uu - uw)) / (8 * twice)


@pytest.mark.parametrize("name", ZOO)
def test_mixed_cells_follow_the_definition(name: str) -> None:
    found, wanted = cells(zoo(name)), slow_cells(zoo(name))
    np.testing.assert_array_equal(np.isnan(found), np.isnan(wanted))
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-13 * np.nanmax(wanted))


@given(strategies.any_mesh())
def test_cells_of_random_surfaces_follow_the_definition(given: Mesh) -> None:
    found, wanted = cells(given), slow_cells(given)
    np.testing.assert_array_equal(np.isnan(found), np.isnan(wanted))
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-13 * np.nanmax(wanted))


@pytest.mark.parametrize("factor", [1e-8, 1e-6, 1e-3, 1e3, 1e6, 1e8])
def test_needles_and_caps(factor: float) -> None:
    body = torus()
    stretched = body.moved(body.points * [factor, 1, 1])
    found, wanted = cells(stretched), slow_cells(stretched)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-13 * wanted.max())


@pytest.mark.parametrize("width", [1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("lean", [-1.0, 0.0, 0.25, 0.5, 1.0, 2.0])
def test_a_single_needle(width: float, lean: float) -> None:
    """Also beside the right angle, where one rule takes over from the other."""
    for nudge in (0.0, 2.0**-60, -(2.0**-60)):
        needle = mesh([[0, 0, 0], [width, 0, 0], [lean * width + nudge, 1, 0]], [[0, 1, 2]])
        np.testing.assert_allclose(cells(needle), slow_cells(needle), rtol=1e-13)


@pytest.mark.parametrize("height", [1e-12, 1e-6, 0.1, 0.5])
def test_an_obtuse_face_is_halved_and_quartered(height: float) -> None:
    found = cells(mesh([[-1, 0, 0], [1, 0, 0], [0, height, 0]], [[0, 1, 2]]))
    np.testing.assert_allclose(found, height * np.array([0.25, 0.25, 0.5]), rtol=1e-15)


def test_a_right_angle_is_cut_at_the_middle_of_its_hypotenuse() -> None:
    np.testing.assert_allclose(cells(mesh([[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[0, 1, 2]])), [3, 1.5, 1.5], rtol=1e-15)


def test_an_equilateral_face_is_shared_evenly() -> None:
    found = cells(mesh([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2]]))
    np.testing.assert_allclose(found, np.sqrt(3) / 6, rtol=1e-15)


def test_faces_without_area_add_nothing() -> None:
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, 0, 0], [1, 0, 0]]
    plain = cells(mesh(points[:3], [[0, 1, 2]]))
    found = cells(mesh(points, [[0, 1, 2], [0, 3, 1], [1, 4, 2], [1, 4, 0]]))
    np.testing.assert_array_equal(found, [*plain, 0, 0])


@pytest.mark.parametrize("name", ["torus", "ellipsoid", "mobius", "klein_bottle", "grid", "book"])
def test_the_cells_fill_the_surface(name: str) -> None:
    result = curvcli.analyze(tuple(zoo(name)), ["A_mixed"])
    assert float(result.vertices["A_mixed"].sum()) == pytest.approx(result.totals["area"], rel=1e-14)
    assert (result.vertices["A_mixed"] > 0).all()


def test_without_obtuse_faces_they_are_the_voronoi_cells() -> None:
    result = curvcli.analyze(tuple(of_sample("icosphere", size=162)), ["A_mixed", "A_voronoi"])
    np.testing.assert_allclose(result.vertices["A_mixed"], result.vertices["A_voronoi"], rtol=1e-13)


def test_unreferenced_vertices_have_none() -> None:
    found = cells(mesh(np.eye(4)[:, :3], [[0, 1, 2]]))
    assert np.isnan(found[3])
    assert np.isfinite(found[:3]).all()


@pytest.mark.parametrize(("area", "column"), [("barycentric", "A"), ("mixed", "A_mixed"), ("voronoi", "A_voronoi")])
def test_the_density_is_taken_over_the_chosen_area(area: str, column: str) -> None:
    result = curvcli.analyze(tuple(torus()), ["K", "K_density", column], area=area)  # type: ignore[arg-type]
    vertices = result.vertices
    np.testing.assert_allclose(vertices["K_density"], vertices["K"] / vertices[column], rtol=1e-15)

"""Turning, its sums, and plane curves, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from curvcli.curves import Curve
from curvcli.errors import InputError, UsageError
from tests.curves.shapes import figure_eight, helix, random_polygon, regular, rotation, trefoil

TURN = 2 * np.pi


@pytest.mark.parametrize("n", [3, 4, 5, 17, 1000])
def test_regular_polygons_turn_by_equal_angles(n: int) -> None:
    curve = Curve(regular(n), closed=True)
    psi = TURN / n
    np.testing.assert_allclose(curve.turning, psi, atol=1e-14)
    np.testing.assert_allclose(curve.sin2, 2 * np.sin(psi / 2), atol=1e-14)
    np.testing.assert_allclose(curve.tan2, 2 * np.tan(psi / 2), atol=3e-14)
    assert curve.length == pytest.approx(2 * n * np.sin(np.pi / n), rel=1e-14)
    assert curve.total_curvature == pytest.approx(TURN, rel=1e-14)
    assert curve.total_sin2 == pytest.approx(2 * n * np.sin(psi / 2), rel=1e-13)
    assert curve.total_tan2 == pytest.approx(2 * n * np.tan(psi / 2), rel=1e-13)
    assert curve.turning_number == 1
    assert curve.unknotted is True
    assert curve.repeated_points == 0


def test_curvature_vectors_point_inwards_and_close() -> None:
    points = regular(7)
    vectors = Curve(points, closed=True).curvature_vectors
    np.testing.assert_allclose(vectors, -2 * np.sin(np.pi / 7) * points, atol=1e-15)
    np.testing.assert_allclose(vectors.sum(axis=0), 0, atol=1e-15)


@pytest.mark.parametrize(("n", "times"), [(5, 2), (7, 3), (9, 4)])
def test_star_polygons_turn_more_than_once(n: int, times: int) -> None:
    curve = Curve(regular(n, times), closed=True)
    assert curve.turning_number == times
    assert curve.signed_total == pytest.approx(times * TURN, rel=1e-14)
    # From the other side of the plane the same curve runs the other way round.
    assert Curve(regular(n, times)[::-1], closed=True).turning_number == -times


def test_figure_eight_turns_to_both_sides_alike() -> None:
    curve = Curve(figure_eight(64) @ rotation(4).T + 3, closed=True)
    assert curve.plane
    assert curve.turning_number == 0
    assert abs(curve.signed_total or 0.0) < 1e-12
    assert curve.total_curvature > TURN


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9, 1e-200, 1e200])
@pytest.mark.parametrize("offset", [0.0, 1e3])
def test_planes_are_found_at_any_scale_and_place(scale: float, offset: float) -> None:
    plane = (regular(12) @ rotation(1).T + offset) * scale
    assert Curve(plane, closed=True).plane
    plane[3] += 1e-9 * scale * rotation(1)[:, 2]
    assert not Curve(plane, closed=True).plane


def test_thin_plane_polygons_are_plane() -> None:
    thin = regular(12) * [1.0, 1e-9, 0.0] @ rotation(2).T
    assert Curve(thin, closed=True).plane


def test_knots_turn_by_more_than_two_turns() -> None:
    curve = Curve(trefoil(200), closed=True)
    assert curve.total_curvature > 2 * TURN
    assert curve.unknotted is None
    assert not curve.plane
    assert curve.signed_total is None
    # More than two turns prove nothing: a star polygon is no knot.
    assert Curve(regular(7, 3), closed=True).unknotted is None
    assert Curve(trefoil(200)).unknotted is None


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("d", [2, 3, 4, 6])
def test_curvature_vectors_add_up_to_the_change_of_tangent(closed: bool, d: int) -> None:
    curve = Curve(random_polygon(d, 50, d), closed)
    tangents = curve.tangents
    inside = curve.curvature_vectors if closed else curve.curvature_vectors[1:-1]
    change = np.zeros(d) if closed else tangents[-2] - tangents[0]
    np.testing.assert_allclose(inside.sum(axis=0), change, atol=1e-13)
    for start, stop in ((3, 9), (10, 40)):
        part = curve.curvature_vectors[start + 1 : stop + 1].sum(axis=0)
        np.testing.assert_allclose(part, tangents[stop] - tangents[start], atol=1e-13)


def test_ends_of_open_curves_have_no_turning() -> None:
    points = helix(10)
    curve = Curve(points)
    assert np.isnan(curve.turning[[0, -1]]).all()
    assert np.isfinite(curve.turning[1:-1]).all()
    np.testing.assert_array_equal(curve.edge_vectors, np.diff(points, axis=0))
    assert np.isnan(curve.tangents[-1]).all()
    assert curve.turning_number is None
    assert curve.holonomy is None


def test_turning_back_has_no_tangent_of_the_half_angle() -> None:
    curve = Curve([[0, 0, 0], [1, 2, 3], [0, 0, 0], [0, 1, 0]])
    assert curve.turning[1] == pytest.approx(np.pi, abs=1e-15)
    assert curve.sin2[1] == pytest.approx(2)
    assert np.isnan(curve.tan2[1])
    assert curve.total_tan2 is None
    assert np.isnan(curve.bishop[1][1]).all()
    assert np.isfinite(curve.bishop[1][0]).all()


def test_repeated_points_are_null_and_counted_and_change_nothing_else() -> None:
    points = random_polygon(5, 12)
    rows = np.repeat(np.arange(12), [1, 3, 1, 1, 2, 1, 1, 1, 1, 1, 1, 2])
    curve, plain = Curve(points[rows], closed=True), Curve(points, closed=True)
    assert curve.repeated_points == 4
    assert np.isnan(curve.turning).sum() == 4
    last = np.append(np.diff(rows) > 0, True)
    np.testing.assert_array_equal(curve.turning[last], plain.turning)
    np.testing.assert_array_equal(curve.torsion[last], plain.torsion)
    assert curve.total_curvature == plain.total_curvature
    assert curve.holonomy == plain.holonomy
    assert curve.writhe() == plain.writhe()


def test_a_curve_that_is_one_point() -> None:
    for closed in (True, False):
        curve = Curve([[1.0, 2.0, 3.0]] * 3, closed)
        assert curve.length == 0
        assert curve.total_curvature == 0
        assert curve.writhe() == 0
        assert curve.holonomy is None
        assert curve.turning_number is None


@pytest.mark.parametrize("scale", [1e-9, 1e9, 1e-150])
def test_angles_do_not_depend_on_scale(scale: float) -> None:
    points = random_polygon(8, 40)
    curve, scaled = Curve(points, closed=True), Curve(points * scale, closed=True)
    np.testing.assert_allclose(scaled.turning, curve.turning, rtol=1e-14)
    np.testing.assert_allclose(scaled.torsion, curve.torsion, rtol=1e-13, atol=1e-14)
    assert scaled.length == pytest.approx(curve.length * scale, rel=1e-14)
    assert scaled.writhe() == pytest.approx(curve.writhe(), rel=1e-13)
    assert scaled.holonomy == pytest.approx(curve.holonomy, rel=1e-12)


def test_offsets_cost_no_digits() -> None:
    # Coordinates that stay exact when they are moved.
    points = np.round(random_polygon(9, 40) * 2**20) / 2**20
    curve, moved = Curve(points, closed=True), Curve(points + 2.0**30, closed=True)
    np.testing.assert_array_equal(moved.turning, curve.turning)
    assert moved.writhe() == curve.writhe()
    assert moved.holonomy == curve.holonomy


@pytest.mark.parametrize(
    "points", [np.zeros(3), np.zeros((3, 1)), np.zeros((0, 3)), [[0, 0, np.nan]], [["a", "b"]]], ids=str
)
def test_what_is_no_curve_is_refused(points: object) -> None:
    with pytest.raises(InputError):
        Curve(points)  # type: ignore[arg-type]


def test_frames_need_three_dimensions() -> None:
    curve = Curve(random_polygon(1, 9, 4), closed=True)
    for question in ("torsion", "frenet", "plane", "holonomy"):
        with pytest.raises(UsageError, match=r"E\^4"):
            getattr(curve, question)
    with pytest.raises(UsageError, match=r"E\^4"):
        curve.writhe()

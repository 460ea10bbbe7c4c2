"""Writhe against quadrature of the Gauss integral, crossings, and reflection."""

from __future__ import annotations

import numpy as np
import pytest

from curvcli.curves import Curve, Curves, writhe
from curvcli.curves.writhe import within
from curvcli.errors import UsageError
from tests.curves.shapes import gauss_integral, helix, random_polygon, regular, rotation, trefoil


@pytest.mark.parametrize("closed", [True, False])
def test_against_quadrature(closed: bool) -> None:
    points = trefoil(24)
    assert Curve(points, closed).writhe() == pytest.approx(gauss_integral(points, closed), rel=1e-12)


def test_a_flat_trefoil_writhes_by_its_crossings() -> None:
    # Pressed almost flat, nearly every view shows the three crossings of one sign.
    flat = trefoil(400) * [1, 1, 1e-4]
    turns = Curve(flat, closed=True).writhe()
    assert abs(turns) == pytest.approx(3, abs=1e-2)
    t = np.linspace(0, 1, 7)[:, None]
    over = np.array([-1.0, -1, 0.1]) * (1 - t) + np.array([1.0, 1, 0.1]) * t
    under = np.array([1.0, -1, -0.1]) * (1 - t) + np.array([-1.0, 1, -0.1]) * t
    # The strand from lower left to upper right passes over: a positive crossing, right-handed.
    round_ = np.array([[3.0, 1, 0], [3, -1, 0]])
    right = np.vstack([over, round_, under])
    assert Curve(right).writhe() > 0.5
    assert Curve(right * [1, 1, -1]).writhe() < -0.5


@pytest.mark.parametrize("n", [12, 63, 64, 65, 200])
def test_reflection_changes_the_sign_and_motion_nothing(n: int) -> None:
    points = trefoil(n)
    turns = Curve(points, closed=True).writhe()
    assert Curve(points * [1, 1, -1], closed=True).writhe() == pytest.approx(-turns, rel=1e-12)
    assert Curve(points[::-1], closed=True).writhe() == pytest.approx(turns, rel=1e-12)
    assert Curve(np.roll(points, 5, axis=0), closed=True).writhe() == pytest.approx(turns, rel=1e-12)
    moved = points @ rotation(5).T * 1e5 + [3e5, -2e5, 1e5]
    assert Curve(moved, closed=True).writhe() == pytest.approx(turns, rel=1e-11)


def test_plane_curves_and_spherical_symmetry_have_none() -> None:
    assert Curve(regular(50), closed=True).writhe() == 0
    saddle = regular(40)
    saddle[:, 2] = np.cos(2 * 2 * np.pi * np.arange(40) / 40)
    # A reflection takes it to itself.
    assert Curve(saddle, closed=True).writhe() == pytest.approx(0, abs=1e-14)
    assert Curve(regular(3), closed=True).writhe() == 0


@pytest.mark.parametrize("seed", range(20))
def test_plane_curves_that_cross_themselves_have_none(seed: int) -> None:
    random = np.random.default_rng(seed)
    eight = np.array([[0.0, 0], [1, 1], [1, 0], [0, 1]]) + random.normal(scale=0.1, size=(4, 2))
    star = np.array([[np.cos(4 * np.pi * k / 5), np.sin(4 * np.pi * k / 5)] for k in range(5)])
    for flat in (eight, star + random.normal(scale=0.05, size=(5, 2)), random.normal(size=(100, 2))):
        for axis in range(3):
            assert Curve(np.insert(flat, axis, 0.75, axis=1), closed=True).writhe() == 0
        whole = np.round(64 * flat)
        assert Curve(np.column_stack([whole, -whole.sum(axis=1)]), closed=True).writhe() == 0


def test_right_handed_helices_writhe_positively() -> None:
    assert Curve(helix(100)).writhe() > 0
    assert Curve(helix(100) * [1, 1, -1]).writhe() < 0


def test_many_curves_at_once_are_each_as_alone() -> None:
    pieces = [(trefoil(n), closed) for n in (5, 9, 9, 30, 70, 130) for closed in (True, False)]
    pieces += [(regular(4), True), (helix(2), False), (helix(1), False)]
    start = np.concatenate([[0], np.cumsum([len(points) for points, _ in pieces])])
    together = Curves(np.concatenate([p for p, _ in pieces]).T.copy(), start, np.array([c for _, c in pieces]))
    turns, error = writhe(together)
    alone = [Curve(points, closed).writhe() for points, closed in pieces]
    np.testing.assert_array_equal(turns, alone)
    assert (error[:6] < 1e-11).all()


def test_blocks_and_whole_agree() -> None:
    # 64 edges are summed as one array, 65 in blocks; a point in the middle of an edge changes nothing.
    points = trefoil(64)
    split = np.insert(points, 10, (points[9] + points[10]) / 2, axis=0)
    assert Curve(split, closed=True).writhe() == pytest.approx(Curve(points, closed=True).writhe(), rel=1e-12)


def test_error_bound_covers_what_moving_the_points_by_a_rounding_does() -> None:
    points = random_polygon(17, 60)
    turns, error = writhe(Curves(points.T.copy(), np.array([0, 60]), np.array([True])))
    nudged = points @ rotation(3).T
    again = Curve(nudged, closed=True).writhe()
    assert 0 < abs(again - turns[0]) + 1e-16 < error[0] < 1e-6


def test_double_sums_are_refused_beyond_their_size() -> None:
    curve = Curve(trefoil(100), closed=True)
    with pytest.raises(UsageError, match="100 edges, at most 99"):
        curve.writhe(max_edges=99)
    assert curve.writhe(max_edges=100) == curve.writhe(max_edges=None)
    # From the smallest up, as long as all sums together are no larger than one of that many edges.
    assert within(np.array([30, 40, 3, 500]), 50).tolist() == [True, False, True, False]
    assert within(np.array([30, 40]), 50).tolist() == [True, True]
    assert within(np.array([30, 500]), None).all()

"""Writhe against quadrature of the Gauss integral, crossings, and reflection."""

from __future__ import annotations

from pathlib import Path

import mpmath as mp  # type: ignore[import-untyped]
import numpy as np
import pytest

from curvcli.curves import Curve, Curves, writhe
from curvcli.curves.writhe import within
from curvcli.errors import UsageError
from tests.curves.conftest import Cli
from tests.curves.shapes import figure_eight, gauss_integral, helix, random_polygon, regular, rotation, trefoil


@pytest.mark.parametrize("closed", [True, False])
def test_writhe_is_the_gauss_integral(closed: bool) -> None:
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


def exact_writhe(points: np.ndarray) -> mp.mpf:
    """Writhe in turns of a closed polygon, its coordinates taken as exact, in 60 digits."""
    with mp.workdps(60):
        corners = [mp.matrix([mp.mpf(float(x)) for x in point]) for point in points]
        n, total = len(corners), mp.mpf(0)
        for i in range(n):
            for j in range(i + 2, n - (i == 0)):
                p, q, r, s = (corners[k % n] for k in (i, i + 1, j, j + 1))
                a, b, c, d = r - p, s - p, s - q, r - q
                total -= solid_angle(a, b, c) + solid_angle(a, c, d)
        return total / (2 * mp.pi)


def solid_angle(a: mp.matrix, b: mp.matrix, c: mp.matrix) -> mp.mpf:
    def dot(x: mp.matrix, y: mp.matrix) -> mp.mpf:
        return mp.fsum(x[k] * y[k] for k in range(3))

    volume = mp.det(mp.matrix([list(a), list(b), list(c)]))
    one, two, three = (mp.sqrt(dot(x, x)) for x in (a, b, c))
    across = one * two * three + dot(a, b) * three + dot(b, c) * one + dot(c, a) * two
    return mp.mpf(0) if volume == 0 else 2 * mp.atan2(volume, across)


def crossing(gap: float, seed: int) -> np.ndarray:
    """A closed hexagon, two edges of which pass each other at a distance, at equal heights or not, turned somehow."""
    random = np.random.default_rng(seed)
    up, down = gap / 2, -gap / 2
    hexagon = np.array([[-1, -1, up], [1, 1, up], [3, 0, 2.0], [1, -1, down], [-1, 1, down], [-3, 0, 1.0]])
    if seed % 2:
        hexagon[[0, 1, 3, 4], :2] *= random.uniform(0.2, 3, (4, 1))
    return hexagon @ rotation(seed).T


@pytest.mark.parametrize("gap", [1e-3, 1e-8, 1e-10, 1e-12, 1e-13, 1e-14, 1e-15, 1e-16, 1e-18])
def test_the_bound_covers_the_error_and_no_value_is_given_beyond_a_quarter(gap: float) -> None:
    for seed in range(12):
        points = crossing(gap, seed)
        turns, error = writhe(Curves(points.T.copy(), np.array([0, 6]), np.array([True])))
        if np.isnan(turns[0]):
            assert error[0] > 0.25
            assert gap < 1e-12
        else:
            assert abs(turns[0] - exact_writhe(points)) <= error[0] <= 0.25
            assert gap > 1e-16


@pytest.mark.parametrize("n", [8, 40, 64, 65, 200])
def test_plane_curves_that_cross_themselves_have_none_in_any_plane(n: int) -> None:
    for seed in range(4):
        for offset in (0, 30):
            turned = figure_eight(n) @ rotation(seed).T + offset
            turns, error = writhe(Curves(turned.T.copy(), np.array([0, n]), np.array([True])))
            assert (turns[0], error[0]) == (0, 0)


def test_an_undefined_writhe_is_null_and_said(cli: Cli, tmp_path: Path) -> None:
    for gap, defined in ((0.5, True), (1e-17, False)):
        path = tmp_path / f"{gap}.obj"
        rows = [f"v {x!r} {y!r} {z!r}" for x, y, z in crossing(gap, 3).tolist()]
        path.write_text("\n".join([*rows, "l 1 2 3 4 5 6 1"]) + "\n")
        report = cli.told(path)
        assert (report["curves"][0]["writhe"] is not None) == defined
        assert (report["curves"][0]["writhe_error"] < 0.25) == defined
        assert ("writhe_undefined" in [warning["code"] for warning in report["warnings"]]) != defined
        holonomy = next(check for check in report["checks"] if check["name"] == "holonomy")
        assert holonomy["status"] == ("pass" if defined else "not_applicable")

"""Linking numbers: against the signed crossings of a projection, on links that are known, and at a bounded cost."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from curvcli.curves.links import links
from curvcli.curves.polygon import Curves
from tests.curves.conftest import Cli, polyline
from tests.curves.shapes import Points, random_polygon, regular
from tests.helpers.cli.program import DISK

X = np.array([1.0, 0.0, 0.0])


def curves(*given: Points, closed: bool = True) -> Curves:
    start = np.cumsum([0, *map(len, given)])
    return Curves(np.ascontiguousarray(np.vstack(given).T), start, np.full(len(given), closed))


def torus_link(k: int, n: int) -> tuple[Points, Points]:
    """Two curves that wind k times round each other."""
    t = 2 * np.pi * np.arange(n) / n

    def one(phase: float) -> Points:
        r = 2 + 0.7 * np.cos(k * t + phase)
        return np.stack([r * np.cos(t), r * np.sin(t), 0.7 * np.sin(k * t + phase)], axis=1)

    return one(0), one(np.pi)


def crossings(one: Points, other: Points) -> float:
    """Half the signed crossings of both curves seen along some direction, pair by pair of their edges."""
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    one, other = one @ turn, other @ turn
    total = 0.0
    for p, p2 in zip(one, np.roll(one, -1, axis=0), strict=True):
        for q, q2 in zip(other, np.roll(other, -1, axis=0), strict=True):
            d, e = p2 - p, q2 - q
            det = d[0] * -e[1] + e[0] * d[1]
            if det == 0:  # they are parallel
                continue
            s = ((q - p)[0] * -e[1] + e[0] * (q - p)[1]) / det
            t = (d[0] * (q - p)[1] - d[1] * (q - p)[0]) / det
            if 0 < s < 1 and 0 < t < 1:
                above = np.sign((p + s * d)[2] - (q + t * e)[2])
                total += above * np.sign(d[0] * e[1] - d[1] * e[0])
    return total / 2


@pytest.mark.parametrize("seed", range(12))
def test_random_polygons_by_their_crossings(seed: int) -> None:
    one, other = random_polygon(seed, 15), random_polygon(seed + 100, 40)
    found = links(curves(one, other))
    assert found.known.tolist() == [True]
    assert round(float(found.number[0])) == crossings(one, other)
    assert abs(found.number[0] - round(float(found.number[0]))) < found.error[0] < 1e-9


@pytest.mark.parametrize("k", [-3, -1, 0, 1, 2, 5])
@pytest.mark.parametrize("scale", [1.0, 1e-160, 1e160])
def test_torus_links_have_known_linking_numbers(k: int, scale: float) -> None:
    one, other = torus_link(k, 90)
    found = links(curves(one * scale, other * scale))
    assert abs(found.number[0] - crossings(one, other)) < 1e-9
    assert abs(round(float(found.number[0]))) == abs(k)
    turned = links(curves(one[::-1] * scale, other * scale))
    assert turned.number[0] == pytest.approx(-found.number[0], abs=1e-9)
    mirrored = links(curves(one * [scale, scale, -scale], other * [scale, scale, -scale]))
    assert mirrored.number[0] == pytest.approx(-found.number[0], abs=1e-9)


def test_far_from_the_origin() -> None:
    one, other = torus_link(2, 60)
    here, there = (links(curves(one + shift, other + shift)).number[0] for shift in (0.0, 1e6))
    assert there == pytest.approx(here, abs=1e-8)


def test_curves_apart_are_not_summed() -> None:
    ring = regular(12)
    found = links(curves(ring, ring + X * 5, ring + X * -9), max_edges=0)
    assert (found.number == 0).all()
    assert (found.error == 0).all()
    assert found.refused == 0


def test_curves_that_touch_have_no_linking_number() -> None:
    one = regular(12)
    at_a_vertex = one + 2 * one[0]  # has one[6] + 2 one[0] = one[0]
    at_a_vertex[6] = one[0]
    across = np.array([[0, 0, -1.0], [2, 0, -1.0], [2, 0, 1.0], [0, 0, 1.0]])
    across[:, :2] += one[:2, :2].mean(axis=0)
    for other in (at_a_vertex, across):
        found = links(curves(one, other))
        assert found.known.tolist() == [False]


def test_open_curves_are_left_out() -> None:
    one, other = torus_link(1, 30)
    assert len(links(curves(one, other, closed=False)).a) == 0


def test_the_cost_is_bounded() -> None:
    one, other = torus_link(1, 100)
    small = torus_link(1, 10)
    found = links(curves(one, other, *small), max_edges=60)
    assert found.refused > 0
    done = dict(zip(zip(found.a.tolist(), found.b.tolist(), strict=True), found.known.tolist(), strict=True))
    assert done[2, 3]
    assert not done[0, 1]


def test_very_many_curves() -> None:
    """Pairs that are apart are neither listed nor looked at."""
    ring = 0.3 * regular(5)
    places = np.stack(np.meshgrid(*[np.arange(30.0)] * 3), axis=-1).reshape(-1, 3)
    xyz = (places[:, None] + ring).reshape(-1, 3)
    chain = torus_link(1, 40)
    many = Curves(
        np.ascontiguousarray(np.vstack([xyz, chain[0] + 100, chain[1] + 100]).T),
        np.concatenate([np.arange(0, len(xyz), 5), len(xyz) + np.array([0, 40, 80])]),
        np.ones(len(places) + 2, bool),
    )
    found = links(many)
    assert (found.a.tolist(), found.b.tolist()) == ([len(places)], [len(places) + 1])
    assert abs(round(float(found.number[0]))) == 1


def test_the_report_has_every_pair(cli: Cli, tmp_path: Path) -> None:
    one, other = torus_link(3, 60)
    given = [(one, True), (other, True), (regular(9) + 20 * X, True), (one[:9] - 20 * X, False)]
    path = polyline(tmp_path / "links.obj", *given)
    rows = cli.told(path)["links"]
    assert [(row["a"], row["b"]) for row in rows] == list(combinations(range(3), 2))
    assert [abs(row["linking"]) for row in rows] == [3, 0, 0]
    assert "linked curves: 0 and 1 (" in cli.run(path).out
    table = cli.run(path, "--table", "links=-", "--format", "csv").out.splitlines()
    assert table[0] == "a,b,linking,linking_error"
    assert len(table) == 4


def test_boundary_loops_are_linked_too(cli: Cli, tmp_path: Path) -> None:
    """The two boundary circles of an annulus with k half-twists link k/2 times."""
    n, turns = 40, 2
    t = 2 * np.pi * np.arange(n) / n
    axis = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    out = axis * np.cos(turns * t)[:, None] + [0, 0, 1] * np.sin(turns * t)[:, None]
    inner, outer = 2 * axis - 0.3 * out, 2 * axis + 0.3 * out
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.vstack([inner, outer]).tolist()]
    for k in range(n):
        a, b, c, d = k + 1, (k + 1) % n + 1, n + (k + 1) % n + 1, n + k + 1
        lines += [f"f {a} {b} {c}", f"f {a} {c} {d}"]
    path = tmp_path / "band.obj"
    path.write_text("\n".join([*lines, ""]))
    (row,) = cli.told(path)["links"]
    assert abs(row["linking"]) == turns
    assert cli.told(DISK)["links"] == []


def test_what_cannot_be_known_is_said(cli: Cli, tmp_path: Path) -> None:
    ring = regular(8)
    path = polyline(tmp_path / "touching.obj", (ring, True), (np.roll(ring, 3, axis=0)[:, [0, 2, 1]] * [1, 1, 1], True))
    report = cli.told(path)
    assert [row["linking"] for row in report["links"]] == [None]
    assert "linking_undefined" in {warning["code"] for warning in report["warnings"]}
    one, other = torus_link(1, 50)
    path = polyline(tmp_path / "large.obj", (one, True), (other, True))
    refused = cli.told(path, "--max-writhe", "40")
    assert [row["linking"] for row in refused["links"]] == [None]
    assert "linking_refused" in {warning["code"] for warning in refused["warnings"]}

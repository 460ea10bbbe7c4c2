"""Records of polylines that share ends are one curve, however they are cut, turned and shuffled."""

from __future__ import annotations

from collections import Counter, defaultdict
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from curvcli.curves.joined import Joined, join
from curvcli.mesh.file import Polylines
from tests.curves.conftest import Cli, polyline
from tests.curves.shapes import regular, trefoil


def joined(records: list[list[int]]) -> Joined:
    sizes = np.cumsum([0, *map(len, records)])
    return join(Polylines(np.array([v for record in records for v in record], np.int32), sizes))


def listed(found: Joined) -> list[tuple[list[int], bool]]:
    runs = zip(found.start[:-1].tolist(), found.start[1:].tolist(), found.closed.tolist(), strict=True)
    return [(found.vertex[a:b].tolist(), closed) for a, b, closed in runs]


def named(vertices: list[int], closed: bool) -> tuple[tuple[int, ...], bool]:
    """The same for a curve and its reverse, wherever a closed one begins."""
    turns = range(len(vertices)) if closed else [0]
    ways = [vertices[k:] + vertices[:k] for k in turns]
    return min(tuple(way[::step]) for way in ways for step in (1, -1)), closed


def test_edges_are_joined_in_any_order_and_direction() -> None:
    assert listed(joined([[0, 1], [1, 2], [2, 3]])) == [([0, 1, 2, 3], False)]
    assert listed(joined([[0, 1], [1, 2], [2, 0]])) == [([0, 1, 2], True)]
    assert listed(joined([[2, 1], [3, 2], [1, 0]])) == [([3, 2, 1, 0], False)]
    assert listed(joined([[0, 1], [2, 1], [2, 0]])) == [([0, 1, 2], True)]
    assert listed(joined([[4, 5], [0, 1, 2], [3, 2], [5, 6, 7]])) == [([4, 5, 6, 7], False), ([0, 1, 2, 3], False)]


def test_branching_vertices_end_curves_and_are_counted() -> None:
    found = joined([[0, 1], [1, 2], [2, 3], [2, 4], [4, 5]])
    assert listed(found) == [([0, 1, 2], False), ([2, 3], False), ([2, 4, 5], False)]
    assert found.branching.tolist() == [2]
    through = joined([[0, 1, 2, 3], [2, 4]])
    assert listed(through) == [([0, 1, 2], False), ([2, 3], False), ([2, 4], False)]
    assert through.branching.tolist() == [2]
    lollipop = [[0, 1], [1, 2], [2, 3], [3, 1]]
    assert listed(joined(lollipop)) == [([0, 1], False), ([1, 2, 3, 1], False)]
    assert listed(joined([[0, 1, 2, 3, 1]])) == listed(joined(lollipop))


def test_a_record_goes_its_own_way() -> None:
    """Through a vertex of its own twice, round by itself, and as a single point."""
    eight = [0, 1, 2, 0, 3, 4, 0]
    assert listed(joined([eight])) == [(eight[:-1], True)]
    assert listed(joined([[5, 0, 1, 2, 0, 6]])) == [([5, 0, 1, 2, 0, 6], False)]
    assert listed(joined([[0, 1, 2, 3], [0, 1, 0]])) == [([0, 1, 2, 3], False), ([0, 1], True)]
    assert listed(joined([[3], [0, 1], [], [7, 7]])) == [([3], False), ([0, 1], False), ([7], True)]
    assert listed(joined([[0, 1], [1, 1], [1, 2]])) == [([0, 1, 2], False)]
    assert listed(joined([])) == []


@pytest.mark.parametrize("seed", range(20))
def test_curves_that_were_cut_to_pieces(seed: int) -> None:
    rng = np.random.default_rng(seed)
    curves, count = [], 0
    for _ in range(rng.integers(1, 12)):
        size = int(rng.integers(3, 40))
        curves.append((list(range(count, count + size)), bool(rng.random() < 0.5)))
        count += size
    name = rng.permutation(count).tolist()
    records = []
    for vertices, closed in curves:
        way = [name[v] for v in (vertices + vertices[:1] if closed else vertices)]
        cuts = sorted({0, len(way) - 1, *rng.integers(0, len(way), 5).tolist()})
        pieces = [way[a : b + 1] for a, b in pairwise(cuts)]
        records += [piece[:: rng.choice([1, -1])] for piece in pieces]
    rng.shuffle(records)
    found = joined(records)
    expected = sorted(named([name[v] for v in vertices], closed) for vertices, closed in curves)
    assert sorted(named(*curve) for curve in listed(found)) == expected
    assert not len(found.branching)


def walked(edges: list[tuple[int, int]]) -> Counter[tuple[tuple[int, ...], bool]]:
    """The curves of a graph, edge by edge: they go on at vertices of two edges."""
    at = defaultdict(list)
    for number, (a, b) in enumerate(edges):
        at[a].append(number)
        at[b].append(number)
    left, curves = set(range(len(edges))), Counter[tuple[tuple[int, ...], bool]]()
    while left:
        first = left.pop()
        way = list(edges[first])
        for _ in range(2):
            while len(at[way[-1]]) == 2 and (onward := left.intersection(at[way[-1]])):
                number = onward.pop()
                left.discard(number)
                a, b = edges[number]
                way.append(b if a == way[-1] else a)
            way.reverse()
        closed = way[0] == way[-1] and len(at[way[0]]) == 2
        curves[named(way[:-1] if closed else way, closed)] += 1
    return curves


@pytest.mark.parametrize("seed", range(30))
def test_random_networks_of_edges(seed: int) -> None:
    """As an edge-by-edge walk finds them."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(4, 40))
    pairs = {tuple(sorted(rng.choice(n, 2, replace=False).tolist())) for _ in range(int(rng.integers(2, n + 8)))}
    edges = [tuple(pair[:: rng.choice([1, -1])]) for pair in pairs]
    rng.shuffle(edges)
    records = [list(map(int, edge)) for edge in edges]
    found = joined(records)
    assert Counter(named(*curve) for curve in listed(found)) == walked([(a, b) for a, b in records])
    degree = np.bincount(np.array(records).ravel(), minlength=n)
    assert found.branching.tolist() == np.flatnonzero(degree > 2).tolist()


def test_a_million_edges_take_no_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    """The records are never looked at one by one."""
    n = 1_000_000
    vertex = np.stack([np.arange(n), (np.arange(n) + 1) % n], axis=1).astype(np.int32).ravel()
    monkeypatch.setattr(Polylines, "__getitem__", None)
    found = join(Polylines(vertex, np.arange(0, 2 * n + 1, 2)))
    np.testing.assert_array_equal(found.vertex, np.arange(n))
    assert found.closed.tolist() == [True]


# ---------------------------------------------------------------------------- by the command line


def edges_of(path: Path, points: np.ndarray, seed: int = 0) -> Path:
    """A closed curve as editors write the edges of a mesh: one record each."""
    rng = np.random.default_rng(seed)
    n = len(points)
    pairs = [(k + 1, (k + 1) % n + 1)[:: rng.choice([1, -1])] for k in rng.permutation(n).tolist()]
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()] + [f"l {a} {b}" for a, b in pairs]
    path.write_text("\n".join([*lines, ""]))
    return path


def test_a_knot_of_shuffled_edges_is_the_knot(cli: Cli, tmp_path: Path) -> None:
    one = cli.told(polyline(tmp_path / "one.obj", (trefoil(120), True)))["curves"]
    other = cli.told(edges_of(tmp_path / "other.obj", trefoil(120)))["curves"]
    assert len(one) == len(other) == 1
    assert other[0]["closed"]
    for key in ("vertices", "length", "total_curvature", "writhe"):
        assert other[0][key] == pytest.approx(one[0][key], rel=1e-12)


def test_a_network_is_told_by_its_branching_vertices(cli: Cli, tmp_path: Path) -> None:
    path = tmp_path / "y.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nl 1 2\nl 1 3\nl 1 4\n")
    report = cli.told(path)
    assert [row["closed"] for row in report["curves"]] == [False] * 3
    (warning,) = report["warnings"]
    assert (warning["code"], warning["count"], warning["examples"]) == ("branching_vertices", 1, [0])


def test_a_repeated_last_point_is_closed_by_welding_and_hinted_at_otherwise(cli: Cli, tmp_path: Path) -> None:
    points = regular(12)
    path = polyline(tmp_path / "ring.obj", (np.vstack([points, points[:1]]), False))
    report = cli.told(path)
    assert [row["closed"] for row in report["curves"]] == [False]
    (warning,) = report["warnings"]
    assert (warning["code"], warning["count"]) == ("coincident_ends", 2)
    assert "--weld exact" in warning["hint"]
    (row,) = cli.told(path, "--weld", "exact")["curves"]
    assert (row["closed"], row["vertices"], row["turning_number"]) == (True, 12, 1)


def test_curves_that_meet_end_to_end_with_vertices_of_their_own(cli: Cli, tmp_path: Path) -> None:
    points = regular(12)
    path = polyline(tmp_path / "arcs.obj", (points[:7], False), (np.vstack([points[6:], points[:1]]), False))
    report = cli.told(path)
    assert len(report["curves"]) == 2
    assert [(w["code"], w["count"]) for w in report["warnings"]] == [("coincident_ends", 4)]
    (row,) = cli.told(path, "--weld", "exact")["curves"]
    assert (row["closed"], row["vertices"]) == (True, 12)

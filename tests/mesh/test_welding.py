"""Welding: exactly equal positions at any scale, and nearly equal ones within a tolerance."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from curvcli.errors import InputError
from curvcli.loading.formats.obj.parse import parse_obj
from curvcli.mesh import welding as weld
from curvcli.mesh.welding import weld_exact, weld_within, welded

few = st.sampled_from([0.0, -0.0, 1.0, 1e-300, 1 + 2**-52, -1.0, 1e300])
positions = arrays(np.float64, st.tuples(st.just(3), st.integers(1, 60)), elements=few)


def by_hand(xyz: np.ndarray) -> tuple[list[int], list[int]]:
    number: dict[tuple[float, ...], int] = {}
    first: list[int] = []
    inverse: list[int] = []
    for k, p in enumerate(map(tuple, (xyz.T + 0).tolist())):
        if p not in number:
            number[p] = len(first)
            first.append(k)
        inverse.append(number[p])
    return first, inverse


@given(positions, st.sampled_from([np.float64, np.float32]))
def test_exact_groups_in_order_of_first_appearance(xyz: np.ndarray, kind: type) -> None:
    with np.errstate(over="ignore", under="ignore"):
        xyz = xyz.astype(kind)
    first, inverse = weld_exact(xyz)
    assert (first.tolist(), inverse.tolist()) == by_hand(xyz)


@given(positions, st.integers(0, 40))
def test_colliding_hashes_do_no_harm(xyz: np.ndarray, useless: int) -> None:
    """The hash is replaced by a constant for some or for all rounds."""
    good = weld._hash
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            weld, "_hash", lambda bits, k: good(bits, k) if k >= useless else np.zeros(len(bits[0]), np.uint64)
        )
        first, inverse = weld_exact(xyz)
    assert (first.tolist(), inverse.tolist()) == by_hand(xyz)


@pytest.mark.parametrize("threads", ["1", "2"])
def test_many_positions_weld_alike_on_any_number_of_threads(threads: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", threads)
    grid = np.stack(np.meshgrid(*[np.arange(40.0) * 1e-9] * 3)).reshape(3, -1)
    order = np.random.default_rng(1).integers(0, grid.shape[1], 300_000)
    first, inverse = weld_exact(grid[:, order])
    distinct, expected_first = np.unique(order, return_index=True)
    assert first.tolist() == sorted(expected_first.tolist())
    assert len(first) == len(distinct)
    np.testing.assert_array_equal(order[first][inverse], order)


@pytest.mark.parametrize("scale", [1e-200, 1e-9, 1.0, 1e9, 1e200])
def test_the_tolerance_is_relative_to_the_diagonal(scale: float) -> None:
    xyz = np.array([[0, 1, 1.001, 0.0005, 1.0021], [0] * 5, [0] * 5]) * scale
    assert weld_within(xyz, 1e-4).tolist() == [0, 1, 2, 3, 4]
    assert weld_within(xyz, 6e-4).tolist() == [0, 1, 2, 0, 4]
    assert weld_within(xyz, 2e-3).tolist() == [0, 1, 1, 0, 1]


def test_positions_that_are_not_finite_stay_alone() -> None:
    xyz = np.array([[0, np.nan, 0, np.inf, np.nan], [0] * 5, [0] * 5], float)
    assert weld_within(xyz, 0.1).tolist() == [0, 1, 0, 3, 4]
    assert weld_within(np.full((3, 2), np.nan), 0.1).tolist() == [0, 1]
    assert weld_within(np.zeros((3, 3)), 0.1).tolist() == [0, 0, 0]


def test_rows_stay_and_corners_move() -> None:
    data = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0.0 0 0\nv 0 1.00001 0\nv 1 1 0\nf 1 2 3\nf 5 2 6\nl 4 5\nf 4 2 6\n"
    mesh = parse_obj(data)
    exact = welded(mesh, "exact")
    assert exact.welded_to is not None
    assert exact.welded_to.tolist() == [-1, -1, -1, 0, -1, -1]
    assert exact.corners.tolist() == [0, 1, 2, 4, 1, 5, 0, 1, 5]
    assert exact.polylines[0].tolist() == [0, 4]
    assert [(n.code, n.count, n.examples) for n in exact.notices] == [("welded_vertices", 1, (3,))]
    near = welded(mesh, 1e-4)
    assert near.welded_to is not None
    assert near.welded_to.tolist() == [-1, -1, -1, 0, 2, -1]
    assert near.corners.tolist() == [0, 1, 2, 2, 1, 5, 0, 1, 5]
    assert welded(mesh, "auto") is mesh
    np.testing.assert_array_equal(near.xyz, mesh.xyz)


def test_a_crowd_is_refused_and_equal_positions_are_none() -> None:
    rng = np.random.default_rng(0)
    crowd = np.concatenate([rng.random((3, 3000)) * 1e-6, np.ones((3, 1))], axis=1)
    with pytest.raises(InputError, match="2999 positions lie within the tolerance"):
        weld_within(crowd, 1e-3)
    equal = np.concatenate([np.zeros((3, 100_000)), np.full((3, 100_000), 1e-9), np.ones((3, 1))], axis=1)
    assert np.unique(weld_within(equal, 1e-3)).tolist() == [0, 200_000]

"""Statistics by group: equal to numpy's on each group, nulls counted, sizes at the ends of the range of doubles."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from curvcli.analysis.statistics import REPORTED, STATISTICS, GroupedColumn, parse_statistics
from curvcli.errors import UsageError
from curvcli.mesh.groups import Segments

EVERY = (*STATISTICS, "p0", "p10", "p97.5", "p100", "area_p02", "area_p50", "area_p100")


def expected(name: str, x: NDArray[np.float64], area: NDArray[np.float64], nulls: int) -> float:
    """One statistic by numpy; x and area of the known values of one group."""
    if name in ("count", "nulls"):
        return len(x) if name == "count" else nulls
    if not len(x):
        return float("nan")
    plain: dict[str, Any] = {"min": np.min, "max": np.max, "mean": np.mean, "std": np.std, "sum": np.sum}
    plain |= {"median": np.median, "absmax": lambda x: np.abs(x).max()}
    if name in plain:
        return float(plain[name](x))
    if name in ("area_mean", "area_std"):
        mean = np.average(x, weights=area)
        return float(mean if name == "area_mean" else np.sqrt(np.average((x - mean) ** 2, weights=area)))
    weighted, _, percentage = name.replace("area_median", "area_p50").rpartition("p")
    share = float(percentage) / 100
    if not weighted:
        return float(np.quantile(x, share))
    return float(np.quantile(x, share, weights=area, method="inverted_cdf"))


def compare(values: NDArray[np.float64], area: NDArray[np.float64], label: NDArray[np.int32], groups: int) -> None:
    grouped = GroupedColumn(values, area, Segments(label, groups, len(values)))
    for name in EVERY:
        got = grouped.statistic(name)
        assert got.shape == (groups,)
        for group in range(groups):
            members = values[label == group]
            known = ~np.isnan(members)
            want = expected(name, members[known], area[label == group][known], int((~known).sum()))
            assert got[group] == pytest.approx(want, rel=1e-13, abs=1e-13, nan_ok=True), (name, group)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 300), st.integers(1, 40), st.sampled_from([0.0, 0.2, 0.9]))
def test_every_statistic_is_numpys(seed: int, n: int, groups: int, share_of_nulls: float) -> None:
    rng = np.random.default_rng(seed)
    label = rng.integers(-1, groups, n).astype(np.int32)
    values = rng.standard_normal(n)
    values[rng.random(n) < share_of_nulls] = np.nan
    compare(values, rng.uniform(0.5, 2.0, n), label, groups)


def test_groups_of_very_different_sizes() -> None:
    rng = np.random.default_rng(3)
    label = np.repeat(np.arange(5, dtype=np.int32), [1, 2, 9, 500, 20_000])
    order = rng.permutation(len(label))
    compare(rng.standard_normal(len(label)), rng.uniform(0.5, 2.0, len(label)), label[order], 5)


def test_ties_and_values_of_no_area() -> None:
    area = np.array([0.0, 1.0, 1.0, 0.0, 0.0])
    grouped = GroupedColumn(np.array([5.0, 1.0, 1.0, -4.0, 7.0]), area, Segments(np.array([0, 0, 0, 0, 1]), 2, 5))
    assert grouped.statistic("area_p0").tolist()[0] == 1.0
    assert grouped.statistic("area_p100").tolist()[0] == 1.0
    assert grouped.statistic("area_mean").tolist()[0] == 1.0
    assert grouped.statistic("max").tolist() == [5.0, 7.0]
    for name in ("area_mean", "area_std", "area_median"):
        assert np.isnan(grouped.statistic(name)[1]), "a group without area has no weighted statistic"


@pytest.mark.parametrize("power", [-1073, -600, 600, 1022])
def test_sizes_at_the_ends_of_the_range_of_doubles(power: int) -> None:
    """One group of tiny or huge values beside one of ordinary values; no square is computed in their own unit."""
    ordinary = np.array([1.0, 2.0, 3.0])
    values = np.concatenate(
        [np.ldexp(ordinary / 2, power + 1) if power < 0 else np.ldexp(ordinary / 4, power), ordinary]
    )
    grouped = GroupedColumn(values, np.ones(6), Segments(np.repeat([0, 1], 3).astype(np.int32), 2, 6))
    for name in ("mean", "median", "area_mean", "area_median"):
        np.testing.assert_allclose(grouped.statistic(name), [values[1], 2.0], rtol=1e-15)
    if power > -1000:
        np.testing.assert_allclose(grouped.statistic("std") / values[[1, 4]], np.sqrt(2 / 3) / 2, rtol=1e-14)


def test_the_whole_is_a_group_of_all() -> None:
    rng = np.random.default_rng(5)
    values, area = rng.standard_normal(1000), rng.random(1000)
    values[::7] = np.nan
    whole = GroupedColumn(values, area, Segments(None, 1, 1000))
    labelled = GroupedColumn(values, area, Segments(np.zeros(1000, np.int32), 1, 1000))
    for name in EVERY:
        assert whole.statistic(name).tolist() == labelled.statistic(name).tolist()


def test_names() -> None:
    assert parse_statistics("mean, p02,mean") == ("mean", "p02")
    assert parse_statistics(["count,area_p97.5", "std"]) == ("count", "area_p97.5", "std")
    assert parse_statistics(()) == ()
    assert {*REPORTED} <= {*STATISTICS}
    for name, nearest in (("men", "mean"), ("area_medan", "area_median"), ("p101", ""), ("p-1", ""), ("", "")):
        with pytest.raises(UsageError, match=f"unknown statistic .*{nearest}"):
            parse_statistics(name)

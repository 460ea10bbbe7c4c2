"""Comparison of groups: scipy's numbers key by key, closed cases, planted differences, missing values, rounding."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pytest
from scipy import stats

from curvcli.errors import UsageError
from curvcli.report.groups.means import TestOptions, adjusted, differences
from curvcli.report.groups.members import Member, key_of, member
from curvcli.report.groups.model import GroupComparison, compare_groups, group_table

Key = tuple[str | None, str, str]
TOTAL: Key = (None, "area", "total")


def group(name: str, rows: Mapping[Key, Sequence[float | None]], rounding: float = 0.0) -> tuple[str, list[Member]]:
    count = len(next(iter(rows.values())))
    members = []
    for k in range(count):
        values = {key: values[k] for key, values in rows.items() if values[k] is not None}
        members.append(Member(f"{name}{k}", values, dict.fromkeys(values, rounding)))
    return name, members


def compared(a: Any, b: Any, **options: Any) -> GroupComparison:
    return compare_groups(a, b, TestOptions(**options), lambda key: True)


def random_groups(seed: int = 0, keys: int = 6, shift: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    generator = np.random.default_rng(seed)
    scales = 10.0 ** generator.integers(-6, 6, (keys, 1))
    return scales * generator.normal(size=(keys, 9)), scales * (generator.normal(size=(keys, 7)) * 2 + shift)


def test_scipy_has_the_same_numbers() -> None:
    a, b = random_groups(shift=1.0)
    found = differences(a, b, np.ones(len(a), bool), TestOptions(alpha=0.01))
    expected = stats.ttest_ind(b, a, axis=1, equal_var=False)
    interval = expected.confidence_interval(0.99)
    for name, values in (
        *(("t", expected.statistic), ("df", expected.df), ("p", expected.pvalue), ("low", interval.low)),
        *(("high", interval.high), ("difference", b.mean(axis=1) - a.mean(axis=1)), ("std_a", a.std(axis=1, ddof=1))),
    ):
        np.testing.assert_allclose(getattr(found, name), values, rtol=1e-9, err_msg=name)
    np.testing.assert_allclose(adjusted(found.p, "by"), stats.false_discovery_control(expected.pvalue, method="by"))


def test_a_closed_case() -> None:
    """A = 1, 2, 3 and B = 2, 4, 6: t = 2/√(1/3 + 4/3), ν = (5/3)²/((1/9 + 16/9)/2), g = 2/√2.5 · Γ(2)/(√2 Γ(3/2))."""
    found = differences(np.array([[1.0, 2, 3]]), np.array([[2.0, 4, 6]]), np.ones(1, bool), TestOptions())
    assert found.t[0] == pytest.approx(2 / np.sqrt(5 / 3))
    assert found.df[0] == pytest.approx((5 / 3) ** 2 / ((1 / 9 + 16 / 9) / 2))
    assert found.g[0] == pytest.approx(2 / np.sqrt(2.5) / (np.sqrt(2) * np.sqrt(np.pi) / 2))


def test_few_arrangements_are_all_counted() -> None:
    """Of the 20 ways to choose 3 of 6 values, 2 have a difference as large as that of 1, 2, 3 and 10, 11, 12."""
    a, b = np.array([[1.0, 2, 3]]), np.array([[10.0, 11, 12]])
    found = differences(a, b, np.ones(1, bool), TestOptions(test="permutation"))
    assert found.p[0] == pytest.approx(2 / 20)


def test_permutations_of_a_key_do_not_depend_on_the_others() -> None:
    a, b = random_groups(keys=5)
    options = TestOptions(test="permutation", resamples=499, seed=7)
    together = differences(a, b, np.ones(5, bool), options).p
    alone = [differences(a[k : k + 1], b[k : k + 1], np.ones(1, bool), options).p[0] for k in range(5)]
    assert together.tolist() == alone
    assert together.tolist() == differences(a, b, np.ones(5, bool), options).p.tolist()
    other = differences(a, b, np.ones(5, bool), TestOptions(test="permutation", resamples=499, seed=8)).p
    assert together.tolist() != other.tolist()


@pytest.mark.parametrize("test", ["welch", "permutation"])
def test_a_planted_difference_is_found_in_its_direction(test: str) -> None:
    generator = np.random.default_rng(3)
    rows = {(None, f"x{k}", "total"): generator.normal(size=20).tolist() for k in range(30)}
    others = {key: generator.normal(size=20).tolist() for key in rows}
    others[None, "x7", "total"] = (generator.normal(size=20) + 3).tolist()
    report = compared(group("a", rows), group("b", others), test=test)
    assert [row.column for row in report.differences if row.significant] == ["x7"]
    (row,) = (row for row in report.differences if row.significant)
    assert row.difference is not None
    assert row.difference > 0
    assert row.ci_low is not None
    assert row.ci_low > 0
    back = compared(group("b", others), group("a", rows), test=test)
    (turned,) = (row for row in back.differences if row.significant)
    assert turned.difference == -row.difference
    assert turned.hedges_g == pytest.approx(-(row.hedges_g or 0))


def test_equal_groups_differ_in_nothing() -> None:
    rows = {TOTAL: [1.0, 2.0, 4.0, 8.0]}
    report = compared(group("a", rows), group("b", rows))
    assert report.significant == 0
    assert report.differences[0].p == pytest.approx(1)
    assert report.differences[0].difference == 0


def test_rounding_is_not_tested() -> None:
    """Two groups of constants that differ in the last digits: no difference."""
    noise = 1e-15 * np.arange(6)
    a, b = {TOTAL: (4 + noise).tolist()}, {TOTAL: (4 + 1e-13 + noise).tolist()}
    spread = np.std(a[TOTAL], ddof=1) / np.sqrt(3)
    assert 1e-13 / spread > 50  # Welch's t would be significant
    report = compared(group("a", a, 1e-12), group("b", b, 1e-12))
    assert [row.status for row in report.differences] == ["same"]
    assert report.tested == report.significant == 0


def test_missing_values_are_counted_and_left_out() -> None:
    a, b = {TOTAL: [1.0, None, 3.0, 5.0]}, {TOTAL: [2.0, 4.0, None, None]}
    (row,) = compared(group("a", a), group("b", b)).differences
    assert (row.n_a, row.missing_a, row.n_b, row.missing_b) == (3, 1, 2, 2)
    assert row.p == pytest.approx(stats.ttest_ind([2, 4], [1, 3, 5], equal_var=False).pvalue)


@pytest.mark.parametrize(
    ("a", "b", "status"),
    [
        ([1.0], [2.0, 3.0], "too_few"),
        ([1.0, 1.0], [2.0, 2.0], "no_variation"),
        ([1.0, 1.0], [1.0, 1.0], "same"),
        ([None, None], [1.0, 2.0], "too_few"),
    ],
)
def test_numbers_that_no_test_can_judge(a: list[float | None], b: list[float | None], status: str) -> None:
    (row,) = compared(group("a", {TOTAL: a}), group("b", {TOTAL: b})).differences
    assert row.status == status
    assert row.p is row.q is row.hedges_g is None
    assert not row.significant


def test_the_largest_numbers_do_not_overflow() -> None:
    rows = np.array([[1e308, 1.5e308, 1.2e308], [5e-324, 1e-323, 2e-323]])
    found = differences(rows, rows[:, ::-1] * 0.5, np.ones(2, bool), TestOptions())
    assert np.isfinite(found.t[0])
    assert found.mean_a[0] == pytest.approx(1.2333e308, rel=1e-3)


def test_unknown_statistics_are_refused_with_the_nearest() -> None:
    rows = {TOTAL: [1.0, 2.0], (None, "h", "mean"): [1.0, 2.0]}
    with pytest.raises(UsageError, match=r"--stat meen: .*nearest: mean"):
        compare_groups(group("a", rows), group("b", rows), TestOptions(), lambda key: True, ["meen"])
    with pytest.raises(UsageError, match="nothing is left to compare"):
        compare_groups(group("a", rows), group("b", rows), TestOptions(), lambda key: False)


def test_different_conventions_are_noted() -> None:
    first = Member("a", {TOTAL: 1.0}, {}, {"mean": "sum"})
    second = Member("b", {TOTAL: 1.0}, {}, {"mean": "average"})
    report = compared(("a", [first, first]), ("b", [second, second]))
    assert report.notes == ["the conventions of the reports differ (mean), so the numbers mean different things"]


def test_keys_and_the_table() -> None:
    assert key_of(None, "K", "total") == "totals.K"
    assert key_of("V1", "h", "mean") == "regions.V1.columns.h.mean"
    assert key_of("V1", "area", "share") == "regions.V1.shares.area"
    report = compared(group("a", {TOTAL: [1.0, 2.0]}), group("b", {TOTAL: [1.0, 3.0]}))
    table = group_table(report)
    assert table["key"].words().tolist() == ["totals.area"]
    assert table["region"].words().tolist() == [None]
    assert table["difference"].tolist() == [0.5]


def test_rounding_of_a_sum_follows_the_faces() -> None:
    from curvcli.report.entries import Entry

    whole = {"topology": {"faces": 100, "vertices": 52}, "totals": {"area": 4.0}}
    entries = [Entry(None, "area", "total", 4.0), Entry(None, "A_vec_x", "total", 0.0), Entry(None, "h", "count", 52)]
    found = member("m", entries, whole).rounding
    terms = 16 * 2.0**-52 * 152
    assert found[None, "area", "total"] == pytest.approx(terms * (4.0 / 100 + 4.0))
    assert found[None, "A_vec_x", "total"] == pytest.approx(terms * (4.0 / 100 + 4.0))
    assert found[None, "h", "count"] == 0

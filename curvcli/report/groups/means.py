"""Tests of the difference of two means, by scipy: Welch's t, permutations; Hedges' g; false discovery rates."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np

from ...support.arrays import Floats, Mask

Correction = Literal["bh", "by", "none"]
TESTS, CORRECTIONS = ("welch", "permutation"), get_args(Correction)
# Values of all keys in one block of permutations.
_BLOCK = 1 << 22


@dataclass(frozen=True)
class TestOptions:
    """Options of the tests.

    test: `welch` or `permutation`. alpha: significance level; the confidence intervals have level 1 − alpha.
    correction: `bh` (Benjamini-Hochberg), `by` (Benjamini-Yekutieli) or `none`. resamples, seed: of permutations.
    """

    __test__ = False  # no test of pytest

    test: str = "welch"
    alpha: float = 0.05
    correction: Correction = "bh"
    resamples: int = 9999
    seed: int = 0


@dataclass(frozen=True)
class Differences:
    """Differences B − A of K keys, (K,) each; NaN where undefined.

    low, high: confidence interval of the difference (Welch). t, df: of Welch's test. p: of the chosen test.
    g: Hedges' g, the difference in pooled standard deviations, corrected for small samples.
    """

    mean_a: Floats
    mean_b: Floats
    std_a: Floats
    std_b: Floats
    difference: Floats
    low: Floats
    high: Floats
    t: Floats
    df: Floats
    p: Floats
    g: Floats


def differences(a: Floats, b: Floats, varies: Mask, options: TestOptions) -> Differences:
    """Compare the means of K keys in two groups.

    a: (K, n), b: (K, m); NaN is missing and left out. varies: (K,) true where the values differ by more than rounding;
    others are not tested. A group of fewer than two values is not tested, and Welch's test not where neither group
    varies. Each key is computed in units of a power of two near its largest value.
    """
    count = len(a)
    size = np.nanmax(np.abs(np.concatenate([a, b, np.zeros((count, 1))], axis=1)), axis=1)
    unit = np.ldexp(1.0, np.maximum(np.frexp(size)[1] - 1, -1000))[:, None]
    unit[size == 0] = 1.0
    a, b = a / unit, b / unit
    columns = {name: np.full(count, np.nan) for name in Differences.__dataclass_fields__}
    for rows in _alike(a, b):
        first, second = (side[rows][:, ~np.isnan(side[rows[0]])] for side in (a, b))
        for name, column in _compared(first, second, varies[rows], options).items():
            columns[name][rows] = column
    for name in ("mean_a", "mean_b", "std_a", "std_b", "difference", "low", "high"):
        columns[name] *= unit[:, 0]
    return Differences(**columns)


def _alike(a: Floats, b: Floats) -> list[Any]:
    """Rows with the same missing members."""
    missing = np.isnan(np.concatenate([a, b], axis=1))
    _, pattern = np.unique(missing, axis=0, return_inverse=True)
    pattern = pattern.reshape(-1)
    return [np.flatnonzero(pattern == number) for number in range(pattern.max(initial=-1) + 1)]


def _compared(a: Floats, b: Floats, varies: Mask, options: TestOptions) -> dict[str, Floats]:
    columns: dict[str, Floats] = {}
    for side, values in (("a", a), ("b", b)):
        if values.shape[1]:
            columns[f"mean_{side}"] = values.mean(axis=1)
        if values.shape[1] > 1:
            columns[f"std_{side}"] = values.std(axis=1, ddof=1)
    if min(a.shape[1], b.shape[1]) < 1:
        return columns
    columns["difference"] = columns["mean_b"] - columns["mean_a"]
    if min(a.shape[1], b.shape[1]) < 2:
        return columns
    spread = columns["std_a"] + columns["std_b"] > 0
    columns |= _welch(a, b, spread & varies, options.alpha)
    columns["g"] = _hedges(columns, a.shape[1], b.shape[1], spread & varies)
    if options.test == "permutation":
        columns["p"] = _permutation(a, b, varies, options)
    return columns


def _welch(a: Floats, b: Floats, tested: Mask, alpha: float) -> dict[str, Floats]:
    """Welch's t test of unequal variances, and the confidence interval of the difference."""
    from scipy.stats import ttest_ind

    columns = {name: np.full(len(a), np.nan) for name in ("t", "df", "p", "low", "high")}
    if tested.any():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # of a group that varies in its last digits
            outcome = ttest_ind(b[tested], a[tested], axis=1, equal_var=False)
            interval = outcome.confidence_interval(1 - alpha)
        for name, values in zip(
            columns, (outcome.statistic, outcome.df, outcome.pvalue, interval.low, interval.high), strict=True
        ):
            columns[name][tested] = values
    return columns


def _hedges(columns: dict[str, Floats], n: int, m: int, defined: Mask) -> Floats:
    """Hedges' g with the exact correction Γ(ν/2) / (√(ν/2) Γ((ν − 1)/2)), ν = n + m − 2."""
    from scipy.special import gammaln

    degrees = n + m - 2
    correction = np.exp(gammaln(degrees / 2) - gammaln((degrees - 1) / 2)) / np.sqrt(degrees / 2)
    pooled = np.sqrt(((n - 1) * columns["std_a"] ** 2 + (m - 1) * columns["std_b"] ** 2) / degrees)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(defined, correction * columns["difference"] / pooled, np.nan)


def _permutation(a: Floats, b: Floats, tested: Mask, options: TestOptions) -> Floats:
    """Two-sided permutation test of the difference of means; exact where the groups have few arrangements.

    Every key sees the same arrangements, so its p does not depend on the other keys.
    """
    from scipy.stats import permutation_test

    p = np.full(len(a), np.nan)
    if tested.any():
        outcome = permutation_test(
            (b[tested], a[tested]),
            lambda first, second, axis: first.mean(axis=axis) - second.mean(axis=axis),
            vectorized=True,
            n_resamples=options.resamples,
            random_state=np.random.default_rng(options.seed),
            batch=max(1, _BLOCK // (tested.sum() * (a.shape[1] + b.shape[1]))),
            axis=1,
        )
        p[tested] = outcome.pvalue
    return p


def adjusted(p: Floats, correction: Correction) -> Floats:
    """p corrected for the number of tests: the false discovery rate at which each is significant. NaN is no test."""
    from scipy.stats import false_discovery_control

    q = p.copy()
    tested = ~np.isnan(p)
    if correction != "none" and tested.any():
        q[tested] = false_discovery_control(p[tested], method=correction)
    return q

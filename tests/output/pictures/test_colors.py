"""Colours at known places of known maps, and ranges worked out by hand."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import numpy as np
import pytest

from curvcli.errors import UsageError
from curvcli.output.pictures.colors import ColorScale, colorize

GREY = [128, 128, 128]
VIRIDIS = [68, 1, 84], [253, 231, 37]
VIK = [0, 18, 97], [89, 0, 8]


def scale(values: list[float] | np.ndarray, **options: Any) -> ColorScale:
    return colorize(np.asarray(values, np.float64), **options)


def test_ends_of_the_range_are_ends_of_the_map() -> None:
    got = scale([-5, 0, 1, 9, np.nan], cmap="viridis", value_range="0:1")
    assert got.rgb.tolist() == [VIRIDIS[0], VIRIDIS[0], VIRIDIS[1], VIRIDIS[1], GREY]
    assert (got.low, got.high, got.clipped_below, got.clipped_above, got.nulls) == (0, 1, 1, 1, 1)
    assert got.cmap == "viridis"


def test_zero_is_the_middle_of_a_signed_column() -> None:
    got = scale([-2, 0, 2], signed=True, value_range="p100")
    assert got.rgb.tolist() == [VIK[0], got.gradient[255].tolist(), VIK[1]]
    assert (got.low, got.high) == (-2, 2)
    assert got.gradient[255].min() > 220


def test_the_default_range_cuts_two_percent_at_each_end() -> None:
    values = np.arange(101.0)
    got = scale(values)
    assert (got.low, got.high, got.clipped_below, got.clipped_above) == (2, 98, 2, 2)
    got = scale(values - 100, signed=True)
    assert (got.low, got.high, got.clipped_below, got.clipped_above) == (-98, 98, 2, 0)


def test_p90_cuts_five_percent_at_each_end() -> None:
    assert (lambda got: (got.low, got.high))(scale(np.arange(101.0), value_range="p90")) == pytest.approx((5, 95))
    assert (lambda got: (got.low, got.high))(scale(np.arange(101.0), value_range="p90", signed=True)) == (-90, 90)


def test_what_is_ignored_or_undefined_does_not_widen_the_range() -> None:
    values = np.array([1.0, 2, 3, 1e9, np.nan])
    got = scale(values, ignore=values > 1e6, value_range="p100", cmap="viridis")
    assert (got.low, got.high, got.clipped_above, got.nulls) == (1, 3, 1, 1)
    assert got.rgb[3:].tolist() == [VIRIDIS[1], GREY]


def test_nothing_but_ignored_values_are_better_than_none() -> None:
    got = scale([1, 3], ignore=np.ones(2, np.bool_), value_range="p100")
    assert (got.low, got.high) == (1, 3)


@pytest.mark.parametrize("signed", [True, False])
@pytest.mark.parametrize("values", [[], [np.nan, np.nan]])
def test_columns_of_nulls_are_grey(values: list[float], signed: bool) -> None:
    got = scale(values, signed=signed)
    assert (got.low, got.high, got.nulls) == (None, None, len(values))
    assert got.rgb.tolist() == [GREY] * len(values)


@pytest.mark.parametrize(("value", "signed", "place"), [(0, True, 255), (7, True, 510), (-7, True, 0), (7, False, 255)])
def test_a_constant_column_has_one_colour(value: float, signed: bool, place: int) -> None:
    got = scale([value] * 3 + [np.nan], signed=signed)
    assert got.rgb.tolist() == [got.gradient[place].tolist()] * 3 + [GREY]
    assert got.clipped_below == got.clipped_above == 0


@pytest.mark.parametrize(("signed", "expected"), [(True, (-5, 5)), (False, (0, 5))])
def test_a_few_values_among_equal_ones_still_make_a_range(signed: bool, expected: tuple[float, float]) -> None:
    got = scale([0.0] * 1000 + [5.0], signed=signed)
    assert (got.low, got.high, got.clipped_above) == (*expected, 0)


def test_rounding_makes_no_range() -> None:
    """K of a finely cut block is rounding but at its corners; areas of a regular grid differ in their last digits."""
    noise = 1e-16 * np.sin(np.arange(1000.0))
    got = scale([*noise, 1.5, 1.5, -1.5], signed=True)
    assert (got.low, got.high, got.clipped_below, got.clipped_above) == (-1.5, 1.5, 0, 0)
    assert got.rgb[:1000].tolist() == [got.gradient[255].tolist()] * 1000
    got = scale(0.1 + noise)
    assert got.low == got.high == pytest.approx(0.1, rel=1e-15)
    assert got.rgb.tolist() == [got.gradient[255].tolist()] * 1000
    assert got.clipped_below == got.clipped_above == 0
    got = scale([*(0.1 + noise), 7.0], value_range="p90")
    assert (got.low, got.high) == (pytest.approx(0.1), 7)


def test_what_is_more_than_rounding_is_a_range() -> None:
    got = scale(1 + 1e-13 * np.arange(101))
    assert 1 < got.low < got.high < 1 + 1e-11
    got = scale([*(1e-13 * np.arange(-500, 501)), 1.0], signed=True)
    assert got.high == pytest.approx(4.9e-11, rel=0.01)


def test_integers_and_masked_integers() -> None:
    got = colorize(np.ma.array([3, 99, 6], mask=[False, True, False]), value_range="p100", cmap="viridis")
    assert got.rgb.tolist() == [VIRIDIS[0], GREY, VIRIDIS[1]]
    assert (got.low, got.high, got.nulls) == (3, 6, 1)
    assert colorize(np.array([3, 6]), value_range="p100", cmap="viridis").rgb.tolist() == [*VIRIDIS]


@pytest.mark.parametrize("size", [1e-310, 1e-300, 1e300, 1.7e308])
def test_values_of_extreme_size_keep_their_colours(size: float) -> None:
    got = scale(np.array([-size, 0, size]), value_range="p100", cmap="viridis")
    assert (got.low, got.high) == (-size, size)
    assert got.rgb[[0, 2]].tolist() == [*VIRIDIS]
    assert got.rgb[1].tolist() == got.gradient[255].tolist()


def test_undefined_is_told_from_every_colour_of_a_grey_map() -> None:
    got = scale([0, 0.5, 1, np.nan], cmap="gray", value_range="0:1")
    assert got.rgb.tolist() == [[0, 0, 0], GREY, [255, 255, 255], [255, 0, 255]]
    assert got.undefined == (255, 0, 255)


def test_maps_by_any_of_their_names() -> None:
    one = scale([0, 1], cmap="crameri:vik", value_range="0:1").rgb.tolist()
    assert one == scale([0, 1], cmap="VIK", value_range="0:1").rgb.tolist()
    assert one[::-1] == scale([0, 1], cmap="vik_r", value_range="0:1").rgb.tolist()


def test_an_unknown_map_is_answered_with_near_names() -> None:
    with pytest.raises(UsageError, match=r"--cmap virdis: no such colour map; nearest: .*viridis"):
        scale([0], cmap="virdis")


@pytest.mark.parametrize(
    "text",
    ["", "1", "1:", ":1", "a:b", "1:1", "2:1", "nan:1", "0:inf", "1:2:3", "p", "p0", "p101", "p-5", "pnan", "95%"],
)
def test_a_range_that_is_none(text: str) -> None:
    with pytest.raises(UsageError, match="expected LO:HI"):
        scale([0, 1], value_range=text)


def test_a_map_known_by_two_names_says_nothing() -> None:
    program = (
        "import numpy as np; from curvcli.output.pictures.colors import colorize; "
        "colorize(np.zeros(1), cmap='coolwarm')"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout == done.stderr == ""

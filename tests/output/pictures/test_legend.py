"""The words of a legend: numbers, ranges and what they cut, ticks."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from curvcli.output.pictures.colors import categorize, colorize
from curvcli.output.pictures.legend import range_text, ticks
from curvcli.support.words import typeset_number

FINITE = st.floats(-1e300, 1e300, allow_subnormal=False)


@pytest.mark.parametrize(
    ("value", "text"), [(0.5, "0.5"), (-0.25, "−0.25"), (123456.0, "1.235·10⁵"), (-1e-9, "−1·10⁻⁹"), (0.0, "0")]
)
def test_numbers_in_legends_are_short(value: float, text: str) -> None:
    assert typeset_number(value) == text


@pytest.mark.parametrize(
    ("values", "options", "text"),
    [
        (range(101), {}, "2 to 98 (p02 to p98), cuts 2 below and 2 above"),
        (range(-50, 51), {"signed": True}, "−49 to 49 (p98 of |values|), cuts 1 below and 1 above"),
        (range(101), {"value_range": "p90"}, "5 to 95 (p05 to p95), cuts 5 below and 5 above"),
        (range(101), {"value_range": "-1:50"}, "−1 to 50 (range as asked), cuts 50 above"),
        (range(3), {"value_range": "0:2"}, "0 to 2 (range as asked), cuts nothing"),
        ([7, 7], {}, "7 wherever defined"),
        ([np.nan], {}, "undefined at every vertex"),
        ([1.0, 1.00001], {"value_range": "p100"}, "1 to 1.00001 (p00 to p100), cuts nothing"),
    ],
)
def test_the_range_and_what_it_cuts(values: object, options: dict[str, object], text: str) -> None:
    scale = colorize(np.array(values, np.float64), **options)  # type: ignore[arg-type]
    assert range_text(scale, options.get("value_range")) == text  # type: ignore[arg-type]


@given(FINITE, FINITE, st.integers(1, 12))
def test_ticks_lie_within_the_range_in_order_and_read_differently(one: float, two: float, room: int) -> None:
    low, high = sorted([one, two])
    places, labels, power = ticks(low, high, room)
    assert 1 <= len(places) == len(labels) <= room + 2
    margin = 1e-9 * max(abs(low), abs(high))
    assert all(low - margin <= place <= high + margin for place in places)
    assert all(a < b for a, b in itertools.pairwise(places))
    assert len(set(labels)) == len(labels)
    assert power % 3 == 0


def test_ticks_are_what_their_labels_say() -> None:
    assert ticks(-1, 1, 4) == ([-1, -0.5, 0, 0.5, 1], ["−1.0", "−0.5", "0.0", "0.5", "1.0"], 0)
    places, labels, power = ticks(0, 5e-7, 5)
    assert (labels, power) == (["0", "100", "200", "300", "400", "500"], -9)
    assert places == pytest.approx([0, 1e-7, 2e-7, 3e-7, 4e-7, 5e-7])
    assert ticks(1.0, 1.0 + 1e-9, 5)[1] == ["1", "+1·10⁻⁹"]
    assert ticks(3, 5, 9, whole=True) == ([3, 4, 5], ["3", "4", "5"], 0)
    assert ticks(100_000, 100_001, 9, whole=True)[1] == ["100000", "100001"]


def test_labels_have_colours_of_their_own() -> None:
    scale = categorize(np.array([0, 0, 2, -1]), ("interior", "boundary", "degenerate"))
    assert [(one.name, one.count) for one in scale.categories] == [("interior", 2), ("degenerate", 1)]
    assert scale.nulls == 1
    assert len({*map(tuple, scale.rgb.tolist())}) == 3
    assert tuple(scale.rgb[3]) == scale.undefined
    assert len(categorize(np.arange(40), tuple(map(str, range(40)))).categories) == 40

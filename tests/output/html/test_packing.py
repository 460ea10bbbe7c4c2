"""Numbers as they stand in a page."""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from curvcli.output.html.packing import differences, packed, scaled, steps

finite = st.floats(-1.7e308, 1.7e308, allow_subnormal=False)


def unpacked(text: str, kind: str) -> NDArray[Any]:
    planes = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8).reshape(np.dtype(kind).itemsize, -1)
    return np.ascontiguousarray(planes.T).view(kind)[:, 0]


@given(arrays(np.float64, st.integers(1, 20), elements=finite | st.just(float("nan"))))
def test_numbers_of_any_size_keep_the_digits_of_float32(numbers: NDArray[np.float64]) -> None:
    values, _, exponent = scaled(numbers)
    assert values.dtype == np.float32
    found = np.ldexp(values.astype(np.float64), exponent)
    np.testing.assert_array_equal(np.isnan(found), np.isnan(numbers))
    known = numbers[~np.isnan(numbers)]
    largest = np.abs(known).max(initial=0.0)
    assert (np.abs(found[~np.isnan(numbers)] - known) <= largest * 2.0**-23).all()


@pytest.mark.parametrize("shift", [1e3, -1e6])
def test_narrow_numbers_are_told_apart(shift: float) -> None:
    numbers = shift + np.linspace(-1.0, 1.0, 9) / 3
    values, rest, exponent = scaled(numbers)
    assert rest is not None
    assert exponent == 0
    np.testing.assert_array_equal(values, numbers.astype(np.float32))
    assert np.abs(values.astype(np.float64) + rest - numbers).max() <= 2.0**-40 * abs(shift)


def test_ordinary_numbers_are_plain_float32() -> None:
    numbers = np.array([0.1, -3.25, np.nan, 1e-20, 7e8])
    values, rest, exponent = scaled(numbers)
    assert (rest, exponent) == (None, 0)
    np.testing.assert_array_equal(values, numbers.astype(np.float32))


@given(arrays(np.int32, st.tuples(st.integers(0, 9), st.just(3)), elements=st.integers(0, 2**31 - 1)))
def test_steps_are_undone_by_adding_up(faces: NDArray[np.int32]) -> None:
    code = steps(faces).astype(np.int64)
    delta = np.where(code % 2 == 1, -(code + 1) // 2, code // 2)
    first = np.cumsum(delta[:, 0])
    found = np.stack([first, first + delta[:, 1], first + delta[:, 1] + delta[:, 2]], axis=1)
    np.testing.assert_array_equal(found, faces)


@pytest.mark.parametrize("kind", ["<f4", "<u4", "|u1", ">f4"])
def test_components_follow_each_other(kind: str) -> None:
    rows = np.arange(12).reshape(4, 3).astype(kind)
    little = "<f4" if kind == ">f4" else kind
    np.testing.assert_array_equal(unpacked(packed(rows), little), rows.T.ravel())


def test_an_ascending_list_as_steps() -> None:
    assert differences(np.array([3, 4, 9], np.int32)).tolist() == [3, 1, 5]

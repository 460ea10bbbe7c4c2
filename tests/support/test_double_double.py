"""Sums of two doubles against exact rational arithmetic."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from operator import add, mul, sub, truediv
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from curvcli.support.double_double import DoubleDouble, corner_products

_parts = st.floats(-1e30, 1e30).filter(lambda x: x == 0 or abs(x) > 1e-30)


@st.composite
def numbers(draw: st.DrawFn) -> DoubleDouble:
    high = draw(_parts)
    low = high * 2.0**-54 * draw(st.floats(-1, 1).filter(lambda x: x == 0 or abs(x) > 1e-6))
    return DoubleDouble(np.array([high]), np.array([low]))


def exact(x: DoubleDouble) -> Fraction:
    return Fraction(float(x.high[0])) + Fraction(float(x.low[0]))


@pytest.mark.parametrize("operation", [add, sub, mul, truediv])
@given(a=numbers(), b=numbers())
def test_arithmetic_is_exact_to_100_bits(
    operation: Callable[[Any, Any], Any], a: DoubleDouble, b: DoubleDouble
) -> None:
    if operation is truediv and not exact(b):
        return
    found, wanted = operation(a, b), operation(exact(a), exact(b))
    size = abs(exact(a)) + abs(exact(b)) if operation in (add, sub) else abs(wanted)
    assert abs(exact(found) - wanted) <= size * Fraction(1, 2**100)
    assert abs(found.low[0]) <= abs(found.high[0]) * 2.0**-53


@given(numbers())
def test_square_roots_are_exact_to_100_bits(a: DoubleDouble) -> None:
    if exact(a) >= 0:
        assert abs(exact(a.sqrt()) ** 2 - exact(a)) <= exact(a) * Fraction(1, 2**100)


def test_negative_numbers_are_clamped() -> None:
    found = DoubleDouble(np.array([-1.0, 0.0, 2.0]), np.array([1e-17, 0.0, -1e-17])).clamped()
    np.testing.assert_array_equal(found.high, [0, 0, 2])
    np.testing.assert_array_equal(found.low, [0, 0, -1e-17])


def test_corner_products_of_a_needle_far_from_the_origin() -> None:
    """Coordinates count as they are: every digit of their differences and products is kept."""
    rng = np.random.default_rng(0)
    xyz = 1e6 + rng.normal(size=(3, 3)) * [[1.0], [1e-4], [1e-6]]
    products, twice_area = corner_products(xyz, tuple(np.array([k]) for k in range(3)))
    p = [[Fraction(float(x)) for x in xyz[:, k]] for k in range(3)]
    u, v, w = ([b - a for a, b in zip(p[i], p[j], strict=True)] for i, j in ((0, 1), (1, 2), (0, 2)))

    def dot(a: list[Fraction], b: list[Fraction]) -> Fraction:
        return sum((x * y for x, y in zip(a, b, strict=True)), Fraction(0))

    for found, wanted in zip(products, (dot(u, w), -dot(u, v), dot(w, v)), strict=True):
        assert abs(exact(found) - wanted) <= dot(w, w) * Fraction(1, 2**98)
    square = dot(u, u) * dot(w, w) - dot(u, w) ** 2
    assert abs(exact(twice_area) ** 2 - square) <= square * Fraction(1, 2**80)

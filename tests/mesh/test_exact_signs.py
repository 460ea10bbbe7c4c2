"""Signs of determinants against rational arithmetic, and where they are 0 against a disturbance that is not."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from numpy.typing import NDArray

from curvcli.mesh.exact_signs import exact_sides


def by_fractions(rows: NDArray[np.float64], bits: int | None = None) -> int:
    """Of three rows; with each component moved by its own tiny number, far below the square of the one before."""
    tiny = [Fraction(0) if bits is None else Fraction(1, 2 ** (bits * 2**k)) for k in range(9)]
    a, b, c = ([Fraction(x) + tiny[3 * k + j] for j, x in enumerate(row)] for k, row in enumerate(rows.tolist()))
    total = sum(a[i] * (b[j] * c[k] - b[k] * c[j]) for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)))
    return (total > 0) - (total < 0)


def vectors(kind: str, count: int) -> NDArray[np.float64]:
    rng = np.random.default_rng(len(kind))
    rows = rng.normal(size=(count, 3, 3))
    if kind == "integers":
        rows = rng.integers(-1, 1, size=rows.shape, endpoint=True) / 1.0
    elif kind == "coplanar to rounding":
        rows[:, 2] = rows[:, 0] + rows[:, 1]
    elif kind == "parallel":
        rows[:, 2] = 0.5 * rows[:, 0]
        rows[::2, 1] = -0.25 * rows[::2, 0]
    elif kind == "far apart in size":
        rows = rng.integers(-2, 2, size=rows.shape, endpoint=True) * rng.choice([1, 1e-8, 1e-16, 1e-90], rows.shape)
    elif kind == "near the end of the range":
        rows = rng.integers(-2, 2, size=rows.shape, endpoint=True) * rng.choice([1.0, 2.0**-300], rows.shape)
    rows = rows[(rows != 0).any(axis=2).all(axis=1)]
    return np.asarray(rows / np.maximum(np.abs(rows).max(axis=(1, 2), keepdims=True), 1))


@pytest.mark.parametrize(
    "kind",
    ["any", "integers", "coplanar to rounding", "parallel", "far apart in size", "near the end of the range"],
)
def test_signs_are_those_of_exact_determinants(kind: str) -> None:
    rows = vectors(kind, 300)
    found = exact_sides(*rows.transpose(1, 2, 0))
    assert (found != 0).all()
    plain = np.array([by_fractions(each) for each in rows])
    np.testing.assert_array_equal(found[plain != 0], plain[plain != 0])
    flat = np.flatnonzero(plain == 0)
    if kind in ("integers", "parallel"):
        assert len(flat) > 20
        bits, step = (12, 1) if kind == "integers" else (600, 40)
        assert [int(found[k]) for k in flat[::step]] == [by_fractions(rows[k], bits) for k in flat[::step]]

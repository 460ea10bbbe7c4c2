"""Compensated cross products: about twice the digits, for triangles so thin that plain arithmetic loses all of them."""

from __future__ import annotations

from .arrays import Floats

VectorLike = tuple[Floats, Floats, Floats] | list[Floats]

_SPLITTER = 134217729.0  # 2²⁷ + 1 cuts a double into two halves whose products are exact


def two_difference(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """a - b as a rounded difference and its exact error (Knuth)."""
    difference = a - b
    virtual = a - difference
    return difference, (a - (difference + virtual)) + (virtual - b)


def two_product(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """a · b as a rounded product and its exact error (Dekker), barring overflow and underflow."""
    product = a * b
    high_a = _SPLITTER * a
    high_a -= high_a - a
    high_b = _SPLITTER * b
    high_b -= high_b - b
    low_a, low_b = a - high_a, b - high_b
    return product, low_a * low_b - (((product - high_a * high_b) - low_a * high_b) - high_a * low_b)


def _difference_of_products(a: Floats, b: Floats, c: Floats, d: Floats, rest: Floats) -> Floats:
    """a b - c d + rest, rounded about once."""
    ab, ab_error = two_product(a, b)
    cd, cd_error = two_product(c, d)
    leading, error = two_difference(ab, cd)
    result: Floats = leading + (error + (ab_error - cd_error) + rest)
    return result


def cross_of_edges(p: VectorLike, q: VectorLike, r: VectorLike) -> list[Floats]:
    """(q - p) × (r - p) with a relative error near ε² |u| |w| / |u × w|: twice the digits of the plain formula.

    p, q, r: three arrays each, the coordinates of the corners.
    """
    u, u_error = zip(*(two_difference(b, a) for a, b in zip(p, q, strict=True)), strict=True)
    w, w_error = zip(*(two_difference(c, a) for a, c in zip(p, r, strict=True)), strict=True)
    return [
        _difference_of_products(
            u[i], w[j], u[j], w[i], u[i] * w_error[j] + u_error[i] * w[j] - u[j] * w_error[i] - u_error[j] * w[i]
        )
        for i, j in ((1, 2), (2, 0), (0, 1))
    ]

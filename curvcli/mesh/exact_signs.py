"""Exact signs of determinants: a floating-point filter, then error-free sums."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from ..support.arrays import Floats, Mask, Sign
from ..support.compensated import two_difference, two_product
from .triangles import EPSILON, Vector, dot

# A function from columns to signs.
_Decide = Callable[[NDArray[np.intp]], Sign]

# The error of a determinant of vectors whose components are at most 1 in size, with room.
_ROUNDING = 64 * EPSILON
# Components below this, but not 0, lose digits of their products to the end of the range of doubles.
_SMALL = 2.0**-280
# Sums with an undecided sign after so many passes go to rational arithmetic.
_PASSES = 12
# The permutations of three columns, with their signs.
_EVEN, _ODD = ((0, 1, 2), (1, 2, 0), (2, 0, 1)), ((0, 2, 1), (1, 0, 2), (2, 1, 0))


def sides(normal: Vector, other: Floats) -> Sign:
    """(n,) sign of normal · other where it exceeds the error bound, else 0.

    normal, other: (3, n). All components of other are at most 1 in size; normal: cross products of two such vectors.
    """
    determinant = dot(normal, other)
    result: Sign = (determinant > _ROUNDING).view(np.int8) - (determinant < -_ROUNDING).view(np.int8)
    return result


def exact_sides(first: Floats, second: Floats, third: Floats) -> Sign:
    """The signs of det(first, second, third), none of them 0, for vectors (3, n) with components up to 1, none zero.

    A zero determinant gets the sign after an infinitesimal perturbation of every component, far larger for the first
    vector than for the second, and for the second than for the third. For vectors in the order of a list all signs are
    those of one list in general position.
    Source: Edelsbrunner and Mücke, Simulation of simplicity, 1990.
    """
    result = _determinants(first, second, third)
    for decide in _perturbed(first, second, third):
        rest = np.flatnonzero(result == 0)
        if not len(rest):
            break
        result[rest] = decide(rest)
    return result


def _perturbed(u: Floats, v: Floats, w: Floats) -> Iterator[_Decide]:
    """The sign of a zero determinant: the first nonzero term of its perturbation expansion, from the largest down."""

    def minor(a: Floats, b: Floats, without: int, turn: int) -> _Decide:
        i, j = (without + 1) % 3, (without + 2) % 3  # cyclic: the sign of the cofactor is in the order
        return lambda rest: np.int8(turn) * _sign_of_difference(a[i, rest], b[j, rest], a[j, rest], b[i, rest])

    def component(without: int, first: int) -> _Decide:
        last = 3 - without - first
        turn = np.int8(1 if (first, without, last) in _EVEN else -1)
        return lambda rest: turn * np.sign(w[last, rest]).astype(np.int8)

    for column in range(3):
        yield minor(v, w, column, 1)
    for column in range(3):
        yield minor(u, w, column, -1)
        for first in range(3):
            if first != column:
                yield component(column, first)


def _sign_of_difference(a: Floats, b: Floats, c: Floats, d: Floats) -> Sign:
    """The sign of a b − c d."""
    ab, ab_rest = two_product(a, b)
    cd, cd_rest = two_product(c, d)
    # Rounding is monotone: the rounding errors decide only where the rounded products are equal.
    result: Sign = np.where(ab != cd, np.sign(ab - cd), np.sign(ab_rest - cd_rest)).astype(np.int8)
    return result


def _determinants(first: Floats, second: Floats, third: Floats) -> Sign:
    """The signs of det(first, second, third)."""
    result = sign_of_sum(np.array(terms_of_determinant(first, second, third)))
    for k in np.flatnonzero(loses_digits(first, second, third) | (result == 2)):
        result[k] = _rational(*(vector[:, k].tolist() for vector in (first, second, third)))
    return result


def terms_of_determinant(first: Floats, second: Floats, third: Floats, turn: float = 1.0) -> list[Floats]:
    """24 arrays with the exact sum turn · det(first, second, third); turn: ±1. See `loses_digits` for the exception."""
    terms = []
    for order, sign in (*((each, turn) for each in _EVEN), *((each, -turn) for each in _ODD)):
        a, b, c = (vector[row] for vector, row in zip((first, second, third), order, strict=True))
        for part in two_product(a, b):
            terms += [sign * each for each in two_product(part, c)]
    return terms


def loses_digits(*vectors: Floats) -> Mask:
    """(n,) flags: a component is so small that its products lose digits to the end of the range of doubles."""
    size = np.abs(vectors)
    return np.asarray(((size < _SMALL) & (size > 0)).any(axis=(0, 1)))


def _rational(*rows: list[float]) -> int:
    """The sign of one determinant."""
    a, b, c = ([Fraction(x) for x in row] for row in rows)
    total = sum(a[i] * b[j] * c[k] for i, j, k in _EVEN) - sum(a[i] * b[j] * c[k] for i, j, k in _ODD)
    return (total > 0) - (total < 0)


def sign_of_sum(terms: Floats) -> Sign:
    """(n,) signs of the exact sums of terms (m, n); 2 where undecided.

    Each pass replaces the terms by others of the same sum: the last by the rounded sum, the others by rounding errors.
    The sign is that of the last term once it exceeds the sum of all others.
    """
    result = np.full(terms.shape[1], 2, np.int8)
    open_, count = np.arange(terms.shape[1]), len(terms)
    for _ in range(_PASSES):
        for k in range(1, count):
            total, error = two_difference(terms[k], -terms[k - 1])
            terms[k - 1], terms[k] = error, total
        rest = np.abs(terms[:-1]).sum(axis=0) * (1 + 2 * count * EPSILON)
        known = (np.abs(terms[-1]) > rest) | ((terms[-1] == 0) & (rest == 0))
        result[open_[known]] = np.sign(terms[-1, known]).astype(np.int8)
        open_, terms = open_[~known], terms[:, ~known]
        if not len(open_):
            break
    return result

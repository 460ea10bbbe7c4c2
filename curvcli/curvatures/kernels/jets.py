"""Least-squares fits of a polynomial to the height over the tangent plane of a vertex.

Degree 2 is always fitted. Degrees 3 and 4 are weighted by their signal against the residuals, so that the fit has the
small bias of degree 4 on a smooth surface, and the small variance of degree 2 on a noisy one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh.triangles import EPSILON
from ...support.arrays import Floats, Mask
from .moments import Moments

# Monomials xⁱ yʲ by degree: 1; x, y; x², xy, y²; …
_POWERS = [(degree - j, j) for degree in range(5) for j in range(degree + 1)]
_COUNT = len(_POWERS)
# Terms up to degree 2, 3 and 4; a fit needs as many points.
QUADRATIC, _CUBIC, _QUARTIC = 6, 10, 15
# A column of the design is lost to rounding where those before it leave less than _LOST of its square. There is no fit
# from the condition _SINGULAR on, and a degree is left out from the dilution _WEAK on (see `_dilution`).
_LOST, _SINGULAR, _WEAK = 1e-12, 1e4, 1e4
# A group of terms is noise where the mean square of its coefficients is not well above that of the residuals: the
# quotient F is compared with this times 1 + 12/(degrees of freedom), about the 99 % quantile of its distribution.
_NOISE = 3.0
# Heights have the rounding of a few operations each.
_ROUNDING = 16 * EPSILON
# Least number of points beyond the terms for an estimate of the noise from the residuals.
_SPARE = 4


@dataclass(frozen=True)
class Jets:
    """Derivatives of the fitted height at the vertex, in the frame of the moments: gradient (2, m), hessian (3, m).

    condition: (m,) of the design of degree 2. size: (m,) the curvature that heights as large as these stand for.
    rounding: (m,) the curvature that rounding of the heights alone may stand for.
    """

    gradient: Floats
    hessian: Floats
    condition: Floats
    size: Floats
    rounding: Floats


@np.errstate(over="ignore", divide="ignore", invalid="ignore")  # undetermined values are masked later
def fit(given: Moments) -> Jets:
    """Fit all neighbourhoods by normal equations, vectorised over vertices."""
    lower, sound = _factor(given)
    condition = _condition(given, lower)
    determined = sound[:QUADRATIC].all(axis=0) & (condition < _SINGULAR)
    third = determined & (given.size >= _CUBIC + _SPARE) & sound[QUADRATIC:_CUBIC].all(axis=0)
    third &= _dilution(lower, QUADRATIC, _CUBIC) < _WEAK
    fourth = third & (given.size >= _QUARTIC + _SPARE) & sound[_CUBIC:].all(axis=0)
    fourth &= _dilution(lower, _CUBIC, _QUARTIC) < _WEAK
    terms = lower[_COUNT].copy()
    terms[QUADRATIC:_CUBIC] *= third
    terms[_CUBIC:] *= fourth
    residual = np.maximum(given.squared_height - np.einsum("ij,ij->j", terms, terms), 0.0)
    freedom = given.size - np.select([fourth, third], [_QUARTIC, _CUBIC], QUADRATIC)
    kept = terms.copy()
    kept[QUADRATIC:_CUBIC] *= _signal(terms[QUADRATIC:_CUBIC], residual, freedom)
    kept[_CUBIC:] = 0.0
    result = _solve(lower, kept, np.zeros((_COUNT - _CUBIC, len(determined))))
    expected = _quartic(result)
    # The expected terms of degree 4 are subtracted from the heights before the groups are weighted.
    rest = terms - np.einsum("kij,kj->ij", lower[_CUBIC:_COUNT, :_COUNT], expected)
    rest[QUADRATIC:_CUBIC] *= third * _signal(rest[QUADRATIC:_CUBIC], residual, freedom)
    rest[_CUBIC:] *= fourth * _signal(rest[_CUBIC:], residual, freedom)
    result = _solve(lower, rest, expected)
    determined &= np.isfinite(result).all(axis=0)
    result[:, ~determined] = np.nan
    hessian = result[3:6] * np.array([2.0, 1.0, 2.0])[:, None]
    spread = np.where(determined, given.of(2, 0) + given.of(0, 2), np.nan)
    size = np.sqrt(given.squared_height * given.size) / spread
    condition = np.where(determined, condition, np.nan)
    # Heights are rounded like distances in the neighbourhood, whose mean square is the spread over the number.
    rounding = _ROUNDING * condition * np.sqrt(given.size / spread)
    return Jets(result[1:3], hessian, condition, size, rounding)


def _factor(given: Moments) -> tuple[Floats, Mask]:
    """(16, 15, m) Cholesky's factor of the normal equations bordered with the heights, and (15, m) sound columns.

    Row 15 holds the heights in the orthonormal basis that belongs to the factor.
    """
    count = len(given.vertex)
    lower = np.zeros((_COUNT + 1, _COUNT, count))
    for column, (i, j) in enumerate(_POWERS):
        for row, (p, q) in enumerate(_POWERS[column:], start=column):
            lower[row, column] = given.of(i + p, j + q)
        lower[_COUNT, column] = given.with_height(i, j)
    sound = np.zeros((_COUNT, count), bool)
    for k in range(_COUNT):
        whole = lower[k, k].copy()
        if k:
            lower[k:, k] -= np.einsum("rkm,km->rm", lower[k:, :k], lower[k, :k])
        np.greater(lower[k, k], _LOST * whole, out=sound[k])
        lower[k:, k] /= np.sqrt(np.where(sound[k], lower[k, k], np.inf))
        lower[k, k][~sound[k]] = 1.0
    return lower, sound


def _signal(terms: Floats, residual: Floats, freedom: Floats) -> Floats:
    """(m,) weight of a group of terms (k, m): 1 − noise/F, at least 0."""
    size = np.einsum("ij,ij->j", terms, terms)
    spare = np.maximum(freedom, 1.0)
    noise = _NOISE * (1 + 12 / spare) * len(terms) * residual / spare
    kept: Floats = 1 - np.divide(np.minimum(noise, size), size, where=size > 0, out=np.ones(len(size)))
    return kept


def _solve(lower: Floats, terms: Floats, expected: Floats) -> Floats:
    """(15, m) coefficients from the terms in the orthonormal basis, plus the expected terms of degree 4."""
    result = terms.copy()
    for k in reversed(range(_COUNT)):
        result[k] /= lower[k, k]
        result[:k] -= lower[k, :k] * result[k]
    result[_CUBIC:] += expected
    return result


def _quartic(coefficients: Floats) -> Floats:
    """(5, m) the terms of degree 4 that follow from those of degree 2 for constant curvature.

    With S the Hessian they are (xᵀ S x)(xᵀ S² x)/8: exact on spheres and cylinders.
    """
    a, b, c = 2 * coefficients[3], coefficients[4], 2 * coefficients[5]
    first = (a / 2, b, c / 2)
    second = (a * a + b * b, 2 * b * (a + c), b * b + c * c)
    terms = np.zeros((_COUNT - _CUBIC, len(a)))
    for i, p in enumerate(first):
        for j, q in enumerate(second):
            terms[i + j] += p * q / 4
    return terms


def _condition(given: Moments, lower: Floats) -> Floats:
    """(m,) √(tr N tr N⁻¹) of the normal matrix N in 1, x/r, y/r, x²/r², √2 xy/r², y²/r², r² the mean of x² + y².

    This is the condition of the design in the Frobenius norm, invariant under rotation of the axes.
    """
    part = lower[:QUADRATIC, :QUADRATIC]
    inverse = _inverse(part)
    square = (given.of(2, 0) + given.of(0, 2)) / given.size
    linear = 1 / np.where(square > 0, square, np.inf)
    scale = np.stack([np.ones_like(square), linear, linear, linear**2, 2 * linear**2, linear**2])
    size = np.einsum("ikj,ikj,ij->j", part, part, scale)
    least = np.where(square > 0, scale, 1.0)
    return np.asarray(np.sqrt(size * np.einsum("ikj,ikj,kj->j", inverse, inverse, 1 / least)), np.float64)


def _dilution(lower: Floats, begin: int, end: int) -> Floats:
    """(m,) tr S⁻¹N/p of the p terms of a degree, N their part of the normal matrix, S what lower degrees leave of it.

    It is the variance factor of these terms, 1 at best, invariant under linear maps of the coordinates.
    """
    part = np.einsum("ikj,klj->ilj", _inverse(lower[begin:end, begin:end]), lower[begin:end, :begin])
    return np.asarray(1 + np.einsum("ikj,ikj->j", part, part) / (end - begin), np.float64)


def _inverse(part: Floats) -> Floats:
    """The inverses of lower triangular matrices (p, p, m)."""
    inverse = np.zeros_like(part)
    for column in range(len(part)):
        inverse[column, column] = 1 / part[column, column]
        for row in range(column + 1, len(part)):
            inner = np.einsum("kj,kj->j", part[row, column:row], inverse[column:row, column])
            inverse[row, column] = -inner / part[row, row]
    return inverse

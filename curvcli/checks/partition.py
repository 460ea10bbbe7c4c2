"""Partition: the shares of all regions add up to the total of the whole."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..mesh.groups import Groups
from ..mesh.surface import Surface
from ..support.arrays import Floats
from .base import IdentityValues, check


@dataclass(frozen=True)
class Share:
    """Shares of one total in the unit of computation, with H = κ₁ + κ₂.

    key, length_exponent, mean_degree: of the total. values: (R + 1,) or (R + 1, 3), of the R regions and of the faces
    without one; NaN where the total of the whole is undefined. total: of the whole, () or (3,). bound: of the rounding
    error of Σ values − total. energy: a multiple of the bending rigidity.
    """

    key: str
    length_exponent: int
    mean_degree: int
    values: Floats
    total: Floats
    bound: Floats
    energy: bool = False


@check(
    gap="Σ shares − total",
    applies="surfaces with --regions",
    bound="(16 + log₂N)ε · Σ|terms| + ε · Σ over the elements on borders of their number of faces · |term|",
    failure="a value belongs to no region or to several.",
    after="dirichlet",
)
def partition(surface: Surface, groups: Groups, shares: Sequence[Share]) -> IdentityValues:
    """The shares of all regions and of the faces without a region add up to the total of the whole, for every total.

    The numbers are those of the total with the largest residual in terms of its tolerance.
    """
    key, length_exponent, value, expected, tolerance = max(_sums(shares), key=lambda sums: _excess(*sums[2:]))
    return IdentityValues(
        np.array([value]),
        np.array([expected]),
        np.array([tolerance]),
        length_exponent,
        detail=f"{key}, of {len(shares)} totals the one with the largest residual for its tolerance",
    )


def _sums(shares: Sequence[Share]) -> Iterator[tuple[str, int, float, float, float]]:
    """Name, length exponent, sum, total and bound of every scalar whose total is defined."""
    for share in shares:
        sums = share.values.reshape(len(share.values), -1).sum(axis=0)
        axes = "xyz" if share.total.ndim else [""]
        for axis, value, total, bound in zip(axes, sums, share.total.ravel(), share.bound.ravel(), strict=True):
            if not np.isnan(total):
                name = f"{share.key}_{axis}" if axis else share.key
                yield name, share.length_exponent, float(value), float(total), float(bound)


def _excess(value: float, expected: float, tolerance: float) -> float:
    """Residual in terms of the tolerance; infinite if it is undefined."""
    with np.errstate(invalid="ignore"):
        residual = abs(value - expected)
    return float("inf") if np.isnan(residual) else residual / tolerance

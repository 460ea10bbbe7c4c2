"""Turning angles ψ, the discretisations 2 sin(ψ/2) and 2 tan(ψ/2) of curvature, and their sums."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..mesh.triangles import EPSILON
from ..support.arrays import Floats, Mask
from .polygon import Curves

# Sums and differences of unit tangents below this are rounding: the edges are collinear.
_ROUNDING = 4 * EPSILON


@dataclass(frozen=True)
class Turning:
    """Turning of curves at their vertices; curves without repeated points, any dimension.

    Vertices between two edges only; the ends of open curves have NaN.
    """

    curves: Curves

    @cached_property
    def _change(self) -> tuple[Floats, Floats, Floats]:
        tangent, before = self.curves.tangent, self.curves.tangent[:, self.curves.preceding]
        change, sum_ = tangent - before, tangent + before
        change[:, ~self.curves.inner] = np.nan
        return change, np.sqrt((change * change).sum(axis=0)), np.sqrt((sum_ * sum_).sum(axis=0))

    @cached_property
    def angle(self) -> Floats:
        """(n,) ψ = 2 atan2(|T′ − T|, |T′ + T|) in [0, π], exact at both ends; NaN at the ends of open curves."""
        _, difference, sum_ = self._change
        return 2 * np.arctan2(difference, sum_)

    @cached_property
    def sin2(self) -> Floats:
        """(n,) 2 sin(ψ/2), the length of the curvature vector T′ − T."""
        return 2 * np.sin(self.angle / 2)

    @cached_property
    def tan2(self) -> Floats:
        """(n,) 2 tan(ψ/2): how the length of a parallel curve changes; NaN where the curve turns back on itself."""
        return np.where(self.reversed, np.nan, 2 * np.tan(self.angle / 2))

    @cached_property
    def straight(self) -> Mask:
        """(n,) mask of the vertices with ψ = 0 to rounding."""
        mask: Mask = self._change[1] <= _ROUNDING
        return mask

    @cached_property
    def reversed(self) -> Mask:
        """(n,) mask of the vertices with ψ = π to rounding."""
        mask: Mask = self.curves.inner & (self._change[2] <= _ROUNDING)
        return mask

    @cached_property
    def vector(self) -> Floats:
        """(d, n) the curvature vector 2 sin(ψ/2) N; N bisects the edges and points to the inside of the turn."""
        change, difference, _ = self._change
        with np.errstate(divide="ignore", invalid="ignore"):
            vector = change / difference * self.sin2
        return np.where(difference == 0, 0.0, vector)

    @cached_property
    def tangent_change(self) -> Floats:
        """(d, m) T(q) − T(p): last tangent less first; 0 on closed curves; NaN where there is no edge."""
        curves = self.curves
        some = curves.edges > 0
        change = np.full((curves.dimension, len(curves)), np.nan)
        first, last = curves.start[:-1][some], curves.start[1:][some] - 1 - ~curves.closed[some]
        change[:, some] = curves.tangent[:, last] - curves.tangent[:, first]
        change[:, some & curves.closed] = 0.0
        return change

    @cached_property
    def total(self) -> Floats:
        """(m,) total curvature Σψ: at least 2π on closed curves (Fenchel), more than 4π on knots (Fáry–Milnor)."""
        return self.curves.sum(self.angle)

    @cached_property
    def unknotted(self) -> Mask:
        """(m,) mask of the closed curves in space with Σψ ≤ 4π, unknotted if without self-crossings (Fáry–Milnor).

        The converse is false: an unknotted curve may have a larger Σψ.
        """
        bound = 4 * np.pi - 16 * EPSILON * self.curves.sizes
        mask: Mask = self.curves.closed & (self.total <= bound) & (self.curves.dimension == 3)
        return mask

"""One curve from its points: results of the vectorised functions as rows and plain numbers."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ..errors import UsageError
from ..support.arrays import Floats, or_none
from .frames import Bishop, Frenet
from .holonomy import normal_holonomy
from .plane import PlaneCurves, plane_curves
from .polygon import curves_of
from .turning import Turning
from .writhe import MAX_EDGES, writhe


class Curve:
    """A polygonal curve in E^d.

    points: (n, d) in order, d ≥ 2. closed: an edge joins the last point to the first, which is not repeated.
    Columns have one row per point. Values of an edge are in the row of its first point. Null (NaN) is undefined: the
    ends of open curves, and points equal to the next one (counted by `repeated_points`); the last of equal points has
    the values. Frames, torsion, writhe and the plane need d = 3; UsageError otherwise.
    Errors: InputError for points that are not finite numbers of that shape.
    """

    def __init__(self, points: ArrayLike, closed: bool = False) -> None:
        self._given = curves_of(points, closed)
        self.closed = closed
        self._distinct, self._kept = self._given.distinct()
        self._turning = Turning(self._distinct)

    def _rows(self, values: Floats) -> Floats:
        """Values of distinct points, (k,) or (d, k), as rows of all points, (n,) or (n, d)."""
        rows = np.full((*values.shape[:-1], self._given.size), np.nan)
        rows[..., self._kept] = values
        return rows.T

    def _in_space(self) -> Turning:
        if self._given.dimension != 3:
            raise UsageError(f"the curve lies in E^{self._given.dimension}, expected E^3")
        return self._turning

    @property
    def points(self) -> Floats:
        """(n, d) the points."""
        return self._given.xyz.T

    @property
    def repeated_points(self) -> int:
        """Points equal to the next one."""
        return self._given.size - self._distinct.size

    @property
    def length(self) -> float:
        """Length of the curve."""
        return float(self._given.length[0])

    @property
    def edge_vectors(self) -> Floats:
        """(n, d) the edge that leaves each point; (n − 1, d) on an open curve."""
        vectors = (self._given.xyz[:, self._given.following] - self._given.xyz).T
        return vectors if self.closed else vectors[:-1]

    @property
    def tangents(self) -> Floats:
        """(n, d) unit tangent of the edge that leaves each point."""
        return self._rows(self._distinct.tangent)

    @property
    def turning(self) -> Floats:
        """(n,) turning angles ψ."""
        return self._rows(self._turning.angle)

    @property
    def sin2(self) -> Floats:
        """(n,) 2 sin(ψ/2)."""
        return self._rows(self._turning.sin2)

    @property
    def tan2(self) -> Floats:
        """(n,) 2 tan(ψ/2); null where ψ = π."""
        return self._rows(self._turning.tan2)

    @property
    def curvature_vectors(self) -> Floats:
        """(n, d) 2 sin(ψ/2) N = T′ − T; their sum is T(q) − T(p), 0 on closed curves."""
        return self._rows(self._turning.vector)

    @property
    def total_curvature(self) -> float:
        """Σψ."""
        return float(self._turning.total[0])

    @property
    def total_sin2(self) -> float:
        """Σ 2 sin(ψ/2)."""
        return float(self._distinct.sum(self._turning.sin2)[0])

    @property
    def total_tan2(self) -> float | None:
        """Σ 2 tan(ψ/2); None where the curve turns back on itself."""
        return None if self._turning.reversed.any() else float(self._distinct.sum(self._turning.tan2)[0])

    @property
    def unknotted(self) -> bool | None:
        """True if Σψ ≤ 4π, which proves a curve without self-crossings unknotted (Fáry–Milnor); None: undecided."""
        return True if self._turning.unknotted[0] else None

    @cached_property
    def _plane(self) -> PlaneCurves:
        return plane_curves(self._in_space())

    @property
    def plane(self) -> bool:
        """True if the points lie in a plane, to the rounding of their coordinates."""
        return bool(self._plane.plane[0])

    @property
    def signed_total(self) -> float | None:
        """Σ ±ψ of a plane closed curve, an integer times 2π; None for others."""
        return or_none(float(self._plane.signed_total[0]))

    @property
    def turning_number(self) -> int | None:
        """Turning number of a plane closed curve, signed_total / 2π; None for others."""
        result = or_none(float(self._plane.turning_number[0]))
        return None if result is None else int(result)

    @cached_property
    def _frenet(self) -> Frenet:
        return Frenet(self._in_space())

    @property
    def frenet(self) -> tuple[Floats, Floats, Floats]:
        """(T, N, B) at every point, (n, 3) each; null on straight parts."""
        frame = self._frenet
        return self._rows(frame.tangent), self._rows(frame.normal), self._rows(frame.binormal)

    @property
    def torsion(self) -> Floats:
        """(n,) torsion angle of the edge that leaves each point, between the binormals at its ends."""
        return self._rows(self._frenet.torsion)

    @cached_property
    def _bishop(self) -> Bishop:
        return Bishop(self._in_space())

    @property
    def bishop(self) -> tuple[Floats, Floats, Floats]:
        """(T, U, V) on every edge, (n, 3) each: U and V by parallel transport."""
        return self.tangents, self._rows(self._bishop.u), self._rows(self._bishop.v)

    @property
    def holonomy(self) -> float | None:
        """Angle of the normal holonomy in (−π, π], right-handed about T; None where undefined."""
        return or_none(float(self._bishop.holonomy[0]))

    def normal_holonomy(self) -> Floats:
        """(d − 1, d − 1) the normal holonomy of a closed curve, an element of SO(d − 1).

        Errors: UsageError for an open curve.
        """
        if not self.closed:
            raise UsageError("the curve is open; only closed curves have a normal holonomy")
        return normal_holonomy(self.points)

    def writhe(self, max_edges: int | None = MAX_EDGES) -> float:
        """Writhe in turns; NaN where the bound of its rounding error exceeds a quarter.

        Errors: UsageError for more than max_edges edges: the double sum is quadratic in them.
        """
        self._in_space()
        edges = int(self._distinct.edges[0])
        if max_edges is not None and edges > max_edges:
            raise UsageError(f"{edges} edges, at most {max_edges} are summed in pairs; max_edges sets the limit")
        return float(writhe(self._distinct, None)[0][0])

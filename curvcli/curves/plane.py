"""Plane curves: detection, normal and turning number."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..mesh.triangles import EPSILON, cross, dot
from ..support.arrays import Floats, Mask
from .frames import unit
from .polygon import Curves, Rows
from .turning import Turning


@dataclass(frozen=True)
class PlaneCurves:
    """Curves of E³ that lie in planes.

    plane: (m,) flags, to the rounding of the coordinates. normal: (3, m) of the plane, its largest component positive,
    NaN for straight and non-planar curves. signed_total: (m,) the sum of the turning angles, counterclockwise ones
    positive seen from the tip of the normal; NaN unless plane, closed, and nowhere turning back.
    """

    plane: Mask
    normal: Floats
    signed_total: Floats

    @property
    def turning_number(self) -> Floats:
        """(m,) signed_total / 2π, rounded to an integer."""
        return np.rint(self.signed_total / (2 * np.pi)) + 0.0


def plane_curves(turning: Turning) -> PlaneCurves:
    """Find the plane of each curve and its signed total curvature, an integer multiple of 2π.

    The plane goes through the first point, the point farthest from it, and the point farthest from the line of both.
    A curve is plane where no point is farther from it than 16 ε times its largest coordinate, which is what rounding
    the points of a plane curve to doubles explains.
    """
    curves = turning.curves
    offset, power = curves.local
    coordinate = np.ldexp(curves.max(np.abs(curves.xyz).max(axis=0, initial=0.0)), -power)
    far = _farthest(curves, offset, dot(offset, offset))
    moment = np.array(cross(np.repeat(far, curves.sizes, axis=1), offset))
    normal = _farthest(curves, moment, dot(moment, moment))
    # On a thin curve the product has few digits; only its right angle to the long direction matters.
    normal, along = unit(normal), unit(far)
    normal = unit(normal - along * dot(along, normal))
    height = np.abs(dot(np.repeat(normal, curves.sizes, axis=1), offset))
    # With an undefined normal all points lie on one line: plane, in no particular plane.
    plane = ~(curves.max(height) > 16 * EPSILON * coordinate)
    largest = np.take_along_axis(normal, np.abs(normal).argmax(axis=0)[None], axis=0)[0]
    normal = np.where(plane, normal * np.where(largest < 0, -1.0, 1.0), np.nan)
    return PlaneCurves(plane, normal, _signed_total(turning, plane, normal))


def _farthest(curves: Curves, vectors: Floats, square: Floats) -> Floats:
    """(3, m) on each curve the first vector of largest square."""
    reached = np.flatnonzero(square == np.repeat(curves.max(square), curves.sizes))
    curve, first = np.unique(curves.label[reached], return_index=True)
    chosen: Rows = reached[first]
    result = np.zeros((3, len(curves)))
    result[:, curve] = vectors[:, chosen]
    return result


def _signed_total(turning: Turning, plane: Mask, normal: Floats) -> Floats:
    curves = turning.curves
    tangent = curves.tangent
    bend = cross(tangent[:, curves.preceding], tangent)
    side = dot(np.repeat(normal, curves.sizes, axis=1), bend)
    total = curves.sum(np.where(side < 0, -turning.angle, turning.angle))
    known = plane & curves.closed & ~np.isnan(normal[0]) & (curves.sum(turning.reversed) == 0)
    return np.where(known, total, np.nan)

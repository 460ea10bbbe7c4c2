"""Frames along curves in space: Frenet's, Bishop's by parallel transport, and the twist of any normal field."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..mesh.triangles import EPSILON, cross, dot
from ..support.arrays import Floats, Mask
from .turning import Turning


def unit(vector: Floats) -> Floats:
    """Vectors (3, n) made unit; NaN where they vanish."""
    length = np.sqrt(dot(vector, vector))
    with np.errstate(divide="ignore", invalid="ignore"):
        return vector / length


@dataclass(frozen=True)
class Frenet:
    """The Frenet frame at vertices and the torsion of edges; NaN where the curve is straight or turns back."""

    turning: Turning

    @cached_property
    def binormal(self) -> Floats:
        """(3, n) B: the unit normal of the plane of the two edges at the vertex."""
        curves = self.turning.curves
        binormal = unit(np.array(cross(curves.tangent[:, curves.preceding], curves.tangent)))
        binormal[:, ~curves.inner | self.turning.straight | self.turning.reversed] = np.nan
        return binormal

    @cached_property
    def tangent(self) -> Floats:
        """(3, n) T: half-way between the tangents of the two edges at the vertex."""
        curves = self.turning.curves
        tangent = unit(curves.tangent[:, curves.preceding] + curves.tangent)
        tangent[:, ~curves.inner | self.turning.reversed] = np.nan
        return tangent

    @cached_property
    def normal(self) -> Floats:
        """(3, n) N = B × T: towards the inside of the turn, along the curvature vector."""
        return np.array(cross(self.binormal, self.tangent))

    @cached_property
    def torsion(self) -> Floats:
        """(n,) the angle in (−π, π] from the binormal at the edge's tail to that at its head, right-handed about T."""
        curves = self.turning.curves
        here, there = self.binormal, self.binormal[:, curves.following]
        angle = np.arctan2(dot(curves.tangent, cross(here, there)), dot(here, there))
        return np.where(curves.has_edge, angle, np.nan)


def transport_angle(turning: Turning, field: Floats) -> Floats:
    """(n,) at each vertex the angle in (−π, π] from parallel transport to a field of unit normals.

    field: (3, n) one unit vector per edge, perpendicular to it. Parallel transport across a vertex is the rotation that
    takes T to T′ about their common normal; the angle goes from the transported vector of the edge that arrives to that
    of the edge that leaves, right-handed about T′. NaN where the curve turns back: the least rotation is not unique.
    """
    curves = turning.curves
    tangent, before = curves.tangent, curves.tangent[:, curves.preceding]
    mirror = tangent + before
    carried = field[:, curves.preceding]
    with np.errstate(divide="ignore", invalid="ignore"):
        # On vectors normal to T the rotation equals the reflection in the plane normal to T + T′.
        square = np.where(turning.reversed, np.nan, dot(mirror, mirror))
        carried = carried - mirror * (2 * dot(mirror, carried) / square)
    angle = np.arctan2(dot(tangent, cross(carried, field)), dot(carried, field))
    return np.where(curves.inner & ~turning.reversed, angle, np.nan)


@dataclass(frozen=True)
class Bishop:
    """The parallel frame of curves in space: U and V = T × U on every edge, with no twist about T."""

    turning: Turning

    @cached_property
    def _reference(self) -> Floats:
        """(3, n) some unit normal of each edge, by the coordinate axis least along it; smoothness is not needed."""
        tangent = self.turning.curves.tangent
        axis = np.eye(3)[:, np.abs(tangent).argmin(axis=0)]
        return unit(axis - tangent * dot(axis, tangent))

    @cached_property
    def _slip(self) -> Floats:
        return transport_angle(self.turning, self._reference)

    @cached_property
    def u(self) -> Floats:
        """(3, n) U: transported along the curve from the first edge, where it is nearest to the coordinate axis that is
        least along that edge; NaN from a vertex on where the curve turns back."""
        curves = self.turning.curves
        slip = np.where(curves.inner, self._slip, 0.0)
        slip[curves.start[:-1][curves.sizes > 0]] = 0.0
        angle = -(curves.running(slip) + slip)
        ahead = self._reference
        return ahead * np.cos(angle) + np.array(cross(curves.tangent, ahead)) * np.sin(angle)

    @cached_property
    def v(self) -> Floats:
        """(3, n) V = T × U."""
        return np.array(cross(self.turning.curves.tangent, self.u))

    @cached_property
    def holonomy(self) -> Floats:
        """(m,) the angle in (−π, π] of parallel transport once round, right-handed about T; closed curves only.

        ≡ 2π · writhe (mod 2π). NaN on open curves and where a curve turns back on itself.
        """
        curves = self.turning.curves
        return np.where(defined_round(self.turning), _principal(-curves.sum(self._slip)), np.nan)


def defined_round(turning: Turning) -> Mask:
    """(m,) mask of the closed curves with edges that nowhere turn back, so that transport once round is defined."""
    curves = turning.curves
    return np.asarray(curves.closed & (curves.edges > 0) & (curves.sum(turning.reversed) == 0))


def twist(turning: Turning, field: Floats) -> Floats:
    """(m,) total angle from parallel transport to a field of unit normals (3, n); closed curves only.

    twist/2π + writhe is the linking number of the curve with itself pushed along the field (Călugăreanu, White).
    """
    curves = turning.curves
    angle = transport_angle(turning, field)
    known = defined_round(turning) & (curves.sum(np.isnan(angle)) == 0)
    return np.where(known, curves.sum(angle), np.nan)


def twist_error(turning: Turning, field: Floats) -> Floats:
    """(m,) a bound of the rounding error of `twist`: a turn more for each vertex at which the field turns by π to
    rounding, so that it may have gone either way round; NaN where the twist is."""
    curves = turning.curves
    angle = transport_angle(turning, field)
    # The rotation across a vertex has no axis where the curve turns back; its error grows as 1 / cos(ψ/2).
    steep = 1 + 1 / np.cos(np.minimum(turning.angle, np.pi) / 2)
    either = np.pi - np.abs(angle) <= 16 * EPSILON * steep
    bound = (16 + np.log2(np.maximum(curves.sizes, 1))) * EPSILON * curves.sum(steep)
    known = defined_round(turning) & (curves.sum(np.isnan(angle)) == 0)
    return np.where(known, bound + 2 * np.pi * curves.sum(either), np.nan)


def _principal(angle: Floats) -> Floats:
    """Angles in (−π, π]; a rounding error below −π is π."""
    remainder = np.remainder(angle, 2 * np.pi)
    return np.where(remainder > np.pi, remainder - 2 * np.pi, remainder)


def shortest(angle: Floats) -> Floats:
    """|angle| mod 2π, the distance from the nearest multiple of 2π."""
    return np.abs(angle - 2 * np.pi * np.rint(angle / (2 * np.pi)))

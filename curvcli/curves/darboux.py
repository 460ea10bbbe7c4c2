"""Darboux frames along boundary curves, with geodesic and normal curvature."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..mesh.topology import faces_at
from ..mesh.triangles import LOST, cross, dot, triangles
from ..support.arrays import Floats, Mask
from ..support.blocks import slices
from .boundary import Boundary
from .frames import unit
from .turning import Turning


@dataclass(frozen=True)
class Darboux:
    """Darboux frames T, ν, η = T × ν along boundary curves, the surface on their left: η points out of it.

    On every edge ν is the normal of its face; at every vertex it is the direction of the fan's area vector, made
    perpendicular to the curve. A patch without an orientation has one along each of its boundary curves.
    """

    boundary: Boundary

    @cached_property
    def _turning(self) -> Turning:
        return Turning(self.boundary.curves)

    @cached_property
    def kappa_g(self) -> Floats:
        """(n,) π − Σθ of the fan at each vertex, a measure in radians, so that ΣK + Σκ_g = 2πχ; NaN at the ends of open
        curves and where corners coincide."""
        curves = self.boundary.curves
        angle, _, _ = self._fans
        return np.where(curves.inner, np.pi - angle, np.nan)

    @cached_property
    def nu(self) -> Floats:
        """(3, n) unit normal ν of the face at the edge that leaves each vertex; NaN where the face has no area."""
        return self._edge_frame[0]

    @cached_property
    def conormal(self) -> Floats:
        """(3, n) η|e|, outward conormal of the edge that leaves each vertex times its length, in the surface's unit of
        computation."""
        return self._edge_frame[1]

    @cached_property
    def _edge_frame(self) -> tuple[Floats, Floats]:
        boundary = self.boundary
        surface, half_edge = boundary.surface, boundary.half_edge
        t = triangles(surface.xyz, surface.faces[np.maximum(half_edge, 0) // 3])
        edge = np.choose(half_edge % 3, np.array([t.u, t.v, [-x for x in t.w]])[:, :, :])
        with np.errstate(divide="ignore", invalid="ignore"):
            normal = np.array(t.normal) / t.twice_area
        normal[:, half_edge < 0] = np.nan
        return normal * np.where(boundary.forward, 1.0, -1.0), np.array(cross(edge, normal))

    @cached_property
    def vertex_nu(self) -> Floats:
        """(3, n) unit normal ν of the surface at each vertex, perpendicular to T there; NaN where there is none."""
        _, area, vector = self._fans
        # The area vector of a fan has the orientation of its star; along the curve that of the face at its edge counts.
        beside = self.boundary.half_edge
        sign = self.boundary.surface.corner_sign
        star = 1 if sign is None else sign.ravel()[self.boundary.corner]
        vector = vector * np.where(self.boundary.forward, star, -star)
        vector = np.where(dot(vector, vector) > (LOST * area) ** 2, vector, np.nan)
        vector[:, beside < 0] = np.nan
        tangent = self._vertex_tangent
        return unit(vector - tangent * dot(vector, tangent))

    @cached_property
    def _vertex_tangent(self) -> Floats:
        """(3, n) unit T half-way between the edges at each vertex; NaN where the curve ends or turns back."""
        curves = self.boundary.curves
        tangent = unit(curves.tangent[:, curves.preceding] + curves.tangent)
        tangent[:, self._turning.reversed | ~curves.inner] = np.nan
        return tangent

    @cached_property
    def kappa_n(self) -> Floats:
        """(n,) normal curvature, −ν · 2 sin(ψ/2) N: a measure, positive where the surface is convex along the curve, as
        κ₁ and κ₂ are; NaN where ν is."""
        return 0.0 - dot(self.vertex_nu, self._turning.vector)

    @cached_property
    def kappa_eta(self) -> Floats:
        """(n,) η · 2 sin(ψ/2) N, the component of the curvature vector along η = T × ν, out of the surface: a measure,
        with which T′ − T = −kappa_n ν + kappa_eta η and kappa_n² + kappa_eta² = (2 sin(ψ/2))²; NaN where ν is.

        The angle kappa_g, which closes Gauss–Bonnet, does not close this: where the surface is smooth it tends to
        −kappa_eta, positive where the curve bends into the surface.
        """
        return dot(cross(self._vertex_tangent, self.vertex_nu), self._turning.vector)

    @cached_property
    def _fans(self) -> tuple[Floats, Floats, Floats]:
        """Σθ, Σ area and Σ area ν of the fan at each vertex of the curves, from the faces that touch the boundary."""
        boundary = self.boundary
        surface, fans = boundary.surface, boundary.fans
        wanted, where = np.unique(boundary.fan, return_inverse=True)
        place = np.full(fans.count, -1)
        place[wanted] = np.arange(len(wanted))
        at_boundary: Mask = surface.boundary
        touching = faces_at(surface.faces, at_boundary)
        angle, area, vector = np.zeros(len(wanted)), np.zeros(len(wanted)), np.zeros((3, len(wanted)))
        for block in slices(len(touching)):
            face = touching[block]
            t = triangles(surface.xyz, surface.faces[face])
            for k in range(3):
                at = place[fans.of_corners(3 * face + k)]
                here = at >= 0
                at = at[here]
                theta = t.angle(k)
                # A corner that coincides with another one of its face has no angle.
                theta[t.no_angle(k)] = np.nan
                np.add.at(angle, at, theta[here])
                np.add.at(area, at, t.twice_area[here])
                sign = 1.0 if surface.corner_sign is None else surface.corner_sign[face[here], k]
                for component, part in zip(vector, t.normal, strict=True):
                    np.add.at(component, at, part[here] * sign)
        return angle[where], area[where], vector[:, where]

"""Uncertainty of curvatures for noisy coordinates: standard deviations, propagated by analytic derivatives.

Every coordinate of every vertex has independent noise. The displacement of a vertex acts on the curvature of a
neighbour through both triangles at their edge, so contributions are added per edge before they are squared; the
derivative by the vertex itself is minus their sum, since a translation of the whole star changes nothing.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..mesh.precision import precision
from ..mesh.surface import Surface
from ..mesh.triangles import Triangles, cross, dot, triangles
from ..support.arrays import Column, Flags, Floats, Index, VectorColumn
from ..support.blocks import slices
from .quantity import FlagNotice, Quantity
from .registry import curvature_pass
from .star import null_where

_EDGES = 8192
# **H**_p has a direction if it is longer than _FLAT · √|**A**_p| and than _NOISY times the noise of the coordinates,
# which is about its own noise; the direction of a shorter one is replaced by the normal.
_FLAT, _NOISY = 1e-9, 4.0


def deviation(surface: Surface, noise: float | None) -> float:
    """Standard deviation of each coordinate, in the unit of computation."""
    given = precision(surface) if noise is None else noise
    return float(np.ldexp(given, -surface.unit_exponent))


def _below_noise(code: str, name: str, after: str) -> FlagNotice:
    """The notice of vertices whose value is below its uncertainty."""
    return FlagNotice(
        code,
        f"[vertex|vertices] where |{name}| is below its own uncertainty {name}_sigma",
        f"noise of the coordinates alone explains {name} there; estimates over more rings average noise out",
        after,
    )


@curvature_pass(
    provides=(
        Quantity(
            "K_sigma",
            symbol="σ(K_p)",
            formula="√(σ²(Σ_e |g_e|² + |Σ_e g_e|²) + ½σ⁴‖D²K‖²), g_e = **H**_e/|e|²",
            kind="ratio",
            boundary="null",
            preserves="the standard deviation of K over noisy copies, to first order; the second order is that of flat "
            "stars, whose first vanishes",
            source="first-order propagation of errors; curvcli",
            description="Standard deviation of K under independent noise of each coordinate (`--noise`).",
            after="willmore_fit",
        ),
        Quantity("below_noise", kind="flag", public=False, notice=_below_noise("below_noise", "K", "folded_edges")),
    )
)
def angle_defect_uncertainty(surface: Surface, noise: float | None, K: Column) -> tuple[Column | Flags, ...]:
    """Uncertainty of the angle defect.

    Moving the end q of an edge e = pq turns its two triangles about p: ∂K_p/∂q = −Σ η_i/|e| = **H**_e/|e|², whose size
    is 2 sin(θ/2)/|e|. On a flat star it is zero, and K is quadratic in the displacements along the normal, with the
    second derivatives −Σcot θ_i/|e|² at q, 1/(2 area) at neighbours q, q′ of one triangle.
    """
    n = surface.n_vertices
    own, slope, bend, curving = np.zeros((3, n)), np.zeros(n), np.zeros(n), np.zeros(n)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for sides in _sides(surface):
            t = sides.faces
            square, inverse = t.cosines[0] + t.cosines[1], 1 / t.twice_area
            pull = np.array(cross(t.normal, t.u)) * (inverse / square)
            shares = ([*pull, cosine * inverse / square, inverse, inverse * inverse] for cosine in t.cosines[:2])
            for at, (x, y, z, opening, pair, twice) in sides.summed(*(np.array(share) for share in shares)):
                mixed = opening - pair
                np.add.at(slope, at, x * x + y * y + z * z)
                # The sum has every triangle at p twice, once per edge at p.
                np.add.at(bend, at, opening * opening + 2 * mixed * mixed + twice)
                np.add.at(curving, at, mixed)
                for total, part in zip(own, (x, y, z), strict=True):
                    np.add.at(total, at, part)
        sigma = deviation(surface, noise)
        first = sigma * np.sqrt(slope + dot(own, own))
        second = sigma * (sigma * np.sqrt(0.5 * (bend + curving * curving)))
        result = np.hypot(first, second)
    result = null_where(np.isnan(K) | ~np.isfinite(result), result)
    return result, np.abs(K) < result


@curvature_pass(
    provides=(
        Quantity(
            "h_sigma",
            symbol="σ(h_p)",
            formula="σ √(Σ_q |∂h/∂q|² + |Σ_q ∂h/∂q|²)",
            kind="density",
            length_exponent=-1,
            mean_degree=1,
            boundary="null",
            preserves="the standard deviation of h_signed over noisy copies, to first order",
            source="first-order propagation of errors; curvcli",
            after="K_sigma",
        ),
        Quantity("h_below_noise", kind="flag", public=False, notice=_below_noise("h_below_noise", "h", "below_noise")),
    )
)
def h_sigma(
    surface: Surface, noise: float | None, h: Column, H_vec: VectorColumn, star_vector: VectorColumn
) -> tuple[Column | Flags, ...]:
    """Standard deviation of h_signed under independent noise of each coordinate (`--noise`).

    ∂h = (u·∂**H** − h n·∂**A**)/|**A**|, u = **H**/|**H**| and n = **A**/|**A**|, from the derivatives of every
    triangle's share of **H** and **A**.
    """
    n = surface.n_vertices
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        size = np.sqrt(dot(star_vector, star_vector))
        up = star_vector / size
        length, sigma = np.sqrt(dot(H_vec, H_vec)), deviation(surface, noise)
        along = np.where(length > np.maximum(_FLAT * np.sqrt(size), _NOISY * sigma), H_vec / length, up)
        total, own = np.zeros(n), np.zeros((3, n))
        for sides in _sides(surface):
            for at, share in sides.summed(*_mean_shares(sides, along, up, h)):
                pull = share / size[at]
                np.add.at(total, at, dot(pull, pull))
                for row, part in zip(own, pull, strict=True):
                    np.add.at(row, at, part)
        result = sigma * np.sqrt(total + dot(own, own))
    result = null_where(np.isnan(h) | ~np.isfinite(result), result)
    return result, h < result


@dataclass(frozen=True)
class _HalfEdges:
    """The half-edges of some edges, each with its face turned so that it runs from corner 0 to corner 1.

    corners: (m, 3) of the faces. sign: (m, 3) with which their normals enter the stars of these corners, None for +1.
    forward: (m,) flags of half-edges from a to b. start: first half-edge of each edge.
    """

    faces: Triangles
    corners: Index
    sign: Floats | None
    forward: Flags
    start: NDArray[np.intp]
    a: Index
    b: Index

    def summed(self, at_tail: Floats, at_head: Floats) -> Iterator[tuple[Index, Floats]]:
        """Both ends of every edge, each with the sum of the shares (k, m) centred there."""
        for end, tail_mask in ((self.a, self.forward), (self.b, ~self.forward)):
            yield end, np.add.reduceat(np.where(tail_mask, at_tail, at_head), self.start, axis=1)


def _sides(surface: Surface) -> Iterator[_HalfEdges]:
    """The half-edges of all edges, in blocks of edges."""
    edges, faces, signs = surface.edges, surface.faces.reshape(-1), surface.corner_sign
    for block in slices(len(edges), _EDGES):
        first, last = edges.start[block.start], edges.start[block.stop]
        half_edges = edges.order[first:last]
        face = half_edges - half_edges % 3
        turned = np.stack([face + (half_edges + k) % 3 for k in range(3)], axis=1)
        corners = faces[turned]
        sign = None if signs is None else signs.reshape(-1)[turned].astype(np.float64)
        forward = corners[:, 0] == np.repeat(edges.a[block], edges.valence[block])
        start = edges.start[block] - first
        yield _HalfEdges(triangles(surface.xyz, corners), corners, sign, forward, start, edges.a[block], edges.b[block])


def _mean_shares(sides: _HalfEdges, along: VectorColumn, up: VectorColumn, h: Column) -> Iterator[Floats]:
    """Shares of each face in |**A**_p| ∂h_p/∂q, for p at the half-edge's tail and q at its head, and the reverse.

    The face p, q, r adds F = −½ u·(ν × d) to u·**H**_p, u = **H**_p/|**H**_p| and d = r − q. Its normal ν = N/|N|
    changes by ∂N − ν(ν·∂N) over |N|.
    """
    t = sides.faces
    nu = [x / t.twice_area for x in t.normal]
    # In the cyclic order of corners the head follows the tail; the tail is the last corner after the head.
    for end, opposite, side in ((0, t.v, t.w), (1, [-x for x in t.w], t.v)):
        center = sides.corners[:, end]
        u, normal = along[:, center], up[:, center]
        w = [-0.5 * x for x in cross(opposite, u)]
        level = dot(w, nu)
        m = [(a - level * b) / t.twice_area for a, b in zip(w, nu, strict=True)]
        weight = h[center] / 6 if sides.sign is None else h[center] / 6 * sides.sign[:, end]
        lever = [a - weight * b for a, b in zip(m, normal, strict=True)]
        turned = [0.5 * x for x in cross(u, nu)]
        if end == 0:
            yield np.array([a + b for a, b in zip(cross(side, lever), turned, strict=True)])
        else:
            yield np.array([a - b for a, b in zip(cross(lever, side), turned, strict=True)])

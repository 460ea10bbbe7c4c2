"""Intrinsic Delaunay triangulation: other straight edges of the same surface between the same vertices.

Flips live on a Δ-complex: an edge may be a loop, two faces may share two edges, a face may be glued to itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...mesh.topology import next_corner, previous_corner
from ...mesh.triangles import EPSILON, dot, span, triangles
from ...support.arrays import Floats, Mask
from ...support.blocks import slices
from ...support.double_double import THIN_COTANGENT, DoubleDouble, corner_products, empty
from .gluing import glue

if TYPE_CHECKING:
    from ...mesh.surface import Surface

Indices = NDArray[np.integer[Any]]

# An edge is flipped if cot α + cot β is below this; cocircular edges stay, or they would flip for ever.
_LIMIT = 1e-12
# Rounding of a sum of cotangents in double-double arithmetic, in units of the cotangents squared.
_SLACK = 1e-28
# Squares below this, in the unit of computation, have lost digits to underflow that a flip needs.
_LOST = 2.0**-900
# Flips per block: their temporaries stay in the second-level cache.
_FLIPS_PER_BLOCK = 4096
# Practical meshes need a few flips per edge; a mesh with more than these, ten seconds' worth, is given up.
_MOST_FLIPS, _MOST_FLIPS_PER_EDGE = 8_000_000, 20
# Cost of a round without its flips, in flips.
_ROUND = 400


class IntrinsicTriangulation:
    """A surface of faces glued along their sides, with intrinsic geometry only, flipped to Delaunay.

    Side 3 f + k of face f runs from corner k to corner k + 1. tail: (3F,) vertex where each side begins. edge: (3F,)
    edge of each side. side: (E,) one side of each edge. mates: (E,) sum of an edge's two sides, -1 where it is
    constrained: edges with n_e ≠ 2, of which each side is an edge of its own. weight: (E,) cot α + cot β.
    flips, rounds: their numbers. failing: (E,) mask of the edges still to flip: none, unless flipping was given up.
    most_flips: limit of flips, by default twenty per edge and at most eight million.

    Thin or flipped faces have their geometry in double-double arithmetic, exact enough for needles and for consistent
    decisions: at each corner the dot product of its two edges, and twice the area.
    Termination: each flip lowers the Dirichlet energy of every function that is linear on faces.
    Source: Bobenko and Springborn, A discrete Laplace–Beltrami operator for simplicial surfaces, section 2.
    """

    def __init__(self, surface: Surface, most_flips: int | None = None) -> None:
        glued = glue(surface)
        self.xyz, self.n_vertices, self.tail, self.twofold = surface.xyz, surface.n_vertices, glued.tail, glued.twofold
        pairs = len(glued.half_edge)
        n_faces, n_edges = len(self.tail) // 3, pairs + len(glued.single)
        self._cotangent, self._thin = self._plain_cotangents()
        self._lifted = np.zeros(n_faces, bool)
        self._products, self._twice_area = empty(len(self.tail)), empty(n_faces)
        self._flipped = np.zeros(n_edges, bool)
        self._mark = np.empty(max(n_edges, n_faces), np.int32)
        self.flips = self.rounds = 0
        self.side, self.mates, self.weight = np.empty(n_edges, np.int32), np.empty(n_edges, np.int32), np.empty(n_edges)
        self.edge = np.empty(len(self.tail), np.int32)
        for block in slices(pairs):
            half_edge, twin = (np.ascontiguousarray(sides[block], np.intp) for sides in (glued.half_edge, glued.twin))
            self.side[block], self.mates[block] = half_edge, half_edge + twin
            self.edge[half_edge] = self.edge[twin] = np.arange(block.start, block.stop, dtype=np.int32)
            with np.errstate(over="ignore", invalid="ignore"):
                self.weight[block] = self._cotangent.take(half_edge) + self._cotangent.take(twin)
        self.side[pairs:], self.mates[pairs:] = glued.single, -1
        self.edge[glued.single] = np.arange(pairs, n_edges, dtype=np.int32)
        self.weight[pairs:] = self._cotangent[glued.single]
        self.failing = self.weight < -_LIMIT
        self.failing[pairs:] = False
        self._weigh_thin(self._distinct(self._edges_of(np.flatnonzero(self._thin))))
        self._flip_all(_MOST_FLIPS + _MOST_FLIPS_PER_EDGE * n_edges if most_flips is None else most_flips)

    # ------------------------------------------------------------------ geometry

    def _plain_cotangents(self) -> tuple[Floats, Mask]:
        """(3F,) cotangent of the angle opposite each side, and the mask of faces too thin for plain arithmetic."""
        corners = self.tail.reshape(-1, 3)
        cotangent, thin = np.empty(corners.shape), np.empty(len(corners), bool)
        for block in slices(len(corners)):
            t = triangles(self.xyz, corners[block])
            with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
                opposite = [t.cosines[k - 1] / t.twice_area for k in range(3)]
            for k in range(3):
                cotangent[block, k] = opposite[k]
            thin[block] = _any_large(opposite)
        return cotangent.ravel(), thin

    def _lift(self, faces: Indices) -> None:
        """Compute the double-double geometry of the given faces from their corners, unless known."""
        new = self._distinct(faces[~self._lifted[faces]])
        if len(new):
            self._lifted[new] = True
            corners = tuple(self.tail[3 * new + k] for k in range(3))
            products, twice_area = corner_products(self.xyz, corners)
            for k in range(3):
                self._products.put(3 * new + k, products[k])
            self._twice_area.put(new, twice_area)

    def _weigh(self, edges: Indices) -> None:
        """Weights of the given edges, and flags of the edges to flip."""
        for block in slices(len(edges), _FLIPS_PER_BLOCK):
            edge = edges[block]
            half_edge, mate, free = self._sides(edge)
            thin = self._thin[half_edge // 3] | self._thin[mate // 3]
            with np.errstate(over="ignore", invalid="ignore"):
                weight = self._cotangent[half_edge] + np.where(free, self._cotangent[mate], 0.0)
            self.weight[edge] = weight
            self.failing[edge] = free & (half_edge // 3 != mate // 3) & (weight < -_LIMIT) & ~self._lost(half_edge)
            self._weigh_thin(edge[thin])

    def _weigh_thin(self, edges: Indices) -> None:
        """`_weigh` in double-double arithmetic, for edges of thin faces."""
        for block in slices(len(edges), _FLIPS_PER_BLOCK):
            edge = edges[block]
            half_edge, mate, free = self._sides(edge)
            f, g = half_edge // 3, mate // 3
            self._lift(np.concatenate([f, g]))
            c, d = self._products.at(previous_corner(half_edge)), self._products.at(previous_corner(mate))
            c_area, d_area = self._twice_area.at(f), self._twice_area.at(g)
            with np.errstate(all="ignore"):
                cotangent, opposite = c.high / c_area.high, d.high / d_area.high
                weight = ((c * d_area + d * c_area) / (c_area * d_area)).high
                flat = (c_area.high == 0) | (d_area.high == 0)
                weight = np.where(flat, cotangent + opposite, weight)
                limit = _LIMIT + _SLACK * np.maximum(abs(cotangent), abs(opposite)) ** 2
                self.failing[edge] = free & (f != g) & ~self._lost(half_edge) & (weight < -np.minimum(limit, 1e300))
            self.weight[edge] = np.where(free, weight, cotangent)

    def _lost(self, sides: Indices) -> Mask:
        """Mask of the sides of lifted faces across which no flip can be computed."""
        lost: Mask = self._lifted[sides // 3]
        lifted = np.flatnonzero(lost)
        known = sides[lifted]
        lost[lifted] = self._products.high[known] + self._products.high[next_corner(known)] < _LOST
        return lost

    def _sides(self, edges: Indices) -> tuple[Indices, Indices, Mask]:
        """Both sides of the given edges, one side twice for a constrained edge, and the mask of unconstrained ones."""
        half_edge = self.side[edges]
        free = self.mates[edges] >= 0
        return half_edge, np.where(free, self.mates[edges] - half_edge, half_edge), free

    # ------------------------------------------------------------------ flips

    def _flip_all(self, most: int) -> None:
        """Flip until no edge fails; each round flips the edges with precedence in both of their faces."""
        first = np.full(len(self._lifted), np.uint32(0xFFFFFFFF))
        todo: Indices = np.flatnonzero(self.failing)
        while len(todo) and self.flips + _ROUND * self.rounds < most:
            half_edge = self.side[todo]
            f, g = half_edge // 3, (self.mates[todo] - half_edge) // 3
            # An odd factor permutes the numbers below 2³²: precedence is pseudo-random, unique and repeatable.
            precedence = (todo.astype(np.uint32) + np.uint32(self.rounds)) * np.uint32(2654435761)
            np.minimum.at(first, f, precedence)
            np.minimum.at(first, g, precedence)
            chosen = (first[f] == precedence) & (first[g] == precedence)
            first[f] = first[g] = 0xFFFFFFFF
            self._flip(todo[chosen])
            changed = self._distinct(self._edges_of(np.concatenate([f[chosen], g[chosen]])))
            self._weigh(changed)
            todo = self._distinct(np.concatenate([todo[~chosen], changed]))
            todo = todo[self.failing[todo]]
            self.rounds += 1

    def _flip(self, edges: Indices) -> None:
        """Flip edges without common faces.

        The faces p q r and q p s at edge p q are laid out in the plane with p q as axis, where the corner products and
        areas are the coordinates of r and s; they become q r s and p s r.
        """
        for block in slices(len(edges), _FLIPS_PER_BLOCK):
            edge = edges[block]
            pq = self.side[edge]
            qp = self.mates[edge] - pq
            qr, rp, ps, sq = next_corner(pq), previous_corner(pq), next_corner(qp), previous_corner(qp)
            f, g = pq // 3, qp // 3
            self._lift(np.concatenate([f, g]))
            c_p, c_q, c_r = (self._products.at(side) for side in (pq, qr, rp))
            d_p, d_q, d_s = (self._products.at(side) for side in (ps, qp, sq))
            c_area, d_area = self._twice_area.at(f), self._twice_area.at(g)
            square, heights = c_p + c_q, c_area * d_area
            at_p, at_q = (c_p * d_p - heights) / square, (c_q * d_q - heights) / square
            p_area, q_area = (c_p * d_area + d_p * c_area) / square, (c_q * d_area + d_q * c_area) / square
            self._replace((qr, rp, pq), (at_q, c_q + c_r - at_q, d_q + d_s - at_q), q_area.clamped())
            self._replace((ps, sq, qp), (at_p, d_p + d_s - at_p, c_p + c_r - at_p), p_area.clamped())
            self._reglue(edge, pq, qp, rp, sq)
            self.flips += len(edge)

    def _replace(self, sides: tuple[Indices, ...], products: tuple[DoubleDouble, ...], area: DoubleDouble) -> None:
        """Give faces a new shape: the products at the tails of their sides in cyclic order, and twice the area."""
        face = sides[0] // 3
        self._twice_area.put(face, area)
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
            cotangents = [product.high / area.high for product in products]
        for k, side in enumerate(sides):
            self._products.put(side, products[k])
            self._cotangent[side] = cotangents[k - 1]
        self._thin[face] = _any_large(cotangents)

    def _reglue(self, edge: Indices, pq: Indices, qp: Indices, rp: Indices, sq: Indices) -> None:
        """Edge s q moves to the side that was p q, edge r p to the one that was q p; both freed sides are r s."""
        for old, new in ((sq, pq), (rp, qp)):
            self.tail[new] = self.tail[old]
        moved = self.edge[np.concatenate([sq, rp])]
        old, new = np.concatenate([sq, rp]), np.concatenate([pq, qp])
        free = self.mates[moved] >= 0
        np.add.at(self.mates, moved[free], (new - old)[free])
        self.edge[new], self.side[moved] = moved, new
        self.edge[rp] = self.edge[sq] = edge
        self.side[edge], self.mates[edge] = rp, rp + sq
        self._flipped[edge] = True

    def _edges_of(self, faces: Indices) -> Indices:
        """The edges of faces, with repetitions."""
        edges: Indices = self.edge[(3 * faces[:, None] + np.arange(3)).ravel()]
        return edges

    def _distinct(self, items: Indices) -> Indices:
        """Each of the given edges (or faces) once."""
        position = np.arange(len(items), dtype=np.int32)
        self._mark[items] = position
        once: Indices = items[self._mark[items] == position]
        return once

    # ------------------------------------------------------------------ results

    def lengths_squared(self, edges: slice) -> Floats:
        """(n,) squared lengths of a slice of the edges, in the unit of computation."""
        side = self.side[edges].astype(np.intp)
        head = next_corner(side)
        ends = [self.tail.take(corner).astype(np.intp) for corner in (side, head)]
        along = span(self.xyz, *ends)
        squares = dot(along, along)
        new = np.flatnonzero(self._flipped[edges])
        squares[new] = (self._products.at(side[new]) + self._products.at(head[new])).high
        return squares

    def degenerate_corners(self) -> Mask:
        """(V,) mask of the corners of faces without area, twice area ≤ 4ε · (longest edge)², after all flips."""
        known = np.flatnonzero(self._lifted)
        c = [self._products.at(3 * known + k).high for k in range(3)]
        longest = c[0] + c[1] + c[2] - np.minimum(np.minimum(c[0], c[1]), c[2])
        return self._corners(known[self._twice_area.high[known] <= 4 * EPSILON * longest])

    def unfinished_corners(self) -> Mask:
        """(V,) mask of the corners of faces at edges that still fail."""
        side = self.side[self.failing]
        return self._corners(np.concatenate([side, self.mates[self.failing] - side]) // 3)

    def _corners(self, faces: Indices) -> Mask:
        marked = np.zeros(self.n_vertices, bool)
        marked[self.tail.reshape(-1, 3)[faces].ravel()] = True
        return marked


def _any_large(cotangents: list[Floats]) -> Mask:
    """Mask of the faces with a cotangent too large for plain arithmetic, or undefined."""
    largest = np.maximum(np.maximum(abs(cotangents[0]), abs(cotangents[1])), abs(cotangents[2]))
    large: Mask = ~(largest <= THIN_COTANGENT)
    return large

"""Dirichlet energy of a piecewise linear map by cotangents, and its gradient."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...mesh.triangles import Triangles, Vector, dot, triangles
from ...support.arrays import Floats
from ...support.blocks import slices
from ...support.double_double import THIN_COTANGENT, cross, differences, product

if TYPE_CHECKING:
    from ...mesh.surface import Surface


@dataclass(frozen=True)
class Dirichlet:
    """Dirichlet energy E(f) per face, its gradient, and error terms.

    energy: (F,) of each face, NaN where the face is degenerate. gradient: (3, V) sums over the faces that are not.
    energy_terms (F,), gradient_terms (V,): sums of the absolute terms, each divided by the sine of its angle: rounding
    changes energy and gradient by a few ε times these.
    """

    energy: Floats
    gradient: Floats
    energy_terms: Floats
    gradient_terms: Floats


def dirichlet(surface: Surface, f: Floats) -> Dirichlet:
    """E(f) = ¼ Σ_T Σ_corners cot θ |opposite edge of f|² and ∇_p E(f) = ½ Σ (cot α + cot β)(f_p − f_q).

    Angles are those of the surface. f: (3, V) the images of its vertices. On a boundary edge one cotangent remains.
    Source: Sullivan, Discrete surfaces.
    """
    n = surface.n_vertices
    energy, energy_terms = np.empty(surface.n_faces), np.empty(surface.n_faces)
    gradient, gradient_terms = np.zeros((3, n)), np.zeros(n)
    for block in slices(surface.n_faces):
        t = triangles(surface.xyz, surface.faces[block])
        sides = (t.v, t.w, t.u) if f is surface.xyz else _opposite_sides(f, t.corners)
        squares = [dot(side, side) for side in sides]
        cotangents, cosecants, flat = _angles(t)
        thin = np.flatnonzero(np.maximum.reduce(np.abs(cotangents)) > THIN_COTANGENT)
        for cotangent in cotangents:
            cotangent[thin] = 0.0
        energy[block] = 0.25 * sum(c * s for c, s in zip(cotangents, squares, strict=True))
        if len(thin):
            energy[block.start + thin] = _add_thin(gradient, surface.xyz, f, t.corners[:, thin])
        energy[block][flat] = np.nan
        energy_terms[block] = 0.25 * sum(c * s for c, s in zip(cosecants, squares, strict=True))
        _scatter(gradient, gradient_terms, t.corners, sides, squares, cotangents, cosecants)
    return Dirichlet(energy, gradient, energy_terms, gradient_terms)


def _add_thin(gradient: Floats, xyz: Floats, f: Floats, corners: NDArray[np.intp]) -> Floats:
    """(n,) energies of thin faces in double-double arithmetic; their gradients are added to those of the vertices.

    For two edges u, w of a face and their images F_u, F_w the cotangent formula is
    (|w|²|F_u|² − 2 u·w F_u·F_w + |u|²|F_w|²) / (8 area), which is (||w|² F_u − u·w F_w|² + |u × w|²|F_w|²) over
    8 area |w|²: nothing cancels in that sum. w is the longest edge.
    """
    opposite = np.argmax([dot(side, side) for side in _opposite_sides(xyz, corners)], axis=0)
    apex, base, tip = np.take_along_axis(corners, (opposite + np.arange(3)[:, None]) % 3, axis=0)
    (u, w), (F_u, F_w) = ([differences(x, base, apex), differences(x, base, tip)] for x in (xyz, f))
    normal = cross(u, w)
    square = product(normal, normal)
    twice_area = square.sqrt()
    uu, uw, ww = product(u, u), product(u, w), product(w, w)
    of_u = [ww * a - uw * b for a, b in zip(F_u, F_w, strict=True)]
    of_w = [uu * b - uw * a for a, b in zip(F_u, F_w, strict=True)]
    for row, a, b in zip(gradient, of_u, of_w, strict=True):
        at_apex, at_tip = a / twice_area, b / twice_area
        for corner, pull in ((apex, at_apex), (tip, at_tip), (base, -(at_apex + at_tip))):
            np.add.at(row, corner, 0.5 * pull.high)
    return 0.25 * ((product(of_u, of_u) + square * product(F_w, F_w)) / (twice_area * ww)).high


def _opposite_sides(f: Floats, corners: NDArray[np.intp]) -> tuple[Vector, Vector, Vector]:
    """The images of the edges opposite corners 0, 1, 2, from corner 1 to 2, 0 to 2, 0 to 1."""
    p, q, r = ([x.take(corner) for x in f] for corner in corners)
    v, w, u = ([b - a for a, b in zip(tail, head, strict=True)] for tail, head in ((q, r), (p, r), (p, q)))
    return v, w, u


def _angles(t: Triangles) -> tuple[list[Floats], list[Floats], NDArray[np.bool_]]:
    """Cotangents and cosecants of the angles at the three corners, 0 on degenerate faces, and the mask of these."""
    flat = t.twice_area == 0 if t.degenerate is None else t.degenerate
    over = np.divide(1.0, t.twice_area, where=~flat, out=np.zeros_like(t.twice_area))
    v, w, u = (np.sqrt(dot(edge, edge)) for edge in (t.v, t.w, t.u))
    return [c * over for c in t.cosines], [over * u * w, over * u * v, over * v * w], flat


def _scatter(
    gradient: Floats,
    terms: Floats,
    corners: NDArray[np.intp],
    sides: tuple[Vector, Vector, Vector],
    squares: list[Floats],
    cotangents: list[Floats],
    cosecants: list[Floats],
) -> None:
    """Add ½ cot θ (f_q − f_r) at q and its opposite at r for the edge qr opposite each corner."""
    pull = [[0.5 * cot * x for x in side] for cot, side in zip(cotangents, sides, strict=True)]
    size = [0.5 * csc * np.sqrt(square) for csc, square in zip(cosecants, squares, strict=True)]
    for corner, (first, sign), (second, other) in (
        (0, (1, -1.0), (2, -1.0)),
        (1, (0, -1.0), (2, 1.0)),
        (2, (0, 1.0), (1, 1.0)),
    ):
        for k in range(3):
            np.add.at(gradient[k], corners[corner], sign * pull[first][k] + other * pull[second][k])
        np.add.at(terms, corners[corner], size[first] + size[second])

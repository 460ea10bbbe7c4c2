"""Vertex normals for estimates: from stars, fitted to the chords of neighbourhoods, or from the file."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..mesh.neighbourhoods import Pattern, as_weights, neighbourhoods
from ..mesh.scale import Scale, rings
from ..mesh.surface import Surface
from ..mesh.triangles import dot, triangles
from ..support.arrays import Flags, Floats, VectorColumn
from ..support.blocks import for_each, slices
from .kernels.tensor import ENTRIES, WHERE, frame
from .registry import curvature_pass
from .star import null_where

# Pairs of neighbours per block; temporaries stay in the second-level cache.
_PAIRS = 16384
# Weight of a normal at the boundary, computed from half a star; inside it is 1.
_ONE_SIDED = 2.0**-10
# A full step multiplies each error of the normals by some r. An error common to all neighbours has r = −1, and the
# third-order term of the condition alternates with it: steps come in pairs, which leave both unchanged. A
# pair of sizes 1/(1 ± √y) multiplies any other error by (r² − y)/(1 − y). With y the roots of a Chebyshev polynomial on
# [0, _LEFT²], the largest product of these for |r| ≤ _LEFT is the least possible.
_LEFT = 0.75
# Over one ring, two damped steps leave a smaller error.
_DAMPED = (0.7, 0.7)
# Below this determinant, in squares of the trace, chords are nearly parallel and determine no normal.
_IN_LINE = 1e-6
# Mean squares of chords below this part of the component's squared extent cancel in moments about its middle.
_LOST = 1e-10


@curvature_pass(public=False, kind="direction", vector=True, parity="odd")
def star_normal(surface: Surface, normals: Literal["mesh", "file"]) -> VectorColumn:
    """Unit normals as the stars are oriented, exact on spheres: Σ e × e′/(|e|²|e′|²) over the corners at p, e and e′
    their edges (Max, Weights for computing vertex normals from facet normals, 1999); or the file's, turned to that
    side. Null where there is no direction.

    Errors: InputError where the file's normals are wanted and it has none.
    """
    given = _of_file(surface) if normals == "file" else None
    total = np.zeros((3, surface.n_vertices))
    sign = surface.corner_sign
    for block in slices(surface.n_faces):
        t = triangles(surface.xyz, surface.faces[block])
        u, v, w = t.cosines[0] + t.cosines[1], t.cosines[1] + t.cosines[2], t.cosines[0] + t.cosines[2]
        for k, square in enumerate((u * w, u * v, v * w)):
            weight = np.divide(1.0, square, where=square > np.finfo(np.float64).tiny, out=np.zeros_like(square))
            if sign is not None:
                weight *= sign[block, k]
            for row, component in zip(total, t.normal, strict=True):
                np.add.at(row, t.corners[k], component * weight)
    if given is not None:
        return np.where(dot(given, total) < 0, -given, given)
    return _unit(total)


def _unit(vector: Floats) -> VectorColumn:
    """Normalise vectors; null for zero and non-finite ones."""
    unit: VectorColumn = np.empty_like(vector)
    for block in slices(vector.shape[1]):
        each = vector[:, block]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            scaled = each / np.abs(each).max(axis=0)
            np.divide(scaled, np.sqrt(dot(scaled, scaled)), out=unit[:, block])
    return unit


def _of_file(surface: Surface) -> VectorColumn:
    """Unit normals of the file."""
    given = None if surface.file is None else surface.file.vertex_normals
    if given is None:
        raise InputError(
            "no normals at the vertices, expected properties nx, ny, nz (PLY) or vn records (OBJ)",
            path=surface.file.path if surface.file is not None else None,
            hint="--normals mesh takes them from the triangles",
        )
    return _unit(np.asarray(given, np.float64))


@curvature_pass(public=False, kind="direction", vector=True, parity="odd")
def fitted_normal(
    surface: Surface, scale: Scale, normals: Literal["mesh", "file"], star_normal: VectorColumn
) -> VectorColumn:
    """The normals that fit their neighbours': on any quadric, up to third order, (n_p + n_q)·(x_q − x_p) = 0.

    Given the n_q, each n_p is the least-squares solution over its neighbourhood: first estimates are averaged, the
    curvature of the surface is not smoothed away. Normals of the file are left as they are.
    """
    if normals == "file":
        return star_normal
    known: Flags = np.logical_and.reduce(np.isfinite(star_normal))
    everywhere = bool(known.all())
    weight = None
    if not everywhere or not surface.interior.all():
        weight = np.where(known, np.where(surface.interior, 1.0, _ONE_SIDED), 0.0)
    normal = star_normal if everywhere else np.where(known, star_normal, 0.0)
    normal = _Fit(surface, scale, weight).normals(normal, _steps(scale))
    return normal if everywhere else null_where(~known, normal)


def _steps(scale: Scale) -> Sequence[float]:
    """Step sizes 1/(1 ± √y), y the roots of a Chebyshev polynomial on [0, _LEFT²]."""
    if scale == rings(1):
        return _DAMPED
    pairs = 2 if scale.kind == "rings" and scale.size > 2 else 3  # many neighbours share errors sooner
    part = [_LEFT * math.cos((k + 0.5) * math.pi / (2 * pairs)) for k in range(pairs)]
    return [1 / (1 + sign * each) for each in part for sign in (1, -1)]


class _Fit:
    """Least squares over the chords d = x_q − x_p of all neighbourhoods: Σ d ((n_p + n_q)·d) = 0.

    The first residual is summed over all pairs. The small change by each step is summed from moments about the middle
    of the component: Σ d (m_q·d) = Σ x (x·m) − x_p Σ x·m − (Σ x ⊗ m) x_p + x_p (x_p·Σ m).
    """

    def __init__(self, surface: Surface, scale: Scale, weight: Floats | None) -> None:
        self._surface, self._scale, self._weight = surface, scale, weight
        members = surface.components.vertices
        used = np.where(surface.referenced, surface.xyz, np.nan)
        low, high = (np.array([sign * members.max(sign * x) for x in used]) for sign in (-1.0, 1.0))
        middle, extent = low + 0.5 * (high - low), (high - low).max(axis=0)
        several = members.label is not None
        # Unreferenced vertices are in no neighbourhood, and may have NaN coordinates.
        centre = middle[:, members.label] if several else np.broadcast_to(middle, (3, surface.n_vertices))
        self._at = np.zeros((3, surface.n_vertices))
        np.subtract(surface.xyz, centre, out=self._at, where=surface.referenced)
        self._lost = _LOST * np.square(extent[members.label] if several else np.full(surface.n_vertices, extent[0]))
        self._square = np.empty((6, surface.n_vertices))
        self._residual = np.empty((3, surface.n_vertices))
        # Rows with too much cancellation in moments.
        self._by_pairs = surface.without_orientation.copy()

    def normals(self, normal: VectorColumn, steps: Sequence[float]) -> VectorColumn:
        """The normals after steps towards the solution, of all vertices at once."""
        self._begin(normal)
        for step in steps[:-1]:
            turned = _solved(normal, self._square, self._residual, step)
            self._add(turned - normal, turned)
            normal = turned
        return _solved(normal, self._square, self._residual, steps[-1])

    def _begin(self, normal: VectorColumn) -> None:
        """Σ d ⊗ d and the first residual."""

        def squares(block: slice) -> list[Floats]:
            at = self._at[:, block]
            return [at[i] * at[j] for i, j in ENTRIES] + [*at, np.ones(at.shape[1])]

        moments = self._weighted(10, squares)

        def begin(piece: tuple[slice, Pattern]) -> None:
            block, rows = piece
            total, p = (as_weights(rows) @ moments).T, self._at[:, block]
            square = self._square[:, block]
            for row, (i, j) in zip(square, ENTRIES, strict=True):
                row[:] = total[WHERE[i, j]] - total[6 + i] * p[j] - total[6 + j] * p[i] + total[9] * p[i] * p[j]
            self._residual[:, block] = self._over_pairs(block.start + np.arange(len(p[0])), rows, normal, normal, None)
            lost = np.flatnonzero(square[0] + square[3] + square[5] < self._lost[block] * total[9])
            if len(lost):
                self._by_pairs[block.start + lost] = True
                exact = np.empty((6, len(lost)))
                self._over_pairs(block.start + lost, rows[lost], normal, normal, exact)
                square[:, lost] = exact

        for_each(neighbourhoods(self._surface, self._scale), begin)

    def _add(self, change: VectorColumn, normal: VectorColumn) -> None:
        """Update the residual for a change of the normals."""

        def products(block: slice) -> list[Floats]:
            at, by = self._at[:, block], change[:, block]
            along = dot(at, by)
            return [*(at * along), along, *by] + [a * b for a in at for b in by]

        moments = self._weighted(16, products)

        def add(piece: tuple[slice, Pattern]) -> None:
            block, rows = piece
            total, p = (as_weights(rows) @ moments).T, self._at[:, block]
            height = dot(p, total[4:7]) - total[3]
            square, own = self._square[:, block], change[:, block]
            added = np.empty_like(own)
            for i in range(3):
                other = total[i] + p[i] * height - dot(p, total[7 + 3 * i : 10 + 3 * i])
                added[i] = other + dot(square[WHERE[i]], own)
            pairs = np.flatnonzero(self._by_pairs[block])
            if len(pairs):
                added[:, pairs] = self._over_pairs(block.start + pairs, rows[pairs], change, normal, None)
            self._residual[:, block] += added

        for_each(neighbourhoods(self._surface, self._scale), add)

    def _weighted(self, count: int, columns: Callable[[slice], list[Floats]]) -> Floats:
        """(V, count) columns, from a function of blocks of vertices, times the weights."""
        result = np.empty((self._surface.n_vertices, count))

        def fill(block: slice) -> None:
            np.stack(columns(block), axis=1, out=result[block])
            if self._weight is not None:
                result[block] *= self._weight[block, None]

        for_each(slices(len(result)), fill)
        return result

    def _over_pairs(
        self, at: NDArray[np.intp], rows: Pattern, field: VectorColumn, normal: VectorColumn, square: Floats | None
    ) -> Floats:
        """(3, n) Σ d ((m_p + m_q)·d) of a field m over the rows of n vertices, and Σ d ⊗ d if `square` is given.

        Without an orientation m_q gets the sign of the product of the normals at p and q.
        """
        surface, count = self._surface, np.diff(rows.indptr)
        result = np.zeros((3, len(count)))
        if square is not None:
            square[:] = 0.0
        for part in pair_blocks(rows.indptr):
            first, last = rows.indptr[part.start], rows.indptr[part.stop]
            if first == last:
                continue
            q, p = rows.indices[first:last], np.repeat(at[part], count[part])
            chord = [x.take(q) - x.take(p) for x in surface.xyz]
            other = [x.take(q) for x in field]
            if not surface.orientable:
                turn = np.copysign(1.0, sum(x.take(q) * x.take(p) for x in normal))
                turn = np.where(surface.without_orientation.take(p), turn, 1.0)
                other = [turn * x for x in other]
            height = dot([a + x.take(p) for a, x in zip(other, field, strict=True)], chord)
            weighted = chord if self._weight is None else [self._weight.take(q) * x for x in chord]
            filled = np.flatnonzero(count[part])
            start = (rows.indptr[part.start : part.stop] - first)[filled]
            for k in range(3):
                result[k, filled + part.start] = np.add.reduceat(weighted[k] * height, start)
                if square is None:
                    continue
                for j in range(k, 3):
                    square[WHERE[k, j], filled + part.start] = np.add.reduceat(weighted[k] * chord[j], start)
        return result


def pair_blocks(indptr: NDArray[np.integer], size: int = _PAIRS) -> Iterator[slice]:
    """Slices of at least one row with about so many entries each. indptr: (rows + 1,) of a sparse matrix."""
    rows = len(indptr) - 1
    start = 0
    while start < rows:
        stop = int(np.searchsorted(indptr, indptr[start] + size, side="right")) - 1
        stop = min(max(stop, start + 1), rows)
        yield slice(start, stop)
        start = stop


def _solved(normal: VectorColumn, square: Floats, residual: Floats, step: float) -> VectorColumn:
    """The normals turned a step towards the solution of square · change = −residual within their tangent planes."""
    turned = np.empty_like(normal)

    def turn(block: slice) -> None:
        n, rest, m = normal[:, block], residual[:, block], square[:, block]
        u, v = frame(n)
        square_u = [dot(m[row], u) for row in WHERE]
        uu, uv, vv = dot(u, square_u), dot(v, square_u), dot(v, [dot(m[row], v) for row in WHERE])
        a, b = dot(u, rest), dot(v, rest)
        determinant, trace = uu * vv - uv * uv, uu + vv
        with np.errstate(divide="ignore", invalid="ignore"):
            along_u, along_v = (uv * b - vv * a) / determinant, (uv * a - uu * b) / determinant
            change = along_u * u + along_v * v
        usable = determinant > _IN_LINE * trace * trace
        turned[:, block] = _unit(n + step * np.where(usable, change, 0.0))

    for_each(slices(normal.shape[1]), turn)
    return turned

"""Normals at vertices, for estimates: from the stars, made to fit the chords to all neighbours; or the file's own."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..blocks import Floats, by_corner, dot, face_blocks, triangles
from ..declare import Flags, VectorColumn, curvature_pass
from ..errors import InputError
from ..neighbourhoods import Pattern, neighbourhoods
from ..settings import Scale, rings
from ..surface import Surface
from ..threads import for_each
from .star import null_where
from .tensor import WHERE, frame

# Pairs of neighbours per block; temporaries stay in the second-level cache.
_PAIRS = 16384
# How much less the normal of a vertex with half a star counts.
_ONE_SIDED = 2.0**-10
# A full step averages the errors of single normals away. What neighbours err alike it turns round, and the next one
# back again along with the step's own error of third order: their number is even. Over one ring there is little to
# average, and two damped steps leave less.
_FULL, _DAMPED = (1.0, 1.0, 1.0, 1.0), (0.7, 0.7)
# Chords that lie so nearly in one direction fix no normal.
_IN_LINE = 1e-6


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
    for block in face_blocks(surface.n_faces):
        face = by_corner(surface.faces[block])
        t = triangles(surface.xyz, surface.faces[block])
        u, v, w = t.cosines[0] + t.cosines[1], t.cosines[1] + t.cosines[2], t.cosines[0] + t.cosines[2]
        for k, square in enumerate((u * w, u * v, v * w)):
            weight = np.divide(1.0, square, where=square > np.finfo(np.float64).tiny, out=np.zeros_like(square))
            if sign is not None:
                weight *= sign[block, k]
            for row, component in zip(total, t.normal, strict=True):
                np.add.at(row, face[k], component * weight)
    if given is not None:
        return np.where(dot(given, total) < 0, -given, given)
    return _unit(total)


def _unit(vector: Floats) -> VectorColumn:
    """Vectors of unit length, null where there is none or it is no number."""
    unit: VectorColumn = np.empty_like(vector)
    for block in face_blocks(vector.shape[1]):
        each = vector[:, block]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            scaled = each / np.abs(each).max(axis=0)
            np.divide(scaled, np.sqrt(dot(scaled, scaled)), out=unit[:, block])
    return unit


def _of_file(surface: Surface) -> VectorColumn:
    """The file's normals at unit length."""
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
    fit = _Fit(surface, scale, weight)
    normal = star_normal if everywhere else np.where(known, star_normal, 0.0)
    for step in _DAMPED if scale == rings(1) else _FULL:
        normal = fit.turned(normal, step)
    return normal if everywhere else null_where(~known, normal)


class _Fit:
    """Least squares over the chords d = x_q − x_p of all neighbourhoods: Σ (d ⊗ d) n_p = −Σ d (n_q·d)."""

    def __init__(self, surface: Surface, scale: Scale, weight: Floats | None) -> None:
        self._surface, self._scale, self._weight = surface, scale, weight
        self._square = np.zeros((6, surface.n_vertices))
        self._new = True

    def turned(self, normal: VectorColumn, step: float) -> VectorColumn:
        """The normals after a step towards the solution, all vertices at once."""
        found = np.empty_like(normal)

        def turn(rows: tuple[slice, Pattern]) -> None:
            block, pattern = rows
            image = self._image(block, pattern, normal)
            found[:, block] = _solved(normal[:, block], self._square[:, block], image, step)

        for_each(neighbourhoods(self._surface, self._scale), turn)
        self._new = False
        return found

    def _image(self, block: slice, rows: Pattern, normal: VectorColumn) -> Floats:
        """(3, n) Σ d (n_q·d) of the rows of a block; Σ d ⊗ d, which stays the same, is worked out the first time."""
        surface, count = self._surface, np.diff(rows.indptr)
        image = np.zeros((3, len(count)))
        for part in pair_blocks(rows.indptr):
            first, last = rows.indptr[part.start], rows.indptr[part.stop]
            if first == last:
                continue
            q, each = rows.indices[first:last], count[part]
            here = slice(block.start + part.start, block.start + part.stop)
            chord = [x.take(q) - np.repeat(x[here], each) for x in surface.xyz]
            other = [x.take(q) for x in normal]
            height = dot(other, chord)
            if not surface.orientable:
                height *= np.copysign(1.0, dot(other, [np.repeat(x[here], each) for x in normal]))
            weighted = chord if self._weight is None else [self._weight.take(q) * x for x in chord]
            filled = np.flatnonzero(each)
            start = (rows.indptr[part.start : part.stop] - first)[filled]
            for k in range(3):
                image[k, filled + part.start] = np.add.reduceat(weighted[k] * height, start)
                for j in range(k, 3) if self._new else ():
                    square = np.add.reduceat(weighted[k] * chord[j], start)
                    self._square[WHERE[k, j], filled + here.start] = square
        return image


def pair_blocks(indptr: NDArray[np.integer], size: int = _PAIRS) -> Iterator[slice]:
    """Slices of rows that have about so many entries together, one row at least."""
    rows = len(indptr) - 1
    start = 0
    while start < rows:
        stop = int(np.searchsorted(indptr, indptr[start] + size, side="right")) - 1
        stop = min(max(stop, start + 1), rows)
        yield slice(start, stop)
        start = stop


def _solved(normal: VectorColumn, square: Floats, image: Floats, step: float) -> VectorColumn:
    """The normals turned a step towards the solution of square · n = −image within their tangent planes."""
    u, v = frame(normal)
    wanted = [-(image[k] + dot(square[WHERE[k]], normal)) for k in range(3)]
    square_u = [dot(square[row], u) for row in WHERE]
    uu, uv, vv = dot(u, square_u), dot(v, square_u), dot(v, [dot(square[row], v) for row in WHERE])
    a, b = dot(u, wanted), dot(v, wanted)
    determinant, trace = uu * vv - uv * uv, uu + vv
    with np.errstate(divide="ignore", invalid="ignore"):
        along_u, along_v = (vv * a - uv * b) / determinant, (uu * b - uv * a) / determinant
        solution = along_u * u + along_v * v
    usable = determinant > _IN_LINE * trace * trace
    return _unit(normal + step * np.where(usable, solution, 0.0))

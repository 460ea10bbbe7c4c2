"""Moments of neighbourhoods in tangent frames, the input of local fits.

Neighbourhoods of about the same size form one table, padded with the vertex itself, which adds nothing; a small matrix
product per vertex computes all sums Σ xⁱ yʲ and Σ z yʲ xⁱ at once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ...mesh.neighbourhoods import Pattern, adjacency, as_weights, neighbourhoods
from ...mesh.scale import Scale
from ...mesh.surface import Surface
from ...mesh.triangles import dot
from ...support.arrays import Floats
from .tensor import frame

# The highest power of a coordinate in the products of two monomials of degree 4, and of x beside z.
_PRODUCT, _BESIDE = 8, 4
# The factors of all products: 1, x, …, x⁸, z on one side; 1, y, …, y⁸, z, zy, …, zy⁴ on the other.
_POWERS = 2 * _PRODUCT + 4 + _BESIDE
# Entries of a table that fit into the second-level cache with all powers; vertices solved together.
_ENTRIES, _ROWS = 1 << 14, 1 << 13
# The difference of the squares of length and width, as a part of their sum, beyond which a strip is narrow.
_NARROW = 0.5
# Neighbourhoods are padded to a multiple of this.
_STEP = 8


@dataclass(frozen=True)
class Moments:
    """The moments of some vertices' neighbourhoods, z along the normal.

    vertex: (m,) which vertices. size: (m,) points in the neighbourhood, the vertex included. frame: (3, 3, m) the axes
    u, v and the normal, each by its components. sums: (10, 14, m): [i, j] holds Σ xⁱ yʲ, [i, 9 + j] holds Σ z xⁱ yʲ,
    [9, 9] holds Σ z². shadow: (m,) the part of its area that the neighbourhood's projection along the
    normal n has, Σ**A**_q·n/Σ|**A**_q|; 1 without an orientation.
    """

    vertex: NDArray[np.intp]
    size: Floats
    frame: Floats
    sums: Floats
    shadow: Floats

    def of(self, i: int, j: int) -> Floats:
        """(m,) Σ xⁱ yʲ."""
        sums: Floats = self.size if i == j == 0 else self.sums[i, j]
        return sums

    def with_height(self, i: int, j: int) -> Floats:
        """(m,) Σ z xⁱ yʲ."""
        sums: Floats = self.sums[i, _PRODUCT + 1 + j]
        return sums

    @property
    def squared_height(self) -> Floats:
        """(m,) Σ z²."""
        sums: Floats = self.sums[_PRODUCT + 1, _PRODUCT + 1]
        return sums


def moments(surface: Surface, scale: Scale, star_vector: Floats, least: int) -> Iterator[Callable[[], Moments]]:
    """Yield functions that compute the moments of some neighbourhoods, together of all manifold vertices with a normal
    and at least so many points.

    star_vector: (3, V) vector areas of the stars. The normal is that of the vertex and its neighbours together; where
    the patch has no orientation, that of the vertex alone.
    """
    normal: Floats = (as_weights(adjacency(surface)) @ star_vector.T).T
    if not surface.orientable:
        normal = np.where(surface.without_orientation, star_vector, normal)
    length = np.sqrt(dot(normal, normal))
    usable = surface.referenced & ~surface.nonmanifold & (length > 0)
    normal = np.divide(normal, length, where=usable, out=np.full_like(normal, np.nan))
    frames = np.array([*frame(normal), normal])
    stars = np.array([*star_vector, np.sqrt(dot(star_vector, star_vector))]).T
    for block, rows in neighbourhoods(surface, scale):
        size = np.diff(rows.indptr)
        total = (as_weights(rows) @ stars).T
        shadow = np.ones(len(size))
        np.divide(dot(total[:3], normal[:, block]), total[3], out=shadow, where=total[3] > 0)
        shadow[surface.without_orientation[block]] = 1.0
        chosen = np.flatnonzero(usable[block] & (size >= least))
        chosen = chosen[np.argsort(size[chosen], kind="stable")]
        for start in range(0, len(chosen), _ROWS):
            yield partial(_of_rows, surface, frames, shadow, rows, block.start, chosen[start : start + _ROWS])


def _of_rows(
    surface: Surface, frames: Floats, shadow: Floats, rows: Pattern, first: int, chosen: NDArray[np.intp]
) -> Moments:
    """The moments of the chosen rows of a block, sorted by size."""
    vertex, size = chosen + first, np.diff(rows.indptr)[chosen]
    width = -(-size // _STEP) * _STEP
    axes = frames[:, :, vertex]
    sums = np.empty((_PRODUCT + 2, _PRODUCT + 2 + _BESIDE, len(chosen)))
    room = np.empty(_POWERS * max(_ENTRIES, int(width[-1])))
    start = 0
    while start < len(chosen):
        stop = min(int(np.searchsorted(width, width[start], "right")), start + max(_ENTRIES // int(width[start]), 1))
        part = slice(start, stop)
        table = _table(rows, chosen[part], vertex[part], int(width[start]))
        powers = room[: _POWERS * table.size].reshape(_POWERS, *table.shape)
        _fill(surface, axes[:, :, part], vertex[part], table, powers, sums[:, :, part])
        start = stop
    return Moments(vertex, size.astype(np.float64), axes, sums, shadow[chosen])


def _table(rows: Pattern, chosen: NDArray[np.intp], vertex: NDArray[np.intp], width: int) -> NDArray[np.intp]:
    """(m, width) the points of each row, padded with the vertex itself, as intp for fast gathers."""
    begin, end = rows.indptr[chosen][:, None], rows.indptr[chosen + 1][:, None]
    place = begin + np.arange(width, dtype=begin.dtype)
    inside = place < end
    return np.where(inside, rows.indices[np.minimum(place, len(rows.indices) - 1)], vertex[:, None])


def _fill(
    surface: Surface, axes: Floats, vertex: NDArray[np.intp], table: NDArray[np.intp], powers: Floats, sums: Floats
) -> None:
    """Write the sums (10, 14, m) of a table of points from their powers; may rotate the axes (3, 3, m)."""
    x, y = powers[: _PRODUCT + 2], powers[_PRODUCT + 2 :]
    x[0] = y[0] = 1.0
    offset = [at.take(table) - at[vertex][:, None] for at in surface.xyz]
    part = np.empty(table.shape)
    for target, axis in ((x[1], axes[0]), (y[1], axes[1]), (x[_PRODUCT + 1], axes[2])):
        np.multiply(offset[0], axis[0][:, None], out=target)
        for step, component in zip(offset[1:], axis[1:], strict=True):
            np.multiply(step, component[:, None], out=part)
            target += part
    _turn(axes, x[1], y[1])
    y[_PRODUCT + 1] = x[_PRODUCT + 1]
    for k in range(2, _PRODUCT + 1):
        np.multiply(x[k - 1], x[1], out=x[k])
        np.multiply(y[k - 1], y[1], out=y[k])
    for k in range(_PRODUCT + 2, _PRODUCT + 2 + _BESIDE):
        np.multiply(y[k - 1], y[1], out=y[k])
    sums[:] = np.matmul(x.transpose(1, 0, 2), y.transpose(1, 2, 0)).transpose(1, 2, 0)


def _turn(axes: Floats, x: Floats, y: Floats) -> None:
    """Rotate the axes along a narrow strip of points, for a well-conditioned fit."""
    xx, yy, xy = (np.einsum("ij,ij->i", a, b) for a, b in ((x, x), (y, y), (x, y)))
    narrow = np.flatnonzero(np.hypot(xx - yy, 2 * xy) > _NARROW * (xx + yy))
    if not len(narrow):
        return
    turn = 0.5 * np.arctan2(2 * xy[narrow], xx[narrow] - yy[narrow])
    cos, sin = np.cos(turn), np.sin(turn)
    u, v, _ = axes[:, :, narrow]
    axes[0][:, narrow], axes[1][:, narrow] = cos * u + sin * v, cos * v - sin * u
    old, cos, sin = x[narrow], cos[:, None], sin[:, None]
    x[narrow], y[narrow] = cos * old + sin * y[narrow], cos * y[narrow] - sin * old

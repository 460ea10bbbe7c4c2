"""Neighbourhoods of vertices, within some rings of edges or within a radius, as rows of sparse matrices.

Rows are computed in blocks, so that memory is bounded for any size of mesh and neighbourhood.
"""

from __future__ import annotations

from collections.abc import Iterator
from weakref import WeakKeyDictionary

import numpy as np
from scipy.sparse import csr_array

from ..errors import InputError
from ..support.arrays import Floats, Index, Mask
from ..support.blocks import for_each, slices
from .scale import Scale
from .surface import Surface
from .triangles import dot, span

# Expected entries of a block of rows.
_ENTRIES_PER_BLOCK = 1 << 21
_ROWS_PER_BLOCK = 1 << 16
# Entries, counted before repetitions are merged, beyond which a block is halved.
_LARGEST_BLOCK = 1 << 25
# A row is left empty where its next step meets this many times the usual number of vertices, and at least so many.
_USUAL, _ALWAYS = 64, 1 << 10

Pattern = csr_array

# Largest neighbourhood, in vertices of a usual mesh; beyond it the time is out of proportion to the mesh.
_MOST_EXPECTED = 10_000

# Neighbourhoods are cached for several passes up to this many entries (5 bytes each).
_MOST_KEPT = 1 << 26
_KEPT: WeakKeyDictionary[Surface, tuple[Scale, list[tuple[slice, Pattern]]]] = WeakKeyDictionary()


def adjacency(surface: Surface) -> Pattern:
    """(V, V) boolean: the ends of the edges at each vertex, and the vertex itself where a face uses it."""
    own = np.flatnonzero(surface.referenced).astype(np.int32)
    vertex = np.concatenate([surface.edges.a, surface.edges.b, own])
    neighbour = np.concatenate([surface.edges.b, surface.edges.a, own])
    count, vertices = len(vertex), surface.n_vertices
    # The transposition of a sparse matrix is a counting sort.
    rows = csr_array((neighbour, vertex, np.arange(count + 1, dtype=np.int32)), shape=(count, vertices)).tocsc()
    return csr_array((np.ones(count, bool), rows.data, rows.indptr), shape=(vertices, vertices))


def mean_edge_length(surface: Surface) -> float:
    """The mean length of all edges, in the unit of computation."""
    total = 0.0
    for block in slices(len(surface.edges)):
        along = span(surface.xyz, surface.edges.a[block], surface.edges.b[block])
        total += float(np.sqrt(dot(along, along)).sum())
    return total / len(surface.edges)


def radius_of(surface: Surface, scale: Scale) -> float:
    """The radius of a scale in edge lengths or in length, in the unit of computation."""
    if scale.kind == "edges":
        return scale.size * mean_edge_length(surface)
    with np.errstate(over="ignore"):  # an infinite radius reaches everything
        return float(np.ldexp(scale.size, -surface.unit_exponent))


def neighbourhoods(surface: Surface, scale: Scale) -> Iterator[tuple[slice, Pattern]]:
    """Yield blocks of vertices with a boolean CSR matrix (rows of the block, V): the neighbours of each vertex.

    Every vertex is in its own neighbourhood; the row of an unreferenced vertex is empty. Rings: all vertices within so
    many edges. Radius: the vertices within that distance in space that a path of edges within it joins to the centre;
    a sheet that passes nearby is left out. Columns within a row are unordered. Rows with far more vertices than usual
    at the scale, next to vertices of huge degree, are left empty.
    Errors: InputError for a radius that takes in too many vertices.
    """
    kept = _KEPT.get(surface)
    if kept is not None and kept[0] == scale:
        yield from kept[1]
        return
    _KEPT.pop(surface, None)
    grow = _Rings(surface, scale) if scale.kind == "rings" else _Balls(surface, scale)
    size = max(min(_ROWS_PER_BLOCK, _ENTRIES_PER_BLOCK // grow.expected), 1)
    entries, blocks = 0, []
    for block in slices(surface.n_vertices, size):
        for place, rows in _grown(grow, block):
            entries += rows.nnz
            if scale.kind != "rings" and entries > _MOST_EXPECTED * surface.n_vertices:
                raise _too_far(surface, f"more than {_MOST_EXPECTED:,}")
            if entries <= _MOST_KEPT:
                blocks.append((place, rows))
            else:
                blocks.clear()
            yield place, rows
    if entries <= _MOST_KEPT:
        _KEPT[surface] = scale, blocks


def _too_far(surface: Surface, count: str) -> InputError:
    return InputError(
        f"the radius takes in {count} vertices around each, at most {_MOST_EXPECTED:,} expected",
        path=surface.file.path if surface.file is not None else None,
        hint="a smaller --radius, or a coarser mesh",
    )


def clear_cache(surface: Surface) -> None:
    """Drop the cached neighbourhoods of a surface."""
    _KEPT.pop(surface, None)


def _grown(grow: _Rings | _Balls, block: slice) -> Iterator[tuple[slice, Pattern]]:
    """The rows of a block, or of its halves where the block has too many entries."""
    rows = grow.rows(block)
    if rows is not None:
        yield block, rows
        return
    middle = (block.start + block.stop) // 2
    yield from _grown(grow, slice(block.start, middle))
    yield from _grown(grow, slice(middle, block.stop))


class _Rings:
    """Neighbourhoods of some rings."""

    def __init__(self, surface: Surface, scale: Scale) -> None:
        self.near = adjacency(surface)
        self.count = int(scale.size)
        self.expected = 3 * self.count * (self.count + 1) + 1
        self.most = max(_USUAL * self.expected, _ALWAYS)
        self.degree = np.diff(self.near.indptr).astype(np.float64)

    def rows(self, block: slice) -> Pattern | None:
        """The rows of a block; None if it has too many entries."""
        rows = self.near[block]
        for _ in range(self.count - 1):
            small = _without_huge(rows, self.degree, self.most)
            if small is None:
                return None
            rows = small @ self.near
        return rows


class _Balls:
    """The connected parts of balls, grown edge by edge."""

    def __init__(self, surface: Surface, scale: Scale) -> None:
        self.surface, self.near = surface, adjacency(surface)
        self.radius = radius_of(surface, scale)
        mean = mean_edge_length(surface)
        reach = self.radius / mean if mean > 0 else 1.0
        self.expected = min(int(4 * min(reach, 1e3) ** 2) + 1, surface.n_vertices)
        if self.expected > _MOST_EXPECTED:
            raise _too_far(surface, f"about {self.expected:,}")
        self.most = max(_USUAL * self.expected, _ALWAYS)
        self.degree = np.diff(self.near.indptr).astype(np.float64)

    def rows(self, block: slice) -> Pattern | None:
        """The rows of a block; None if they are too many for one."""
        start = np.flatnonzero(self.surface.referenced[block]).astype(np.int32)
        shape = (block.stop - block.start, self.surface.n_vertices)
        frontier = csr_array((np.ones(len(start), bool), (start, start + np.int32(block.start))), shape=shape)
        previous = csr_array(shape, dtype=bool)
        reached = frontier
        while frontier.nnz:
            work = frontier @ self.degree
            huge = work + np.diff(reached.indptr) > self.most
            if huge.any():
                frontier, previous, reached = (_emptied(rows, huge) for rows in (frontier, previous, reached))
            if work[~huge].sum() + reached.nnz > _LARGEST_BLOCK and block.stop - block.start > 1:
                return None
            # The ends of the next edges were met in this step or the last two.
            ends = _within(self.surface, frontier @ self.near, block, self.radius)
            fresh = (ends > frontier) > previous
            fresh.eliminate_zeros()
            previous, frontier = frontier, fresh
            reached = reached + fresh
        return reached


def _without_huge(rows: Pattern, degree: Floats, most: int) -> Pattern | None:
    """Empty the rows whose next step is too large; None if all together have too many entries."""
    work = rows @ degree
    huge = work > most
    if work[~huge].sum() > _LARGEST_BLOCK and rows.shape[0] > 1:
        return None
    return _emptied(rows, huge) if huge.any() else rows


def _emptied(rows: Pattern, which: Mask) -> Pattern:
    """Copy the pattern with some rows empty."""
    count = np.diff(rows.indptr)
    kept = np.repeat(~which, count)
    total = np.zeros(len(count) + 1, np.int32)
    np.cumsum(np.where(which, 0, count), out=total[1:])
    return csr_array((rows.data[kept], rows.indices[kept], total), shape=rows.shape)


def _within(surface: Surface, rows: Pattern, block: slice, radius: float) -> Pattern:
    """Keep the entries within the radius about the vertex of their row."""
    count = np.diff(rows.indptr)
    at = np.repeat(np.arange(block.start, block.stop, dtype=np.int32), count)
    square = np.zeros(len(at))
    for x in surface.xyz:
        step = x[rows.indices] - x[at]
        square += step * step
    kept = square <= radius * radius
    total = np.zeros(len(at) + 1, np.int32)
    np.cumsum(kept, out=total[1:])
    indices = rows.indices[kept]
    return csr_array((np.ones(len(indices), bool), indices, total[rows.indptr]), shape=rows.shape)


def sums(surface: Surface, scale: Scale, data: Floats) -> Floats:
    """(V, k) sums over the neighbourhood of each vertex of data (V, k), which must be finite; 0 where it is empty."""
    total = np.empty(data.shape)

    def add(piece: tuple[slice, Pattern]) -> None:
        block, rows = piece
        total[block] = as_weights(rows) @ data

    for_each(neighbourhoods(surface, scale), add)
    return total


def as_weights(rows: Pattern) -> csr_array:
    """The same pattern with a weight of one, for products with columns."""
    return csr_array((np.ones(rows.nnz), rows.indices, rows.indptr), shape=rows.shape)


def sizes(surface: Surface, scale: Scale) -> Index:
    """(V,) number of vertices in each neighbourhood, the vertex itself included."""
    count = np.zeros(surface.n_vertices, np.int32)
    for block, rows in neighbourhoods(surface, scale):
        count[block] = np.diff(rows.indptr)
    return count

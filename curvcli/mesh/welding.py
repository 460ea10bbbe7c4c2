"""Merging vertices at equal, or nearly equal, positions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, Notice
from ..support.blocks import LONG, map_pieces, slices
from .file import MeshFile, Polylines

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

_PAIRS = 1 << 20
"""Pairs of positions that are looked at together."""
_CROWD = 200
"""Positions near a vertex, on average, of which a tolerance is too large for the mesh."""
# Odd multipliers of a hash, with well spread bits: one for each coordinate and one for the end.
_MIX = (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0xD6E8FEB86659FD93)


def welded(mesh: MeshFile, weld: str | float) -> MeshFile:
    """Merge the vertices of a mesh: corners move to the lowest row of each group, `welded_to` is set, rows stay.

    weld: `auto` or `none` (nothing is merged), `exact`, or a tolerance relative to the diagonal of the bounding box.
    """
    if weld in ("auto", "none"):
        return mesh
    if weld == "exact":
        first, number = weld_exact(mesh.xyz)
        lowest = first[number]
    else:
        lowest = weld_within(mesh.xyz, float(weld))
    to = np.where(lowest == np.arange(len(lowest)), np.int32(-1), lowest)
    merged = np.flatnonzero(to >= 0)
    message = "[vertex|vertices] merged with an earlier one, whose row holds the values"
    notice = Notice.at("welded_vertices", merged, message, "--weld none keeps [it|them] apart")
    return replace(
        mesh,
        corners=lowest[mesh.corners],
        polylines=Polylines(lowest[mesh.polylines.vertex], mesh.polylines.start),
        welded_to=to,
        notices=(*mesh.notices, notice) if len(merged) else mesh.notices,
    )


def weld_exact(xyz: NDArray[np.floating[Any]]) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Group exactly equal positions (-0.0 equals 0.0).

    xyz: (3, n) float64 or float32, one row per coordinate.
    Returns the lowest index of each group (m,), ascending, and for each position the number of its group (n,).
    """
    lowest = _lowest_equal(xyz)
    is_first = np.empty(len(lowest), np.bool_)
    for block in slices(len(lowest), LONG):
        is_first[block] = lowest[block] == _indices(block)
    number = np.cumsum(is_first, dtype=np.int32)
    number -= 1
    for block in slices(len(lowest), LONG):
        lowest[block] = number.take(lowest[block])
    return np.flatnonzero(is_first).astype(np.int32), lowest


def _lowest_equal(xyz: NDArray[np.floating[Any]]) -> NDArray[np.int32]:
    """For each position the lowest index of an equal one.

    A hash table filled in bulk: each slot keeps the lowest index, positions equal to it are settled, and the few others
    go to the next round with another hash. Equality is tested on the bits. The work is done in blocks, because page
    faults cost about as much as the arithmetic.
    """
    lowest, table = np.empty(xyz.shape[1], np.int32), np.empty(1, np.int32)
    count, pieces = len(lowest), list[slice | NDArray[np.int32]](slices(len(lowest), LONG))
    for round_ in range(32):
        if not count:
            return lowest
        power = max(4, count.bit_length())
        if len(table) < 1 << power:
            table = np.empty(1 << power, np.int32)
        slots = list(map_pieces(pieces, partial(_slots, xyz, round_, np.uint64(64 - power))))
        for piece, slot in zip(reversed(pieces), reversed(slots), strict=True):
            table[slot[::-1].astype(np.intp)] = _indices(piece)[::-1]  # the last assignment wins: the lowest index
        index = np.concatenate(list(map_pieces(zip(pieces, slots, strict=True), partial(_settle, lowest, xyz, table))))
        count, pieces = len(index), [index[block] for block in slices(len(index), LONG)]
    # Only an adversarial file gets here: sort the rest.
    columns = _bits(xyz, index)
    order = np.lexsort((index, *columns))
    new = np.ones(len(order), np.bool_)
    new[1:] = np.any([column[order[1:]] != column[order[:-1]] for column in columns], axis=0)
    lowest[index[order]] = index[order][new][np.cumsum(new) - 1]
    return lowest


def _slots(
    xyz: NDArray[np.floating[Any]], round_: int, shift: np.uint64, piece: slice | NDArray[np.int32]
) -> NDArray[np.uint32]:
    """Slots of the positions of a piece in the hash table."""
    return (_hash(_bits(xyz, piece), round_) >> shift).astype(np.uint32)


def _settle(
    lowest: NDArray[np.int32],
    xyz: NDArray[np.floating[Any]],
    table: NDArray[np.int32],
    placed: tuple[slice | NDArray[np.int32], NDArray[np.uint32]],
) -> NDArray[np.int32]:
    """Set `lowest` of a piece to the table entries in its slots; return the positions that differ from theirs."""
    piece, slot = placed
    candidate = table.take(slot)
    both = zip(_bits(xyz, piece), _bits(xyz, candidate), strict=True)
    equal = np.logical_and.reduce([mine == other for mine, other in both])
    lowest[piece] = candidate
    unsettled: NDArray[np.int32] = _indices(piece)[~equal]
    return unsettled


def _indices(piece: slice | NDArray[np.int32]) -> NDArray[np.int32]:
    """The indices of a piece."""
    return np.arange(piece.start, piece.stop, dtype=np.int32) if isinstance(piece, slice) else piece


def _bits(xyz: NDArray[np.floating[Any]], chosen: slice | NDArray[np.int32]) -> list[NDArray[Any]]:
    """The coordinates of some positions as unsigned numbers, -0.0 as 0.0."""
    unsigned = np.uint64 if xyz.dtype == np.float64 else np.uint32
    return [(row[chosen] + xyz.dtype.type(0)).view(unsigned) for row in xyz]


def _hash(columns: list[NDArray[Any]], round_: int) -> NDArray[np.uint64]:
    mixed = np.full(len(columns[0]), round_, np.uint64)
    for k, column in enumerate(columns):
        mixed += column
        mixed *= np.uint64(_MIX[(k + round_) % 4])
        mixed ^= mixed >> np.uint64(29 + round_ % 5)
    mixed *= np.uint64(_MIX[3])
    return mixed


def position_keys(xyz: NDArray[np.float64]) -> NDArray[np.uint64]:
    """(n,) a hash of each position (3, n); equal positions have equal hashes."""
    keys = np.empty(xyz.shape[1], np.uint64)
    for block in slices(len(keys)):
        keys[block] = _hash([(row[block] + 0.0).view(np.uint64) for row in xyz], 0)
    return keys


def weld_within(
    xyz: NDArray[np.float64], tolerance: float, among: NDArray[np.bool_] | None = None
) -> NDArray[np.int32]:
    """Group positions joined by steps of at most `tolerance` times the diagonal of the bounding box.

    Returns the lowest index of each position's group (n,).

    xyz: (3, n). Positions that are not finite stay alone. among: (n,) the positions that may be joined, by default all.
    Errors: InputError for too many pairs of positions within the tolerance.
    """
    from scipy.spatial import cKDTree

    from .topology import label_graph

    n = xyz.shape[1]
    lowest = np.arange(n, dtype=np.int32)
    finite = np.flatnonzero(np.isfinite(xyz).all(0))
    if not len(finite):
        return lowest
    low, high = xyz[:, finite].min(1), xyz[:, finite].max(1)
    if among is not None:
        finite = finite[among[finite]]
    first, number = weld_exact(xyz[:, finite])
    points = xyz[:, finite[first]]
    with np.errstate(over="ignore"):
        extent = high - low
    scale = extent.max()
    if not np.isfinite(scale) or scale == 0:
        points, scale, low, high = (x * 0.5**10 for x in (points, scale, low, high))
        extent = high - low
        scale = extent.max() or 1.0
    points = (points - low[:, None]) / scale
    reach = tolerance * float(np.linalg.norm(extent / scale))
    tree, count = cKDTree(points.T), len(first)
    near = int(tree.count_neighbors(tree, reach)) // count
    if near > _CROWD:
        raise InputError(
            f"{near} positions lie within the tolerance of a vertex on average, a few expected",
            hint="a smaller --weld TOL, or `--weld exact`",
        )
    groups, label = count, np.arange(count, dtype=np.int32)
    for a, b in _near_pairs(tree, reach, near):
        groups, again = label_graph(groups, label[a], label[b])
        label = again[label]
    lead = np.full(groups, n, np.int64)
    np.minimum.at(lead, label, finite[first])
    lowest[finite] = lead[label[number]]
    return lowest


def _near_pairs(tree: cKDTree, reach: float, near: int) -> Iterator[tuple[NDArray[Any], NDArray[Any]]]:
    """Yield pairs of positions within reach of each other, all at once or, for very many, in blocks.

    near: average number of neighbours of a position.
    """
    if near * tree.n <= _PAIRS:
        a, b = tree.query_pairs(reach, output_type="ndarray").T
        yield a, b
        return
    from scipy.spatial import cKDTree

    around = np.cumsum(tree.query_ball_point(tree.data, reach, return_length=True))
    bounds = np.searchsorted(around, np.arange(0, around[-1], _PAIRS)).tolist()
    for begin, end in pairwise([*dict.fromkeys(bounds), tree.n]):
        distances = cKDTree(tree.data[begin:end]).sparse_distance_matrix(tree, reach, output_type="ndarray")
        yield distances["i"] + begin, distances["j"]

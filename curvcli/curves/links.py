"""Linking numbers of pairs of closed curves: the Gauss integral over both."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..errors import UsageError
from ..mesh.triangles import EPSILON
from ..support.arrays import Floats, Mask
from .polygon import Curves, Rows
from .writhe import MAX_EDGES, UNSURE, edge_pairs

LISTED = 100
"""Up to so many closed curves all pairs are listed; of more, those whose boxes meet."""

MOST_PAIRS = 1_000_000
"""Pairs of curves whose boxes are compared, and that are listed, at most."""

# A block of pairs of edges whose temporaries stay in the second-level cache.
_ROWS, _COLUMNS = 16, 1024


@dataclass(frozen=True)
class Links:
    """Pairs of closed curves, in order.

    a, b: (k,) numbers of the curves, a < b. number: (k,) linking number in turns as summed, NaN where it was not.
    error: (k,) bound of its rounding error. touching: (k,) pairs with a common point. refused: number of pairs with
    too large a double sum, or of too many pairs of boxes.
    """

    a: Rows
    b: Rows
    number: Floats
    error: Floats
    touching: Mask
    refused: int

    @property
    def known(self) -> Mask:
        """(k,) flags of certain integers."""
        near = np.abs(self.number - np.rint(self.number)) <= UNSURE
        return (self.error <= UNSURE) & near & ~self.touching


def links(curves: Curves, max_edges: int | None = MAX_EDGES) -> Links:
    """Linking number (1/4π) ∬ (T × T′)·(x − x′)/|x − x′|³ of each pair of closed curves: half the signed crossings.

    An integer, which changes sign with the direction of either curve and under reflection; 0 where the boxes of the
    curves are apart, without a sum. Undefined where curves touch. Solid angles of pairs of edges as for the writhe.
    curves: in E³, without repeated points. max_edges: pairs are summed from the smallest up while √Σ products of edges
    ≤ max_edges. Time is that of the sums and of comparing the boxes, which is refused beyond MOST_PAIRS pairs.
    Errors: UsageError for other dimensions. Source: Sullivan, Curves; Gauss, 1833.
    """
    if curves.dimension != 3:
        raise UsageError(f"linking numbers need curves in E^3, not in E^{curves.dimension}")
    closed = np.flatnonzero(curves.closed & (curves.edges > 1))
    if len(closed) < 2:
        nothing = np.empty(0)
        return Links(*(np.empty(0, np.int64),) * 2, nothing, nothing, np.empty(0, bool), 0)
    pairs = _candidates(curves, closed)
    if pairs is None:
        nothing = np.empty(0)
        count = len(closed) * (len(closed) - 1) // 2
        return Links(*(np.empty(0, np.int64),) * 2, nothing, nothing, np.empty(0, bool), count)
    a, b, meet = pairs
    touching = _touching(curves, a, b)
    number = np.where(meet, np.nan, 0.0)
    error = number.copy()
    cost = curves.edges[a].astype(np.float64) * curves.edges[b]
    wanted = np.flatnonzero(meet & ~touching)
    wanted = wanted[np.argsort(cost[wanted], kind="stable")]
    if max_edges is not None:
        wanted = wanted[np.cumsum(cost[wanted]) <= float(max_edges) ** 2]
    for pair in wanted.tolist():
        number[pair], error[pair] = _sum(_corners(curves, int(a[pair])), _corners(curves, int(b[pair])))
    refused = int(np.count_nonzero(meet & ~touching)) - len(wanted)
    return Links(a, b, number, error, touching, refused)


def _candidates(curves: Curves, closed: Rows) -> tuple[Rows, Rows, Mask] | None:
    """Pairs in order, with flags of meeting boxes: all pairs of few curves, meeting pairs of many, None of too many."""
    low = np.stack([-curves.max(-x)[closed] for x in curves.xyz])
    high = np.stack([curves.max(x)[closed] for x in curves.xyz])
    if len(closed) <= LISTED:
        first, second = np.triu_indices(len(closed), 1)
    else:
        order = np.argsort(low[0], kind="stable")
        after = np.searchsorted(low[0][order], high[0][order], side="right")
        counts = after - np.arange(1, len(order) + 1)
        if counts.sum() > 64 * MOST_PAIRS:
            return None
        blocks = [_meeting(low, high, order, counts, block) for block in _blocks(counts)]
        first, second = np.concatenate(blocks, axis=1)
        rank = np.lexsort([second, first])
        first, second = first[rank], second[rank]
    return None if len(first) > MOST_PAIRS else (closed[first], closed[second], _meet(low, high, first, second))


def _blocks(counts: Rows) -> Iterator[slice]:
    """Runs of curves with about as many pairs each as fit into the cache."""
    number = np.cumsum(counts) // (1 << 18)
    ends = np.flatnonzero(np.diff(number, append=-1)) + 1
    yield from map(slice, [0, *ends[:-1].tolist()], ends.tolist())


def _meeting(low: Floats, high: Floats, order: Rows, counts: Rows, block: slice) -> Rows:
    """(2, k) pairs whose boxes meet, of some curves in order with the `counts` that follow each."""
    some = counts[block]
    first = np.repeat(np.arange(block.start, block.stop), some)
    second = first + 1 + np.arange(len(first)) - np.repeat(np.cumsum(some) - some, some)
    pairs = np.sort([order[first], order[second]], axis=0)
    return np.asarray(pairs[:, _meet(low, high, *pairs)])


def _meet(low: Floats, high: Floats, first: Rows, second: Rows) -> Mask:
    """(k,) flags: the boxes of two curves have a common point."""
    meet: Mask = np.logical_and.reduce((low[:, first] <= high[:, second]) & (low[:, second] <= high[:, first]))
    return meet


def _touching(curves: Curves, a: Rows, b: Rows) -> Mask:
    """(k,) mask of the pairs of curves with a vertex at the same position."""
    order = np.lexsort(curves.xyz + 0.0)
    xyz, label = curves.xyz[:, order], curves.label[order]
    result: set[tuple[int, int]] = set()
    for step in range(1, curves.size):
        same = (xyz[:, step:] == xyz[:, :-step]).all(axis=0)
        if not same.any():
            break
        at = np.flatnonzero(same)
        result.update(zip(label[at].tolist(), label[at + step].tolist(), strict=True))
    if not result:
        return np.zeros(len(a), bool)
    return np.array([(i, j) in result or (j, i) in result for i, j in zip(a.tolist(), b.tolist(), strict=True)])


def _corners(curves: Curves, curve: int) -> Floats:
    """(3, 1, edges + 1) the corners of a closed curve, the first again at the end."""
    xyz = curves.xyz[:, curves.start[curve] : curves.start[curve + 1]]
    return np.concatenate([xyz, xyz[:, :1]], axis=1)[:, None]


def _sum(first: Floats, second: Floats) -> tuple[float, float]:
    """The linking number of two curves by their corners, and a bound of its error, in turns."""
    first, second = _in_common(first, second)
    k, m = first.shape[2] - 1, second.shape[2] - 1
    sums = [
        edge_pairs(first[..., i : i + _ROWS + 1], second[..., j : j + _COLUMNS + 1]).summed(None)
        for i in range(0, k, _ROWS)
        for j in range(0, m, _COLUMNS)
    ]
    total, bound, crossings = np.sum(sums, axis=0).tolist()
    # A pair of edges that cross adds half a turn of one sign or the other.
    return total / (4 * np.pi), (16 + np.log2(k * m)) * EPSILON * bound / (4 * np.pi) + crossings / 2


def _in_common(first: Floats, second: Floats) -> tuple[Floats, Floats]:
    """Translate and scale both, by a power of 2, so that no square overflows or underflows."""
    unit = 4 if max(np.abs(first).max(), np.abs(second).max()) >= 2.0**1020 else 0
    first, second = np.ldexp(first, -unit), np.ldexp(second, -unit)
    base = first[:, :, :1]
    first, second = first - base, second - base
    power = np.frexp(max(np.abs(first).max(), np.abs(second).max()))[1]
    return np.ldexp(first, -power), np.ldexp(second, -power)

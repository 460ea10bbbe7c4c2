"""Bounding-box tree: candidate pairs for contact, searched level by level in whole arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...support.arrays import Floats, Ints, Mask
from ...support.blocks import slices

# Children of a node, and number of candidates expanded at a time.
_WIDTH = 4
_AT_ONCE = 1 << 15
# Pairs of nodes expanded at a time, each into 16 pairs of children.
_PAIRS = 1 << 13
_BITS = 16


class BoxTree:
    """One tree of boxes for each group of items; a node holds up to four consecutive nodes of the level below.

    low, high: (3, n) corners of the items' boxes. group: (n,) group of each item; every group has an item.
    Items are sorted along a space-filling curve; building and searching take O(n log n) on usual meshes.
    """

    def __init__(self, low: Floats, high: Floats, group: NDArray[np.integer[Any]], groups: int) -> None:
        self.groups = groups
        self.order = _along_a_curve(low, high, group, groups)
        count = np.bincount(group, minlength=groups)
        # Contiguous rows: indexing a non-contiguous array would copy all of it.
        self._low, self._high = ([np.ascontiguousarray(rows[:, self.order])] for rows in (low, high))
        self._first = [_starts(count)]
        while count.max() > 1:
            fewer = -(-count // _WIDTH)
            first, below = _starts(fewer), self._first[-1]
            number = np.arange(first[-1]) - np.repeat(first[:-1], fewer)
            start = np.repeat(below[:-1], fewer) + _WIDTH * number
            self._low.append(np.ascontiguousarray(np.minimum.reduceat(self._low[-1], start, axis=1)))
            self._high.append(np.ascontiguousarray(np.maximum.reduceat(self._high[-1], start, axis=1)))
            self._first.append(first)
            count = fewer

    def members(self, group: Ints) -> tuple[Ints, Ints]:
        """Position in `order` of the first item of each given group, and their numbers."""
        first = self._first[0]
        return first[group], first[group + 1] - first[group]

    def meeting(self, first: Ints, second: Ints) -> Iterator[tuple[Ints, Ints, Ints]]:
        """Yield pairs of items of two groups whose boxes meet: number of the pair of groups, item and item.

        first, second: (n,) groups of each pair. For a group with itself each pair comes once, and no item with itself.
        """
        same, top = first == second, len(self._first) - 1
        stack: list[tuple[int, Ints, Ints, Ints]]
        stack = [(top, *part) for part in _in_parts(np.arange(len(first)), first, second)]
        while stack:
            level, pair, a, b = stack.pop()
            if level == top:
                kept = self._overlap(level, a[None], b[None])[0, 0]
                pair, a, b = pair[kept], a[kept], b[kept]
            if level:
                (mine, a), (yours, b) = self._children(level, first[pair], a), self._children(level, second[pair], b)
                meet = self._overlap(level - 1, a, b)
                meet &= mine[:, None] & yours[None]
                meet &= ~(same[pair] & (a[:, None] > b[None]))
                i, j, row = np.nonzero(meet)
                stack += [(level - 1, *part) for part in _in_parts(pair[row], a[i, row], b[j, row])]
            elif len(pair):
                distinct = a != b
                yield pair[distinct], self.order[a[distinct]], self.order[b[distinct]]

    def _children(self, level: int, group: Ints, node: Ints) -> tuple[Mask, Ints]:
        """(4, n) flags of the children that exist, and their nodes; beyond the last, the last again."""
        above, below = self._first[level], self._first[level - 1]
        children = below[group] + _WIDTH * (node - above[group]) + np.arange(_WIDTH)[:, None]
        last = below[group + 1] - 1
        return children <= last, np.minimum(children, last)

    def _overlap(self, level: int, a: Ints, b: Ints) -> Mask:
        """(i, j, n) flags: the boxes of nodes a (i, n) and b (j, n) meet."""
        low, high = self._low[level], self._high[level]
        meet = np.ones((len(a), *b.shape), bool)
        for axis in range(3):
            meet &= low[axis].take(a)[:, None] <= high[axis].take(b)[None]
            meet &= low[axis].take(b)[None] <= high[axis].take(a)[:, None]
        return meet

    def holding(self, points: Floats, group: Ints, above: bool = False) -> Iterator[tuple[Ints, Ints]]:
        """Yield the items of one group per point whose boxes contain it: number of the point, and item.

        points: (3, n). above: include the boxes that the ray from the point along the third axis meets.
        """
        stack = [(len(self._first) - 1, np.arange(len(group)), group)]
        while stack:
            level, point, node = stack.pop()
            if len(point) > _AT_ONCE:
                stack += [(level, point[part], node[part]) for part in slices(len(point), _AT_ONCE)]
                continue
            low, high = self._low[level], self._high[level]
            kept = np.ones(len(point), bool)
            for axis, row in enumerate(points):
                at = row.take(point)
                kept &= at <= high[axis].take(node)
                if axis < 2 or not above:
                    kept &= at >= low[axis].take(node)
            point, node = point[kept], node[kept]
            if level:
                where, node = self._below(level, group[point], node)
                stack.append((level - 1, point[where], node))
            elif len(point):
                yield point, self.order[node]

    def _below(self, level: int, group: Ints, node: Ints) -> tuple[Ints, Ints]:
        """The children of some nodes: index of the parent among these, and node of the child."""
        above, below = self._first[level], self._first[level - 1]
        start = below[group] + _WIDTH * (node - above[group])
        count = np.minimum(_WIDTH, below[group + 1] - start)
        where = np.repeat(np.arange(len(node)), count)
        return where, np.arange(len(where)) - np.repeat(np.cumsum(count) - count, count) + start[where]


def _in_parts(a: Ints, b: Ints, c: Ints) -> list[tuple[Ints, Ints, Ints]]:
    """Three arrays of one length in parts."""
    return [(a[part], b[part], c[part]) for part in slices(len(a), _PAIRS)]


def _starts(count: Ints) -> Ints:
    """(n + 1,) starts of runs of these lengths."""
    return np.concatenate([[0], np.cumsum(count)])


def _along_a_curve(low: Floats, high: Floats, group: NDArray[np.integer[Any]], groups: int) -> Ints:
    """Items sorted by group, and within it along the Morton curve through the centres of their boxes."""
    code = np.zeros(len(group), np.uint64)
    for axis in range(3):
        middle = low[axis] / 2 + high[axis] / 2
        least, most = np.full(groups, np.inf), np.full(groups, -np.inf)
        np.minimum.at(least, group, middle)
        np.maximum.at(most, group, middle)
        with np.errstate(divide="ignore", invalid="ignore"):
            place = (middle - least[group]) / (most - least)[group] * ((1 << _BITS) - 1)
        code |= _spread(np.where(place > 0, place, 0).astype(np.uint64)) << np.uint64(axis)
    return np.asarray(np.lexsort((code, group)), np.int64)


def _spread(bits: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """16 bits with two zeros between each two."""
    steps: tuple[Callable[[NDArray[np.uint64]], NDArray[np.uint64]], ...] = (
        lambda x: (x | x << np.uint64(16)) & np.uint64(0x0000FF0000FF),
        lambda x: (x | x << np.uint64(8)) & np.uint64(0x00F00F00F00F),
        lambda x: (x | x << np.uint64(4)) & np.uint64(0x0C30C30C30C3),
        lambda x: (x | x << np.uint64(2)) & np.uint64(0x249249249249),
    )
    for step in steps:
        bits = step(bits)
    return bits

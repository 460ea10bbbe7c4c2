"""Nesting of closed surfaces: depth by winding numbers, and pairs that cross.

Bounding boxes only save work. Touching is not crossing: a cavity may touch its outer wall from inside, and bodies may
touch each other from outside.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...support.arrays import Floats, Ints, Mask
from ...support.blocks import slices
from .boxes import BoxTree
from .contacts import find_contacts, samples
from .sides import INSIDE, OUTSIDE, ROUNDING, Sides

# Number of pairs of faces in contact, per pair of surfaces, that are sampled for points on both sides.
_CONTACTS = 20_000
# Numbers of points of a surface that are tried in turn until one does not lie on the other surface.
_TRIED = (1, 32, 4096)


class Nesting(NamedTuple):
    """depth: (n,) number of other surfaces around each; 0 for surfaces that cross another, which have no depth.

    crossing: (m, 2) pairs that cross or coincide, ascending.
    """

    depth: Ints
    crossing: Ints

    def crosses(self) -> Mask:
        """(n,) mask of the surfaces that cross or coincide with another one."""
        mask = np.zeros(len(self.depth), bool)
        mask[self.crossing.ravel()] = True
        return mask


def nest(xyz: Floats, faces: NDArray[np.integer[Any]], surface: NDArray[np.integer[Any]], sign: Ints) -> Nesting:
    """The nesting of closed surfaces.

    xyz: (3, V). faces: (F, 3). surface: (F,) the surface of each face, -1 for none. sign: (n,) signs of the volumes,
    0 within rounding.
    """
    n = len(sign)
    low, high = _boxes(xyz, faces, surface, n)
    root = np.zeros(1, np.int64)
    meeting = BoxTree(low, high, np.zeros(n, np.int32), 1).meeting(root, root)
    pairs = np.sort(
        np.concatenate([np.zeros((2, 0), np.int64), *map(np.stack, (x[1:] for x in meeting))], axis=1), axis=0
    )
    pairs = pairs[:, _deep(low, high, *pairs)]
    if not pairs.size:
        return Nesting(np.zeros(n, np.int64), np.zeros((0, 2), np.int64))
    first, second = pairs[:, np.lexsort(pairs[::-1])]
    used, number = np.unique([first, second], return_inverse=True)
    place = np.full(n + 1, -1, np.int64)  # the last entry is for faces of no surface
    place[used] = np.arange(len(used))
    chosen = np.flatnonzero(place[surface] >= 0)
    sides = Sides(xyz, faces[chosen], place[surface[chosen]], len(used))
    result = _Search(sides, number.reshape(2, -1), low[:, used], high[:, used]).nesting(sign[used])
    depth = np.zeros(n, np.int64)
    depth[used] = result.depth
    return Nesting(depth, used[result.crossing])


def _boxes(
    xyz: Floats, faces: NDArray[np.integer[Any]], surface: NDArray[np.integer[Any]], n: int
) -> tuple[Floats, Floats]:
    """(3, n) corners of the boxes of the surfaces."""
    low, high = np.full((3, n), np.inf), np.full((3, n), -np.inf)
    for block in slices(len(faces)):
        inside = np.flatnonzero(surface[block] >= 0)
        which, corners = surface[block][inside], faces[block][inside].T.astype(np.intp)
        for axis in range(3):
            a, b, c = (xyz[axis].take(corner) for corner in corners)
            np.minimum.at(low[axis], which, np.minimum(np.minimum(a, b), c))
            np.maximum.at(high[axis], which, np.maximum(np.maximum(a, b), c))
    return low, high


def _deep(low: Floats, high: Floats, first: Ints, second: Ints) -> Mask:
    """(n,) flags: the boxes overlap by more than a common wall, beyond rounding; others hold bodies side by side."""
    reach = ROUNDING * np.maximum(np.abs(low), np.abs(high))
    rounding = np.maximum(reach[:, first], reach[:, second])
    depth = np.minimum(high[:, first], high[:, second]) - np.maximum(low[:, first], low[:, second])
    thickness = np.minimum((high - low)[:, first], (high - low)[:, second])
    deep: Mask = np.all((depth > rounding) | (thickness <= rounding), axis=0)
    return deep


class _Search:
    """Pairs of surfaces whose boxes meet, and the known sides of each about the other.

    inside, outside: (2, pairs) flags: a point of the first is inside (outside) the second, and of the second inside
    (outside) the first.
    """

    def __init__(self, sides: Sides, pairs: Ints, low: Floats, high: Floats) -> None:
        self.sides, self.pairs = sides, pairs
        first, second = pairs
        contacts = find_contacts(sides, first, second)
        self.crossing = np.zeros(len(first), bool)
        self.crossing[contacts.crossing] = True
        self.inside, self.outside = np.zeros((2, len(first)), bool), np.zeros((2, len(first)), bool)
        self.inner = np.ones((2, len(first)), bool)
        rounding = ROUNDING * np.maximum(np.abs(low), np.abs(high))
        for way, (a, b) in enumerate(((first, second), (second, first))):
            slack = np.maximum(rounding[:, a], rounding[:, b])
            self.inner[way] = ((low[:, a] >= low[:, b] - slack) & (high[:, a] <= high[:, b] + slack)).all(axis=0)
        self.outside |= ~self.inner  # its box reaches beyond the other's
        if len(contacts.pair):
            touching = samples(sides, contacts, _CONTACTS)
            self._look(touching.points, touching.pair, np.where(touching.first, 0, 1))
        for tried in _TRIED:
            self._try(tried)
        self.crossing |= (self.inside & self.outside).any(axis=0)

    def _look(self, points: Floats, pair: Ints, way: Ints) -> None:
        """Record the sides of points of surfaces about the other surface of their pair."""
        for block in slices(len(pair)):
            side = self.sides.of(points[:, block], self.pairs[1 - way[block], pair[block]])
            for flags, wanted in ((self.inside, INSIDE), (self.outside, OUTSIDE)):
                of = side == wanted
                flags[way[block][of], pair[block][of]] = True

    def _try(self, most: int) -> None:
        """Test up to `most` points of each surface whose side is still unknown."""
        way, pair = np.nonzero(self.inner & ~(self.inside | self.outside) & ~self.crossing)
        if not len(pair):
            return
        surface = self.pairs[way, pair]
        first, members = self.sides.tree.members(surface)
        taken = np.minimum(members, most)
        row = np.repeat(np.arange(len(pair)), taken)
        step = np.arange(len(row)) - np.repeat(np.cumsum(taken) - taken, taken)
        corners = self.sides.corners(self.sides.tree.order[first[row] + step * members[row] // taken[row]])
        self._look(corners[0], pair[row], way[row])
        if most > 1:
            self._look(corners.mean(axis=0), pair[row], way[row])

    def nesting(self, sign: Ints) -> Nesting:
        """Compute depths and crossing pairs. sign: of the volumes."""
        (first, second), n = self.pairs, len(sign)
        unknown = (~(self.inside | self.outside)).all(axis=0) & ~self.crossing
        depth = np.zeros(n, np.int64)
        for way in (0, 1):
            within = self.inside[way] & ~self.crossing
            np.add.at(depth, self.pairs[way][within], 1)
        # A core that fills its cavity: of two coincident surfaces of opposite signs the cavity contains the core.
        twins = np.flatnonzero(unknown)
        filled = (depth[first[twins]] % 2 == 1) & (sign[first[twins]] * sign[second[twins]] < 0)
        core = np.where(sign[first] > 0, first, second)[twins[filled]]
        np.add.at(depth, core, 1)
        crossing = self.crossing.copy()
        crossing[twins[~filled]] = True
        pairs = self.pairs[:, crossing].T
        depth[pairs.ravel()] = 0
        return Nesting(depth, pairs[np.lexsort(pairs.T[::-1])])

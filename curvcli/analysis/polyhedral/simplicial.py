"""Combinatorics of a simplicial manifold: ridges, faces of codimension two, and the cycle of simplices about each.

Rows of corners are kept sorted, so that a face has the same row in every simplex. A ridge is the face opposite a corner
j; a hinge, the face of codimension two opposite two corners i, j. A turn (c, i, j) goes through simplex c about that
hinge, in at the ridge opposite i and out at the ridge opposite j; its number is (c (n + 1) + i)(n + 1) + j.
"""

from __future__ import annotations

from functools import cached_property
from itertools import combinations

import numpy as np

from ...errors import InputError
from ...support.arrays import Ints, Mask


class Complex:
    """The combinatorics of a simplicial n-manifold with or without boundary, n ≥ 2.

    simplices: (C, n + 1) vertices; corners: the same with every row sorted; order: (C, n + 1) position of each corner
    of the sorted row in the row given.
    Errors: InputError for a repeated corner or simplex, a ridge of more than two simplices, or a hinge whose simplices
    are not one cycle or path.
    """

    def __init__(self, simplices: Ints) -> None:
        self.simplices = simplices
        self.count, self.n = len(simplices), simplices.shape[1] - 1
        self.order = np.argsort(simplices, axis=1, kind="stable")
        self.corners = np.take_along_axis(simplices, self.order, axis=1)
        repeated = (self.corners[:, 1:] == self.corners[:, :-1]).any(axis=1)
        if repeated.any():
            c = int(np.argmax(repeated))
            raise InputError(f"has a repeated corner: {_row(simplices[c])}", place=f"simplex {c}")
        rows, which = number_rows(self.corners)
        if len(rows) < self.count:
            c = int(np.flatnonzero(np.bincount(which)[which] > 1)[1])
            raise InputError(f"is listed twice: {_row(simplices[c])}", place=f"simplex {c}")

    # ------------------------------------------------------------------ ridges

    @cached_property
    def _ridges(self) -> tuple[Ints, Ints, Ints]:
        """Corners of the ridges, the ridge of each flag c (n + 1) + j, and the two flags of each ridge, -1 for none."""
        n, flags = self.n, self.count * (self.n + 1)
        without = np.array([[k for k in range(n + 1) if k != j] for j in range(n + 1)])
        ridges, which = number_rows(self.corners[:, without].reshape(flags, n))
        valence = np.bincount(which)
        if valence.max() > 2:
            ridge = int(np.argmax(valence > 2))
            at = ", ".join(str(c) for c in (np.flatnonzero(which == ridge) // (n + 1))[:5])
            raise InputError(
                f"belongs to {valence[ridge]} simplices (first {at}), expected at most 2 in a manifold",
                place=f"ridge {_row(ridges[ridge])}",
            )
        sides = np.full((len(ridges), 2), -1)
        flag = np.argsort(which, kind="stable")
        second = np.zeros(flags, bool)
        second[1:] = which[flag[1:]] == which[flag[:-1]]
        sides[which[flag], second.astype(np.int64)] = flag
        return ridges, which.reshape(self.count, n + 1), sides

    @property
    def ridges(self) -> Ints:
        """(R, n) vertices of each ridge, sorted."""
        return self._ridges[0]

    @property
    def ridge_of(self) -> Ints:
        """(C, n + 1) the ridge opposite each sorted corner."""
        return self._ridges[1]

    @property
    def sides(self) -> Ints:
        """(R, 2) the flags c (n + 1) + j on the two sides of each ridge, -1 beyond the boundary."""
        return self._ridges[2]

    @cached_property
    def across(self) -> Ints:
        """(C (n + 1),) the flag on the other side of each flag's ridge, -1 on the boundary."""
        flag, opposite = self.sides.T
        across = np.full(self.count * (self.n + 1), -1)
        across[flag] = opposite
        inside = opposite >= 0
        across[opposite[inside]] = flag[inside]
        return across

    # ------------------------------------------------------------------ hinges

    @cached_property
    def _hinges(self) -> tuple[Ints, Ints]:
        """Corners of the hinges, and the hinge of each turn, -1 where i = j."""
        n, pairs = self.n, list(combinations(range(self.n + 1), 2))
        without = np.array([[k for k in range(n + 1) if k not in pair] for pair in pairs])
        hinges, which = number_rows(self.corners[:, without].reshape(-1, n - 1))
        of = np.full((self.count, n + 1, n + 1), -1)
        for place, (i, j) in enumerate(pairs):
            of[:, i, j] = of[:, j, i] = which.reshape(self.count, -1)[:, place]
        return hinges, of.ravel()

    @property
    def hinges(self) -> Ints:
        """(H, n - 1) vertices of each hinge, sorted."""
        return self._hinges[0]

    @property
    def hinge_of(self) -> Ints:
        """(C (n + 1)²,) the hinge of each turn, -1 where i = j."""
        return self._hinges[1]

    @cached_property
    def valence(self) -> Ints:
        """(H,) number of simplices at each hinge."""
        return np.bincount(self.hinge_of[self.hinge_of >= 0]) // 2

    @cached_property
    def boundary(self) -> Mask:
        """(H,) hinges in a ridge of the boundary."""
        mask = np.zeros(len(self.hinges), bool)
        open_in = np.repeat(self.across < 0, self.n + 1)
        mask[self.hinge_of[open_in & (self.hinge_of >= 0)]] = True
        return mask

    def follow(self, turns: Ints) -> Ints:
        """The turn about the same hinge in the next simplex, -1 at the boundary."""
        size = self.n + 1
        flag, j = turns // size, turns % size
        c, i = flag // size, flag % size
        ahead = self.across[c * size + j]
        # Both simplices hold the ridge's corners in the same order, each with its own gap.
        place = i - (i > j)
        out = place + (place >= ahead % size)
        return np.where(ahead < 0, -1, ahead * size + out)

    @cached_property
    def rounds(self) -> tuple[Ints, Ints]:
        """Turns about each hinge in order, and the start of each hinge's turns, (H + 1,).

        A round starts in the lowest simplex of an interior hinge, at an end of a boundary hinge's path, and goes
        counterclockwise about the hinge's sorted vertices in the orientation of that simplex as given.
        """
        start = np.concatenate([[0], np.cumsum(self.valence)])
        first = self._first_turns()
        turns = np.empty(start[-1], np.int64)
        active, at = np.arange(len(self.hinges)), first
        step = 0
        while len(active):
            turns[start[active] + step] = at
            step += 1
            ahead = self.follow(at)
            ends = self.valence[active] == step
            # The last turn closes the cycle, or leaves through the boundary; no turn before it does.
            closes = np.where(self.boundary[active], ahead < 0, ahead == first[active])
            if (closes != ends).any():
                self._refuse(active[closes != ends][0])
            active, at = active[~ends], ahead[~ends]
        return turns, start

    def _first_turns(self) -> Ints:
        turn = np.flatnonzero(self.hinge_of >= 0)
        hinge = self.hinge_of[turn]
        open_in = self.across[turn // (self.n + 1)] < 0
        ends = np.bincount(hinge[open_in], minlength=len(self.hinges))
        if (ends > 2).any():
            self._refuse(np.argmax(ends > 2))
        keep = open_in | ~self.boundary[hinge]
        turn, hinge = turn[keep], hinge[keep]
        size = len(self.hinge_of)
        first = np.full(len(self.hinges), 2 * size)
        np.minimum.at(first, hinge, turn + size * ~self._counterclockwise(turn))
        return first % size

    def _counterclockwise(self, turns: Ints) -> Mask:
        """True where (hinge, corner j, corner i) is an even permutation of the simplex as given."""
        size = self.n + 1
        flag, j = turns // size, turns % size
        c, i = flag // size, flag % size
        # Corners i and j of the sorted row move to its end, past those between.
        swaps = (self.n - i) + (self.n - j) - 1 + (i < j)
        return np.asarray((swaps + odd(self.order)[c]) % 2 == 0)

    def _refuse(self, hinge: np.integer) -> None:
        raise InputError(
            "its simplices are not one cycle or one path, expected a manifold",
            place=f"face {_row(self.hinges[hinge])}",
            hint="split the complex there",
        )


def number_rows(rows: Ints) -> tuple[Ints, Ints]:
    """The distinct rows in lexicographic order, and the number of each row's."""
    order = np.lexsort(rows.T[::-1])
    new = np.ones(len(rows), bool)
    new[1:] = (rows[order[1:]] != rows[order[:-1]]).any(axis=1)
    which = np.empty(len(rows), np.int64)
    which[order] = np.cumsum(new) - 1
    return rows[order[new]], which


def odd(permutations: Ints) -> Mask:
    """(C,) true where a row, a permutation of 0 … n, is odd."""
    inversions = np.zeros(len(permutations), np.int64)
    for i, j in combinations(range(permutations.shape[1]), 2):
        inversions += permutations[:, i] > permutations[:, j]
    return np.asarray(inversions % 2 == 1)


def _row(values: Ints) -> str:
    return "(" + ", ".join(str(int(value)) for value in values) + ")"

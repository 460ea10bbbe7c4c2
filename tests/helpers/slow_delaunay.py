"""Intrinsic Delaunay flips one by one in 50 digits, with dictionaries and no gluing but that of the sides of edges."""

from __future__ import annotations

from collections import defaultdict
from typing import Any, NamedTuple

import mpmath as mp  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import NDArray

from tests.helpers.meshes import Mesh


class Side(NamedTuple):
    """One side of a face: its edge, and whether it runs along the edge's own direction."""

    edge: int
    along: bool


class SlowDelaunay:
    """A Δ-complex of faces with three corners and three sides each; side k runs from corner k to corner k + 1.

    Side windings need not agree: a face met from the wrong side is turned over before a flip.
    """

    def __init__(self, given: Mesh) -> None:
        self.count = len(given.points)
        self.corners = [list(map(int, face)) for face in given.faces]
        points = [[mp.mpf(float(x)) for x in point] for point in given.points]
        shared = defaultdict(list)
        for f, face in enumerate(self.corners):
            for k in range(3):
                shared[tuple(sorted((face[k], face[(k + 1) % 3])))].append((f, k))
        self.sides = [[Side(-1, True)] * 3 for _ in self.corners]
        self.square: list[Any] = []
        for (a, b), sides in shared.items():
            square = sum((x - y) ** 2 for x, y in zip(points[a], points[b], strict=True))
            for group in [sides] if len(sides) == 2 else [[one] for one in sides]:
                for f, k in group:
                    self.sides[f][k] = Side(len(self.square), self.corners[f][k] == a)
                self.square.append(square)
        self.flips = 0
        self._run()

    def _at(self) -> dict[int, list[tuple[int, int]]]:
        """The sides of every edge."""
        found = defaultdict(list)
        for f, sides in enumerate(self.sides):
            for k, side in enumerate(sides):
                found[side.edge].append((f, k))
        return found

    def twice_area(self, f: int) -> Any:
        a, b, c = (mp.sqrt(self.square[side.edge]) for side in self.sides[f])
        return mp.sqrt(max((a + b + c) * (a + b - c) * (a - b + c) * (b + c - a), 0)) / 2

    def cosine(self, f: int, k: int) -> Any:
        """The dot product of the two edges at the corner opposite side k."""
        a, b, c = (self.square[self.sides[f][(k + j) % 3].edge] for j in range(3))
        return (b + c - a) / 2

    def _fails(self, sides: list[tuple[int, int]]) -> bool:
        if len(sides) != 2 or sides[0][0] == sides[1][0]:
            return False
        (f, k), (g, m) = sides
        one, other = self.twice_area(f), self.twice_area(g)
        return bool(self.cosine(f, k) * other + self.cosine(g, m) * one < -(mp.mpf(10) ** -12) * one * other)

    def _turn_over(self, f: int) -> None:
        p, q, r = self.corners[f]
        self.corners[f] = [p, r, q]
        self.sides[f] = [Side(side.edge, not side.along) for side in self.sides[f][::-1]]

    def _run(self) -> None:
        todo = set(range(len(self.square)))
        at = self._at()
        while todo:
            edge = todo.pop()
            if self._fails(at[edge]):
                self._flip(edge, at[edge])
                self.flips += 1
                at = self._at()
                todo |= {side.edge for f, _ in at[edge] for side in self.sides[f]}

    def _flip(self, edge: int, at: list[tuple[int, int]]) -> None:
        (f, k), (g, _) = at
        side = self.sides[f][k]
        if Side(edge, side.along) in self.sides[g]:
            self._turn_over(g)
        m = self.sides[g].index(Side(edge, not side.along))
        p, q, r = (self.corners[f][(k + j) % 3] for j in range(3))
        s = self.corners[g][(m + 2) % 3]
        _, qr, rp = (self.sides[f][(k + j) % 3] for j in range(3))
        _, ps, sq = (self.sides[g][(m + j) % 3] for j in range(3))
        base = mp.sqrt(self.square[edge])
        above = self._apex(base, self.square[rp.edge], self.square[qr.edge])
        below = self._apex(base, self.square[ps.edge], self.square[sq.edge])
        self.square[edge] = (above[0] - below[0]) ** 2 + (above[1] + below[1]) ** 2
        self.corners[f], self.sides[f] = [q, r, s], [qr, Side(edge, True), sq]
        self.corners[g], self.sides[g] = [p, s, r], [ps, Side(edge, False), rp]

    @staticmethod
    def _apex(base: Any, left: Any, right: Any) -> tuple[Any, Any]:
        """A triangle's third corner over a base on the x axis, from the squares of its other sides."""
        x = (left - right + base * base) / (2 * base)
        return x, mp.sqrt(max(left - x * x, 0))

    def areas(self) -> NDArray[np.float64]:
        """⅛ Σ cot |opposite edge|² over both ends of every side; NaN at corners of faces without area."""
        total = [mp.mpf(0)] * self.count
        for f, corners in enumerate(self.corners):
            squares = [self.square[side.edge] for side in self.sides[f]]
            twice = self.twice_area(f)
            flat = twice <= 4 * mp.mpf(2) ** -52 * max(squares)
            for k in range(3):
                part = mp.nan if flat else squares[k] * self.cosine(f, k) / twice / 8
                for corner in (corners[k], corners[(k + 1) % 3]):
                    total[corner] += part
        return np.array([float(x) for x in total])


def slow_areas(given: Mesh) -> NDArray[np.float64]:
    """Circumcentric areas of the intrinsic Delaunay triangulation; NaN at vertices without a face."""
    with mp.workdps(50):
        areas = SlowDelaunay(given).areas()
    areas[np.setdiff1d(np.arange(len(areas)), given.faces)] = np.nan
    return areas

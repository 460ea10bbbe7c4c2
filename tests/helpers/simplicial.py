"""Simplicial manifolds built in code: regular polytopes, cubes in cells, and a body with its simplices in disorder."""

from __future__ import annotations

from itertools import combinations, permutations, product

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Simplices = list[tuple[int, ...]]


def simplex_boundary(n: int) -> tuple[Floats, Simplices]:
    """The regular (n + 1)-simplex in E^(n + 2), its corners the unit vectors."""
    return np.eye(n + 2), list(combinations(range(n + 2), n + 1))


def cross_polytope(n: int) -> tuple[Floats, Simplices]:
    """One of each pair of opposite corners, for all n + 1 axes."""
    points = np.vstack([np.eye(n + 1), -np.eye(n + 1)])
    return points, [tuple(k + (n + 1) * s for k, s in enumerate(side)) for side in product((0, 1), repeat=n + 1)]


def cell_600() -> tuple[Floats, Simplices]:
    """120 unit quaternions; the tetrahedra are the fours of corners at the least distance 1/φ from one another."""
    golden = (1 + np.sqrt(5)) / 2
    corners = [*np.eye(4), *-np.eye(4), *(np.array(signs) / 2 for signs in product((-1, 1), repeat=4))]
    for order in permutations(range(4)):
        if sum(order[i] > order[j] for i, j in combinations(range(4), 2)) % 2 == 0:
            for signs in product((-1, 1), repeat=3):
                corners.append(np.array([*(np.array(signs) * [golden, 1, 1 / golden] / 2), 0.0])[list(order)])
    points = np.array(corners)
    distance = np.linalg.norm(points[:, None] - points[None], axis=2)
    near = np.abs(distance - 1 / golden) < 1e-9
    cells: Simplices = [
        (a, b, c, d)
        for a, b in combinations(range(120), 2)
        if near[a, b]
        for c, d in combinations([c for c in range(b + 1, 120) if near[a, c] and near[b, c]], 2)
        if near[c, d]
    ]
    return points, cells


def grid_cube(size: int) -> tuple[Floats, Simplices]:
    """A cube of size³ cells, each cut in six along its diagonal, the same way in all of them."""
    points = np.array(list(product(range(size + 1), repeat=3)), float)
    number = {tuple(map(int, point)): k for k, point in enumerate(points)}
    cells = []
    for start in product(range(size), repeat=3):
        for order in permutations(range(3)):
            steps = np.vstack([np.array(start), np.eye(3, dtype=int)[list(order)]])
            walk = np.cumsum(steps, axis=0)
            cells.append(tuple(number[tuple(map(int, corner))] for corner in walk))
    return points, cells


def tesseract_boundary() -> tuple[Floats, Simplices]:
    """Eight cubes, each cut in six along monotone paths so that neighbours agree; corners by their bits."""
    points = np.array([[(k >> axis) & 1 for axis in range(4)] for k in range(16)], float)
    cells = []
    for fixed, value in product(range(4), (0, 1)):
        for order in permutations([axis for axis in range(4) if axis != fixed]):
            start = value << fixed
            cells.append(tuple(start + sum(1 << axis for axis in order[:k]) for k in range(4)))
    return points, cells

"""Curves with known turning, writhe and torsion."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]


def regular(n: int, times: int = 1) -> Points:
    """The regular n-gon, or star polygon {n/times}, counterclockwise in the unit circle of the xy-plane."""
    angle = 2 * np.pi * times * np.arange(n) / n
    return np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)


def figure_eight(n: int) -> Points:
    """A plane curve with one crossing that turns as much to the left as to the right."""
    angle = 2 * np.pi * np.arange(n) / n + 0.1
    return np.stack([np.sin(angle), np.sin(2 * angle), 0 * angle], axis=1)


def helix(n: int, step: float = 0.3, rise: float = 0.1) -> Points:
    """n points on a right-handed helix: equal edges, equal turning, equal torsion."""
    angle = step * np.arange(n)
    return np.stack([np.cos(angle), np.sin(angle), rise * np.arange(n)], axis=1)


def trefoil(n: int) -> Points:
    """A polygon in the left-handed trefoil knot."""
    t = 2 * np.pi * np.arange(n) / n
    x = np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), np.sin(3 * t)
    return np.stack(x, axis=1)


def random_polygon(seed: int, n: int, d: int = 3) -> Points:
    """n normally distributed points of E^d."""
    return np.random.default_rng(seed).normal(size=(n, d))


def rotation(seed: int, d: int = 3) -> Points:
    """A rotation of E^d."""
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(d, d)))
    if np.linalg.det(q) < 0:
        q[0] *= -1
    return np.asarray(q)


def gauss_integral(points: Points, closed: bool, order: int = 40) -> float:
    """Writhe in turns by Gauss–Legendre quadrature over every pair of edges that do not meet."""
    node, weight = np.polynomial.legendre.leggauss(order)
    node, weight = (node + 1) / 2, weight / 2
    heads = np.roll(points, -1, axis=0) if closed else points[1:]
    tails = points if closed else points[:-1]
    total = 0.0
    for i in range(len(tails)):
        for j in range(i + 2, len(tails)):
            if closed and i == 0 and j == len(tails) - 1:
                continue
            u, v = heads[i] - tails[i], heads[j] - tails[j]
            apart = (tails[i] + node[:, None, None] * u) - (tails[j] + node[None, :, None] * v)
            density = (np.cross(u, v) * apart).sum(-1) / (apart**2).sum(-1) ** 1.5
            total += float(weight @ density @ weight)
    return 2 * total / (4 * np.pi)

"""Curvatures of formulas by numerical differentiation in 40 digits, independent of the closed forms under test."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath as mp  # type: ignore[import-untyped]

mp.mp.dps = 40

Vector = Any
Surface = Callable[[Any, Any], list[Any]]
Level = Callable[[Any, Any, Any], Any]


def of_map(surface: Surface, u: Any, v: Any) -> tuple[Vector, Any, Any]:
    """Unit normal, k1 + k2 (convex positive) and k1 k2 of a parametrisation at (u, v)."""

    def derivative(i: int, j: int) -> Vector:
        return mp.matrix([mp.diff(lambda s, t, k=k: surface(s, t)[k], (u, v), (i, j)) for k in range(3)])

    xu, xv = derivative(1, 0), derivative(0, 1)
    normal = cross(xu, xv)
    normal /= mp.norm(normal)
    e, f, g = dot(xu, xu), dot(xu, xv), dot(xv, xv)
    big_l, big_m, big_n = (-dot(derivative(*order), normal) for order in ((2, 0), (1, 1), (0, 2)))
    area = e * g - f * f
    return normal, (e * big_n - 2 * f * big_m + g * big_l) / area, (big_l * big_n - big_m**2) / area


def of_level_set(level: Level, x: Any, y: Any, z: Any) -> tuple[Vector, Any, Any]:
    """Unit normal along the gradient, k1 + k2 (convex positive) and k1 k2 of a level set (Goldman 2005)."""
    point = (x, y, z)

    def partial(*axes: int) -> Any:
        return mp.diff(level, point, tuple(axes.count(axis) for axis in range(3)))

    gradient = mp.matrix([partial(axis) for axis in range(3)])
    hessian = mp.matrix([[partial(i, j) for j in range(3)] for i in range(3)])
    length = mp.norm(gradient)
    trace = hessian[0, 0] + hessian[1, 1] + hessian[2, 2]
    mean = (length**2 * trace - dot(gradient, hessian * gradient)) / length**3
    cofactors = mp.matrix(3, 3)
    for i in range(3):
        for j in range(3):
            p, q, r, s = (i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3
            cofactors[i, j] = hessian[p, r] * hessian[q, s] - hessian[p, s] * hessian[q, r]
    return gradient / length, mean, dot(gradient, cofactors * gradient) / length**4


def dot(a: Vector, b: Vector) -> Any:
    return mp.fsum(a[k] * b[k] for k in range(3))


def cross(a: Vector, b: Vector) -> Vector:
    return mp.matrix([a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3] for k in range(3)])

"""The definitions of the star's curvatures, face by face in 60 digits, on the coordinates as they are in double."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mpmath as mp  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import NDArray

from tests.helpers.meshes import Mesh

Vector = list[Any]
DIGITS = 60


def minus(a: Vector, b: Vector) -> Vector:
    return [x - y for x, y in zip(a, b, strict=True)]


def plus(a: Vector, b: Vector) -> Vector:
    return [x + y for x, y in zip(a, b, strict=True)]


def times(a: Vector, factor: Any) -> Vector:
    return [x * factor for x in a]


def dot(a: Vector, b: Vector) -> Any:
    return sum((x * y for x, y in zip(a, b, strict=True)), mp.mpf(0))


def cross(a: Vector, b: Vector) -> Vector:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def norm(a: Vector) -> Any:
    return mp.sqrt(dot(a, a))


@dataclass
class Star:
    """The sums over the faces at one vertex of a mesh whose winding is consistent."""

    angle: Any
    area: Any
    vector_area: Vector
    gradient: Vector
    mean: Vector
    boundary: bool
    excess: int


def stars(given: Mesh) -> list[Star]:
    """Every vertex's star: Σθ, ⅓ Σ area, ⅓ Σ area ν, ∇ area and ½ Σ H_e."""
    with mp.workdps(DIGITS):
        return _stars(given)


def _stars(given: Mesh) -> list[Star]:
    p: list[Vector] = [[mp.mpf(float(x)) for x in point] for point in given.points]
    zero = mp.mpf(0)
    found = [Star(zero, zero, [zero] * 3, [zero] * 3, [zero] * 3, False, 0) for _ in p]
    conormals: dict[tuple[int, int], list[Vector]] = {}
    for face in given.faces.tolist():
        u, w = minus(p[face[1]], p[face[0]]), minus(p[face[2]], p[face[0]])
        normal = cross(u, w)
        twice = norm(normal)
        nu = times(normal, 1 / twice) if twice else None
        for k in range(3):
            a, b, c = (face[(k + j) % 3] for j in range(3))
            star = found[a]
            star.angle += mp.atan2(twice, dot(minus(p[b], p[a]), minus(p[c], p[a])))
            star.area += twice / 6
            star.vector_area = plus(star.vector_area, times(normal, mp.mpf(1) / 6))
            star.excess -= 1
            if nu is None:
                continue
            star.gradient = plus(star.gradient, times(cross(nu, minus(p[c], p[b])), mp.mpf(1) / 2))
            conormals.setdefault((min(a, b), max(a, b)), []).append(cross(minus(p[b], p[a]), nu))
    for (a, b), each in conormals.items():
        for end in (a, b):
            found[end].excess += 1
            found[end].boundary |= len(each) == 1
            for eta in each if len(each) > 1 else []:
                found[end].mean = plus(found[end].mean, times(eta, -mp.mpf(1) / 2))
    return found


COLUMNS: dict[str, Callable[[Star], Any]] = {
    "K": lambda s: None if s.boundary else 2 * mp.pi - s.angle - s.excess * mp.pi,
    "kappa_g": lambda s: 2 * mp.pi - s.angle - s.excess * mp.pi if s.boundary else None,
    "A": lambda s: s.area,
    "A_vec": lambda s: s.vector_area,
    "area_gradient": lambda s: s.gradient,
    "H_vec": lambda s: s.mean,
    "h": lambda s: None if s.boundary else norm(s.mean) / norm(s.vector_area),
    "K_density": lambda s: None if s.boundary else (2 * mp.pi - s.angle - s.excess * mp.pi) / s.area,
    "willmore_hks": lambda s: None if s.boundary else dot(s.mean, s.mean) / s.area,
}


def column(known: list[Star], name: str) -> NDArray[np.float64]:
    """One column rounded to double, NaN for null and where no double holds it."""
    with mp.workdps(DIGITS):
        values = [COLUMNS[name](star) for star in known]
        return np.array([rounded(value) for value in values])


def rounded(value: Any) -> Any:
    """A number or vector as doubles."""
    if isinstance(value, list):
        return [rounded(x) for x in value]
    if value is None or (value != 0 and not 2.0**-1022 <= abs(value) < mp.mpf(2) ** 1024):
        return np.nan
    return float(value)

"""Smooth surfaces with known curvatures, each under a regular and an irregular triangulation of any size."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from curvcli.samples import get
from curvcli.samples.curvature import principal
from curvcli.samples.model import ExactColumns

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Mesh:
    """points (V, 3), faces (F, 3) and the exact columns of the smooth surface at the vertices."""

    points: Floats
    faces: NDArray[np.int32]
    exact: ExactColumns


Make = Callable[[int], Mesh]


def of_sample(name: str, **values: float) -> Make:
    """A surface of `curvcli sample`."""

    def make(size: int) -> Mesh:
        made = get(name)(size=size, **values)
        return Mesh(made.points, made.faces, made.exact)

    return make


def revolved(
    radius: Callable[[Floats], Floats],
    height: Callable[[Floats], Floats],
    pace: Callable[[Floats], Floats],
    curvatures: Callable[[Floats], ExactColumns],
    end: float,
) -> Make:
    """A surface of revolution over 0 ≤ t ≤ end through random points, uniform by area; ds = pace dt."""
    fine = np.linspace(0, end, 20001)
    middle = (fine[1:] + fine[:-1]) / 2
    step = pace(middle) * np.diff(fine)
    swept = np.concatenate([[0], np.cumsum(step * radius(middle))])
    # ∫ ds/r is conformal together with the angle: Delaunay there is near Delaunay on the surface.
    conformal = np.concatenate([[0], np.cumsum(step / radius(middle))])

    def make(size: int) -> Mesh:
        random = np.random.default_rng(size)
        edge = math.sqrt(2 * math.pi * swept[-1] / size)
        rims = [max(8, round(2 * math.pi * float(radius(np.array([t]))[0]) / edge)) for t in (0.0, end)]
        inside = size - sum(rims)
        t = np.interp(random.uniform(0.2 * edge, swept[-1] - 0.2 * edge, inside), swept, fine)
        phi = random.uniform(0, 2 * np.pi, inside)
        t = np.concatenate([np.zeros(rims[0]), np.full(rims[1], end), t])
        phi = np.concatenate([*(2 * np.pi * np.arange(count) / count for count in rims), phi])
        faces = around(phi, np.interp(t, fine, conformal))
        points = np.stack([radius(t) * np.cos(phi), radius(t) * np.sin(phi), height(t)], axis=1)
        return Mesh(points, faces, curvatures(t))

    return make


def around(phi: Floats, w: Floats) -> NDArray[np.int32]:
    """Delaunay triangles on the cylinder: of three copies side by side, those whose middle lies in the middle one."""
    from scipy.spatial import Delaunay

    turn = 2 * np.pi
    copies = np.concatenate([np.stack([phi + k * turn, w], axis=1) for k in (-1, 0, 1)])
    found = Delaunay(copies).simplices
    middle = copies[found][:, :, 0].mean(axis=1)
    # A triangle and its copies differ by whole turns: exactly one of them has its middle there.
    kept = found[(middle >= 0) & (middle < turn)]
    a, b, c = (copies[kept[:, k]] for k in range(3))
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    kept, area = kept[area != 0], area[area != 0]
    kept[area < 0] = kept[area < 0][:, ::-1]
    return np.ascontiguousarray(kept % len(phi), np.int32)


def catenoid() -> Make:
    """cosh between −1 and 1."""

    def curvatures(t: Floats) -> ExactColumns:
        bent = 1 / np.cosh(t - 1) ** 2
        return principal(bent, -bent)

    return revolved(lambda t: np.cosh(t - 1), lambda t: t - 1, lambda t: np.cosh(t - 1), curvatures, 2.0)


def unduloid(neck: float = 0.4, bulge: float = 1.0) -> Make:
    """One period, bulge to bulge."""
    from scipy.special import ellipeinc, ellipkinc

    modulus, pace = 1 - (neck / bulge) ** 2, neck + bulge

    def radius(t: Floats) -> Floats:
        return np.asarray(bulge * np.sqrt(1 - modulus * np.sin(t) ** 2))

    def curvatures(t: Floats) -> ExactColumns:
        ratio = neck * bulge / radius(t) ** 2
        return principal((1 + ratio) / pace, (1 - ratio) / pace)

    def height(t: Floats) -> Floats:
        return np.asarray(neck * ellipkinc(t, modulus) + bulge * ellipeinc(t, modulus))

    return revolved(radius, height, lambda t: np.full_like(t, pace), curvatures, math.pi)


SURFACES: dict[str, dict[str, Make]] = {
    "sphere": {"regular": of_sample("icosphere"), "irregular": of_sample("irregular_sphere")},
    "torus": {"regular": of_sample("torus"), "irregular": of_sample("irregular_torus")},
    "ellipsoid": {"regular": of_sample("ellipsoid"), "irregular": of_sample("irregular_ellipsoid")},
    "catenoid": {"regular": of_sample("catenoid"), "irregular": catenoid()},
    "unduloid": {"regular": of_sample("unduloid", periods=1), "irregular": unduloid()},
}

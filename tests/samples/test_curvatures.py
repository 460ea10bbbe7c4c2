"""Exact columns against derivatives of each surface's own equation, written down here a second time."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath as mp  # type: ignore[import-untyped]
import numpy as np
import pytest

from curvcli.samples import get
from curvcli.samples.grids import disk, rings_for, split
from curvcli.samples.model import FloatArray, Sample
from tests.samples.differential import Level, Surface, dot, of_level_set, of_map

LEVELS: dict[str, tuple[dict[str, float], Level]] = {
    "icosphere": ({"radius": 1.5}, lambda x, y, z: x * x + y * y + z * z - 2.25),
    "irregular_sphere": ({"radius": 1.5}, lambda x, y, z: x * x + y * y + z * z - 2.25),
    "uv_sphere": ({"radius": 1.5}, lambda x, y, z: x * x + y * y + z * z - 2.25),
    "hemisphere": ({"radius": 1.5}, lambda x, y, z: x * x + y * y + z * z - 2.25),
    "cap": ({"radius": 1.5, "angle": 100.0}, lambda x, y, z: x * x + y * y + z * z - 2.25),
    "ellipsoid": ({"a": 2.0, "b": 1.0, "c": 0.5}, lambda x, y, z: x * x / 4 + y * y + 4 * z * z - 1),
    "irregular_ellipsoid": ({"a": 2.0, "b": 1.0, "c": 0.5}, lambda x, y, z: x * x / 4 + y * y + 4 * z * z - 1),
    "torus": ({"radius": 1.0, "tube": 0.25, "jitter": 0.4}, lambda x, y, z: ring(x, y, z, 1, mp.mpf(1) / 16)),
    "irregular_torus": ({"radius": 1.0, "tube": 0.25}, lambda x, y, z: ring(x, y, z, 1, mp.mpf(1) / 16)),
    "clifford_torus": ({"radius": 1.0}, lambda x, y, z: ring(x, y, z, 1, mp.mpf(1) / 2)),
    "cyclide": ({"distance": 2.0}, lambda x, y, z: ring(*inverse(x, y, z), 1, mp.mpf(1) / 2)),
    "cylinder": ({"radius": 0.5}, lambda x, y, z: x * x + y * y - 0.25),
    "schwarz_lantern": ({"radius": 0.5}, lambda x, y, z: x * x + y * y - 0.25),
    "cone": ({"radius": 0.5, "height": 2.0}, lambda x, y, z: mp.hypot(x, y) - (2 - z) / 4),
    "paraboloid": ({"focus": 2.0}, lambda x, y, z: z - (1 - x * x - y * y) / 4),
    "saddle": ({"focus": 2.0}, lambda x, y, z: z - (x * x - y * y) / 4),
    "monkey_saddle": ({"focus": 2.0}, lambda x, y, z: z - (x**3 - 3 * x * y * y) / 12),
    "scherk": ({}, lambda x, y, z: mp.exp(z) * mp.cos(x) - mp.cos(y)),
    "catenoid": ({"neck": 0.5}, lambda x, y, z: mp.hypot(x, y) - mp.cosh(2 * z) / 2),
    "helicoid": ({"pitch": 0.5}, lambda x, y, z: y * mp.cos(2 * z) - x * mp.sin(2 * z)),
    "pseudosphere": ({"radius": 2.0}, lambda x, y, z: z - 2 * tractrix(mp.hypot(x, y) / 2)),
    "plane": ({"jitter": 0.4}, lambda x, y, z: z),
    "disk": ({}, lambda x, y, z: z),
    "annulus": ({}, lambda x, y, z: z),
}


def ring(x: Any, y: Any, z: Any, radius: Any, square: Any) -> Any:
    return (mp.hypot(x, y) - radius) ** 2 + z * z - square


def inverse(x: Any, y: Any, z: Any) -> tuple[Any, Any, Any]:
    square = x * x + y * y + z * z
    return x / square + 2, y / square, z / square


def tractrix(r: Any) -> Any:
    return mp.asech(r) - mp.sqrt(1 - r * r)


def chosen(sample: Sample, count: int = 6) -> list[int]:
    """A few vertices, spread over those that have curvatures."""
    known = np.flatnonzero(~np.isnan(sample.exact["K_density"]))
    return [int(vertex) for vertex in known[np.linspace(0, len(known) - 1, count).astype(int)]]


def mesh_normal(sample: Sample, vertex: int) -> FloatArray:
    a, b, c = (sample.points[corner] for corner in sample.faces[(sample.faces == vertex).any(axis=1)].T)
    return np.asarray(np.cross(b - a, c - a).sum(axis=0))


def compare(sample: Sample, vertex: int, normal: Any, mean: Any, gaussian: Any) -> None:
    """Signs follow the winding of the mesh; on a one-sided surface there are none."""
    exact = {name: float(column[vertex]) for name, column in sample.exact.items()}
    size = 1e-11 * max(1.0, abs(float(mean)) ** 2, abs(float(gaussian)))
    assert exact["K_density"] == pytest.approx(float(gaussian), abs=size)
    assert exact["h"] == pytest.approx(abs(float(mean)), abs=size)
    if not sample.facts["orientable"]:
        assert set(sample.exact) == {"K_density", "h"}
        return
    across = mesh_normal(sample, vertex) @ np.array([float(component) for component in normal])
    signed = math.copysign(1.0, across) * float(mean)
    assert exact["h_signed"] == pytest.approx(signed, abs=size)
    root = math.sqrt(max(signed**2 / 4 - float(gaussian), 0.0))
    # Near umbilics the root itself is only known to the square root of the rounding.
    assert exact["kappa_1"] == pytest.approx(signed / 2 + root, abs=1e3 * size if root > 1e-3 else 1e-6)
    assert exact["kappa_2"] == pytest.approx(signed / 2 - root, abs=1e3 * size if root > 1e-3 else 1e-6)
    assert exact["kappa_1"] >= exact["kappa_2"]


@pytest.mark.parametrize("name", LEVELS)
def test_against_the_equation(name: str) -> None:
    values, level = LEVELS[name]
    sample = get(name)(size=400, **values)
    for vertex in chosen(sample):
        point = [mp.mpf(float(coordinate)) for coordinate in sample.points[vertex]]
        gradient, mean, gaussian = of_level_set(level, *point)
        assert abs(level(*point)) < 1e-14
        compare(sample, vertex, gradient, mean, gaussian)


@pytest.mark.parametrize("name", LEVELS)
def test_every_vertex_lies_on_the_surface(name: str) -> None:
    values, level = LEVELS[name]
    sample = get(name)(size=150, **values)
    assert max(abs(level(*map(float, point))) for point in sample.points) < 1e-13


def check_map(sample: Sample, surface: Surface, parameters: FloatArray, vertices: list[int]) -> None:
    size = np.abs(sample.points).max()
    for vertex in vertices:
        u, v = (mp.mpf(float(parameter)) for parameter in parameters[vertex])
        there = np.array([float(coordinate) for coordinate in surface(u, v)])
        np.testing.assert_allclose(there, sample.points[vertex], rtol=0, atol=4e-14 * size)
        compare(sample, vertex, *of_map(surface, u, v))


def on_disk(size: int, count: int) -> FloatArray:
    """The Cartesian parameters of the first vertices of a disk of rings."""
    rho, phi, _ = disk(rings_for(size))
    return np.stack([rho * np.cos(phi), rho * np.sin(phi)], axis=1)[:count]


def test_enneper_has_the_curvatures_of_its_map() -> None:
    sample = get("enneper")(size=400)

    def surface(u: Any, v: Any) -> list[Any]:
        return [u - u**3 / 3 + u * v * v, v - v**3 / 3 + v * u * u, u * u - v * v]

    check_map(sample, surface, on_disk(400, len(sample.points)), chosen(sample))


def test_boys_surface_has_the_curvatures_of_its_map() -> None:
    sample = get("projective_plane")(size=400)

    def surface(u: Any, v: Any) -> list[Any]:
        w = mp.mpc(u, v)
        below = w**6 + mp.sqrt(5) * w**3 - 1
        g = [
            -1.5 * mp.im(w * (1 - w**4) / below),
            -1.5 * mp.re(w * (1 + w**4) / below),
            mp.im((1 + w**6) / below) - 0.5,
        ]
        square = mp.fsum(part**2 for part in g)
        return [part / square for part in g]

    parameters = on_disk(400, len(sample.points))
    check_map(sample, surface, parameters, chosen(sample))
    # What makes the rim close up: opposite points of it are one.
    u, v = (mp.mpf(float(parameter)) for parameter in parameters[-1])
    r = mp.hypot(u, v)
    assert max(abs(a - b) for a, b in zip(surface(u / r, v / r), surface(-u / r, -v / r), strict=True)) < 1e-30


def half_turn(eight: Callable[[Any], tuple[Any, Any]], radius: float) -> Surface:
    def surface(u: Any, v: Any) -> list[Any]:
        x, y = eight(v)
        out = radius + mp.cos(u / 2) * x - mp.sin(u / 2) * y
        return [out * mp.cos(u), out * mp.sin(u), mp.sin(u / 2) * x + mp.cos(u / 2) * y]

    return surface


@pytest.mark.parametrize("name", ["mobius", "klein_bottle"])
def test_half_turned_strips_have_the_curvatures_of_their_maps(name: str) -> None:
    sample = get(name)(size=400, radius=2.0, width=0.7)
    u = np.arctan2(sample.points[:, 1], sample.points[:, 0]) % (2 * np.pi)
    # 2 pi less a rounding is where the strip starts, not where it ends.
    u[u > 2 * np.pi - 1e-9] = 0
    out, up = np.hypot(*sample.points[:, :2].T) - 2, sample.points[:, 2]
    x, y = np.cos(u / 2) * out + np.sin(u / 2) * up, np.cos(u / 2) * up - np.sin(u / 2) * out
    if name == "mobius":
        check_map(sample, half_turn(lambda v: (v, mp.mpf(0)), 2.0), np.stack([u, x], axis=1), chosen(sample))
        return
    # sin 2v = 2 sin v cos v; on the middle circle v = 0.
    v = np.arctan2(x, np.where(np.abs(x) > 1e-9, y / np.where(x == 0, 1, 2 * x) * 0.7, 1.0))
    width = mp.mpf(0.7)
    check_map(
        sample,
        half_turn(lambda v: (width * mp.sin(v), width * mp.sin(2 * v)), 2.0),
        np.stack([u, v], 1),
        chosen(sample),
    )


@pytest.mark.parametrize(("name", "neck"), [("unduloid", 0.3), ("nodoid", -0.3)])
def test_delaunay_surfaces_have_the_curvatures_of_their_profiles(name: str, neck: float) -> None:
    sample = get(name)(size=400, neck=0.3, bulge=1.2, periods=1)
    small, large = mp.mpf(neck), mp.mpf(1.2)
    modulus = 1 - (small / large) ** 2
    columns = int(np.flatnonzero(np.abs(sample.points[:, 2] - sample.points[0, 2]) > 1e-9)[0])
    rows = len(sample.points) // columns

    def surface(phi: Any, t: Any) -> list[Any]:
        r = large * mp.sqrt(1 - modulus * mp.sin(t) ** 2)
        z = small * mp.ellipf(t, modulus) + large * mp.ellipe(t, modulus)
        return [r * mp.cos(phi), r * mp.sin(phi), z]

    row, place = np.divmod(np.arange(len(sample.points)), columns)
    parameters = np.stack([2 * np.pi * place / columns, np.pi * row / (rows - 1)], axis=1)
    check_map(sample, surface, parameters, chosen(sample, 4))
    assert np.ptp(sample.exact["h_signed"]) == 0


def test_the_developable_strip_has_the_curvatures_of_its_map() -> None:
    sample = get("developable_strip")(size=400, length=3.0, bend=1.5)
    ends = sample.points[:, 1] == -0.5
    s = np.linspace(-1.5, 1.5, int(ends.sum()))[np.cumsum(ends) - 1]

    def surface(along: Any, across: Any) -> list[Any]:
        unit = mp.sqrt(mp.pi)
        return [unit * mp.fresnelc(along / unit), across, unit * mp.fresnels(along / unit)]

    check_map(sample, surface, np.stack([s, sample.points[:, 1]], axis=1), chosen(sample))


def test_the_trefoil_tube_has_the_curvatures_of_its_map() -> None:
    sample = get("trefoil_tube")(size=600, radius=1.0, tube=0.4)
    around = 2 * math.pi * 0.4
    rows, columns = split(600, sample.limit["area"] / around**2)

    def knot(t: Any) -> Any:
        return mp.matrix([mp.sin(t) + 2 * mp.sin(2 * t), mp.cos(t) - 2 * mp.cos(2 * t), -mp.sin(3 * t)])

    def tangent(t: Any) -> Any:
        return mp.matrix([mp.cos(t) + 4 * mp.cos(2 * t), 4 * mp.sin(2 * t) - mp.sin(t), -3 * mp.cos(3 * t)])

    t = 2 * np.pi * (np.arange(len(sample.points)) // columns) / rows
    for vertex in chosen(sample):
        at, point = mp.mpf(float(t[vertex])), mp.matrix([float(x) for x in sample.points[vertex]])
        assert mp.norm(point - knot(at)) == pytest.approx(0.4, abs=1e-13)

        # The distance from the knot, as a level set: no frame is needed.
        def distance(x: Any, y: Any, z: Any, at: Any = at) -> Any:
            where = mp.matrix([x, y, z])

            def along(s: Any) -> Any:
                return dot(where - knot(s), tangent(s))

            return mp.norm(where - knot(mp.findroot(along, at)))

        compare(sample, vertex, *of_level_set(distance, *point))


def test_the_tube_of_the_trefoil_does_not_meet_itself() -> None:
    sample = get("trefoil_tube")(tube=0.59)
    t = np.linspace(0, 2 * np.pi, 4001)
    knot = np.stack([np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), -np.sin(3 * t)], axis=1)
    nearest = [np.linalg.norm(knot - point, axis=1).min() for point in sample.points]
    np.testing.assert_allclose(nearest, 0.59, atol=1e-5)


def test_both_components_keep_their_curvatures() -> None:
    sample = get("two_components")()
    count = int((np.linalg.norm(sample.points, axis=1) < 0.5).sum())
    assert np.ptp(sample.exact["kappa_1"][:count]) == 0
    np.testing.assert_allclose(sample.exact["kappa_1"][:count] * np.linalg.norm(sample.points[0]), 1.0)
    np.testing.assert_allclose(sample.exact["kappa_1"][count:], 1 / 0.3)


def test_where_a_surface_is_not_smooth_it_has_no_curvature() -> None:
    cone, can = get("cone")(), get("closed_cylinder")(radius=0.5)
    assert np.flatnonzero(np.isnan(cone.exact["kappa_1"])).tolist() == [int(cone.points[:, 2].argmax())]
    rim = (np.abs(np.hypot(*can.points[:, :2].T) - 0.5) < 1e-12) & (np.abs(can.points[:, 2]) == 1)
    side = np.abs(can.points[:, 2]) < 1
    assert np.array_equal(np.isnan(can.exact["h"]), rim)
    assert (can.exact["kappa_1"][side] == 2).all()
    assert (can.exact["kappa_1"][~side & ~rim] == 0).all()

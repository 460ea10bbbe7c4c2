"""Rectified integrals, folding index and intrinsic curvature index: definitions by brute force, and closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

import curvcli
from curvcli.curvatures.catalogue import FOLDING
from tests.helpers import meshes
from tests.helpers.meshes import ZOO, of_sample

FOUR_PI = 4 * math.pi


@pytest.mark.parametrize("name", ZOO)
def test_each_index_is_its_definition_vertex_by_vertex(name: str) -> None:
    """Van Essen and Drury (1997), with κ₁ and κ₂ of the table where the surface has an orientation."""
    given = meshes.zoo(name)
    result = curvcli.analyze((given.points, given.faces), "core,folding")
    table = result.vertices
    sums = dict.fromkeys(FOLDING, 0.0)
    for p in range(len(given.points)):
        K, h, density, area = (float(table[column][p]) for column in ("K", "h", "K_density", "A"))
        if not math.isnan(K):
            sums["K_positive"] += K if K > 0 else 0.0
            sums["K_negative"] += K if K < 0 else 0.0
            sums["K_rectified"] += abs(K)
            sums["intrinsic_index"] += K / FOUR_PI if K > 0 else 0.0
        if not math.isnan(h):
            sums["H_rectified"] += h * area
        if not (math.isnan(h) or math.isnan(density)):
            root = math.sqrt(max(h * h / 4 - density, 0.0))
            larger, smaller = sorted([abs(h / 2 + root), abs(h / 2 - root)], reverse=True)
            sums["folding_index"] += larger * (larger - smaller) * area / FOUR_PI
            kappas = [abs(float(table[column][p])) for column in ("kappa_1", "kappa_2")]
            if not math.isnan(kappas[0]):
                assert sorted(kappas, reverse=True) == pytest.approx([larger, smaller], rel=1e-9, abs=1e-9)
    assert {key: result.totals[key] for key in FOLDING} == pytest.approx(sums, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("radius", [1e-3, 1.0, 40.0])
def test_a_sphere(radius: float) -> None:
    given = of_sample("icosphere", size=2562)
    totals = curvcli.analyze((given.points * radius, given.faces), "folding").totals
    assert totals["intrinsic_index"] == pytest.approx(1.0, abs=1e-12)
    assert totals["K_positive"] == pytest.approx(FOUR_PI, abs=1e-11)
    assert totals["K_negative"] == 0.0
    assert totals["H_rectified"] == pytest.approx(2 * FOUR_PI * radius, rel=1e-3)
    assert 0 <= totals["folding_index"] < 0.1  # type: ignore[operator]


def test_a_torus_by_quadrature() -> None:
    """A torus of radii 2 and 1/2: |κ| = 1/r round the tube is the larger everywhere."""
    large, small = 2.0, 0.5
    n, m = 160, 60
    u, v = np.meshgrid(2 * np.pi * np.arange(n) / n, 2 * np.pi * np.arange(m) / m, indexing="ij")
    ring = large + small * np.cos(v)
    points = np.stack([ring * np.cos(u), ring * np.sin(u), small * np.sin(v)], axis=-1).reshape(-1, 3)
    corner = np.arange(n * m).reshape(n, m)
    a, b = corner.ravel(), np.roll(corner, -1, 0).ravel()
    c, d = np.roll(corner, (-1, -1), (0, 1)).ravel(), np.roll(corner, -1, 1).ravel()
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    totals = curvcli.analyze((points, faces), "folding").totals

    def integral(density: object) -> float:
        def ring_of(v: float) -> float:
            along = math.cos(v) / (large + small * math.cos(v))
            return float(density(1 / small, along)) * 2 * math.pi * (large + small * math.cos(v)) * small  # type: ignore[operator]

        return float(quad(ring_of, 0, 2 * math.pi, points=[math.pi / 2, 3 * math.pi / 2])[0])

    exact = {
        "K_positive": FOUR_PI,
        "K_negative": -FOUR_PI,
        "K_rectified": 2 * FOUR_PI,
        "H_rectified": integral(lambda k, other: abs(k + other)),
        "folding_index": integral(lambda k, other: k * (k - abs(other))) / FOUR_PI,
        "intrinsic_index": 1.0,
    }
    assert {key: totals[key] for key in exact} == pytest.approx(exact, rel=0.01)


def test_conventions_and_regions() -> None:
    """κ₁ and κ₂ do not change with the convention for H; regions have totals and shares of the indices."""
    given = meshes.torus()
    labels = (given.points[given.faces].mean(axis=1)[:, 2] > 0).astype(np.int64)
    reports = [
        curvcli.analyze((given.points, given.faces), "folding", mean=mean, regions=labels).report()  # type: ignore[arg-type]
        for mean in ("sum", "average")
    ]
    assert reports[1]["totals"]["H_rectified"] == reports[0]["totals"]["H_rectified"] / 2
    assert reports[1]["totals"]["folding_index"] == reports[0]["totals"]["folding_index"]
    for key in FOLDING:
        shares = [region["shares"][key] for region in reports[0]["regions"]]
        assert sum(shares) == pytest.approx(reports[0]["totals"][key], rel=1e-12)


def test_fractions_of_the_surface_by_sign() -> None:
    """On a torus the half outside has K > 0; on a plate everything is 0 within rounding, tilted or not."""
    given = of_sample("torus", size=5000)
    report = curvcli.analyze((given.points, given.faces), "core").report()
    fractions = report["fractions"]
    for name in ("K", "H"):
        assert sum(fractions[f"{name}_{sign}"] for sign in ("positive", "negative", "zero")) == pytest.approx(1.0)
    area, K = (curvcli.analyze((given.points, given.faces)).vertices[name] for name in ("A", "K"))
    assert fractions["K_positive"] == pytest.approx(area[K > 1e-14].sum() / area.sum(), rel=1e-12)
    bumpy = meshes.grid(8)
    plate = bumpy.moved(bumpy.points * [1, 1, 0])
    tilted = plate.moved(plate.points @ meshes.rotation() + [1e3, 0, 0])
    single = tilted.moved(tilted.points.astype(np.float32).astype(np.float64))
    for flat in (plate, tilted, single):
        fractions = curvcli.analyze((flat.points, flat.faces), "core").report()["fractions"]
        assert fractions == {
            "K_positive": 0,
            "K_negative": 0,
            "K_zero": 1,
            "H_positive": 0,
            "H_negative": 0,
            "H_zero": 1,
        }


def test_fractions_need_a_vertex_with_a_value() -> None:
    given = meshes.soup()
    fractions = curvcli.analyze((given.points, given.faces), "core").report()["fractions"]
    assert set(fractions.values()) == {None}

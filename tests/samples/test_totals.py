"""Discrete facts against sums over the mesh, and smooth totals against the exact columns they are integrals of."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from curvcli.samples import get, names
from curvcli.samples.model import FloatArray, Sample

NAMES = names()


def chi(sample: Sample) -> int:
    return int(sample.facts["euler_characteristic"] or 0)


def corner_angles(sample: Sample) -> FloatArray:
    p = sample.points[sample.faces]
    after, before = np.roll(p, -1, axis=1) - p, np.roll(p, 1, axis=1) - p
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(after, before), axis=2), (after * before).sum(axis=2)))


def face_areas(sample: Sample) -> FloatArray:
    a, b, c = (sample.points[corner] for corner in sample.faces.T)
    return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2)


def mean_curvature_total(sample: Sample) -> float:
    """Sum of signed dihedral angle times length over inner edges, one by one."""
    beside: dict[tuple[int, int], int] = {}
    for number, (a, b, c) in enumerate(sample.faces.tolist()):
        beside |= {(a, b): number, (b, c): number, (c, a): number}
    a, b, c = (sample.points[corner] for corner in sample.faces.T)
    normals = np.cross(b - a, c - a)
    total = []
    for (a, b), left in beside.items():
        right = beside.get((b, a))
        if a < b and right is not None:
            edge = sample.points[b] - sample.points[a]
            length = np.linalg.norm(edge)
            sine = np.cross(normals[left], normals[right]) @ edge / length
            total.append(length * math.atan2(sine, normals[left] @ normals[right]))
    return math.fsum(total)


@pytest.mark.parametrize("name", [name for name in NAMES if "K" in get(name)().exact])
def test_the_exact_K_is_the_angle_defect(name: str) -> None:
    sample = get(name)()
    known = ~np.isnan(sample.exact["K"])
    defect = 2 * np.pi - np.bincount(sample.faces.ravel(), corner_angles(sample).ravel())
    np.testing.assert_allclose(defect[known], sample.exact["K"][known], rtol=0, atol=1e-12)
    if sample.facts["closed"]:
        assert math.fsum(sample.exact["K"]) == pytest.approx(sample.facts["K"], abs=1e-11)


@pytest.mark.parametrize("name", NAMES)
def test_facts_area_and_mean_curvature(name: str) -> None:
    sample = get(name)()
    if "area" in sample.facts:
        assert math.fsum(face_areas(sample)) == pytest.approx(sample.facts["area"], rel=1e-12)
    if "H_theta" in sample.facts:
        assert mean_curvature_total(sample) == pytest.approx(sample.facts["H_theta"], rel=1e-12)
    if sample.facts["closed"]:
        assert sample.facts["K"] == 2 * math.pi * chi(sample)


@pytest.mark.parametrize("name", NAMES)
def test_limit_of_gauss_bonnet(name: str) -> None:
    sample = get(name)()
    if "K" in sample.limit and ("kappa_g" in sample.limit or sample.facts["closed"]):
        turning = sample.limit.get("kappa_g", 0.0)
        assert sample.limit["K"] + turning == pytest.approx(2 * math.pi * chi(sample), abs=1e-12)


def integrals(sample: Sample, of: Callable[[FloatArray], FloatArray] = np.asarray) -> dict[str, float]:
    """The totals as integrals of the exact columns (or of what is made of them) over the mesh."""
    area = np.bincount(sample.faces.ravel(), np.repeat(face_areas(sample) / 3, 3))
    found = {"area": math.fsum(area), "volume": float(np.linalg.det(sample.points[sample.faces]).sum() / 6)}
    if "h" in sample.exact:
        found["K"] = float(np.nansum(of(sample.exact["K_density"]) * area))
        found["willmore"] = float(np.nansum(sample.exact["h"] ** 2 * area))
    if "h_signed" in sample.exact:
        found["H_theta"] = float(np.nansum(of(sample.exact["h_signed"]) * area))
    return found


# Curvature that sits on a curve or a point of the smooth surface, beside that of its smooth parts.
CONCENTRATED = {
    "closed_cylinder": {"K": 4 * math.pi, "H_theta": 2 * math.pi**2},
    "cone": {"K": 2 * math.pi * (1 - math.sqrt(0.5))},
}


@pytest.mark.parametrize("name", [name for name in NAMES if get(name)().limit and name != "schwarz_lantern"])
def test_limits_are_integrals_of_the_exact_columns(name: str) -> None:
    coarse, fine = get(name)(size=2_000), get(name)(size=32_000)
    for key, limit in fine.limit.items():
        if key == "kappa_g":
            continue
        smooth = limit - CONCENTRATED.get(name, {}).get(key, 0.0)
        scale = max(abs(limit), integrals(fine, np.abs).get(key, 0.0))
        far, near = (abs(integrals(sample)[key] - smooth) for sample in (coarse, fine))
        # Four times as fine: order 2 gives 1/16; next to an apex or a rim the order is 1.
        assert near < 1e-10 or (near < 0.05 * scale and near < 0.45 * far), (key, scale, far, near)


def test_the_area_of_the_lantern_stays_too_large() -> None:
    sample = get("schwarz_lantern")(size=100_000, folding=0.5)
    promised = 2 * math.pi * math.hypot(2.0, math.pi**2 * 0.5 / 2)
    assert sample.facts["area"] == pytest.approx(promised, rel=1e-2)
    assert promised > 1.5 * sample.limit["area"]


@pytest.mark.parametrize("name", NAMES)
def test_scaled_by_a_power_of_two_is_exact(name: str) -> None:
    sample, twice = get(name)(), get(name)().scaled(4.0)
    small, large = integrals(sample), integrals(twice)
    assert np.array_equal(twice.points, 4 * sample.points)
    for key, exponent in {"area": 2, "volume": 3, "K": 0, "willmore": 0, "H_theta": 1}.items():
        for totals in ("limit", "facts"):
            if key in getattr(sample, totals):
                assert getattr(twice, totals)[key] == getattr(sample, totals)[key] * 4.0**exponent
        if key in small:
            assert large[key] == pytest.approx(small[key] * 4.0**exponent, rel=1e-12, abs=1e-15)

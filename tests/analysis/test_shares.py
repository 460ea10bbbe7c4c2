"""Shares of regions: equal to a split face by face, and they add up to the totals on every kind of surface."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

import curvcli
from curvcli.api import Analysis
from curvcli.checks.catalogue import identities
from curvcli.curvatures.registry import passes
from curvcli.samples import names
from tests.helpers import meshes
from tests.helpers.meshes import ZOO, Mesh, of_sample

Labels = NDArray[np.int64]


def analysed(given: Mesh, labels: Labels, **options: str) -> Analysis:
    return curvcli.analyze((given.points, given.faces), "paper", regions=labels, checks="partition", **options)  # type: ignore[arg-type]


def random_labels(faces: int, seed: int = 0, regions: int = 3) -> Labels:
    """Labels of faces by chance, some without one."""
    labels = np.random.default_rng(seed).integers(-1, regions, faces)
    labels[:regions] = np.arange(regions)[:faces]
    return labels


def by_face(result: Analysis, on: str, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """(F,) the share of every face, face by face."""
    if on == "face":
        return np.nan_to_num(values)
    surface = result.surface
    area = result.faces["area"]
    share = np.zeros(surface.n_faces)
    star = np.zeros(surface.n_vertices)
    count = np.zeros(surface.n_vertices)
    number = {
        pair: edge for edge, pair in enumerate(zip(surface.edges.a.tolist(), surface.edges.b.tolist(), strict=True))
    }
    valence = np.zeros(len(number))
    for face, corners in enumerate(surface.faces.tolist()):
        for k in range(3):
            star[corners[k]] += area[face]
            count[corners[k]] += 1
            valence[number[tuple(sorted((corners[k], corners[k - 1])))]] += 1
    for face, corners in enumerate(surface.faces.tolist()):
        for k in range(3):
            p = corners[k]
            if on == "vertex":
                part = area[face] / star[p] if star[p] > 0 else 1 / count[p]
                share[face] += np.nan_to_num(values[p]) * part
            else:
                edge = number[tuple(sorted((p, corners[k - 1])))]
                share[face] += np.nan_to_num(values[edge]) / valence[edge]
    return share


@pytest.mark.parametrize("name", ZOO)
def test_a_share_is_the_sum_over_the_faces_of_a_region(name: str) -> None:
    given = meshes.zoo(name)
    labels = random_labels(len(given.faces), 1)
    result = analysed(given, labels)
    regions = {region["name"]: region["shares"] for region in result.report()["regions"]}
    totals = {
        quantity.total: quantity for quantity in passes.totals() if quantity.total in next(iter(regions.values()))
    }
    assert {"area", "K", "H_theta", "willmore", "H_vec", "dirichlet"} <= totals.keys()
    for key, quantity in totals.items():
        if result.totals[key or ""] is None:
            assert all(shares[key] is None for shares in regions.values())
            continue
        table = {"vertex": result.vertices, "edge": result.edges, "face": result.faces}[quantity.on]
        column = np.asarray(table["area" if key == "area" else quantity.stem], np.float64)
        scalars = column.T if quantity.vector else [column]
        split = np.stack([by_face(result, quantity.on, values) for values in scalars], axis=-1)
        for region, shares in regions.items():
            expected = split[labels == int(region)].sum(axis=0)
            np.testing.assert_allclose(
                np.atleast_1d(shares[key]), expected, rtol=1e-11, atol=1e-12, err_msg=f"{key} {region}"
            )


@pytest.mark.parametrize("name", names())
def test_shares_add_up_on_every_sample(name: str) -> None:
    """To the bound of the identity, with labels by chance."""
    given = of_sample(name)
    result = analysed(given, random_labels(len(given.faces), len(name), 5))
    (check,) = [check for check in result.checks if check.name == "partition"]
    assert check.status == "pass"
    assert check.tolerance is not None
    scale = max(float(np.abs(value).max()) for value in result.totals.values() if isinstance(value, float))
    assert check.tolerance < 1e-9 * max(scale, 1.0)


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e9])
def test_shares_scale_with_their_totals(scale: float) -> None:
    given = meshes.ellipsoid()
    labels = random_labels(len(given.faces))
    one, other = (analysed(given.moved(given.points * size), labels) for size in (1.0, scale))
    for key, power in (("willmore", 0), ("H_theta", 1), ("area", 2)):
        shares = [result.report()["regions"][1]["shares"][key] for result in (one, other)]
        assert shares[1] == pytest.approx(shares[0] * scale**power, rel=1e-12)
    assert {check.status for check in other.checks} == {"pass"}


def test_the_convention_for_H_scales_shares() -> None:
    given = meshes.ellipsoid()
    labels = random_labels(len(given.faces))
    whole, half = (analysed(given, labels, mean=mean).report()["regions"][0]["shares"] for mean in ("sum", "average"))
    assert half["willmore"] == whole["willmore"] / 4
    assert half["H_theta"] == whole["H_theta"] / 2
    assert half["K"] == whole["K"]


def test_a_wrong_share_fails_the_check() -> None:
    """Each total is tested: one value that is off is found, and named."""
    given = meshes.torus()
    result = analysed(given, random_labels(len(given.faces)))
    rule = identities()["partition"]
    for place, region in product(range(len(result.shares)), (0, 3)):
        shares = list(result.shares)
        values = shares[place].values.copy()
        values[region] += 1e-9
        shares[place] = replace(shares[place], values=values)
        (check,) = rule.run(result.surface, result.surface.whole, {"shares": shares})
        assert check.status == "fail"
        assert check.detail.startswith(shares[place].key)
    (check,) = rule.run(result.surface, result.surface.whole, {"shares": result.shares})
    assert check.status == "pass"


def test_no_region_no_shares_and_no_check() -> None:
    given = meshes.torus()
    result = curvcli.analyze((given.points, given.faces), "core")
    assert not result.shares
    assert "partition" not in {check.name for check in result.checks}
    assert "shares" not in result.report()["components"][0]

"""Every column, total and count of the twelve meshes whose exact values are known, at every scale."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import curvcli
from curvcli.api import Analysis
from curvcli.curvatures.quantity import Quantity
from curvcli.curvatures.registry import passes
from tests.helpers import exact_values as exact
from tests.helpers.columns import for_all

_ = curvcli.passes  # importing registers them

VERTEX = {q.stem: q for q in passes.quantities("vertex") if q.stem in exact.Vertices("cube").columns()}
EDGE = {q.stem: q for q in passes.quantities("edge") if q.stem in exact.edges("cube")}
SCALES = {"2^-30": 2.0**-30, "1e-9": 1e-9, "1": 1.0, "1e9": 1e9, "2^30": 2.0**30}

# Columns without an exact value in the files: a word, a ratio ill-conditioned at umbilics, directions of a tensor.
NO_EXACT_VALUE = {"status", "shape_index", "dir_1", "dir_2"}
# On the minimal surface |H| is rounding alone: its size is compared absolutely, and its quotients mean nothing.
MINIMAL = {"h", "h_signed", "h_hks", "h_perp", "willmore", "willmore_hks", "willmore_perp", "H_vec"}
MINIMAL |= {"H_rectified", "folding_index"}
NORMAL = {"h_normal", "willmore_normal"}
# Differences of angles, which vanish on spheres: their size is that of the angles.
ANGLES = {"willmore_conformal", "K_plus", "K_minus", "K_abs", "K_comb"}


@cache
def analysis(name: str, scale: float = 1.0) -> Analysis:
    surface = curvcli.load(exact.MESHES[name])
    if scale == 1.0:
        return curvcli.analyze(surface, "all")
    return curvcli.analyze((surface.points * scale, surface.faces), "all")


@cache
def rounding(name: str, scale: float) -> float:
    """Largest change by the rounding of scaled coordinates, relative to the size of a column."""
    if math.frexp(scale)[0] == 0.5:
        return 0.0
    surface = curvcli.load(exact.MESHES[name])
    a, b = surface.points[surface.edges.a], surface.points[surface.edges.b]
    shortest = np.sqrt(((a - b) ** 2).sum(axis=1)).min()
    return float(2.0**-48 * abs(surface.points).max() / shortest)


def agree(
    found: NDArray[Any], wanted: NDArray[Any], quantity: Quantity, scale: float, slack: float, absolute: bool = False
) -> None:
    """Nulls in the same places, K within 5e-14, everything else within 1e-11 of the column's largest value."""
    np.testing.assert_array_equal(np.isnan(found), np.isnan(wanted))
    known = ~np.isnan(wanted)
    if not known.any():
        return
    wanted = wanted * scale**quantity.length_exponent
    largest = abs(wanted[known]).max()
    if quantity.name in ("K", "kappa_g"):
        tolerance = 5e-14 + slack
    else:
        tolerance = (1e-11 + 16 * slack) * (scale**quantity.length_exponent if absolute else largest)
    assert abs(found - wanted)[known].max() <= tolerance


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("name", exact.NAMES)
def test_columns_of_vertices_are_exact(name: str, scale: str) -> None:
    known, factor = exact.Vertices(name).columns(), SCALES[scale]
    unreferenced = np.array([degree is None for degree in exact.expected(name)["vertices"]["degree"]])

    def hold(column: str) -> None:
        found, wanted = np.array(analysis(name, factor).vertices[column], np.float64), known[column].copy()
        if column == "degree":
            wanted[unreferenced] = 0
        assert np.isnan(wanted[unreferenced]).all() or column == "degree"
        if column in NORMAL and name == "catenoid_minimal":
            return
        if column in NORMAL and name == "monkey_saddle":
            found[0] = wanted[0] = np.nan
        absolute = column in ANGLES or (column in MINIMAL and name == "catenoid_minimal")
        agree(found, wanted, VERTEX[column], factor, rounding(name, factor), absolute)

    for_all(VERTEX, hold)


def test_every_curvature_of_the_paper_is_compared() -> None:
    missing = [q.stem for q in passes.quantities("vertex") if q.source.startswith("Sullivan") and q.stem not in VERTEX]
    assert set(missing) <= NO_EXACT_VALUE
    missing = [q.stem for q in passes.quantities("edge") if q.source.startswith("Sullivan") and q.stem not in EDGE]
    assert not missing


@pytest.mark.parametrize("name", exact.NAMES)
def test_columns_of_edges_are_exact(name: str) -> None:
    known = exact.edges(name)
    result = analysis(name)
    edges = result.surface.edges
    np.testing.assert_array_equal(np.stack([edges.a, edges.b]), np.stack([known["a"], known["b"]]))
    for_all(EDGE, lambda key: agree(np.array(result.edges[key], np.float64), known[key], EDGE[key], 1.0, 0.0))


@pytest.mark.parametrize("name", exact.NAMES)
def test_the_status_of_vertices_is_exact(name: str) -> None:
    vertices = exact.expected(name)["vertices"]
    wanted = [
        "unreferenced" if degree is None else "boundary" if boundary else "interior"
        for degree, boundary in zip(vertices["degree"], vertices["boundary"], strict=True)
    ]
    assert analysis(name).vertices["status"].tolist() == wanted


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("name", exact.NAMES)
def test_totals_are_exact(name: str, scale: str) -> None:
    factor = SCALES[scale]
    estimates = {q.total for q in passes.quantities() if passes.depends_on_scale(q.name)}
    found = {key: value for key, value in analysis(name, factor).totals.items() if key not in estimates}
    wanted = exact.totals(name)
    exponents = exact.length_exponents()
    slack = rounding(name, factor)
    area = wanted["area"]
    assert found.keys() == wanted.keys() == exponents.keys()
    for key, target in wanted.items():
        value = found[key]
        if target is None:
            assert not np.isfinite(np.array(value, np.float64)).any(), key
            continue
        # A sum may cancel: its size is that of the surface it is taken over.
        size = max(area ** (exponents[key] / 2), float(np.linalg.norm(target)), 1.0 if exponents[key] == 0 else 0.0)
        if key in NORMAL and name in ("catenoid_minimal", "monkey_saddle"):
            continue
        gap = np.linalg.norm(np.array(value) / factor ** exponents[key] - np.array(target))
        assert gap <= (1e-11 + 64 * slack) * size, (key, value, target)


@pytest.mark.parametrize("name", exact.NAMES)
def test_topology_is_exact(name: str) -> None:
    report = analysis(name).report()
    known = exact.expected(name)["topology"]
    found = report["topology"]
    pairs = {
        "vertices": "V",
        "edges": "E",
        "faces": "F",
        "euler_characteristic": "chi",
        "components": "n_components",
        "boundary_edges": "n_boundary_edges",
        "boundary_loops": "n_boundary_loops",
        "closed": "closed",
        "manifold": "manifold",
        "orientable": "orientable",
        "consistent_winding": "consistent_as_given",
    }
    assert {key: found[key] for key in pairs} == {key: known[other] for key, other in pairs.items()}
    lists = ("nonmanifold_edges", "nonmanifold_vertices", "degenerate_faces", "duplicate_faces")
    assert [found[key] for key in lists] == [len(known[key]) for key in lists]
    assert found["unreferenced_vertices"] == len(known["unreferenced_vertices"])
    pieces = known["components"]
    for kind in ("genus", "crosscaps"):
        each = [piece[kind] for piece in pieces]
        assert found[kind] == (None if None in each else sum(each))
    for piece, one in zip(pieces, report["components"], strict=True):
        there = one["topology"]
        keys = {"vertices": "V", "edges": "E", "faces": "F", "euler_characteristic": "chi"}
        keys |= {key: key for key in ("boundary_loops", "orientable", "closed", "genus", "crosscaps")}
        assert {key: there[key] for key in keys} == {key: piece[other] for key, other in keys.items()}


@pytest.mark.parametrize("name", exact.NAMES)
def test_totals_of_components(name: str) -> None:
    """Each component's totals are the sums of the exact columns over its vertices."""
    result = analysis(name)
    groups = result.surface.components
    piece = np.full(result.surface.n_vertices, -1)
    piece[result.surface.faces] = groups.face[:, None]
    columns = exact.Vertices(name).columns()
    reports = result.report()["components"]
    assert len(reports) == groups.count
    for quantity in passes.quantities("vertex"):
        values = columns.get(quantity.name)
        if quantity.total is None or values is None:
            continue
        if quantity.name in NORMAL and name in ("catenoid_minimal", "monkey_saddle"):
            continue
        for number, report in enumerate(reports):
            found, own = report["totals"][quantity.total], values[piece == number].reshape(np.sum(piece == number), -1)
            if quantity.parity == "odd" and not report["topology"]["orientable"]:
                assert found is None or None in found
                continue
            wanted = [math.fsum(x[~np.isnan(x)]) for x in own.T]
            size = math.fsum(abs(own[~np.isnan(own)])) + 1.0
            assert np.abs(np.atleast_1d(found) - wanted).max() <= 1e-11 * size, (quantity.name, number)


@pytest.mark.parametrize("name", exact.NAMES)
def test_constant_mean_curvature_and_minimality(name: str) -> None:
    report, known = analysis(name).report(), exact.expected(name)["global"]
    if not exact.expected(name)["topology"]["orientable"]:
        assert report["cmc"] == {"H": None, "residual_max": None, "residual_density_max": None}
    else:
        size = max(abs(known["cmc_H"]), known["max_abs_H"])
        assert report["cmc"]["H"] == pytest.approx(-known["cmc_H"], abs=1e-11 * max(size, 1.0))
        assert report["cmc"]["residual_max"] == pytest.approx(known["cmc_residual_max"], abs=1e-11 * max(size, 1.0))
    assert report["minimal"]["H_vec_max"] == pytest.approx(known["max_abs_H"], rel=1e-11, abs=1e-11)


@pytest.mark.parametrize("name", exact.NAMES)
def test_coefficients_of_steiner_are_exact(name: str) -> None:
    found, known = analysis(name).report()["steiner"], exact.expected(name)["global"]
    assert found["convex"] == known["convex"]
    if known["volume"] is None:
        assert found["coefficients"] is None
        return
    totals = exact.totals(name)
    sums = [totals["volume"], totals["area"], totals["H_theta"] / 2, totals["K"] / 3]
    np.testing.assert_allclose(found["coefficients"], sums, rtol=1e-11, atol=1e-11)
    np.testing.assert_allclose(sums, known.get("steiner", sums), rtol=1e-14)

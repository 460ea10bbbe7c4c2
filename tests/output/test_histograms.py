"""Histograms: every vertex and all of the area are in one row, and numpy agrees."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import curvcli
from curvcli.api import Analysis
from curvcli.curvatures.catalogue import load_passes
from curvcli.curvatures.registry import passes
from curvcli.errors import UsageError
from curvcli.output.appearance import Appearance
from curvcli.output.distributions import ColumnSample, axis, distribution
from tests.helpers.meshes import of_sample

FINITE = st.floats(allow_nan=False, allow_infinity=False, width=64)


@pytest.fixture(scope="module")
def analysis() -> Analysis:
    mesh = of_sample("irregular_torus", size=800)
    return curvcli.analyze((mesh.points, mesh.faces), "core")


@pytest.fixture(scope="module")
def disk() -> Analysis:
    mesh = of_sample("disk", size=200)
    return curvcli.analyze((mesh.points, mesh.faces), "core")


def one(values: Any, areas: Any, name: str = "K") -> ColumnSample:
    load_passes()
    values = np.array(values, float)
    return ColumnSample("m", name, passes.quantity(name), values, np.array(areas, float), np.zeros(len(values), bool))


def test_counts_and_areas_of_known_values() -> None:
    values, areas = [-5.0, 0, 0.5, 1, 1, 9, np.nan], [1.0, 1, 2, 3, 1, 2, 50]
    column = axis([one(values, areas)], Appearance(value_range="0:1", bins=2))
    np.testing.assert_array_equal(column.edges, [0, 0.5, 1])
    found = distribution([column], 0)
    assert found.vertices.tolist() == [1, 1, 3, 1]
    assert found.area.tolist() == [1, 1, 6, 2]
    assert found.undefined == (1, 50)
    assert (column.least, column.most) == (-5, 9)


@given(st.lists(FINITE, min_size=1, max_size=30), FINITE, FINITE)
def test_every_defined_value_is_in_one_bin(values: list[float], first: float, second: float) -> None:
    low, high = min(first, second), max(first, second)
    if not low < high:
        return
    column = axis([one(values, np.ones(len(values)))], Appearance(value_range=f"{low!r}:{high!r}"))
    found = distribution([column], 0)
    assert found.vertices.sum() == len(values)
    assert found.vertices[0] == np.sum(np.array(values) < low)
    assert found.vertices[-1] == np.sum(np.array(values) > high)


@pytest.mark.parametrize("name", ["h", "K_density", "kappa_1", "A"])
def test_numpy_agrees(analysis: Analysis, name: str) -> None:
    table = analysis.histogram(name, bins=17)
    inside = table["part"] == "bin"
    assert inside.sum() == 17
    edges = np.append(table["low"][inside], table["high"][inside][-1])
    values, areas = analysis.vertices[name], analysis.vertices["A"]
    np.testing.assert_array_equal(table["vertices"][inside], np.histogram(values, edges)[0])
    np.testing.assert_allclose(table["area"][inside], np.histogram(values, edges, weights=areas)[0], rtol=1e-12)
    assert table["vertices"].sum() == len(values)
    assert table["area"].sum() == pytest.approx(analysis.totals["area"], rel=1e-12)
    ends = {part: table["vertices"][table["part"] == part].sum() for part in ("below", "above")}
    assert ends == {"below": (values < edges[0]).sum(), "above": (values > edges[-1]).sum()}


def test_numpy_agrees_on_two_columns(analysis: Analysis) -> None:
    table = analysis.histogram("kappa_1", "kappa_2", bins=9)
    inside = table["part"] == "bin"
    assert inside.sum() == 81
    shape = (9, 9)
    edges = []
    for low, high in (("low", "high"), ("against_low", "against_high")):
        values = [*np.unique(table[low][inside]), table[high][inside].max()]
        edges.append(np.array(values))
    values = [analysis.vertices[name] for name in ("kappa_1", "kappa_2")]
    for weights, name in ((None, "vertices"), (analysis.vertices["A"], "area")):
        expected = np.histogram2d(*values, bins=edges, weights=weights)[0]
        np.testing.assert_allclose(table[name][inside].reshape(shape), expected, rtol=1e-12, atol=1e-15)
    assert table["vertices"].sum() == len(values[0])
    assert table["area"].sum() == pytest.approx(analysis.totals["area"], rel=1e-12)


def test_undefined_values_have_a_row_with_their_area(disk: Analysis) -> None:
    table = disk.histogram("h")
    (lost,) = np.flatnonzero(table["part"] == "undefined")
    nulls = np.isnan(disk.vertices["h"])
    assert table["vertices"][lost] == nulls.sum() == disk.report()["columns"]["h"]["nulls"]
    assert table["area"][lost] == pytest.approx(disk.vertices["A"][nulls].sum(), rel=1e-12)
    assert np.isnan([table["low"][lost], table["area_share"][lost]]).all()
    assert np.nansum(table["area_share"]) == pytest.approx(1)


def test_a_column_without_values_has_one_row(analysis: Analysis) -> None:
    table = analysis.histogram("kappa_g")
    assert table["part"].tolist() == ["undefined"]
    assert table["vertices"].tolist() == [800]


def test_a_single_value_has_one_bin() -> None:
    column = axis([one([2, 2, 2], [1, 1, 3], "A")], Appearance())
    assert column.edges.tolist() == [2, 2]
    found = distribution([column], 0)
    assert found.vertices.tolist() == [0, 3, 0]
    assert found.area.tolist() == [0, 5, 0]


def test_counts_and_labels_have_a_row_each(disk: Analysis) -> None:
    table = disk.histogram("degree", value_range="1:9")
    middles = ((table["low"] + table["high"]) / 2)[table["part"] == "bin"]
    assert middles.tolist() == [1, 2, 3, 4, 5, 6, 7, 8, 9]
    table = disk.histogram("status")
    rows = dict(zip(table["part"], table["vertices"], strict=True))
    assert rows["boundary"] == disk.surface.boundary.sum()
    assert rows["interior"] == disk.surface.interior.sum()


def test_units_scale_the_area(disk: Analysis) -> None:
    larger = curvcli.analyze((disk.surface.points * 1000, disk.surface.faces), "core").histogram("h")
    ratio = larger["area"].sum() / disk.histogram("h")["area"].sum()
    assert ratio == pytest.approx(1e6)


@pytest.mark.parametrize(
    ("columns", "complaint"),
    [
        (("kappa",), "--histogram kappa: no such column"),
        (("K", "h", "A"), "3 columns, expected one, or two"),
        (("theta",), "a column of edges"),
        (("K", "status"), "status has labels"),
        (("A_vec",), "no such column of vertices; nearest: A_vec_"),
        (("K_fit",), "is not computed"),
    ],
)
def test_unsuitable_columns_are_refused(analysis: Analysis, columns: tuple[str, ...], complaint: str) -> None:
    with pytest.raises(UsageError, match=complaint):
        analysis.histogram(*columns)

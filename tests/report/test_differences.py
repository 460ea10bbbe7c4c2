"""Differences that count as moved: equal runs never, rounding never, everything else always and by name."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest

import curvcli
from curvcli.report.compare.cells import compare_cells
from curvcli.report.compare.values import Tolerance, compare_reports, leaves, selector
from curvcli.samples import get


def surface(name: str, **parameters: Any) -> curvcli.Surface:
    made = get(name)(**parameters)
    return curvcli.Surface(made.points, made.faces)


def report(of: Any, passes: str = "all", **options: Any) -> dict[str, Any]:
    return curvcli.analyze(of, passes, **options).report()


def keys(a: dict[str, Any], b: dict[str, Any], **options: Any) -> list[str]:
    return [one.key for one in compare_reports(a, b, **options)[0]]


@pytest.fixture(scope="module")
def torus() -> dict[str, Any]:
    return report(surface("irregular_torus", size=200))


def test_a_report_equals_itself_to_the_last_bit(torus: dict[str, Any]) -> None:
    found, compared = compare_reports(torus, copy.deepcopy(torus), Tolerance(0, 0))
    assert found == []
    assert compared == len(dict(leaves(torus))) > 300


SAMPLES = ("irregular_torus", "icosphere", "plane", "catenoid", "developable_strip", "schwarz_lantern", "cube")
INVARIANT = ("topology", "totals.[!HA]*", "totals.H_[ts]*", "steiner", "cmc", "minimal", "checks", "columns.[Khkwcs]*")
# Quotients of rounding by rounding where the surface is flat.
FLAT = ("columns.shape_index", "columns.h_normal", "totals.willmore_normal", "columns.willmore_normal")
# What noise makes of a curvature; by default the noise is that of the digits of the coordinates, which turning changes.
NOISE = "columns.*_sigma"


@pytest.mark.parametrize("name", SAMPLES)
def test_rounding_alone_moves_no_invariant(name: str) -> None:
    """The same surface turned by one radian: other rounding everywhere, and where terms cancel, other digits."""
    made = get(name)(**({} if name == "cube" else {"size": 150}))
    c, s = np.cos(1.0), np.sin(1.0)
    about_x, about_z = np.array([[1, 0, 0], [0, c, s], [0, -s, c]]), np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    turned = np.array(made.points) @ about_x @ about_z
    a, b = report((made.points, made.faces)), report((turned, made.faces))
    found, compared = compare_reports(a, b, wanted=selector(INVARIANT, ["columns.*_[xyz]", NOISE, *FLAT]))
    assert found == []
    assert compared > 60


def test_what_cancels_is_measured_by_its_terms(torus: dict[str, Any]) -> None:
    other = copy.deepcopy(torus)
    area = torus["totals"]["area"]
    assert max(map(abs, torus["totals"]["A_vec"])) < 1e-12 * area  # closed: zero up to rounding
    other["totals"]["A_vec"] = [1e-15 * area, -2e-15 * area, 0.0]
    other["totals"]["K"] += 1e-12
    assert keys(torus, other) == []
    assert keys(torus, other, tolerance=Tolerance(0, 0)) == ["totals.K", "totals.A_vec"]
    other["totals"]["A_vec"] = [1e-8 * area, 0.0, 0.0]
    other["totals"]["K"] += 1e-6
    assert keys(torus, other) == ["totals.K", "totals.A_vec"]


def test_every_value_that_moves_is_named(torus: dict[str, Any]) -> None:
    """No leaf is forgotten: each changed alone is found under its own key."""
    for key in (
        *("totals.willmore", "totals.volume", "totals.H_vec", "cmc.H", "minimal.H_vec_max", "steiner.convex"),
        *("topology.genus", "columns.K.min", "columns.H_vec_x.mean", "columns.h.nulls", "conventions.mean"),
    ):
        other = copy.deepcopy(torus)
        section, *path = key.split(".")
        place = other[section]
        for part in path[:-1]:
            place = place[part]
        value = place[path[-1]]
        match value:
            case bool():
                place[path[-1]] = not value
            case int():
                place[path[-1]] = value + 1
            case float():
                place[path[-1]] = value * (1 + 1e-6) + 1e-6
            case list():
                place[path[-1]] = [x + 1e-3 for x in value]
            case _:
                place[path[-1]] = "average"
        assert keys(torus, other) == [key]


def test_undefined_against_a_number_has_changed(torus: dict[str, Any]) -> None:
    other = copy.deepcopy(torus)
    other["totals"]["volume"] = None
    (found,) = compare_reports(torus, other, Tolerance(1e9, 1e9))[0]
    assert (found.key, found.status, found.b, found.moved) == ("totals.volume", "changed", None, None)


def test_a_check_that_fails_now_and_one_that_is_gone(torus: dict[str, Any]) -> None:
    other = copy.deepcopy(torus)
    other["checks"][0]["status"] = "fail"
    gone = other["checks"].pop()["name"]
    found = compare_reports(torus, other)[0]
    first = torus["checks"][0]
    assert [(one.key, one.status) for one in found] == [
        (f"checks.{first['name']}.whole", "changed"),
        (f"checks.{gone}", "absent_in_b"),
    ]
    assert keys(torus, other, common=True) == [f"checks.{first['name']}.whole"]


def test_what_was_not_computed_is_absent_in_one_line_each() -> None:
    s = surface("disk", size=100)
    less, more = report(s, "core"), report(s, "core,h_hks,K_plus")
    found = compare_reports(less, more)[0]
    assert {one.status for one in found} == {"absent_in_a"}
    assert {"columns.h_hks", "columns.K_plus"} <= {one.key for one in found}
    assert keys(less, more, common=True) == []


def test_more_components_are_told_by_their_count() -> None:
    one, two = report(surface("icosphere", size=42), "core"), surface("icosphere", size=42)
    points, faces = np.vstack([two.points, two.points + 3]), np.vstack([two.faces, two.faces + two.n_vertices])
    both = report((points, faces), "core")
    found = keys(one, both)
    assert {"topology.components", "components.count", "totals.K"} <= set(found)
    assert not any(key.startswith("components.0") for key in found)
    moved = report((points * np.where(np.arange(len(points)) < two.n_vertices, 1, 2)[:, None], faces), "core")
    pieces = [key for key in keys(both, moved) if key.startswith("components.")]
    assert pieces
    assert all(key.startswith("components.1.") for key in pieces)


def test_regions_go_by_their_names() -> None:
    s = surface("icosphere", size=42)
    labels = np.arange(s.n_faces) % 2
    a, b = report(s, "core", regions=labels), report(s, "core", regions=labels)
    assert keys(a, b) == []
    b["regions"][1]["totals"]["area"] *= 1.01
    assert keys(a, b) == [f"regions.{b['regions'][1]['name']}.totals.area"]
    b["regions"][1]["name"] = "elsewhere"
    assert keys(a, b) == ["regions.1", "regions.elsewhere"]


def test_only_and_ignore(torus: dict[str, Any]) -> None:
    other = copy.deepcopy(torus)
    for name in ("area", "willmore", "volume"):
        other["totals"][name] *= 2
    assert keys(torus, other, wanted=selector(["totals"])) == ["totals.area", "totals.volume", "totals.willmore"]
    assert keys(torus, other, wanted=selector(["totals.w*"])) == ["totals.willmore"]
    assert keys(torus, other, wanted=selector([], ["totals"])) == []
    assert keys(torus, other, wanted=selector(["totals"], ["totals.*l*"])) == ["totals.area"]


# ---------------------------------------------------------------------- cells


def cells(**columns: Any) -> dict[str, Any]:
    return {name: np.array(column) for name, column in columns.items()}


def test_the_cell_that_moved_most() -> None:
    a = cells(K=[1.0, 2.0, 3.0, np.nan])
    b = cells(K=[1.0, 2.0 + 1e-3, 3.0 - 2e-3, np.nan])
    (found,), lacking, compared = compare_cells(a, b)
    assert (found.name, found.rows, found.differing, found.vertex, found.a, found.b) == ("K", 4, 2, 2, 3.0, 2.998)
    assert found.moved == pytest.approx(2e-3)
    assert (lacking, compared) == ([], 1)
    assert compare_cells(a, b, Tolerance(1e-3))[0] == []
    assert compare_cells(a, b, Tolerance(0, 2.1e-3))[0] == []


def test_one_spike_does_not_widen_what_the_others_may_move() -> None:
    a = cells(h=[1.0, 1.0, 1.0, 1e15])
    b = cells(h=[1.0, 1.0, 1.001, 1e15])
    (found,), _, _ = compare_cells(a, b)
    assert (found.differing, found.vertex) == (1, 2)


def test_null_against_a_number_comes_first() -> None:
    (found,), _, _ = compare_cells(cells(K=[1.0, 5.0, 2.0]), cells(K=[1.0, 6.0, np.nan]))
    assert (found.differing, found.vertex, found.a, found.b, found.moved) == (2, 2, 2.0, None, None)


def test_words_and_absent_columns() -> None:
    a, b = cells(status=["interior", "boundary"], K=[0.0, 1.0]), cells(status=["interior", "interior"])
    (found,), (lacking,), compared = compare_cells(a, b)
    assert (found.name, found.vertex, found.a, found.b) == ("status", 1, "boundary", "interior")
    assert (lacking.key, lacking.status, compared) == ("vertices.K", "absent_in_b", 1)
    assert compare_cells(a, b, wanted=selector(["vertices.K"]), common=True) == ([], [], 0)


def test_axes_of_a_vector_share_their_scale() -> None:
    """A flat mesh in the xy plane: what z holds is rounding of x and y."""
    a = cells(H_vec_x=[1.0, 2.0], H_vec_y=[1.0, 1.0], H_vec_z=[1e-17, 0.0])
    b = cells(H_vec_x=[1.0, 2.0], H_vec_y=[1.0, 1.0], H_vec_z=[0.0, -3e-16])
    assert compare_cells(a, b)[0] == []
    assert [one.name for one in compare_cells(a, b, Tolerance(0))[0]] == ["H_vec_z"]


def test_directions_are_lines_but_vectors_are_not() -> None:
    one = {f"dir_1_{axis}": np.array([0.6, 0.8]) for axis in "xyz"} | {f"H_vec_{axis}": np.ones(2) for axis in "xyz"}
    other = {name: -column for name, column in one.items()}
    assert [found.name for found in compare_cells(one, other)[0]] == ["H_vec_x", "H_vec_y", "H_vec_z"]

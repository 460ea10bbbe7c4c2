"""Differences of directions and of roots, and at the ends of the range of doubles."""

from __future__ import annotations

import copy

import numpy as np
import pytest

import curvcli
from curvcli.curvatures.catalogue import load_passes
from curvcli.curvatures.quantity import Quantity
from curvcli.curvatures.registry import Pass, Registry, passes
from curvcli.report.compare.cells import compare_cells
from curvcli.report.compare.values import Tolerance
from curvcli.samples import get
from tests.report.test_differences import keys, report, surface

load_passes()
LINES = [quantity for quantity in passes.quantities("vertex") if quantity.kind == "direction"]


@pytest.mark.parametrize("quantity", LINES, ids=lambda quantity: quantity.name)
@pytest.mark.parametrize("scale", ["", "_2e", "_3rings", "_r0.25"])
def test_every_line_is_one_whatever_its_sign(quantity: Quantity, scale: str) -> None:
    """All directions of vertices are lines, also at one of several scales; another line is another line."""
    if scale and not passes.depends_on_scale(quantity.name):
        return
    directions = np.random.default_rng(1).normal(size=(3, 50))
    directions /= np.sqrt((directions**2).sum(axis=0))
    signs = np.where(np.arange(50) % 3, 1.0, -1.0)
    names = [f"{quantity.stem}{scale}_{axis}" for axis in "xyz"]
    one, other = (dict(zip(names, columns, strict=True)) for columns in (directions, directions * signs))
    assert compare_cells(one, other)[0] == []
    turned = dict(zip(names, np.roll(directions, 1, axis=0), strict=True))
    assert [found.name for found in compare_cells(one, turned)[0]] == names


def test_arrows_are_no_lines() -> None:
    assert [q.name for q in passes.quantities() if q.line] == [quantity.name for quantity in LINES]
    assert not passes.quantity("normal").line


def test_statistics_of_lines_are_compared_to_the_last_bit_or_not_at_all() -> None:
    s = surface("irregular_torus", size=200)
    a = report(s, "dir_1,dir_1_fit,H_vec")
    b = copy.deepcopy(a)
    for name in ("dir_1_x", "dir_1_fit_y"):
        column = b["columns"][name]
        column |= {"min": -a["columns"][name]["max"], "max": -a["columns"][name]["min"], "mean": 0.1}
    assert keys(a, b) == []
    assert "columns.dir_1_fit_y.mean" in keys(a, b, tolerance=Tolerance(0))
    b["columns"]["dir_1_fit_y"]["nulls"] += 1
    assert keys(a, b) == ["columns.dir_1_fit_y.nulls"]


FLAT_SAMPLES = ("plane", "icosphere", "developable_strip", "schwarz_lantern")


@pytest.mark.parametrize("name", FLAT_SAMPLES)
def test_roots_of_differences_are_those_declared(name: str) -> None:
    """A turn of a flat or umbilic surface moves cells of star columns by rounding only."""
    made = get(name)(**({"size": 150} if name != "icosphere" else {}))
    c, s = np.cos(1.0), np.sin(1.0)
    turned = np.array(made.points) @ np.array([[1, 0, 0], [0, c, s], [0, -s, c]])
    chosen = [
        q.name
        for q in passes.quantities("vertex")
        if not (q.vector or q.labels or passes.depends_on_scale(q.name))
        and q.name not in ("K_sigma", "h_sigma", "h_normal", "willmore_normal", "shape_index")
    ]
    one, other = (curvcli.analyze((points, made.faces), chosen).vertices for points in (made.points, turned))
    tables = [{name: np.asarray(side[name]) for name in chosen} for side in (one, other)]
    assert compare_cells(tables[0], tables[1])[0] == []


def test_a_plug_in_inherits_that_it_is_a_root() -> None:
    other = Registry()
    other.add(Pass("base", lambda surface: surface, (Quantity("base", rooted=True), Quantity("even")), ("surface",)))
    added = other.add(
        Pass("of_root", lambda base: base, (Quantity("of_root"), Quantity("not", rooted=False)), ("base",))
    )
    assert [quantity.rooted for quantity in added.provides] == [True, False]
    assert other.quantity("even").rooted is False
    assert other.add(Pass("twice", lambda of_root: of_root, (Quantity("twice"),), ("of_root",))).provides[0].rooted


@pytest.mark.parametrize("scale", [2.0**-700, 2.0**-500, 2.0**500, 2.0**700])
@pytest.mark.parametrize("name", ["plane", "catenoid"])
def test_meshes_at_the_ends_of_the_range_are_compared(name: str, scale: float) -> None:
    """Powers of lengths that no double holds measure nothing, and are no reason to stop."""
    made = get(name)(size=60)
    here, moved = np.array(made.points) * scale, np.array(made.points) * scale
    moved[0] += 1e-3 * scale
    a, b = report((here, made.faces)), report((moved, made.faces))
    assert keys(a, copy.deepcopy(a)) == []
    assert "loops.0.length" in keys(a, b)
    one, other = (curvcli.analyze((points, made.faces), "core").vertices for points in (here, moved))
    columns = ("K", "A", "h", "K_density")
    one, other = ({name: np.asarray(side[name]) for name in columns} for side in (one, other))
    assert compare_cells(one, one)[0] == []
    assert "K" in [column.name for column in compare_cells(one, other)[0]]


def test_positions_at_both_ends_of_the_range_are_told_apart() -> None:
    a, b = ({"x": np.array([-1.7e308, 0.0, end])} for end in (1.7e308, 1.6e308))
    assert compare_cells(a, a)[0] == []
    (found,) = compare_cells(a, b)[0]
    assert (found.name, found.differing, found.vertex) == ("x", 1, 2)

"""Shared cases of shape indices, recipes, pictures and smooth energies, by the command line."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.cli.program import curvcli, wrote
from tests.helpers.shared import SHARED, needs_shared

pytestmark = needs_shared


def case(name: str) -> str:
    assert SHARED is not None
    return str(SHARED / "cases" / name)


def report(name: str, *options: str) -> dict[str, Any]:
    ended = curvcli("analyze", case(name), "--json", *options)
    wrote(ended)
    found: dict[str, Any] = json.loads(ended.out)
    return found


def warnings(name: str, *options: str) -> dict[str, Any]:
    return {one["code"]: one for one in report(name, *options)["warnings"]}


def test_umbilics_have_a_shape_index(tmp_path: Path) -> None:
    import numpy as np

    path = tmp_path / "umbilic.npz"
    wrote(curvcli("analyze", case("umbilic.ply"), "-p", "kappa_1,kappa_2,shape_index", "-o", path))
    table = np.load(path)
    equal = table["kappa_1"] == table["kappa_2"]
    assert equal.sum() > 50
    assert (table["shape_index"][equal] == 1).all()
    assert np.isfinite(table["shape_index"]).all()


def test_a_shape_index_at_a_radius() -> None:
    named = warnings("scan_ball_r25.ply", "-p", "shape_index", "--radius", "6")["not_at_scale"]
    assert "shape_index_corrected" in named["hint"]
    names = [f"shape_index_{suffix}" for suffix in ("ring", "corrected", "fit")]
    columns = report("scan_ball_r25.ply", "-p", ",".join(names), "--radius", "6")["columns"]
    for name in names:
        assert columns[name]["median"] > 0.9
        assert columns[name]["nulls"] == 0


@pytest.mark.parametrize("name", ["flat_plate_tilted.ply", "two_planes.ply"])
def test_rounding_has_one_colour(name: str, tmp_path: Path) -> None:
    pytest.importorskip("pyvista")
    ended = curvcli("analyze", case(name), "-o", tmp_path / "x.png", "--color-by", "K_density,h_signed")
    assert ended.code == 0
    lines = [line for line in ended.err.splitlines() if "x.png" in line]
    assert "K_density: 0 length⁻² within rounding wherever defined" in lines[0]
    flat = name.startswith("flat")
    assert ("h_signed: 0 length⁻¹ within rounding wherever defined" in lines[1]) == flat
    assert "within rounding" in lines[1]
    assert "clamped_radicand" not in warnings(name)


def test_smooth_energies_of_a_rough_mesh() -> None:
    plain = report("gyroid_cell_mc.stl")
    (told,) = (one for one in plain["warnings"] if one["code"] == "rough_energy")
    assert "willmore = 11.2" in told["message"]
    scaled = report("gyroid_cell_mc.stl", "-p", "willmore_corrected,willmore_ring,willmore_fit", "--rings", "2")
    assert scaled["totals"]["willmore_corrected"] == pytest.approx(0.158, abs=0.001)
    assert "rough_energy" not in {one["code"] for one in scaled["warnings"]}
    assert "rough_energy" not in warnings("umbilic.ply")
    assert "creased" in warnings("plate_fillet_r1.5.stl")

"""The script of the validation page, on small meshes: its surfaces are those it names, its page has every column."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import curvcli
from benchmarks.validation import __main__ as validation
from benchmarks.validation import agreement, convergence
from benchmarks.validation.surfaces import SURFACES
from tests.helpers.cli.program import ROOT


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("kind", ["regular", "irregular"])
def test_a_surface_is_sound(name: str, kind: str) -> None:
    mesh = SURFACES[name][kind](500)
    analysis = curvcli.analyze((mesh.points, mesh.faces))
    topology = analysis.report()["topology"]
    assert topology["manifold"]
    assert topology["consistent_winding"]
    assert topology["degenerate_faces"] == topology["unreferenced_vertices"] == 0
    assert topology["euler_characteristic"] == {"sphere": 2, "ellipsoid": 2}.get(name, 0)
    # The sign is that of the exact columns: the normal points outwards.
    mean, wanted = analysis.vertices["h_signed"], mesh.exact["h_signed"]
    assert name == "catenoid" or np.nanmean(mean * wanted) > 0


@pytest.mark.parametrize(("name", "radius"), [("catenoid", np.cosh(1.0)), ("unduloid", 1.0)])
def test_what_is_revolved_here_is_the_sample(name: str, radius: float) -> None:
    """The same area in the limit, and the same rims."""
    areas = [
        curvcli.analyze(tuple(vars(SURFACES[name][kind](8000)).values())[:2]).totals["area"] for kind in SURFACES[name]
    ]
    assert areas[0] == pytest.approx(areas[1], rel=2e-3)
    points = SURFACES[name]["irregular"](500).points
    assert np.hypot(*points[:, :2].T).max() == pytest.approx(radius)


def test_an_order_of_convergence_is_recovered() -> None:
    course = convergence.Course()
    for edge in (0.4, 0.2, 0.1):
        course.add(edge, 3 * edge**2, 1e-13)
    assert course.order(course.largest) == pytest.approx(2)
    assert np.isnan(course.order(course.mean))


def test_regular_tori_converge_to_second_order() -> None:
    courses = convergence.converge("torus", "regular", (400, 1600))
    assert {convergence.label(quantity, "barycentric") for quantity in convergence.densities()} <= courses.keys()
    for name in ("h_signed", "K_density", "K_density, voronoi", "kappa_1"):
        assert courses[name].order(courses[name].mean) == pytest.approx(2, abs=0.25), name


def test_exact_arithmetic_is_near() -> None:
    rows = agreement.exact()
    assert {"K", "A_voronoi", "willmore_conformal"} <= {column for _, column, _, _ in rows}
    assert max(error for _, _, error, _ in rows) < 1e-12


def test_a_part_of_the_page(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib", reason="matplotlib draws the pictures and is not installed")
    text = validation.one_surface("sphere", tmp_path, (200, 400))
    assert text.count("| `h_signed` |") == 1
    picture = tmp_path / "validation" / "sphere.png"
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_the_page_names_its_command_and_its_pictures_are_small() -> None:
    page = (ROOT / "docs" / "validation.md").read_text(encoding="utf-8")
    assert "python -m benchmarks.validation" in page
    for name in SURFACES:
        assert f"(validation/{name}.png)" in page
        assert (ROOT / "docs" / "validation" / f"{name}.png").stat().st_size <= 150_000

"""The recipe "no fillet tighter than r = 2", as the page has it, on parts whose radii are known."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import curvcli
from tests.helpers import meshes, parts
from tests.helpers.cli.program import curvcli as program
from tests.helpers.meshes import Mesh
from tests.helpers.shared import SHARED, needs_shared

PAGE = Path(__file__).resolve().parents[2] / "docs" / "recipes" / "cad.md"
PROFILES = list(parts.PROFILES)


def recipe() -> list[str]:
    (row,) = [line for line in PAGE.read_text().splitlines() if line.startswith("| no fillet tighter than r = 2 |")]
    found = re.findall(r"--assert '([^']+)'", row)
    assert len(found) >= 2
    return [word for assertion in found for word in ("--assert", assertion)]


def verdict(part: Mesh, folder: Path) -> int:
    return program("check", part.write(folder / "part.obj"), *recipe(), "-q").code


@pytest.mark.slow
@pytest.mark.parametrize("segments", [3, 8])
@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize(("radius", "code"), [(0.5, 1), (1.5, 1), (1.9, 1), (2.2, 0), (3.0, 0)])
def test_fillets_of_rings_are_judged_by_their_radius(
    profile: str, radius: float, code: int, segments: int, tmp_path: Path
) -> None:
    part = parts.ring(parts.filleted(parts.PROFILES[profile], radius, segments))
    assert verdict(part, tmp_path) == code


@pytest.mark.slow
@pytest.mark.parametrize("profile", PROFILES)
def test_one_sharp_or_tight_corner_is_enough(profile: str, tmp_path: Path) -> None:
    """Convex and concave corners, each alone among wide fillets."""
    corners = parts.PROFILES[profile]
    for corner in range(len(corners)):
        for radius in (0.0, 1.5):
            radii = np.full(len(corners), 3.0)
            radii[corner] = radius
            assert verdict(parts.ring(parts.filleted(corners, radii, 6)), tmp_path) == 1, (corner, radius)


@pytest.mark.parametrize(("radius", "code"), [(1.0, 1), (1.9, 1), (4.0, 0)])
def test_boxes_rounded_all_over(radius: float, code: int, tmp_path: Path) -> None:
    assert verdict(parts.rounded_box([20, 15, 10], radius, 6), tmp_path) == code


@pytest.mark.parametrize("size", [0.1, 40.0, 1000.0])
def test_a_sharp_cube_fails_at_any_size(size: float, tmp_path: Path) -> None:
    cube = meshes.of_sample("cube")
    assert verdict(cube.moved(cube.points * size), tmp_path) == 1


@pytest.mark.parametrize(("radius", "code"), [(1.5, 1), (3.5, 0)])
def test_balls_are_judged_by_their_radius(radius: float, code: int, tmp_path: Path) -> None:
    ball = meshes.of_sample("icosphere", size=642)
    ball = ball.moved(radius * ball.points / np.linalg.norm(ball.points, axis=1)[:, None])
    assert verdict(ball, tmp_path) == code


@pytest.mark.parametrize("long", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("radius", [0.25, 7.0])
@pytest.mark.parametrize("side", [1, -1])
def test_curvature_across_is_1_over_r_on_prisms(long: float, radius: float, side: int) -> None:
    """On an inscribed prism of equal facets, to rounding, whatever their length and their diagonals."""
    n = 24
    angle = 2 * np.pi * np.arange(n) / n
    circle = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    points = np.concatenate([np.column_stack([circle, np.full(n, z)]) for z in (0.0, long, 3 * long)])
    low = np.arange(2 * n)
    ahead = low // n * n + (low + 1) % n
    faces = np.concatenate([np.stack([low, ahead, ahead + n], 1), np.stack([low, ahead + n, low + n], 1)])
    found = curvcli.analyze((points, faces[:, ::side]), ["core"])
    across, theta = found.edges["kappa_across"], found.edges["theta"]
    bent = np.abs(theta) > 1e-6
    np.testing.assert_allclose(across[bent], side / radius, rtol=1e-12)
    assert bent.sum() == 2 * n
    assert (np.isnan(across) == np.isnan(theta)).all()


def test_kappa_max_is_the_larger_size() -> None:
    found = curvcli.analyze(meshes.torus().surface(), "all").vertices
    wanted = np.maximum(np.abs(found["kappa_1"]), np.abs(found["kappa_2"]))
    np.testing.assert_allclose(found["kappa_max"], wanted, rtol=1e-13)
    band = meshes.of_sample("mobius", size=300).surface()
    on_band = curvcli.analyze(band, ["kappa_max", "kappa_1"]).vertices
    assert (np.isfinite(on_band["kappa_max"]) == band.interior).all()
    assert np.isnan(on_band["kappa_1"]).all()


@needs_shared
@pytest.mark.parametrize("name", ["sharp_cube_40.stl", "plate_fillet_r1.5.stl"])
def test_shared_cases_fail(name: str) -> None:
    assert SHARED is not None
    case = SHARED / "cases" / name
    assert program("check", case, *recipe(), "-q").code == 1
    if name.startswith("plate"):
        across = curvcli.analyze(str(case), ["core"]).edges["kappa_across"]
        assert np.nanmax(np.abs(across)) == pytest.approx(1 / 1.5, rel=1e-3)
        assert program("check", case, *recipe()[2:], "-q").code == 1

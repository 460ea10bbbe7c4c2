"""Developable sheets come out flat up to their rims, whichever way they are triangulated."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

import curvcli
from curvcli.samples import get
from tests.helpers import meshes
from tests.helpers.meshes import Mesh, mesh

Floats = NDArray[np.float64]
# From numbers in [0, 1] to points of a curve and the directions of the rulings through them.
Ruled = Callable[[Floats], tuple[Floats, Floats]]


def half_cylinder(s: Floats) -> tuple[Floats, Floats]:
    turn = np.pi * s
    return np.stack([np.cos(turn), np.sin(turn), 0 * s], 1), np.tile([0.0, 0.0, 1.0], (len(s), 1))


def cone(s: Floats) -> tuple[Floats, Floats]:
    """Of an ellipse, without its apex."""
    turn = 4 * s
    away = np.stack([1.5 * np.cos(turn), np.sin(turn), 1 + 0 * s], 1)
    return away, 0.5 * away


def rolled_paper(s: Floats) -> tuple[Floats, Floats]:
    turn, radius = 9 * s, 1 + 0.5 * s
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), 0 * s], 1), np.tile([0.2, 0, 1.0], (len(s), 1))


def tilted_plane(s: Floats) -> tuple[Floats, Floats]:
    return np.stack([3 * s, 2 * s, s], 1), np.tile([0.3, -0.2, 1.0], (len(s), 1))


SHEETS: dict[str, Ruled] = {each.__name__: each for each in (half_cylinder, cone, rolled_paper, tilted_plane)}


def sheet(ruled: Ruled, *, random: bool, across: int = 20, along: int = 14) -> Mesh:
    """Vertices on rulings, flat quadrilaterals between them; at random places and cut either way, or regular."""
    rng = np.random.default_rng(2)
    at = np.tile(np.linspace(0, 2, along), (across, 1))
    if random:
        at[:, 1:-1] += rng.uniform(-0.05, 0.05, (across, along - 2))
    base, rule = ruled(np.linspace(0, 1, across))
    points = base[:, None] + at[:, :, None] * rule[:, None]
    number = np.arange(across * along).reshape(across, along)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
    turned = rng.random(len(a)) < (0.5 if random else 0.0)
    one = np.where(turned, [a, b, d], [a, b, c])
    other = np.where(turned, [b, c, d], [a, c, d])
    return mesh(points.reshape(-1, 3) @ meshes.rotation().T, np.hstack([one, other]).T)


@pytest.mark.parametrize("scale", [{"rings": 1}, {"rings": 2}, {"rings": 4}, {"radius": "2.5e"}], ids=str)
@pytest.mark.parametrize("random", [False, True])
@pytest.mark.parametrize("name", SHEETS)
def test_no_gauss_curvature_up_to_the_rim(name: str, random: bool, scale: dict[str, object]) -> None:
    given = sheet(SHEETS[name], random=random)
    for moved in (given, given.moved(given.points * 1e-9), given.moved(given.points * 1e9)):
        found = curvcli.analyze(moved.surface(), "K,K_corrected,h_corrected", **scale)  # type: ignore[arg-type]
        K, size = found.vertices["K_corrected"], np.nanmax(np.abs(found.vertices["h_corrected"]))
        assert np.nanmax(np.abs(found.vertices["K"])) < 1e-14
        assert np.isfinite(K).all()
        edge = np.sqrt(found.totals["area"] / len(moved.faces))  # type: ignore[operator]
        assert np.abs(K).max() <= 1e-13 * max(size, 1 / edge) ** 2


def test_area_weighted_normals_of_a_half_cylinder_say_the_same() -> None:
    """They are all perpendicular to the axis, so that μ₂ = ½⟨u₀, u₁ × u₂⟩ is 0 on each face, at the rim too."""
    given = sheet(half_cylinder, random=True)
    normal = np.cross(*(given.points[given.faces[:, k]] - given.points[given.faces[:, 0]] for k in (1, 2)))
    total = np.zeros_like(given.points)
    for corner in given.faces.T:
        np.add.at(total, corner, normal)
    unit = total / np.linalg.norm(total, axis=1)[:, None]
    measure = 0.5 * np.linalg.det(unit[given.faces])
    assert np.abs(measure).max() < 1e-16
    found = curvcli.analyze(given.surface(), "K_corrected", rings=1).vertices["K_corrected"]
    assert np.abs(found).max() < 1e-13


def test_coordinates_of_fewer_digits_leave_what_their_angle_defects_allow() -> None:
    """Nothing jumps where defects are small but not rounding."""
    given = sheet(half_cylinder, random=False)
    for moved, least in ((np.float32(given.points).astype(float), 1e-3), (np.round(given.points, 9), 1e-4)):
        found = curvcli.analyze(given.moved(moved).surface(), "K,K_corrected", rings=1).vertices
        assert 0 < np.nanmax(np.abs(found["K"])) < 1e-5
        assert np.abs(found["K_corrected"]).max() < least
    far = curvcli.analyze(given.moved(given.points + 1e6).surface(), "K_corrected", rings=1).vertices["K_corrected"]
    assert np.abs(far).max() < 1e-5


@pytest.mark.parametrize("name", ["cylinder", "schwarz_lantern", "disk", "plane"])
def test_samples_without_angle_defects(name: str) -> None:
    """The lantern is one of them: its angles sum to 2π at every vertex, though its faces stand across the cylinder."""
    made = get(name)(size=400)
    found = curvcli.analyze((made.points, made.faces), "K,K_corrected", rings=2).vertices
    assert np.nanmax(np.abs(found["K"])) < 1e-13
    assert np.abs(found["K_corrected"]).max() < 1e-9


def test_curved_surfaces_keep_their_estimate_at_the_rim() -> None:
    half = get("hemisphere")(size=600)
    found = curvcli.analyze((half.points, half.faces), "K_corrected", rings=1).vertices["K_corrected"]
    assert np.abs(found - 1).max() < 0.06

"""Curvature and torsion per length: exact on circles and helices, in the unit of the file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from curvcli.curves.densities import curvature, signed_curvature, torsion_density
from curvcli.curves.frames import Frenet
from curvcli.curves.plane import plane_curves
from curvcli.curves.polygon import curves_of
from curvcli.curves.turning import Turning
from tests.curves.conftest import Cli, polyline
from tests.curves.shapes import figure_eight, helix, random_polygon, regular


@pytest.mark.parametrize("step", [0.01, 0.3, 1.0, 2.0])
@pytest.mark.parametrize(("radius", "rise"), [(1.0, 0.5), (10.0, -3.0), (1e-3, 2e-3)])
def test_a_helix_has_its_torsion_at_every_step(step: float, radius: float, rise: float) -> None:
    """rise: per radian; τ = b/(r² + b²), whatever the step of the points."""
    points = helix(40, step, rise * step / radius) * radius
    frenet = Frenet(Turning(curves_of(points, False)))
    density = torsion_density(frenet)
    assert np.isnan(density[[0, -1]]).all()
    np.testing.assert_allclose(density[1:-1], rise / (radius**2 + rise**2), rtol=1e-7)


def test_a_helix_has_its_curvature() -> None:
    """To the square of the step: (1/24)(τ h)² and less."""
    for step in (0.2, 0.1):
        found = curvature(Turning(curves_of(helix(60, step, 0.3 * step), False)))[1:-1]
        assert np.abs(found * 1.09 - 1).max() < 0.01 * step**2


@pytest.mark.parametrize("n", [3, 7, 100])
@pytest.mark.parametrize("scale", [1.0, 1e-200, 1e200])
def test_a_regular_polygon_has_the_curvature_of_its_circle(n: int, scale: float) -> None:
    turning = Turning(curves_of(regular(n) * scale, True))
    np.testing.assert_allclose(curvature(turning), 1 / scale, rtol=1e-12)
    np.testing.assert_allclose(signed_curvature(turning, plane_curves(turning)), 1 / scale, rtol=1e-12)


def test_the_curvature_vectors_add_up() -> None:
    curves = curves_of(random_polygon(3, 30), False)
    turning = Turning(curves)
    size = curvature(turning) * (curves.edge_length + curves.edge_length[curves.preceding]) / 2
    np.testing.assert_allclose(size[1:-1], turning.sin2[1:-1], rtol=1e-13)


def test_signs_of_plane_curves() -> None:
    """A figure of eight turns as much to the left as to the right; a reversed curve has the other sign."""
    points = figure_eight(200)
    for way, sign in ((points, 1), (points[::-1], -1)):
        turning = Turning(curves_of(way, True))
        signed = signed_curvature(turning, plane_curves(turning))
        assert (signed > 0.1).sum() == (signed < -0.1).sum() > 50
        assert np.sign(signed[np.argmax(way[:, 0])]) == sign * np.sign(
            signed_curvature(Turning(curves_of(points, True)), plane_curves(Turning(curves_of(points, True))))[
                np.argmax(points[:, 0])
            ]
        )
    space = Turning(curves_of(random_polygon(1, 20), True))
    assert np.isnan(signed_curvature(space, plane_curves(space))).all()


def test_a_straight_line_is_not_curved() -> None:
    line = np.arange(6)[:, None] * np.array([[1.0, 2.0, -1.0]])
    turning = Turning(curves_of(line, False))
    assert np.nanmax(curvature(turning)) < 1e-15
    assert np.isnan(torsion_density(Frenet(turning))).all()
    assert np.nanmax(signed_curvature(turning, plane_curves(turning))[1:-1]) < 1e-15


def test_an_unsteady_helix_has_nearly_its_torsion() -> None:
    rng = np.random.default_rng(0)
    t = np.cumsum(rng.uniform(0.02, 0.04, 400))
    points = np.stack([2 * np.cos(t), 2 * np.sin(t), 0.5 * t], axis=1)
    density = torsion_density(Frenet(Turning(curves_of(points, False))))[2:-2]
    np.testing.assert_allclose(density, 0.5 / 4.25, rtol=2e-3)


def test_columns_of_the_table(cli: Cli, tmp_path: Path) -> None:
    path = polyline(tmp_path / "helix.obj", (helix(20, 0.2, 0.1) * 1e3, False))
    header, *rows = cli.run(path, "-o", "-", "--format", "csv").out.splitlines()
    names = header.split(",")
    assert names.index("curvature") == names.index("tan2") + 1
    torsion = [row.split(",")[names.index("torsion_density")] for row in rows]
    assert torsion[0] == torsion[-1] == ""
    assert all(float(text) == pytest.approx(1e-3 * 0.5 / 1.25, rel=1e-9) for text in torsion[1:-1])
    signed = {row.split(",")[names.index("signed_curvature")] for row in rows}
    assert signed == {""}

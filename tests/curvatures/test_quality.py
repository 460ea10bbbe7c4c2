"""Quality of triangles: closed values, Verdict's own, degenerate faces, and the Delaunay defect by brute force."""

from __future__ import annotations

import math

import mpmath as mp
import numpy as np
import pytest

import curvcli
from curvcli.mesh.surface import Surface
from tests.helpers import meshes

RATIOS = ("aspect_ratio", "edge_ratio", "radius_ratio", "circumradius")
NAMES = ("angle_min", "angle_max", *RATIOS)


def quality(*corners: tuple[float, float, float]) -> dict[str, float]:
    faces = curvcli.analyze((np.array(corners, np.float64), np.array([[0, 1, 2]])), "topology").faces
    return {name: float(faces[name][0]) for name in NAMES}


def by_mpmath(p: list[list[float]]) -> dict[str, mp.mpf]:
    """The definitions of Verdict in 50 digits."""
    with mp.workdps(50):
        points = [[mp.mpf(x) for x in corner] for corner in p]

        def side(i: int, j: int) -> mp.mpf:
            return mp.sqrt(sum((x - y) ** 2 for x, y in zip(points[i], points[j], strict=True)))

        a, b, c = lengths = side(1, 2), side(2, 0), side(0, 1)
        around = a + b + c
        s = around / 2
        area = mp.sqrt(s * (s - a) * (s - b) * (s - c))
        cosines = ((b, c, a), (c, a, b), (a, b, c))
        angles = [mp.acos((x * x + y * y - z * z) / (2 * x * y)) for x, y, z in cosines]
        return {
            "angle_min": min(angles),
            "angle_max": max(angles),
            "aspect_ratio": max(lengths) * around / (4 * mp.sqrt(3) * area),
            "edge_ratio": max(lengths) / min(lengths),
            "radius_ratio": a * b * c * around / (16 * area**2),
            "circumradius": a * b * c / (4 * area),
        }


def test_an_equilateral_triangle_is_best() -> None:
    found = quality((1, 0, 0), (0, 1, 0), (0, 0, 1))
    assert found["angle_min"] == pytest.approx(math.pi / 3, rel=1e-15)
    assert found["angle_max"] == pytest.approx(math.pi / 3, rel=1e-15)
    for name in ("aspect_ratio", "edge_ratio", "radius_ratio"):
        assert found[name] == pytest.approx(1, rel=1e-15)
    assert found["circumradius"] == pytest.approx(math.sqrt(2 / 3), rel=1e-15)


def test_a_right_triangle() -> None:
    found = quality((0, 0, 0), (3, 0, 0), (0, 4, 0))
    assert found["angle_min"] == math.atan2(3, 4)
    assert found["angle_max"] == math.pi / 2
    wanted = {"aspect_ratio": 5 * 12 / (4 * math.sqrt(3) * 6), "edge_ratio": 5 / 3}
    wanted |= {"radius_ratio": 2.5 / 2, "circumradius": 2.5}
    for name, value in wanted.items():
        assert found[name] == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize("scale", [1.0, 2.0**-300, 2.0**200])
@pytest.mark.parametrize("thin", [0.7, 1e-3, 1e-9])
def test_thin_triangles_in_50_digits(thin: float, scale: float) -> None:
    """Needles and caps, and unequal ones; the circumradius has the power of the scale."""
    for corners in (
        [[0, 0, 0], [1, thin, 0], [1, 0, thin]],
        [[0, 0, 0], [1, 0, thin], [0.5, thin, 0.25 * thin]],
        [[0.1, -0.2, 0.3], [1.1, thin, 0.4], [0.35, thin / 3, 0.3]],
    ):
        scaled = (np.array(corners) * scale).tolist()
        found, wanted = quality(*map(tuple, scaled)), by_mpmath(scaled)  # type: ignore[arg-type]
        for name in NAMES:
            assert found[name] == pytest.approx(float(wanted[name]), rel=1e-12), (name, corners)


def test_degenerate_faces() -> None:
    """Collinear corners have the angles 0 and π, as in Verdict; its infinite ratios are null here. Coincident corners
    have no angle and no ratio of edges."""
    line = quality((0, 0, 0), (1, 0, 0), (3, 0, 0))
    assert (line["angle_min"], line["angle_max"], line["edge_ratio"]) == (0, math.pi, 3)
    assert all(math.isnan(line[name]) for name in ("aspect_ratio", "radius_ratio", "circumradius"))
    points, faces = [[0, 0, 0], [1, 0, 0], [0, 0, 0], [0, 1, 0]], [[0, 1, 3], [0, 2, 1]]
    both = curvcli.analyze((np.array(points, float), np.array(faces)), "topology").faces
    for name in NAMES:
        assert np.isnan(both[name]).tolist() == [False, True], name


@pytest.mark.parametrize("name", ["irregular_sphere", "torus", "schwarz_lantern", "cube"])
def test_the_values_of_verdict(name: str) -> None:
    pv = pytest.importorskip("pyvista", reason="pyvista is not installed")
    vtk = pytest.importorskip("vtkmodules.vtkFiltersVerdict", reason="vtk is not installed")
    mesh = meshes.of_sample(name)
    verdict = {
        "angle_min": "MinAngle",
        "angle_max": "MaxAngle",
        "aspect_ratio": "AspectRatio",
        "edge_ratio": "EdgeRatio",
        "radius_ratio": "RadiusRatio",
    }
    faces = curvcli.analyze(mesh.surface(), "topology").faces
    for ours, theirs in verdict.items():
        measure = vtk.vtkMeshQuality()
        measure.SetInputData(pv.PolyData.from_regular_faces(mesh.points, mesh.faces))
        getattr(measure, f"SetTriangleQualityMeasureTo{theirs}")()
        measure.Update()
        wanted = np.asarray(pv.wrap(measure.GetOutput()).cell_data["Quality"])
        wanted = np.radians(wanted) if ours.startswith("angle") else wanted
        # Verdict takes angles by the arc cosine, which loses half of the digits near π.
        np.testing.assert_allclose(faces[ours], wanted, rtol=1e-7 if ours.startswith("angle") else 1e-11, err_msg=ours)


def defects(surface: Surface) -> list[float]:
    """α + β − π edge by edge."""
    opposite: dict[tuple[int, int], list[float]] = {}
    for face in surface.faces.tolist():
        for k in range(3):
            a, b, c = (face[(k + j) % 3] for j in range(3))
            u, v = surface.points[a] - surface.points[c], surface.points[b] - surface.points[c]
            angle = math.atan2(np.linalg.norm(np.cross(u, v)), float(u @ v))
            opposite.setdefault((min(a, b), max(a, b)), []).append(angle)
    return [sum(each) - math.pi if len(each) == 2 else math.nan for _, each in sorted(opposite.items())]


@pytest.mark.parametrize("name", ["torus", "grid", "mobius", "book", "inconsistent"])
def test_the_delaunay_defect_edge_by_edge(name: str) -> None:
    surface = meshes.zoo(name).surface()
    found = curvcli.analyze(surface, "topology").edges["delaunay_defect"]
    np.testing.assert_allclose(found, defects(surface), atol=1e-14)


def test_a_delaunay_triangulation_has_none() -> None:
    """Of a square cut along a diagonal it is exactly 0; of a rhombus cut along its long diagonal positive."""
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    flat = curvcli.analyze((square, faces), "topology").edges["delaunay_defect"]
    assert flat[1] == 0
    rhombus = curvcli.analyze((square @ np.array([[1, 0.9, 0], [0.9, 1, 0], [0, 0, 1]]), faces), "topology").edges
    assert rhombus["delaunay_defect"][1] > 1
    sphere = curvcli.analyze(meshes.of_sample("irregular_sphere", size=2000).surface(), "topology").edges
    assert np.nanmax(sphere["delaunay_defect"]) < 0.1

"""Corrected curvatures: exact where the normals are, near the truth on bad triangulations, and null where undefined."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

import curvcli
from curvcli.api import Analysis
from curvcli.errors import InputError
from curvcli.mesh.file import MeshFile
from curvcli.mesh.surface import Surface
from curvcli.samples import get
from tests.helpers import irregular, meshes
from tests.helpers.irregular import SURFACES, error

COLUMNS = "K_corrected,h_corrected,kappa_1_corrected,kappa_2_corrected,dir_1_corrected,dir_2_corrected"


@cache
def estimated(name: str, count: int = 10_000, regular: bool = False, **scale: int) -> tuple[irregular.Known, Analysis]:
    known = SURFACES[name](count, regular)
    return known, curvcli.analyze((known.points, known.faces), COLUMNS, **scale)  # type: ignore[arg-type]


def with_normals(points: np.ndarray, faces: np.ndarray, normal: np.ndarray) -> Surface:
    file = MeshFile("ply", np.ascontiguousarray(points.T), np.ascontiguousarray(faces, np.int32).ravel())
    file.vertex_properties.update(zip(("nx", "ny", "nz"), normal.T, strict=True))
    return Surface(points, faces, file=file)


@pytest.mark.parametrize(("name", "bound"), [("sphere", 1e-9), ("torus", 0.03), ("ellipsoid", 0.035)])
def test_on_random_points(name: str, bound: float) -> None:
    """The angle defect per area is wrong there by half of itself and more."""
    known, found = estimated(name)
    assert error(found.vertices["K_corrected"], known.K) < bound
    assert error(found.vertices["h_corrected"], known.H) < bound / 2


@pytest.mark.parametrize("rings", [1, 2, 3])
@pytest.mark.parametrize("name", SURFACES)
def test_no_bias_on_regular_meshes(name: str, rings: int) -> None:
    known, found = estimated(name, regular=True, rings=rings)
    for column, exact in (("K_corrected", known.K), ("h_corrected", known.H)):
        assert abs(np.median(found.vertices[column] / exact) - 1) < 0.001
        assert error(found.vertices[column], exact) < 0.005


@pytest.mark.parametrize("name", ["torus", "ellipsoid"])
def test_the_error_falls_with_the_size_of_faces(name: str) -> None:
    """Of about the first order: four times the vertices, about half the error."""
    coarse, fine = (error(found.vertices["K_corrected"], known.K) for known, found in _sizes(name))
    assert fine < coarse / 1.85


def _sizes(name: str) -> list[tuple[irregular.Known, Analysis]]:
    return [estimated(name, 2_500), estimated(name)]


@pytest.mark.parametrize("name", SURFACES)
def test_five_rings_tell_the_mean_curvature_under_noise(name: str) -> None:
    """At a thousandth of the size, where curvatures of one ring are noise, five rings still tell the mean curvature."""
    known = SURFACES[name]()
    size = np.linalg.norm(np.ptp(known.points, axis=0))
    noisy = known.points + np.random.default_rng(1).normal(scale=1e-3 * size, size=known.points.shape)
    found = curvcli.analyze((noisy, known.faces), "h_corrected", rings=5)
    assert error(found.vertices["h_corrected"], known.H) < 0.12


@pytest.mark.parametrize("rings", [1, 3])
def test_spheres_are_exact(rings: int) -> None:
    """Normals of complete stars on a sphere are exact for any triangles, and so are the estimates."""
    known, found = estimated("sphere", 2_500, rings=rings)
    for column, exact in (("K_corrected", 0.25), ("h_corrected", 1.0)):
        np.testing.assert_allclose(found.vertices[column], exact, rtol=1e-9)
    assert known.normal.shape == known.points.shape


@pytest.mark.parametrize("rings", [1, 2])
def test_cylinders_with_their_own_normals(rings: int) -> None:
    """K = 0, κ₁ = 1/r round it and κ₂ = 0 along it: u is linear on every triangle."""
    made = get("cylinder")(size=400)
    radial = made.points * [1.0, 1.0, 0.0]
    radius = np.linalg.norm(radial, axis=1).mean()
    surface = with_normals(made.points, made.faces, 7 * radial)
    found = curvcli.analyze(surface, COLUMNS, rings=rings, normals="file")
    assert found.conventions.normals == "file"
    inside = surface.interior
    columns = {name: found.vertices[name][inside] for name in COLUMNS.split(",")}
    np.testing.assert_allclose(columns["K_corrected"], 0, atol=1e-12)
    np.testing.assert_allclose(columns["h_corrected"], 1 / radius, rtol=1e-12)
    np.testing.assert_allclose(columns["dir_2_corrected"], np.tile([0, 0, 1.0], (inside.sum(), 1)), atol=1e-2)


def test_file_normals_on_the_wrong_side_are_turned() -> None:
    known = irregular.ellipsoid(1_000)
    right, wrong = (
        curvcli.analyze(with_normals(known.points, known.faces, way * known.normal), COLUMNS, normals="file")
        for way in (1.0, -3.0)
    )
    for name in COLUMNS.split(","):
        np.testing.assert_allclose(wrong.vertices[name], right.vertices[name], rtol=1e-12, atol=1e-12)
    assert error(right.vertices["h_corrected"], known.H) < 0.06


def test_a_vertex_without_a_normal_in_the_file() -> None:
    known = irregular.sphere(500)
    normal = known.normal.copy()
    normal[7] = np.nan
    normal[8] = 0.0
    found = curvcli.analyze(with_normals(known.points, known.faces, normal), COLUMNS, rings=1, normals="file")
    nulls = np.flatnonzero(np.isnan(found.vertices["K_corrected"]))
    assert nulls.tolist() == [7, 8]
    assert found.report()["columns"]["K_corrected"]["nulls"] == 2


def test_no_normals_in_the_file(tmp_path: Path) -> None:
    path = tmp_path / "cube.obj"
    made = get("cube")()
    lines = [*("v {} {} {}".format(*p) for p in made.points), *("f {} {} {}".format(*(f + 1)) for f in made.faces)]
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(InputError) as raised:
        curvcli.analyze(str(path), COLUMNS, normals="file")
    assert str(raised.value).startswith(f"{path}: no normals")
    assert "--normals mesh" in str(raised.value)


def test_obj_normals_by_way_of_the_corners(tmp_path: Path) -> None:
    """Named after the vertex and its texture coordinate, counted back, and left out."""
    known = irregular.sphere(200, radius=1.0)
    n = len(known.points)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in known.points.tolist()]
    lines += [f"vn {5 * x!r} {5 * y!r} {5 * z!r}" for x, y, z in known.normal.tolist()]
    lines += ["vt 0 0"]
    for k, (a, b, c) in enumerate(known.faces.tolist()):
        one, other = (f"{b + 1}//{b + 1}", f"{b + 1}//{b - n}")[k % 2], f"{c + 1}/1/{c + 1}"
        lines.append(f"f {a + 1}/1/{a + 1} {one} {other}")
    path = tmp_path / "ball.obj"
    path.write_text("\n".join(lines) + "\n")
    found = curvcli.analyze(str(path), "K_corrected,h_corrected", normals="file")
    np.testing.assert_allclose(found.vertices["K_corrected"], 1.0, rtol=1e-12)
    np.testing.assert_allclose(found.vertices["h_corrected"], 2.0, rtol=1e-12)
    path.write_text("\n".join(lines).replace("//1 ", "//9999 ").replace("/1/1\n", "/1/9999\n") + "\n")
    with pytest.raises(InputError, match="normal index 9999 found"):
        curvcli.load(path, normals="file")


def test_principal_curvatures_and_directions() -> None:
    known, found = estimated("torus", regular=True, rings=2)
    columns = found.vertices
    small, large = np.sort([known.H - 1 / 0.7, np.full(len(known.H), 1 / 0.7)], axis=0)
    assert error(columns["kappa_1_corrected"], large) < 0.005
    assert error(columns["kappa_2_corrected"], small) < 0.01
    total = columns["kappa_1_corrected"] + columns["kappa_2_corrected"]
    np.testing.assert_allclose(total, columns["h_corrected"], atol=1e-12)
    # κ₁ goes round the tube, κ₂ round the axis.
    x, y, _ = known.points.T
    axis = np.stack([-y, x, 0 * x], axis=1) / np.hypot(x, y)[:, None]
    assert np.abs(np.einsum("ij,ij->i", columns["dir_2_corrected"], axis)).min() > 0.999
    assert np.abs(np.einsum("ij,ij->i", columns["dir_1_corrected"], axis)).max() < 0.04


def test_boundaries_are_estimated_from_one_side() -> None:
    known = irregular.ellipsoid(10_000)
    centre = known.points[known.faces].mean(axis=1)
    faces = known.faces[centre[:, 0] + 0.3 * centre[:, 1] > 0.1]
    surface = Surface(known.points, faces)
    found = curvcli.analyze(surface, COLUMNS)
    rim = surface.boundary
    assert error(found.vertices["K_corrected"][rim], known.K[rim]) < 0.05
    assert error(found.vertices["h_corrected"][rim], known.H[rim]) < 0.05
    assert np.isnan(found.vertices["K_corrected"][~surface.referenced]).all()


def test_without_orientation_only_the_gauss_curvature_stays() -> None:
    """On a Möbius strip, where κ₁ and κ₂ have no sign; K is that of the same strip cut open."""
    strip = meshes.of_sample("mobius", size=2_000)
    found = curvcli.analyze((strip.points, strip.faces), COLUMNS)
    assert not np.isnan(found.vertices["K_corrected"]).any()
    for name in COLUMNS.split(",")[1:]:
        assert np.isnan(found.vertices[name]).all()
    cut = strip.with_faces(np.delete(strip.faces, np.flatnonzero((strip.faces == 0).any(axis=1)), axis=0))
    there = curvcli.analyze((cut.points, cut.faces), COLUMNS).vertices["K_corrected"]
    far = np.linalg.norm(strip.points - strip.points[0], axis=1) > 1.0
    np.testing.assert_allclose(there[far], found.vertices["K_corrected"][far], rtol=1e-9, atol=1e-12)


def test_normals_that_do_not_belong_to_the_faces() -> None:
    known = irregular.sphere(300)
    found = curvcli.analyze(
        with_normals(known.points, known.faces, np.tile([0, 0, 1.0], (300, 1))), COLUMNS, rings=1, normals="file"
    )
    null = np.isnan(found.vertices["K_corrected"])
    assert not null.all()
    assert null[np.abs(known.normal[:, 2]) < 0.02].all()
    assert not null[np.abs(known.normal[:, 2]) > 0.6].any()

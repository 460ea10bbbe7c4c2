"""Maps between surfaces on the same faces: known singular values, conformal and harmonic maps, and what is refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

import curvcli
from curvcli.analysis.maps import SurfaceMap
from curvcli.errors import InputError
from curvcli.mesh.surface import Surface
from tests.helpers.meshes import ZOO, Mesh, grid, of_sample, rotation, zoo
from tests.helpers.strategies import any_mesh

seeds = st.integers(0, 2**32 - 1)


def flat_grid() -> Mesh:
    given = grid()
    return given.moved(given.points * [1, 1, 0])


def map_to(given: Mesh, image: NDArray[np.float64]) -> SurfaceMap:
    return SurfaceMap(given.surface(), image)


def statuses(f: SurfaceMap) -> set[str]:
    return {check.status for check in f.checks}


# ---------------------------------------------------------------------------- singular values


@given(seeds)
def test_linear_maps_have_the_singular_values_of_their_matrix(seed: int) -> None:
    rng = np.random.default_rng(seed)
    matrix = rng.normal(size=(3, 2)) * [1, 10.0 ** rng.integers(-6, 1)]
    given = flat_grid()
    turn = rotation(seed)
    f = map_to(given.moved(given.points @ turn.T), given.points[:, :2] @ matrix.T)
    expected = np.linalg.svd(matrix, compute_uv=False)
    np.testing.assert_allclose(f.sigma_1, expected[0], rtol=1e-13)
    np.testing.assert_allclose(f.sigma_2, expected[1], rtol=1e-8, atol=1e-14 * expected[0])
    area = f.area.sum()
    assert f.totals["dirichlet"] == pytest.approx((expected**2).sum() * area / 2, rel=1e-13)
    assert f.totals["image_area"] == pytest.approx(expected.prod() * area, rel=1e-9)
    assert f.totals["nonconformality"] == pytest.approx((expected[0] - expected[1]) ** 2 * area / 2, rel=1e-12)
    np.testing.assert_allclose(f.nonconformality, (f.sigma_1 - f.sigma_2) ** 2 * f.area / 2, rtol=1e-9)
    # Affine maps of the plane are harmonic.
    assert f.harmonic[0] <= f.harmonic[2]
    assert statuses(f) == {"pass"}


def test_a_stretched_triangle_has_its_factors_as_singular_values() -> None:
    given = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]], np.int32))
    f = map_to(given, np.array([[7.0, 0, 0], [7, 3, 0], [7, 0, 0.5]]))
    assert f.sigma_1.tolist() == [3.0]
    assert f.sigma_2.tolist() == [0.5]
    assert f.totals == {"dirichlet": 2.3125, "area": 0.5, "image_area": 0.75, "nonconformality": 1.5625}
    assert f.gradient.tolist() == [[0, -1.5, -0.25], [0, 1.5, 0], [0, 0, 0.25]]
    assert np.isnan(f.harmonic_residual).all()
    assert f.harmonic[1] is None


@given(seeds, st.sampled_from([1e-3, 1.0, 50.0]), st.sampled_from(list(ZOO)))
def test_similarities_are_conformal(seed: int, scale: float, name: str) -> None:
    given = zoo(name)
    f = map_to(given, scale * given.points @ rotation(seed).T)
    assert f.totals["nonconformality"] <= 1e-26 * f.totals["dirichlet"]
    assert np.nanmax(np.abs(f.sigma_1 / scale - 1)) < 1e-12
    assert np.nanmax(np.abs(f.sigma_2 / scale - 1)) < 1e-12


def test_stereographic_projection_is_conformal_in_the_limit() -> None:
    shares = []
    for size in (162, 642, 2562):
        sphere = of_sample("icosphere", size=size)
        # Inversion in a sphere about a point outside: conformal, and smooth on the whole sphere.
        from_pole = sphere.points - [0, 0, 2]
        f = map_to(sphere, from_pole / (from_pole**2).sum(axis=1)[:, None])
        assert statuses(f) == {"pass"}
        shares.append(f.totals["nonconformality"] / f.totals["dirichlet"])
    # Second order: a quarter per refinement.
    assert shares[1] / shares[0] == pytest.approx(0.25, rel=0.15)
    assert shares[2] / shares[1] == pytest.approx(0.25, rel=0.15)


def test_the_identity_has_the_area_as_energy() -> None:
    given = zoo("torus")
    f = map_to(given, given.points)
    known = curvcli.analyze(given.surface(), "area_gradient,dirichlet")
    np.testing.assert_array_equal(f.energy, known.faces["dirichlet"])
    np.testing.assert_allclose(f.gradient, known.vertices["area_gradient"], rtol=0, atol=1e-13)
    assert f.totals["dirichlet"] == pytest.approx(f.totals["area"], rel=1e-14)


# ---------------------------------------------------------------------------- identities


@given(any_mesh(), seeds, st.sampled_from([1e-9, 1.0, 1e9]), st.sampled_from([0.0, 1e6]))
def test_identities_hold_for_any_map(given: Mesh, seed: int, scale: float, offset: float) -> None:
    image = np.random.default_rng(seed).normal(size=given.points.shape)
    f = map_to(given.moved((given.points + offset) * scale), image)
    assert statuses(f) <= {"pass", "not_applicable"}
    assert not (f.nonconformality < 0).any()
    assert not (f.sigma_1 < f.sigma_2).any()


@pytest.mark.parametrize("name", ["energy", "nonconformality"])
def test_a_disturbed_value_fails(name: str) -> None:
    given = zoo("torus")
    f = map_to(given, given.points[:, [1, 0, 0]])
    values = getattr(f.stretch, name).copy()
    values[3] += 1e-9
    f.__dict__["stretch"] = replace(f.stretch, **{name: values})
    assert [check.name for check in f.checks if check.status == "fail"] == [
        {"energy": "dirichlet_energy"}.get(name, name)
    ]


def test_gradient_is_the_derivative_of_the_energy() -> None:
    given = zoo("cap")
    rng = np.random.default_rng(5)
    image, step = rng.normal(size=given.points.shape), rng.normal(size=given.points.shape)
    change = map_to(given, image + step).totals["dirichlet"] - map_to(given, image - step).totals["dirichlet"]
    assert change / 2 == pytest.approx(float((map_to(given, image).gradient * step).sum()), rel=1e-12)


def test_harmonic_residual_is_null_on_the_boundary_only() -> None:
    given = grid()
    f = map_to(given, given.points)
    np.testing.assert_array_equal(np.isnan(f.harmonic_residual), given.surface().boundary)
    assert f.harmonic[0] == np.nanmax(f.harmonic_residual) > 1e12 * f.harmonic[2]


# ---------------------------------------------------------------------------- scale


@pytest.mark.parametrize("exponent", [-30, 30, -600, 500])
def test_scale_of_source_and_image(exponent: int) -> None:
    given = zoo("torus")
    image = given.points[:, [2, 0, 1]] * [1, 2, 3]
    base, factor = map_to(given, image), 2.0**exponent
    f = map_to(given.moved(given.points * factor), image)
    np.testing.assert_array_equal(f.sigma_1, base.sigma_1 / factor)
    np.testing.assert_array_equal(f.nonconformality, base.nonconformality)
    g = map_to(given, image * factor)
    np.testing.assert_array_equal(g.sigma_2, base.sigma_2 * factor)
    np.testing.assert_array_equal(g.harmonic_residual, base.harmonic_residual * factor)
    assert statuses(f) == {"pass"}
    # 2^-1200 is no double, and no energy of g has another size.
    assert statuses(g) == {"not_applicable" if exponent == -600 else "pass"}


# ---------------------------------------------------------------------------- faces without area


@pytest.mark.parametrize("corner", [0, 1, 2])
def test_images_without_area(corner: int) -> None:
    given = Mesh(np.array([[0.0, 0, 0], [2, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]], np.int32))
    image = np.zeros((3, 3))
    image[corner, 2] = 1.0
    f = map_to(given, image)
    # The one corner that moves lies at a distance from its opposite edge over which f climbs by 1.
    height = [2 / np.sqrt(5), 2.0, 1.0][corner]
    np.testing.assert_allclose(f.sigma_1, [1 / height], rtol=1e-15)
    assert f.sigma_2.tolist() == [0.0]
    assert statuses(f) == {"pass"}
    assert [notice.code for notice in f.notices] == ["collapsed_faces"]


def test_image_that_is_a_point() -> None:
    f = map_to(zoo("torus"), np.ones_like(zoo("torus").points))
    assert f.sigma_1.max() == f.totals["dirichlet"] == f.harmonic[0] == 0.0
    assert statuses(f) == {"pass"}


def test_source_faces_without_area_are_null() -> None:
    given = zoo("with_flat_face")
    f = map_to(given, np.random.default_rng(0).normal(size=given.points.shape))
    flat = len(given.faces) - 1
    for column in (f.sigma_1, f.sigma_2, f.nonconformality, f.energy):
        assert np.flatnonzero(np.isnan(column)).tolist() == [flat]
    assert np.flatnonzero(np.isnan(f.gradient[:, 0])).tolist() == sorted(given.faces[flat])
    assert f.area[flat] == 0.0
    assert f.image_area[flat] > 0.0
    assert statuses(f) == {"not_applicable"}
    assert [(notice.code, notice.count, notice.examples) for notice in f.notices] == [
        ("degenerate_source_faces", 1, (flat,))
    ]


# ---------------------------------------------------------------------------- what is refused


def test_different_vertices_and_faces() -> None:
    given = zoo("tetrahedron")
    other = given.faces.copy()
    other[2] = other[2][[1, 2, 0]]
    for points, faces, message in (
        (np.vstack([given.points, [[0, 0, 0]]]), given.faces, "has 5 vertices, expected 4 as in the source"),
        (given.points, given.faces[:3], "has 3 faces, expected 4 as in the source"),
        (given.points, other, "face 2: has corners 3 2 0, expected 0 3 2 as in the source"),
    ):
        with pytest.raises(InputError, match=message):
            SurfaceMap(given.surface(), Surface(points, faces))
    with pytest.raises(InputError, match="shape"):
        SurfaceMap(given.surface(), given.points[:3])
    with pytest.raises(InputError, match="not finite"):
        SurfaceMap(given.surface(), given.points * np.nan)


def test_polygons_are_cut_as_in_the_source(tmp_path: Path) -> None:
    """The same quadrilateral is convex in one file and not in the other; it is one face of the map in both."""
    one, other = tmp_path / "one.obj", tmp_path / "other.obj"
    one.write_text("v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4\n")
    other.write_text("v 0 0 0\nv 2 0 0\nv 0.5 0.5 0\nv 0 2 0\nf 1 2 3 4\n")
    assert (curvcli.load(one).faces != curvcli.load(other).faces).any()
    f = SurfaceMap(one, other)
    np.testing.assert_array_equal(f.image.faces, curvcli.load(one).faces)
    back = SurfaceMap(other, one)
    np.testing.assert_array_equal(back.image.faces, curvcli.load(other).faces)


def test_faces_of_sizes_that_do_not_meet() -> None:
    """A conformal map of faces of sizes 1e-144 and 1 to two of 1e15: the energy is the area, though σ² is no double."""
    face, faces = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), [[0, 1, 2], [3, 4, 5]]
    beside = face + np.array([5.0, 0, 0])
    points, image = np.concatenate([1e-144 * face, beside]), 1e15 * np.concatenate([face, beside])
    of = SurfaceMap((points, faces), image)
    assert of.totals["dirichlet"] == pytest.approx(1e30, rel=1e-13)
    assert of.totals["nonconformality"] < 1
    assert [check.status for check in of.checks] == ["pass", "pass"]

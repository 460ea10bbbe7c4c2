"""Faces that a map turns over: by the sign of the determinant in the plane, from face to face in space."""

from __future__ import annotations

import numpy as np
import pytest

import curvcli
from curvcli.analysis.maps import SurfaceMap
from tests.helpers.meshes import Mesh, grid, of_sample, rotation, zoo


def flat(given: Mesh) -> np.ndarray:
    return given.points * [1, 1, 0]


def determinants(given: Mesh, image: np.ndarray) -> np.ndarray:
    """Signs of the areas of the images of the faces of a graph over the plane, as wound."""
    a, b, c = (image[given.faces[:, k]] for k in range(3))
    area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    return np.sign(area)


@pytest.mark.parametrize("seed", range(8))
def test_into_the_plane_it_is_the_sign_of_the_determinant(seed: int) -> None:
    """Some vertices thrown about: the majority is the one that the rest has."""
    rng = np.random.default_rng(seed)
    given = grid()
    image = flat(given)
    some = rng.choice(len(image), 3, replace=False)
    image[some, :2] += rng.normal(size=(3, 2)) * np.ptp(image[:, 0]) / 4
    expected = determinants(given, image)
    weight = expected * SurfaceMap(given.surface(), image).image_area
    expected = expected if weight.sum() > 0 else -expected
    for turn in (np.eye(3), rotation(seed), np.diag([1, -1, 1]), -rotation(seed + 1)):
        f = SurfaceMap(given.surface(), image @ turn.T + 3)
        np.testing.assert_array_equal(f.orientation, expected)
        assert f.turned_over.tolist() == np.flatnonzero(expected < 0).tolist()


def test_the_winding_of_the_file_does_not_count() -> None:
    given = grid()
    image = flat(given)
    mixed = given.faces.copy()
    mixed[::3] = mixed[::3, ::-1]
    for faces in (given.faces, given.faces[:, ::-1], mixed):
        f = SurfaceMap(curvcli.Surface(given.points, faces), image)
        assert (f.orientation == 1).all()
        assert f.notices == []


def folded(given: Mesh) -> np.ndarray:
    """The half plane x > 0.37 of the mesh's width folded back on the rest."""
    image = flat(given)
    x = image[:, 0]
    crease = x.min() + 0.37 * np.ptp(x)
    image[:, 0] = np.where(x > crease, 2 * crease - x, x)
    return image


@pytest.mark.parametrize("height", [0.0, 1e-3, 0.05])
def test_a_folded_sheet_in_the_plane_and_nearly_in_it(height: float) -> None:
    """The same faces are found by carrying the sign where the sheet lies in no plane."""
    given = grid()
    image = folded(given)
    expected = SurfaceMap(given.surface(), image).orientation
    wavy = image.copy()
    wavy[:, 2] = height * np.sin(3 * image[:, 0]) * np.cos(2 * image[:, 1])
    found = SurfaceMap(given.surface(), wavy @ rotation(3).T).orientation
    assert {1.0, -1.0} == set(expected[~np.isnan(expected)])
    np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("name", ["torus", "ellipsoid", "cap", "mobius", "klein_bottle", "two_bodies", "tetrahedron"])
def test_rigid_motions_reflections_and_affine_maps_turn_nothing_over(name: str) -> None:
    given = zoo(name)
    for matrix in (np.eye(3), rotation(1), -np.eye(3), np.diag([1, 2, 0.7]), 1e-9 * rotation(2), 1e9 * np.eye(3)):
        f = SurfaceMap(given.surface(), given.points @ matrix.T)
        assert (f.orientation == 1).all()


def test_a_dent_turned_inside_out_is_one_patch() -> None:
    """A cap of a sphere pushed in bends its rim, but turns no face over by more than its neighbours."""
    given = of_sample("icosphere")
    image = given.points.copy()
    image[:, 2] = np.minimum(image[:, 2], 1.8 * np.abs(image[:, 2]).max() - image[:, 2])
    assert (SurfaceMap(given.surface(), image).orientation == 1).all()


def test_faces_without_area_are_null() -> None:
    given = grid()
    image = flat(given)
    a, b, c = given.faces[5]
    image[c] = (image[a] + image[b]) / 2
    f = SurfaceMap(given.surface(), image)
    assert np.isnan(f.orientation[5]) == f.stretch.collapsed[5]
    assert np.array_equal(np.isnan(f.orientation), f.stretch.collapsed | np.isnan(f.sigma_1))
    everything = SurfaceMap(given.surface(), 0 * image)
    assert np.isnan(everything.orientation).all()


def test_the_area_distortion_is_the_product_of_the_singular_values() -> None:
    given = grid()
    f = SurfaceMap(given.surface(), given.points @ np.array([[2.0, 1, 0], [0, 3, 0], [0, 0, 0]]))
    np.testing.assert_allclose(f.area_distortion, f.sigma_1 * f.sigma_2, rtol=1e-9)
    np.testing.assert_allclose(f.area_distortion, f.image_area / f.area, rtol=1e-13)
    scaled = SurfaceMap(given.surface(), given.points * 1e150)
    np.testing.assert_allclose(scaled.area_distortion, 1e300, rtol=1e-12)

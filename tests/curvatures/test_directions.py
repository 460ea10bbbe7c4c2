"""Principal directions on surfaces where symmetry says what they are."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import curvcli
from tests.helpers import meshes
from tests.helpers.meshes import Mesh, mesh

Floats = NDArray[np.float64]
TURN = 2 * np.pi


def directions(given: Mesh) -> tuple[Floats, Floats]:
    """(V, 3) each; of unit length, orthogonal to each other and to the vector area where they are not null."""
    result = curvcli.analyze(given.surface(), "dir_1,dir_2,A_vec")
    one, two, normal = (np.asarray(result.vertices[name]) for name in ("dir_1", "dir_2", "A_vec"))
    np.testing.assert_array_equal(np.isnan(one), np.isnan(two))
    known = ~np.isnan(one).any(axis=1)
    normal = normal[known] / np.linalg.norm(normal[known], axis=1)[:, None]
    frame = np.stack([one[known], two[known], normal], axis=1)
    np.testing.assert_allclose(frame @ frame.transpose(0, 2, 1), np.tile(np.eye(3), (len(frame), 1, 1)), atol=1e-14)
    return one, two


def along(found: Floats, wanted: Floats) -> Floats:
    """|cosine| of the angles between lines."""
    return np.asarray(np.abs(np.sum(found * wanted, axis=1)) / np.linalg.norm(wanted, axis=1))


def turned(given: Mesh) -> Mesh:
    return given.moved(given.points @ meshes.rotation().T)


def tube(n: int, m: int, radius: Floats) -> Mesh:
    """Rings of n points at heights 0 … m − 1 about the z axis, of the given radii (m,), with diagonals."""
    t = TURN * np.arange(n) / n
    points = [[[r * np.cos(s), r * np.sin(s), z] for s in t] for z, r in zip(range(m), radius, strict=True)]
    index = np.arange(n * m).reshape(m, n)
    a, b = index[:-1], np.roll(index[:-1], -1, axis=1)
    d, c = index[1:], np.roll(index[1:], -1, axis=1)
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    return mesh(np.array(points).reshape(-1, 3), faces)


def around(points: Floats) -> Floats:
    return np.stack([-points[:, 1], points[:, 0], 0 * points[:, 0]], axis=1)


@pytest.mark.parametrize("slope", [0.0, 0.5, 2.0])
def test_cylinders_and_cones(slope: float) -> None:
    """Only the rulings bend, so that dir_1 goes round and dir_2 along, to the last digits."""
    given = tube(11, 5, 1 + slope * np.arange(5.0))
    inner = slice(11, 44)
    result = curvcli.analyze(given.surface(), "A_vec")
    normal = np.asarray(result.vertices["A_vec"])
    one, two = directions(given)
    assert np.isnan(one[:11]).all()
    assert np.isnan(one[44:]).all()
    ruling = given.points * [slope, slope, 0] / (1 + slope * given.points[:, 2:]) + [0, 0, 1]
    # The eigenvectors of a projected ruling ⊗ ruling: across it and the normal, and along its shadow.
    np.testing.assert_allclose(along(one, np.cross(normal, ruling))[inner], 1, atol=1e-13)
    if slope == 0:
        np.testing.assert_allclose(along(one, around(given.points))[inner], 1, atol=1e-13)
        np.testing.assert_allclose(along(two, ruling)[inner], 1, atol=1e-13)
    turned_one, turned_two = directions(turned(given))
    for found, plain in ((turned_one, one), (turned_two, two)):
        np.testing.assert_allclose(along(found, plain @ meshes.rotation().T)[inner], 1, atol=1e-13)


def test_the_larger_curvature_goes_round_the_tube() -> None:
    """The larger curvature goes round the tube everywhere."""
    R, r, n, m = 2.0, 0.5, 60, 24
    u, w = np.meshgrid(TURN * np.arange(n) / n, TURN * np.arange(m) / m, indexing="ij")
    points = np.stack([(R + r * np.cos(w)) * np.cos(u), (R + r * np.cos(w)) * np.sin(u), r * np.sin(w)], -1)
    index = np.arange(n * m).reshape(n, m)
    a, b = index, np.roll(index, -1, 0)
    c, d = np.roll(b, -1, 1), np.roll(index, -1, 1)
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    given = mesh(points.reshape(-1, 3), faces)
    one, two = directions(given)
    assert along(two, around(given.points)).min() > np.cos(0.15)
    # Seen from inside, the curvatures change their order.
    inside_one, inside_two = directions(meshes.reversed_faces(given))
    np.testing.assert_allclose(along(inside_one, two), 1, atol=1e-13)
    np.testing.assert_allclose(along(inside_two, one), 1, atol=1e-13)


def fan(heights: list[float], radius: list[float]) -> Mesh:
    """A star about the origin."""
    n = len(heights)
    t = TURN * np.arange(n) / n
    rim = np.stack([radius * np.cos(t), radius * np.sin(t), heights], axis=1)
    ring = np.arange(n) + 1
    return mesh(np.vstack([[0, 0, 0], rim]), np.stack([0 * ring, ring, np.roll(ring, -1)], axis=1))


def test_a_saddle_is_convex_along_y() -> None:
    """z = x² − y² seen from above is convex along y."""
    given = fan([1, 0, -1, 0, 1, 0, -1, 0], [1, 2**0.5] * 4)
    for shape, turn in ((given, np.eye(3)), (turned(given), meshes.rotation())):
        one, two = directions(shape)
        np.testing.assert_allclose(along(one[:1], turn[None, :, 1]), 1, atol=1e-14)
        np.testing.assert_allclose(along(two[:1], turn[None, :, 0]), 1, atol=1e-14)


def test_the_largest_component_is_positive() -> None:
    """The largest component is positive."""
    one, two = directions(meshes.torus())
    for found in (one, two):
        largest = np.abs(found).argmax(axis=1)
        assert (found[np.arange(len(found)), largest] > 0).all()


def test_a_billionth_more_bend_decides() -> None:
    """A billionth more bent along x than along y."""
    low = -1 - 1e-9
    one, _ = directions(fan([low, -1, -1, -1, low, -1, -1, -1], [1.0] * 8))
    np.testing.assert_allclose(along(one[:1], np.array([[1.0, 0, 0]])), 1, atol=1e-6)


def test_directions_are_null_where_undefined() -> None:
    """At umbilics, in planes, without an orientation, and where an edge has no dihedral angle."""
    for heights in ([-1.0] * 5, [0.0] * 6):
        for given in (fan(heights, [1.0] * len(heights)), turned(fan(heights, [1.0] * len(heights)))):
            assert np.isnan(directions(given)[0]).all()
    assert np.isnan(directions(meshes.klein_bottle())[0]).all()
    surface = meshes.grid().surface()
    np.testing.assert_array_equal(np.isnan(directions(meshes.grid())[0][:, 0]), surface.boundary)
    flat = fan([0, 1, 1, 0.5, 2, 0], [1.0] * 6)
    flat.points[2] = 2 * flat.points[1]
    assert np.isnan(directions(flat)[0]).all()

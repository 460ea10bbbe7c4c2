"""Displayed vertices of a surface: vertices of the file, in their places."""

from __future__ import annotations

import numpy as np
import pytest

from curvcli.mesh.surface import Surface
from curvcli.output.html.display import Display, simplified, whole
from tests.helpers.meshes import Mesh, grid, mesh, of_sample, tetrahedron


def sound(display: Display, surface: Surface) -> None:
    vertices, faces = display.vertices, display.faces
    assert (np.diff(vertices) > 0).all()
    assert surface.referenced[vertices].all()
    assert faces.min() >= 0
    assert faces.max() < len(vertices)
    assert (faces != np.roll(faces, 1, axis=1)).all()
    for lines, kind in ((display.boundary, surface.boundary), (display.crowded, surface.nonmanifold_ends)):
        assert (lines[:, 0] != lines[:, 1]).all()
        if display.whole:
            assert kind[vertices[lines]].all()


@pytest.mark.parametrize("name", ["torus", "book", "mobius", "two_components"])
def test_all_of_a_small_surface(name: str) -> None:
    surface = of_sample(name).surface()
    display = whole(surface)
    sound(display, surface)
    assert display.whole
    np.testing.assert_array_equal(display.vertices[display.faces], surface.faces)
    assert len(display.boundary) == surface.boundary_edges.sum()
    assert len(display.crowded) == surface.nonmanifold_edges.sum()


def test_vertices_without_faces_are_left_out() -> None:
    plain = tetrahedron()
    points = np.concatenate([[[9.0, 9.0, 9.0]], plain.points, [[np.nan, 0.0, 0.0]]])
    surface = Mesh(points, plain.faces + np.int32(1)).surface()
    display = whole(surface)
    assert display.vertices.tolist() == [1, 2, 3, 4]
    np.testing.assert_array_equal(display.vertices[display.faces], surface.faces)


@pytest.mark.parametrize("most", [100, 1000, 4000])
@pytest.mark.parametrize("name", ["torus", "cylinder", "mobius"])
def test_near_to_as_many_as_allowed(name: str, most: int) -> None:
    surface = of_sample(name, size=8000).surface()
    display = simplified(surface, most)
    sound(display, surface)
    assert not display.whole
    assert most / 2 <= len(display.vertices) <= most
    assert len(display.faces) >= len(display.vertices)
    if name != "torus":
        assert len(display.boundary) > 0


@pytest.mark.parametrize("scale", [1e-200, 1e150])
def test_scale_does_not_matter(scale: float) -> None:
    plain = grid(30)
    one, other = simplified(plain.surface(), 200), simplified(plain.moved(plain.points * scale).surface(), 200)
    assert abs(len(one.vertices) - len(other.vertices)) <= 20
    sound(other, plain.surface())


def test_many_small_pieces_are_sampled() -> None:
    rng = np.random.default_rng(1)
    corners = np.repeat(rng.uniform(0, 1000, (3000, 3)), 3, axis=0) + rng.uniform(0, 1e-3, (9000, 3))
    surface = mesh(corners, np.arange(9000)).surface()
    display = simplified(surface, 600)
    sound(display, surface)
    assert len(display.faces) == 200
    assert len(display.vertices) == 600


def test_a_surface_in_one_point() -> None:
    surface = mesh(np.zeros((30, 3)), np.arange(30)).surface()
    sound(simplified(surface, 12), surface)

"""Common walls of bodies: pairs of coincident faces that face each other are found and explained."""

from __future__ import annotations

import numpy as np
import pytest

import curvcli
from curvcli.mesh.walls import facing_pairs
from curvcli.samples.assembled import boundary
from tests.helpers import meshes
from tests.helpers.gates import judged, outcome
from tests.helpers.meshes import Mesh, mesh
from tests.helpers.nests import together


def blocks(count: int, cut: int, seed: int = 0) -> Mesh:
    """Cubes in a row, each side cut into cut² squares, with common vertices; the faces in any order."""
    parts = []
    for place in range(count):
        solid = np.zeros((count, 1, 1), bool)
        solid[place] = True
        parts.append(mesh(*boundary(solid.repeat(cut, 0).repeat(cut, 1).repeat(cut, 2))))
    made, _ = together(parts, np.random.default_rng(seed))
    points, number = np.unique(made.points, axis=0, return_inverse=True)
    return Mesh(points, number.ravel()[made.faces].astype(np.int32))


@pytest.mark.parametrize(("count", "cut"), [(2, 1), (2, 3), (3, 1), (4, 2)])
def test_cubes_in_a_row(count: int, cut: int) -> None:
    made = blocks(count, cut)
    found = facing_pairs(made.surface())
    assert len(found) == 2 * cut**2 * (count - 1)
    for one, other in made.faces[found]:
        assert sorted(one.tolist()) == sorted(other.tolist())
    normals = [np.cross(*(made.points[face][1:] - made.points[face][0])) for face in made.faces[found].reshape(-1, 3)]
    np.testing.assert_array_equal(normals[::2], -np.array(normals[1::2]))
    notices = {one.code: one for one in curvcli.analyze((made.points, made.faces)).notices}
    assert notices["facing_faces"].count == len(found)
    assert notices["facing_faces"].message == "pairs of coincident faces face each other: bodies with a common wall"
    for name in ("manifold", "no-duplicate-faces"):
        told = outcome(judged(made, name), name)
        assert told.status == "fail"
        assert told.message.endswith(
            f"; {len(found)} pairs of coincident faces face each other: bodies with a common wall"
        )


def reversed_once(made: Mesh) -> Mesh:
    """The first of two cubes wound the other way."""
    first = made.points[made.faces].mean(axis=1)[:, 0] < 1
    wall = np.isclose(made.points[made.faces][:, :, 0], 1).all(axis=1)
    normal = np.cross(*(made.points[made.faces][:, k] - made.points[made.faces][:, 0] for k in (1, 2)))[:, 0]
    mine = first | (wall & (normal > 0))
    faces = made.faces.copy()
    faces[mine] = faces[mine][:, ::-1]
    return made.with_faces(faces)


def both_sides(given: Mesh) -> Mesh:
    return given.with_faces(np.vstack([given.faces, given.faces[:, ::-1]]))


@pytest.mark.parametrize(
    "make",
    [
        meshes.tetrahedron,
        meshes.book,
        lambda: both_sides(meshes.grid()),
        lambda: both_sides(meshes.tetrahedron()),
        lambda: reversed_once(blocks(2, 1)),
        lambda: meshes.grid().with_faces(np.vstack([meshes.grid().faces, meshes.grid().faces[3:5]])),
        lambda: meshes.tetrahedron().with_faces(np.vstack([meshes.tetrahedron().faces, [[0, 1, 2]]])),
    ],
)
def test_meshes_without_walls_have_no_facing_pairs(make: object) -> None:
    assert callable(make)
    surface = make().surface()
    assert not len(facing_pairs(surface))
    assert "facing_faces" not in {one.code for one in curvcli.analyze(surface).notices}

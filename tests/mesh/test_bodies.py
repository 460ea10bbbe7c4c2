"""Bodies that share vertices, edges and walls: each is taken for itself, and judged by its depth."""

from __future__ import annotations

import numpy as np
import pytest

from curvcli.mesh.bodies import split_bodies
from tests.helpers import meshes
from tests.helpers.gates import judged, outcome
from tests.helpers.meshes import Mesh
from tests.helpers.nests import box, prism, together, volume
from tests.mesh.test_solids import TOUCHING

UNIT = box([0, 0, 0], [1, 1, 1])
OTHER_DIAGONAL = box([2, 0, 0], [1, 1, 1])
BESIDE = box([1, 0, 0], [2, 1, 1])


def welded(*parts: Mesh, seed: int | None = None) -> tuple[Mesh, np.ndarray]:
    """All parts with common vertices where positions are equal, and the part of each face."""
    made, label = together(parts, None if seed is None else np.random.default_rng(seed))
    points, number = np.unique(made.points, axis=0, return_inverse=True)
    return Mesh(points, number.ravel()[made.faces].astype(np.int32)), label


PARTS = {
    "a wall": (UNIT, BESIDE),
    "a wall with two diagonals": (UNIT, OTHER_DIAGONAL),
    "an edge": (UNIT, box([1, 1, 0], [2, 2, 1])),
    "a corner": (UNIT, box([1, 1, 1], [2, 2, 2])),
    "four round an edge": tuple(box([x, y, 0], [x + 1, y + 1, 1]) for x in (0, 1) for y in (0, 1)),
    "eight round a corner": tuple(
        box([x, y, z], [x + 1, y + 1, z + 1]) for x in (0, 1) for y in (0, 1) for z in (0, 1)
    ),
    "three in a row": (UNIT, BESIDE, box([2, 0, 0], [3, 1, 1])),
    "prisms in a row": (prism(0, 1), prism(1, 2), prism(2, 4)),
    "a corner left out": (UNIT, BESIDE, box([0, 1, 0], [1, 2, 1])),
}


@pytest.mark.parametrize("turn", [0, 1, 2])
@pytest.mark.parametrize("seed", [None, 1, 2])
@pytest.mark.parametrize("name", PARTS)
def test_bodies_that_share(name: str, seed: int | None, turn: int) -> None:
    parts = PARTS[name]
    made, label = welded(*parts, seed=seed)
    if turn:
        made = made.moved(made.points @ meshes.rotation(turn).T + 10.0 * (turn - 1))
    apart = split_bodies(made.surface())
    assert apart.solids.count == len(parts)
    patch = apart.orientation.patch
    # Coincident faces of a wall may change places.
    volumes = np.bincount(patch, apart.triple_products) / 6
    assert sorted(volumes.tolist()) == pytest.approx(sorted(volume(part) for part in parts))
    assert not apart.solids.depth.any()
    assert not len(apart.solids.crossing)
    assert outcome(judged(made, "outward"), "outward").status == "pass"
    side = label[np.flatnonzero(patch == patch[0])]
    assert (side == label[0]).mean() > 0.5


@pytest.mark.parametrize("seed", range(4))
def test_the_cavity_of_a_body_with_walls(seed: int) -> None:
    cavity = box([0.25, 0.25, 0.25], [0.5, 0.5, 0.5])
    for hole, status in ((meshes.reversed_faces(cavity), "pass"), (cavity, "fail")):
        made, label = welded(UNIT, BESIDE, hole, seed=seed)
        found = outcome(judged(made, "outward"), "outward")
        assert found.status == status
        if status == "fail":
            face = np.flatnonzero(label == 2)[0]
            assert found.message.startswith(f"1 closed patch is inside out (face {face} at (")
            assert found.message.endswith(": a cavity of positive volume")


@pytest.mark.parametrize("name", ["a wall", "a wall with two diagonals", "an edge", "a corner"])
@pytest.mark.parametrize("which", [0, 1])
def test_one_of_two_is_inside_out(name: str, which: int) -> None:
    parts = list(PARTS[name])
    parts[which] = meshes.reversed_faces(parts[which])
    for way in (parts, parts[::-1]):
        made, _ = welded(*way)
        found = outcome(judged(made, "outward"), "outward")
        assert found.status == "fail"
        assert found.message.startswith("1 closed patch is inside out (face ")
        assert "body of negative volume" in found.message


def test_a_core_in_a_cavity_with_its_walls() -> None:
    outer = box([-1, -1, -1], [2, 2, 2])
    made, _ = welded(outer, meshes.reversed_faces(UNIT), UNIT)
    apart = split_bodies(made.surface())
    assert apart.solids.depth.tolist() == [0, 1, 2]
    assert outcome(judged(made, "outward"), "outward").status == "pass"


def test_nothing_to_take_apart() -> None:
    surface = meshes.icosphere().surface()
    assert split_bodies(surface) is surface
    book = meshes.book(3).surface()
    assert split_bodies(book).nonmanifold_edges.sum() == 1


@pytest.mark.parametrize("name", TOUCHING)
def test_welded_bodies_and_cavities_that_touch(name: str) -> None:
    """With the right winding they pass, with the other one they fail, in any order."""
    body, other, depth = TOUCHING[name]
    for wrong in (False, True):
        second = meshes.reversed_faces(other) if (depth[1] == 1) != wrong else other
        for parts in ((body, second), (second, body)):
            made, _ = welded(*parts)
            assert outcome(judged(made, "outward"), "outward").status == ("fail" if wrong else "pass")

"""Solids: how closed patches nest, which of them are inside out, and which cross."""

from __future__ import annotations

import math
from unittest import mock

import numpy as np
import pytest
from hypothesis import example, given, settings

import curvcli
from tests.helpers import meshes, nests, strategies
from tests.helpers.brute import Complex
from tests.helpers.gates import judged, outcome
from tests.helpers.meshes import Mesh
from tests.helpers.nests import box, prism, together

WAYS = {
    "as made": lambda p: p,
    "turned": lambda p: p @ meshes.rotation(7).T,
    "tiny": lambda p: p @ meshes.rotation(8).T * 1e-6,
    "huge": lambda p: p @ meshes.rotation(9).T * 1e6,
    "far": lambda p: p @ meshes.rotation(10).T + [1e6, -2e6, 3e6],
    "beyond squares": lambda p: p * 2.0**-200,
    "scaled": lambda p: p * [1.0, 1e-3, 1e3],
}


def judge(mesh: Mesh, orient: str = "file") -> curvcli.Analysis:
    return curvcli.analyze((mesh.points, mesh.faces), "topology", orient=orient)


def by_part(surface: curvcli.Surface, label: np.ndarray, values: np.ndarray) -> list[object]:
    """The value of the patch of each part."""
    patch = surface.orientation.patch
    return [values[patch[np.flatnonzero(label == part)[0]]].item() for part in range(label.max() + 1)]


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("seed", range(6))
def test_random_nests_are_judged_as_by_brute_force(seed: int, way: str) -> None:
    rng = np.random.default_rng(seed)
    nest = nests.random_nest(rng)
    made, label = together(nest.parts, rng)
    made = made.moved(WAYS[way](made.points))
    surface = made.surface()
    assert by_part(surface, label, surface.solids.depth) == nest.depth
    assert not len(surface.solids.crossing)
    assert by_part(surface, label, surface.inside_out) == nest.wrong
    turned = judge(made, "outward")
    scale = abs(np.linalg.det(WAYS[way](np.eye(3)) - WAYS[way](np.zeros((3, 3)))))
    assert turned.totals["volume"] == pytest.approx(nest.solid * scale, rel=1e-7)
    assert judge(turned_file(made, turned.surface)).notices == []
    # A solid whose surface has Euler characteristic χ has χ/2 itself, and ΣK = 4π χ(solid).
    spheres = sum(len(part.points) - len(part.faces) / 2 == 2 for part in nest.parts)
    assert turned.totals["K"] == pytest.approx(4 * math.pi * spheres, abs=1e-6)


def turned_file(made: Mesh, surface: curvcli.Surface) -> Mesh:
    """The mesh as its surface is oriented."""
    faces = made.faces.copy()
    if surface.orientation.face_sign is not None:
        turned = surface.orientation.face_sign < 0
        faces[turned] = faces[turned][:, ::-1]
    return made.with_faces(faces)


@pytest.mark.parametrize("seed", range(10))
def test_faces_that_are_wound_at_random(seed: int) -> None:
    """The lowest face of each patch says how the file winds it."""
    rng = np.random.default_rng(100 + seed)
    nest = nests.random_nest(rng, flip=0.0)
    made, label = together(nest.parts, rng)
    flipped = rng.random(len(made.faces)) < 0.5
    faces = made.faces.copy()
    faces[flipped] = faces[flipped][:, ::-1]
    found = made.with_faces(faces).surface("outward")
    lowest = [flipped[np.flatnonzero(label == part)[0]].item() for part in range(len(nest.parts))]
    assert by_part(found, label, found.inside_out) == lowest
    assert curvcli.analyze(found, "topology").totals["volume"] == pytest.approx(nest.solid, rel=1e-9)


UNIT = box([0, 0, 0], [1, 1, 1])
BALL = meshes.icosphere()
OCTAHEDRON = meshes.of_sample("octahedron")

# Pairs that cross, and pairs that touch with the depths of the two.
CROSSING = {
    "at a corner": (UNIT, box([0.5, 0.5, 0.5], [1.5, 1.5, 1.5])),
    "along an axis": (UNIT, box([0.5, 0, 0], [1.5, 1, 1])),
    "along an axis, from inside": (UNIT, box([0.5, 0.25, 0.25], [1.5, 0.75, 0.75])),
    "bars of one height": (box([-3, -1, -1], [3, 1, 1]), box([-1, -3, -1], [1, 3, 1])),
    "bars of two widths": (box([-3, -1, -1], [3, 1, 1]), box([-0.5, -3, -0.5], [0.5, 3, 0.5])),
    "a rod through a plate": (box([-3, -3, -1], [3, 3, 1]), box([-0.5, -0.5, -3], [0.5, 0.5, 3])),
    "only the middle of a face": (prism(0, 1), prism(0.5, 1.5)),
    "a corner that reaches just through": (UNIT, box([0.25, 0.25, 0.25], [0.75, 0.75, 1 + 1e-9])),
    "the same twice": (UNIT, UNIT),
    "the same, turned inside out": (UNIT, meshes.reversed_faces(UNIT)),
    "spheres": (BALL, BALL.moved(BALL.points + np.array([0.7, 0.1, 0.2]))),
    "a ball in a box too small": (BALL, box([-0.9, -0.9, -0.9], [0.9, 0.9, 0.9])),
}
TOUCHING = {
    "at a wall": (UNIT, box([1, 0, 0], [2, 1, 1]), [0, 0]),
    "at a part of a wall": (UNIT, box([1, 0.25, 0.25], [2, 0.5, 0.5]), [0, 0]),
    "at a wall with another diagonal": (UNIT, box([2, 0, 0], [1, 1, 1]), [0, 0]),
    "at an edge": (UNIT, box([1, 1, 0], [2, 2, 1]), [0, 0]),
    "at a part of an edge": (UNIT, box([1, 1, 0.25], [2, 2, 0.5]), [0, 0]),
    "at a corner": (UNIT, box([1, 1, 1], [2, 2, 2]), [0, 0]),
    "a corner on a face": (UNIT, OCTAHEDRON.moved(OCTAHEDRON.points / np.sqrt(0.5) + [0.5, 0.5, 2]), [0, 0]),
    "a cavity at a wall": (UNIT, box([0, 0.25, 0.25], [0.5, 0.5, 0.5]), [0, 1]),
    "a cavity at an edge": (UNIT, box([0, 0, 0.25], [0.5, 0.5, 0.5]), [0, 1]),
    "a cavity in a corner": (UNIT, box([0, 0, 0], [0.5, 0.5, 0.5]), [0, 1]),
    "a cavity from wall to wall": (UNIT, box([0, 0, 0], [0.5, 1, 1]), [0, 1]),
    "a cavity with all corners on the walls": (
        box([-1, -1, -1], [1, 1, 1]),
        OCTAHEDRON.moved(np.round(OCTAHEDRON.points / np.sqrt(0.5))),
        [0, 1],
    ),
    "prisms in a row": (prism(0, 1), prism(1, 2), [0, 0]),
    "a prism filled in part": (prism(0, 1), prism(0.25, 0.5), [0, 1]),
    "rounding apart": (UNIT, box([1 - 2**-53, 0, 0], [2, 1, 1]), [0, 0]),
}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", CROSSING)
def test_patches_that_cross(name: str, way: str) -> None:
    for flipped in (False, True):
        one, other = CROSSING[name]
        made, _ = together([meshes.reversed_faces(one) if flipped else one, other])
        made = made.moved(WAYS[way](made.points))
        if way == "far" and "just" in name:
            continue  # less than the coordinates can tell
        surface = made.surface("outward")
        assert surface.solids.crossing.tolist() == [[0, 1]]
        assert not surface.inside_out.any()
        assert surface.orientation.face_sign is None
        found = outcome(judged(made, "outward"), "outward")
        assert found.status == "fail"
        assert f"(face 0 and face {len(one.faces)})" in found.message
        notice = next(one for one in judge(made).notices if one.code == "crossing_patches")
        assert (notice.count, notice.examples) == (2, (0, len(one.faces)))


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", TOUCHING)
def test_patches_that_touch(name: str, way: str) -> None:
    one, other, depth = TOUCHING[name]
    for parts, wanted in (((one, other), depth), ((other, one), depth[::-1])):
        made, _ = together(parts)
        surface = made.moved(WAYS[way](made.points)).surface()
        assert not len(surface.solids.crossing)
        assert surface.solids.depth.tolist() == wanted


def test_patches_that_share_vertices() -> None:
    """Welded, as STL files are read: at a corner, along an edge, and a cavity in a corner."""
    for name in ("at an edge", "at a corner", "a cavity in a corner"):
        one, other, depth = TOUCHING[name]
        made, _ = together((one, other))
        points, number = np.unique(made.points, axis=0, return_inverse=True)
        surface = Mesh(points, number.ravel()[made.faces].astype(np.int32)).surface()
        assert surface.n_vertices < 16
        assert surface.solids.count == 2
        assert surface.solids.depth.tolist() == depth
        assert not len(surface.solids.crossing)


@pytest.mark.parametrize("seed", range(200))
def test_bodies_with_corners_on_a_lattice(seed: int) -> None:
    """They touch in every way there is, and rounding moves what touches when they are turned."""
    rng = np.random.default_rng(seed)
    parts = [nests.lattice_body(rng, (2, 3, 4, 6)[seed % 4]) for _ in range(3)]
    if seed % 3 == 0:  # the same body, smaller, in one of its corners
        corner = parts[0].points[0]
        parts[1] = parts[0].moved(corner + (parts[0].points - corner) * rng.choice([0.25, 0.5, 0.75]))
    depth, crossing = np.zeros(3, int), set()
    for i, j in ((0, 1), (0, 2), (1, 2)):
        cross, first, second = nests.convex_pair(parts[i], parts[j])
        if cross:
            crossing.add((i, j))
        else:
            depth[[i, j]] += first, second
    made, _ = together(parts)
    for points in (made.points, made.points @ meshes.rotation(seed).T + rng.normal(size=3)):
        solids = made.moved(points).surface().solids
        assert {tuple(pair) for pair in solids.crossing.tolist()} == crossing
        alone = [part for part in range(3) if all(part not in pair for pair in crossing)]
        assert solids.depth[alone].tolist() == depth[alone].tolist()


def test_a_core_that_fills_its_cavity() -> None:
    outer, inner = box([-1, -1, -1], [2, 2, 2]), UNIT
    for parts, depth in (
        ((outer, meshes.reversed_faces(inner), inner), [0, 1, 2]),
        ((inner, outer, meshes.reversed_faces(inner)), [2, 0, 1]),
    ):
        surface = together(parts)[0].surface()
        assert surface.solids.depth.tolist() == depth
        assert not surface.inside_out.any()
    assert together((outer, inner, inner))[0].surface().solids.crossing.tolist() == [[1, 2]]


def test_a_cavity_in_a_body_that_crosses_another() -> None:
    """It lies inside one of them, and is judged by that."""
    cavity = meshes.reversed_faces(box([0.1, 0.1, 0.1], [0.2, 0.2, 0.2]))
    parts = (UNIT, box([0.5, 0.5, 0.5], [1.5, 1.5, 1.5]), cavity)
    surface = together(parts)[0].surface()
    assert surface.solids.depth.tolist() == [0, 0, 1]
    assert not surface.inside_out.any()
    assert together((*parts[:2], meshes.reversed_faces(cavity)))[0].surface().inside_out.tolist() == [
        False,
        False,
        True,
    ]


def test_open_and_one_sided_patches_do_not_count() -> None:
    tunnel = box([-1, -1, -1], [2, 2, 2])
    tunnel = tunnel.with_faces(tunnel.faces[1:])
    bottle = meshes.klein_bottle()
    spread = bottle.moved(bottle.points * 10 / np.abs(bottle.points).max())
    for around in (tunnel, spread):
        surface = together((around, UNIT, box([0.2, 0.2, 0.2], [0.4, 0.4, 0.4])))[0].surface()
        assert surface.solids.depth.tolist() == [0, 0, 1]
        assert surface.inside_out.tolist() == [False, False, True]


@settings(max_examples=150, deadline=None)
@given(strategies.any_mesh())
@example(together([BALL, BALL.moved(BALL.points * 0.5)])[0])
def test_against_brute_force(given: Mesh) -> None:
    surface, brute = given.surface(), Complex(given)
    numbers = [n for n, patch in enumerate(brute.patches) if patch.closed and patch.orientable]
    assert np.flatnonzero(surface.solids.mask).tolist() == numbers
    corners = [given.points[given.faces[brute.patches[n].faces]] for n in numbers]
    corners = [
        np.where(np.array(brute.sign)[brute.patches[n].faces][:, None, None] < 0, each[:, ::-1], each)
        for n, each in zip(numbers, corners, strict=True)
    ]
    found = {tuple(pair) for pair in surface.solids.crossing.tolist()}
    for points_on_each in (60, 3000):  # slim overlaps take many
        depth, crossing = nests.nesting(corners, points_on_each)
        if found == {(numbers[i], numbers[j]) for i, j in crossing}:
            break
    assert found == {(numbers[i], numbers[j]) for i, j in crossing}
    assert surface.solids.depth[numbers].tolist() == depth
    crossed = {numbers[i] for pair in crossing for i in pair}
    for number, each in zip(numbers, depth, strict=True):
        size = brute.patches[number].volume * (-1) ** each
        if abs(size) > 1e-9:
            assert surface.inside_out[number] == (size < 0 and number not in crossed)


def test_of_one_patch_nothing_is_asked() -> None:
    with mock.patch("curvcli.mesh.solids.nesting.nest", side_effect=AssertionError):
        assert curvcli.analyze((BALL.points, BALL.faces), orient="outward").notices == []


def test_a_flat_patch_that_crosses_a_body() -> None:
    """Two triangles back to back have no volume and no thickness, and still cross."""
    sheet = meshes.mesh([[0.5, 0.5, 0.5], [2, 0.5, 0.5], [2, 0.8, 0.5]], [[0, 1, 2], [0, 2, 1]])
    surface = together([UNIT, sheet])[0].surface()
    assert surface.solids.crossing.tolist() == [[0, 1]]
    assert not surface.inside_out.any()

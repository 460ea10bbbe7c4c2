"""Parallel transport in simplicial manifolds, and that its holonomy about a hinge is the rotation by the defect."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from curvcli.analysis.polyhedral import PolyhedralManifold
from curvcli.errors import UsageError
from tests.helpers.meshes import cap, fan, of_sample
from tests.helpers.simplicial import cross_polytope

seeds = st.integers(0, 2**32 - 1)


def random_manifold(seed: int) -> PolyhedralManifold:
    points, cells = cross_polytope(3)
    rng = np.random.default_rng(seed)
    rows = np.array([rng.permutation(cell) for cell in cells])[rng.permutation(len(cells))]
    return PolyhedralManifold(points + rng.uniform(-0.2, 0.2, points.shape), rows)


@given(seeds)
def test_transport_is_a_rotation_between_frames(seed: int) -> None:
    manifold = random_manifold(seed)
    frames, (one, other) = manifold.frames, manifold.ridge_simplices.T
    np.testing.assert_allclose(frames @ frames.swapaxes(1, 2), np.tile(np.eye(3), (16, 1, 1)), atol=1e-14)
    edges = manifold.points[manifold.simplices[:, 1:]] - manifold.points[manifold.simplices[:, :1]]
    assert (np.linalg.det(edges @ frames.swapaxes(1, 2)) > 0).all()
    turn = manifold.rotations
    np.testing.assert_allclose(turn @ turn.swapaxes(1, 2), np.tile(np.eye(3), (len(turn), 1, 1)), atol=1e-13)
    # What lies in the ridge stays where it is.
    corner = manifold.points[manifold.ridges]
    within = corner[:, 1:] - corner[:, :1]
    moved = within @ frames[one].swapaxes(1, 2) @ turn.swapaxes(1, 2) @ frames[other]
    np.testing.assert_allclose(moved, within, atol=1e-13)
    # The neighbour's far corner unfolds to the other side of the ridge.
    for here, there, step, ridge in zip(one, other, turn, manifold.ridges, strict=True):
        near, far = (np.setdiff1d(manifold.simplices[c], ridge)[0] for c in (here, there))
        base = manifold.points[ridge[0]]
        unfolded = step.T @ frames[there] @ (manifold.points[far] - base)
        ours = frames[here] @ (manifold.points[near] - base)
        flat = frames[here] @ within[np.flatnonzero((manifold.ridges == ridge).all(axis=1))[0]].T
        sides = [np.linalg.det(np.column_stack([flat, side])) for side in (ours, unfolded)]
        assert sides[0] * sides[1] < 0


@given(seeds)
def test_holonomy_is_a_rotation_about_the_hinge_by_its_defect(seed: int) -> None:
    manifold = random_manifold(seed)
    assert manifold.check().status == "pass"
    holonomy, (a, b) = manifold.holonomy, manifold.points[manifold.hinges].swapaxes(0, 1)
    np.testing.assert_allclose(np.linalg.det(holonomy), 1, atol=1e-13)
    np.testing.assert_allclose(np.trace(holonomy, axis1=1, axis2=2), 1 + 2 * np.cos(manifold.defect), atol=1e-13)
    lowest = np.array(
        [np.flatnonzero(np.isin(manifold.simplices, hinge).sum(axis=1) == 2)[0] for hinge in manifold.hinges]
    )
    along = (manifold.frames[lowest] @ (b - a)[:, :, None])[:, :, 0]
    np.testing.assert_allclose((holonomy @ along[:, :, None])[:, :, 0], along, atol=1e-13)
    # Counterclockwise about the edge as the simplex is oriented: a right-handed rotation about b − a.
    axis = along / np.linalg.norm(along, axis=1)[:, None]
    skew = holonomy - holonomy.swapaxes(1, 2)
    sine = np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=1) / 2
    np.testing.assert_allclose((sine * axis).sum(axis=1), np.sin(manifold.defect), atol=1e-13)


def test_parallel_transport_round_a_vertex_turns_counterclockwise_by_K() -> None:
    mesh = of_sample("octahedron")
    manifold = PolyhedralManifold(*mesh)
    top = int(np.argmax(mesh.points[:, 2]))
    faces = np.flatnonzero((mesh.faces == top).any(axis=1))
    middle = mesh.points[mesh.faces[faces]].mean(axis=1)
    path = faces[np.argsort(np.arctan2(middle[:, 1], middle[:, 0]))].tolist()
    edges = np.diff(mesh.points[mesh.faces[path[0]]], axis=0)
    nu = np.cross(*edges)
    nu /= np.linalg.norm(nu)
    vectors = np.vstack([edges, nu])
    moved = manifold.parallel_transport(vectors, [*path, path[0]])
    K = 2 * np.pi / 3
    np.testing.assert_allclose(moved[:2], np.cos(K) * edges + np.sin(K) * np.cross(nu, edges), atol=1e-14)
    np.testing.assert_allclose(moved[2], 0, atol=1e-14)
    back = manifold.parallel_transport(moved[:2], [path[0], *path[::-1]])
    np.testing.assert_allclose(back, edges, atol=1e-14)
    np.testing.assert_allclose(manifold.holonomy_angle, K, atol=1e-14)
    np.testing.assert_array_equal(manifold.transport([3]), np.eye(2))


def test_defects_beyond_a_half_turn() -> None:
    """Sharp apexes turn by nearly 2π, saddles by more than a turn backwards; holonomy sees both modulo 2π."""
    for mesh in (fan(3, 0.0), fan(40, 6.0)):
        points = mesh.points.copy()
        if len(points) == 4:
            points[0, 2] = 9.0
        manifold = PolyhedralManifold(points, mesh.faces)
        defect = manifold.defect[0]
        assert defect > np.pi or defect < -2 * np.pi
        assert manifold.holonomy_angle[0] == pytest.approx(np.remainder(defect + np.pi, 2 * np.pi) - np.pi, abs=1e-12)
        assert manifold.check().status == "pass"


def test_a_disturbed_holonomy_fails() -> None:
    manifold = PolyhedralManifold(*cross_polytope(3))
    defect = manifold.defect.copy()
    assert manifold.check().status == "pass"
    for wrong in (1e-12, np.nan):
        disturbed = PolyhedralManifold(*cross_polytope(3))
        defect[5] += wrong
        disturbed.__dict__["defect"] = defect
        assert disturbed.check().status == "fail"


def test_paths_that_are_none() -> None:
    manifold = PolyhedralManifold(*cap())
    far = int(np.flatnonzero(~np.isin(manifold.simplices, manifold.simplices[0]).any(axis=1))[0])
    for path in ([0, far], [0, 0], [0, -1], [len(manifold.simplices)], []):
        with pytest.raises(UsageError):
            manifold.transport(path)

"""Frenet and parallel frames, torsion and holonomy."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from curvcli.curves import Curve, normal_basis, normal_holonomy
from curvcli.errors import InputError, UsageError
from tests.curves.shapes import helix, random_polygon, regular, rotation, trefoil

TURN = 2 * np.pi


def apart(one: float, other: float) -> float:
    """Distance of two angles mod 2π."""
    return abs((one - other + np.pi) % TURN - np.pi)


def test_a_helix_has_constant_turning_and_torsion() -> None:
    step, rise = 0.3, 0.1
    curve = Curve(helix(30, step, rise))
    # Edges make a constant angle with the axis and turn about it by `step`.
    slope = np.arctan2(rise, 2 * np.sin(step / 2))
    cosine = np.sin(slope) ** 2 + np.cos(slope) ** 2 * np.cos(step)
    np.testing.assert_allclose(curve.turning[1:-1], np.arccos(cosine), rtol=1e-12)
    torsion = curve.torsion
    assert np.isnan(torsion[[0, 28, 29]]).all()
    # tan(τ/2) = tan(step/2) sin(slope) for the binormals of consecutive vertices of a helix.
    np.testing.assert_allclose(torsion[1:28], 2 * np.arctan(np.tan(step / 2) * np.sin(slope)), rtol=1e-12)
    assert (Curve(helix(30, step, -rise)).torsion[1:28] < 0).all()


def test_frenet_frame_is_orthonormal_and_right_handed() -> None:
    curve = Curve(random_polygon(3, 60), closed=True)
    tangent, normal, binormal = curve.frenet
    frames = np.stack([tangent, normal, binormal], axis=1)
    np.testing.assert_allclose(frames @ frames.transpose(0, 2, 1), np.eye(3)[None].repeat(60, 0), atol=1e-13)
    np.testing.assert_allclose(np.linalg.det(frames), 1, atol=1e-13)
    assert (np.einsum("ij,ij->i", normal, curve.curvature_vectors) > 0).all()


def test_straight_vertices_have_no_binormal() -> None:
    points = np.array([[0, 0, 0], [1, 0.5, 0.25], [2, 1, 0.5], [2, 3, 0.5], [0, 3, 1]])
    curve = Curve(points, closed=True)
    assert np.isnan(curve.frenet[2][1]).all()
    assert np.isnan(curve.torsion[[0, 1]]).all()
    assert np.isfinite(curve.torsion[2:]).all()
    assert np.isfinite(curve.bishop[1]).all()


def test_plane_curves_have_no_torsion_but_half_turns() -> None:
    torsion = Curve(regular(9) @ rotation(3).T, closed=True).torsion
    np.testing.assert_allclose(torsion, 0, atol=1e-14)


def test_parallel_frame_is_orthonormal_and_does_not_twist() -> None:
    curve = Curve(random_polygon(11, 40))
    tangent, u, v = (frame[:-1] for frame in curve.bishop)
    frames = np.stack([tangent, u, v], axis=1)
    np.testing.assert_allclose(frames @ frames.transpose(0, 2, 1), np.eye(3)[None].repeat(39, 0), atol=1e-13)
    for i in range(38):
        # The rotation from one edge's frame to the next's has its axis normal to both edges.
        turn = frames[i + 1].T @ frames[i]
        axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
        np.testing.assert_allclose(axis @ tangent[[i, i + 1]].T, 0, atol=1e-13)


@given(st.integers(0, 10**6), st.integers(3, 40))
@settings(max_examples=40, deadline=None)
def test_holonomy_is_the_writhe_in_radians(seed: int, n: int) -> None:
    curve = Curve(random_polygon(seed, n), closed=True)
    assert curve.holonomy is not None
    assert apart(curve.holonomy, TURN * curve.writhe()) < 1e-9


def test_holonomy_of_smooth_knots() -> None:
    curve = Curve(trefoil(300), closed=True)
    assert curve.holonomy is not None
    assert apart(curve.holonomy, TURN * curve.writhe()) < 1e-12


def test_holonomy_adds_up_the_torsion() -> None:
    curve = Curve(random_polygon(21, 30), closed=True)
    # The Frenet frame is another frame: what it turns against the parallel one round the curve is its torsion.
    assert curve.holonomy is not None
    assert apart(curve.holonomy, -float(curve.torsion.sum())) < 1e-12


@given(st.integers(0, 10**6), st.integers(3, 30), st.integers(3, 6))
@settings(max_examples=40, deadline=None)
def test_normal_holonomy_is_a_rotation(seed: int, n: int, d: int) -> None:
    found = normal_holonomy(random_polygon(seed, n, d))
    assert found.shape == (d - 1, d - 1)
    np.testing.assert_allclose(found @ found.T, np.eye(d - 1), atol=1e-9)
    assert np.linalg.det(found) == pytest.approx(1, abs=1e-9)


def test_normal_holonomy_in_space_is_the_angle() -> None:
    for seed in range(20):
        points = random_polygon(seed, 15)
        angle = Curve(points, closed=True).holonomy
        assert angle is not None
        expected = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        np.testing.assert_allclose(normal_holonomy(points), expected, atol=1e-12)


def test_normal_holonomy_in_higher_space_extends_that_in_space() -> None:
    points = random_polygon(2, 15)
    inside = normal_holonomy(points)
    flat = np.hstack([points, np.zeros((15, 2))]) @ rotation(7, 5).T
    found = normal_holonomy(flat)
    # Up to conjugation: the same rotation, and two more directions that stay.
    assert np.trace(found) == pytest.approx(np.trace(inside) + 2, abs=1e-12)
    np.testing.assert_allclose(
        np.sort(np.linalg.eigvals(found).real), np.sort([*np.linalg.eigvals(inside).real, 1, 1]), atol=1e-7
    )


def test_normal_holonomy_against_rotations_edge_by_edge() -> None:
    points = random_polygon(13, 12, 4)
    edges = np.roll(points, -1, axis=0) - points
    tangents = edges / np.linalg.norm(edges, axis=1)[:, None]
    basis = normal_basis(tangents[0])
    np.testing.assert_allclose(np.linalg.det(np.column_stack([tangents[0], basis])), 1, atol=1e-13)
    carried = basis.copy()
    for a, b in zip(tangents, np.roll(tangents, -1, axis=0), strict=True):
        # Within the plane of a and b turn by the angle between them; leave the rest.
        w = b - a * (a @ b)
        w /= np.linalg.norm(w)
        psi = np.arctan2(w @ b, a @ b)
        x, y = a @ carried, w @ carried
        carried += np.outer(a, (np.cos(psi) - 1) * x - np.sin(psi) * y)
        carried += np.outer(w, np.sin(psi) * x + (np.cos(psi) - 1) * y)
    np.testing.assert_allclose(normal_holonomy(points), basis.T @ carried, atol=1e-12)


def test_many_edges_are_multiplied_in_blocks() -> None:
    points = trefoil(9001)
    angle = Curve(points, closed=True).holonomy
    assert angle is not None
    found = normal_holonomy(points)
    assert apart(float(np.arctan2(found[1, 0], found[0, 0])), angle) < 1e-10


def test_transport_is_undefined_where_a_curve_turns_back() -> None:
    there_and_back = np.array([[0, 0, 0], [1, 1, 1], [2, 2, 2.5], [1, 1, 1]])
    assert np.isnan(normal_holonomy(there_and_back)).all()
    assert Curve(there_and_back, closed=True).holonomy is None


def test_normal_holonomy_needs_a_closed_curve_in_space() -> None:
    with pytest.raises(InputError):
        normal_holonomy(random_polygon(1, 5, 2))
    with pytest.raises(InputError):
        normal_holonomy(np.ones((4, 3)))
    with pytest.raises(UsageError, match="open"):
        Curve(helix(5)).normal_holonomy()

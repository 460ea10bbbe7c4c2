"""Curvature of simplicial manifolds: regular polytopes, flat pieces, surfaces, dihedral angles, and what is refused."""

from __future__ import annotations

from itertools import combinations, permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import curvcli
from curvcli.analysis.polyhedral import PolyhedralManifold
from curvcli.errors import InputError
from tests.helpers.meshes import Mesh, zoo
from tests.helpers.simplicial import (
    Floats,
    Simplices,
    cell_600,
    cross_polytope,
    grid_cube,
    simplex_boundary,
    tesseract_boundary,
)
from tests.helpers.strategies import closed

seeds = st.integers(0, 2**32 - 1)


@pytest.mark.parametrize(
    ("polytope", "cells", "edges", "around"),
    [(simplex_boundary(3), 5, 10, 3), (cross_polytope(3), 16, 24, 4), (cell_600(), 600, 720, 5)],
    ids=["5-cell", "16-cell", "600-cell"],
)
def test_regular_polytopes_have_known_defects(
    polytope: tuple[Floats, Simplices], cells: int, edges: int, around: int
) -> None:
    manifold = PolyhedralManifold(*polytope)
    assert len(manifold.simplices) == cells
    assert len(manifold.hinges) == edges
    assert set(manifold.valence) == {around}
    assert not manifold.boundary.any()
    expected = 2 * np.pi - around * np.arccos(1 / 3)
    np.testing.assert_allclose(manifold.defect, expected, rtol=0, atol=1e-14)
    np.testing.assert_allclose(manifold.holonomy_angle, expected, rtol=0, atol=1e-14)
    assert manifold.check().status == "pass"


@pytest.mark.parametrize("n", [2, 4, 5])
def test_simplices_and_cross_polytopes_of_other_dimensions(n: int) -> None:
    for polytope, around in ((simplex_boundary(n), 3), (cross_polytope(n), 4)):
        manifold = PolyhedralManifold(*polytope)
        np.testing.assert_allclose(manifold.defect, 2 * np.pi - around * np.arccos(1 / n), rtol=0, atol=1e-14)
        assert manifold.check().status == "pass"


def test_the_tesseract_bends_at_its_edges_alone() -> None:
    manifold = PolyhedralManifold(*tesseract_boundary())
    assert len(manifold.simplices) == 48
    differ = np.array([bin(a ^ b).count("1") for a, b in manifold.hinges])
    assert np.bincount(differ).tolist() == [0, 32, 24, 8]
    np.testing.assert_allclose(manifold.defect, np.where(differ == 1, np.pi / 2, 0.0), rtol=0, atol=1e-14)
    np.testing.assert_allclose(manifold.holonomy_angle, np.where(differ == 1, np.pi / 2, 0.0), rtol=0, atol=1e-14)


@given(seeds, st.sampled_from([3, 5]), st.sampled_from([1e-9, 1.0, 1e9, 1e-200, 1e200]))
def test_flat_pieces_have_no_curvature(seed: int, d: int, scale: float) -> None:
    points, cells = grid_cube(2)
    rng = np.random.default_rng(seed)
    inner = (points > 0).all(axis=1) & (points < 2).all(axis=1)
    points[inner] += rng.uniform(-0.2, 0.2, (np.count_nonzero(inner), 3))
    turn = np.linalg.qr(rng.normal(size=(d, 3)))[0]
    manifold = PolyhedralManifold((points @ turn.T + rng.normal(size=d)) * scale, cells)
    inside = ~manifold.boundary
    assert 0 < np.count_nonzero(inside) < len(manifold.hinges)
    np.testing.assert_allclose(manifold.defect[inside], 0, atol=1e-13)
    np.testing.assert_allclose(manifold.holonomy[inside], np.tile(np.eye(3), (inside.sum(), 1, 1)), atol=1e-13)
    # Within the square faces the boundary does not turn; at the twelve edges of the cube it turns by a right angle.
    original = points[manifold.hinges]
    at_corner = (np.isin(original, (0, 2)).all(axis=1) & (original[:, 0] == original[:, 1])).sum(axis=1) == 2
    turning = manifold.defect[manifold.boundary]
    np.testing.assert_allclose(turning, np.where(at_corner[manifold.boundary], np.pi / 2, 0), atol=1e-13)
    assert np.isnan(manifold.holonomy_angle[manifold.boundary]).all()


# ---------------------------------------------------------------------------- surfaces


@pytest.mark.parametrize(
    "name", ["tetrahedron", "grid", "torus", "ellipsoid", "cap", "mobius", "klein_bottle", "two_bodies"]
)
def test_surfaces_have_their_angle_defects(name: str) -> None:
    mesh = zoo(name)
    manifold = PolyhedralManifold(*mesh)
    known = curvcli.analyze(mesh.surface()).vertices
    vertex = manifold.hinges[:, 0]
    np.testing.assert_array_equal(manifold.boundary, mesh.surface().boundary[vertex])
    expected = np.where(manifold.boundary, known["kappa_g"][vertex], known["K"][vertex])
    np.testing.assert_allclose(manifold.defect, expected, rtol=0, atol=1e-13)
    assert manifold.check().status == "pass"


def test_flat_torus_in_four_dimensions() -> None:
    """A product of two regular polygons: every vertex is that of four rectangles."""
    m, n = 7, 5
    i, j = np.meshgrid(np.arange(m), np.arange(n), indexing="ij")
    u, v = 2 * np.pi * i / m, 2 * np.pi * j / n
    points = np.stack([np.cos(u), np.sin(u), 3 * np.cos(v), 3 * np.sin(v)], axis=2).reshape(-1, 4)
    a, b = (i * n + j).ravel(), ((i + 1) % m * n + j).ravel()
    c, d = ((i + 1) % m * n + (j + 1) % n).ravel(), (i * n + (j + 1) % n).ravel()
    manifold = PolyhedralManifold(points, np.vstack([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]))
    np.testing.assert_allclose(manifold.defect, 0, atol=1e-14)
    assert manifold.check().status == "pass"


@given(closed(), seeds)
def test_order_of_corners_and_simplices_does_not_matter(mesh: Mesh, seed: int) -> None:
    rng = np.random.default_rng(seed)
    one = PolyhedralManifold(*mesh)
    rows = rng.permuted(mesh.faces, axis=1)[rng.permutation(len(mesh.faces))]
    other = PolyhedralManifold(mesh.points, rows)
    np.testing.assert_array_equal(one.hinges, other.hinges)
    np.testing.assert_allclose(one.defect, other.defect, rtol=0, atol=1e-11)
    assert other.check().status == "pass"


# ---------------------------------------------------------------------------- dihedral angles


def test_dihedral_angles_stand_where_their_corners_stand() -> None:
    """A corner of a cube with legs 1, 1 and 2."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 2]])
    for order in permutations(range(4)):
        manifold = PolyhedralManifold(points, [order])
        place = np.argsort(order)
        angle = manifold.dihedral[0][np.ix_(place, place)]
        # At the edge opposite corners i and j: the legs, then the edges of the oblique face.
        assert angle[1, 2] == angle[2, 1] == pytest.approx(np.pi / 2, abs=1e-15)
        assert angle[0, 3] == pytest.approx(np.arctan(2 * np.sqrt(2)), abs=1e-15)
        assert angle[0, 1] == pytest.approx(np.arccos(2 / 3), abs=1e-15)
        assert angle[0, 2] == pytest.approx(np.arccos(2 / 3), abs=1e-15)
        np.testing.assert_allclose(manifold.defect, np.pi - manifold.angle_sum, atol=0)
        assert np.isnan(np.diagonal(angle)).all()
        assert manifold.check().status == "not_applicable"


@pytest.mark.parametrize("thin", [1e-3, 1e-6, 1e-9])
def test_needles_keep_their_digits(thin: float) -> None:
    """Two far pairs of close points: the angles are those of the same tetrahedron seen in 60 digits."""
    import mpmath as mp  # type: ignore[import-untyped]

    points = np.array([[0, 0, 0], [thin, 0, 0], [0.25, 0, 1], [0.25, thin, 1]])
    with mp.workdps(60):
        exact = [[mp.mpf(float(x)) for x in point] for point in points]

        def minus(p: list[mp.mpf], q: list[mp.mpf]) -> mp.matrix:
            return mp.matrix([x - y for x, y in zip(p, q, strict=True)])

        def across(i: int, j: int) -> float:
            a, b = (exact[k] for k in range(4) if k not in (i, j))
            axis = minus(b, a)
            sides = []
            for k in (i, j):
                side = minus(exact[k], a)
                sides.append(side - axis * ((side.T * axis)[0] / (axis.T * axis)[0]))
            return float(mp.acos((sides[0].T * sides[1])[0] / (mp.norm(sides[0]) * mp.norm(sides[1]))))

        expected = {(i, j): across(i, j) for i, j in combinations(range(4), 2)}
    angle = PolyhedralManifold(points, [[2, 0, 3, 1]]).dihedral[0]
    place = [1, 3, 0, 2]
    for (i, j), value in expected.items():
        assert angle[place[i], place[j]] == pytest.approx(value, abs=2e-15)


# ---------------------------------------------------------------------------- what is refused


def test_what_is_no_manifold_is_refused() -> None:
    points = np.vstack([np.eye(3), -np.eye(3), np.ones((1, 3))])
    square = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1]])
    two_fans = [(0, 1, 2), (0, 2, 3), (0, 4, 5)]
    for vertices, simplices, message in (
        (points, [(0, 1, 2), (0, 1, 3), (0, 1, 4)], r"ridge \(0, 1\): belongs to 3 simplices \(first 0, 1, 2\)"),
        (points, two_fans, r"face \(0\): its simplices are not one cycle or one path"),
        (points, [(0, 1, 1)], "simplex 0: has a repeated corner"),
        (points, [(0, 1, 2), (2, 0, 1)], "simplex 1: is listed twice"),
        (points, [(0, 1, 7)], "simplex 0: corner 7 does not exist, expected a vertex index from 0 to 6"),
        (points, [(0, -1, 2)], "corner -1 does not exist"),
        (points, [(0, 1)], "n ≥ 2"),
        (points, [(0.0, 1.0, 2.0)], "expected indices"),
        (points, [(0, 1, 2, 3, 4)], r"do not fit into E\^3"),
        (points[0], [(0, 1, 2)], "expected numbers of shape"),
        (points * np.nan, [(0, 1, 2)], "vertex 0: coordinates are not finite"),
        (square, [(0, 1, 2, 3)], r"simplex 0: \(0, 1, 2, 3\) is degenerate"),
        (square, [(0, 1, 2, 4), (1, 2, 3, 4), (0, 1, 2, 3)], "simplex 2"),
        (np.zeros((3, 3)), [(0, 1, 2)], "degenerate"),
        (np.array([[0.1, 0.1], [0.2, 0.2], [0.3, 0.3]]), [(0, 1, 2)], "degenerate"),
    ):
        with pytest.raises(InputError, match=message) as caught:
            PolyhedralManifold(vertices, simplices)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["pinched", "book"])
def test_surfaces_that_are_no_manifold(name: str) -> None:
    with pytest.raises(InputError, match="manifold"):
        PolyhedralManifold(*zoo(name))

"""Boundary curves against a walk from edge to edge, on healthy, torn, glued and arbitrary surfaces."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings

from curvcli import analyze
from curvcli.curves import Boundary, boundary_loops, loop_table
from curvcli.curves.darboux import Darboux
from tests.helpers import meshes, strategies
from tests.helpers.brute import Complex
from tests.helpers.meshes import Mesh, mesh


def walked(boundary: Boundary) -> list[list[tuple[int, int]]]:
    """The directed edges of each curve."""
    found = []
    for k, closed in enumerate(boundary.closed):
        corner = boundary.vertex[boundary.start[k] : boundary.start[k + 1]].tolist()
        found.append(list(zip(corner, corner[1:] + corner[:1] if closed else corner[1:], strict=False)))
    return found


def fan(faces: list[list[int]], edge: tuple[int, int], vertex: int) -> tuple[set[int], list[frozenset[int]]]:
    """The faces round a vertex from the one face at an edge on, and the edge with many faces that may end them."""
    beside: dict[frozenset[int], list[int]] = {}
    for f, corners in enumerate(faces):
        for k in range(3):
            beside.setdefault(frozenset((corners[k], corners[k - 1])), []).append(f)
    here = frozenset(edge)
    (face,) = beside[here]
    seen = {face}
    while True:
        (there,) = (
            e
            for e in map(frozenset, ((faces[face][k], faces[face][k - 1]) for k in range(3)))
            if vertex in e and e != here
        )
        if len(beside[there]) != 2:
            return seen, [there] if len(beside[there]) > 2 else []
        (face,) = (f for f in beside[there] if f != face)
        seen.add(face)
        here = there


@given(strategies.any_mesh())
@settings(max_examples=150, deadline=None)
def test_every_boundary_edge_is_run_along_once_and_curves_follow_fans(given_mesh: Mesh) -> None:
    surface = given_mesh.surface()
    boundary = boundary_loops(surface)
    curves = walked(boundary)
    faces = surface.faces.tolist()
    count = Counter(frozenset((c[k], c[k - 1])) for c in faces for k in range(3))
    run = Counter(frozenset(edge) for curve in curves for edge in curve)
    assert run == Counter(edge for edge, n in count.items() if n == 1)
    for curve, closed in zip(curves, boundary.closed, strict=True):
        for (a, b), (c, d) in zip(curve, curve[1:] + curve[:1] if closed else curve[1:], strict=False):
            assert b == c
            assert fan(faces, (a, b), b)[0] == fan(faces, (c, d), b)[0]
        if not closed:
            # A curve ends only where its fan runs into an edge with more than two faces.
            assert fan(faces, curve[0], curve[0][0])[1]
            assert fan(faces, curve[-1], curve[-1][1])[1]
    for k, curve in enumerate(curves):
        for (a, b), half_edge, forward in zip(
            curve, boundary.half_edge[boundary.start[k] :], boundary.forward[boundary.start[k] :], strict=False
        ):
            f, side = divmod(int(half_edge), 3)
            assert (faces[f][side], faces[f][(side + 1) % 3]) == ((a, b) if forward else (b, a))
            patch = surface.orientation.patch[f]
            if surface.orientation.orientable[patch]:
                sign = surface.orientation.face_sign
                assert forward == (sign is None or sign[f] > 0), "the surface lies on the left"


@given(strategies.any_mesh())
@settings(max_examples=100, deadline=None)
def test_loops_of_manifolds_are_closed_and_counted(given_mesh: Mesh) -> None:
    surface = given_mesh.surface()
    loops = Complex(given_mesh).facts()["boundary_loops"]
    boundary = boundary_loops(surface)
    if surface.is_manifold:
        assert boundary.closed.all()
        assert len(boundary.closed) == loops
    for k in np.flatnonzero(boundary.closed):
        corner = boundary.vertex[boundary.start[k] : boundary.start[k + 1]]
        assert corner[0] == corner.min(), "closed curves begin with their lowest vertex"


@given(strategies.any_mesh())
@settings(max_examples=100, deadline=None)
def test_geodesic_curvature_is_that_of_the_surface(given_mesh: Mesh) -> None:
    analysis = analyze(given_mesh.surface(), "core")
    boundary = boundary_loops(analysis.surface)
    kappa_g = Darboux(boundary).kappa_g
    regular = boundary.curves.inner & ~analysis.surface.nonmanifold[boundary.vertex]
    np.testing.assert_allclose(kappa_g[regular], analysis.vertices["kappa_g"][boundary.vertex[regular]], atol=1e-13)
    if analysis.surface.is_manifold and boundary.closed.any():
        table = loop_table(analysis.surface)
        assert table["sum_kappa_g"].sum() == pytest.approx(analysis.totals["kappa_g"], abs=1e-11)
        force = [table[f"force_{axis}"].sum() for axis in "xyz"]
        if analysis.totals["H_vec"] is not None and not np.isnan(force).any():
            np.testing.assert_allclose(force, analysis.totals["H_vec"], atol=1e-11)


def test_fans_that_touch_keep_a_boundary_each() -> None:
    # Two triangles that share a vertex: two loops that pass through it, not one figure eight.
    bow = mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [-1, 0, 0], [-1, -1, 0]], [[0, 1, 2], [0, 3, 4]])
    boundary = boundary_loops(bow.surface())
    assert [boundary.vertex[a:b].tolist() for a, b in zip(boundary.start, boundary.start[1:], strict=False)] == [
        [0, 1, 2],
        [0, 3, 4],
    ]
    np.testing.assert_allclose(loop_table(bow.surface())["sum_kappa_g"], 2 * np.pi, rtol=1e-14)


def test_curves_end_at_edges_with_many_faces() -> None:
    boundary = boundary_loops(meshes.book(3).surface())
    assert not boundary.closed.any()
    ends = {
        (int(boundary.vertex[a]), int(boundary.vertex[b - 1]))
        for a, b in zip(boundary.start, boundary.start[1:], strict=False)
    }
    assert ends == {(0, 1), (1, 0)} or ends in ({(0, 1)}, {(1, 0)})
    table = loop_table(meshes.book(3).surface())
    assert len(table["loop"]) == 3
    assert np.isnan(table["vector_area_x"]).all()
    assert np.isnan(table["holonomy"]).all()
    assert np.isfinite(table["force_x"]).all()


def test_a_closed_surface_has_none() -> None:
    boundary = boundary_loops(meshes.tetrahedron().surface())
    assert len(boundary.closed) == 0
    assert all(len(column) == 0 for column in loop_table(meshes.tetrahedron().surface()).values())


def test_relabelling_faces_and_turning_the_winding_changes_no_loop() -> None:
    base = meshes.grid(5)
    table = loop_table(base.surface())
    shuffled = base.with_faces(np.random.default_rng(0).permutation(base.faces))
    turned = base.with_faces(base.faces[:, ::-1])
    assert table["vector_area_z"][0] > 0
    for key, column in loop_table(shuffled.surface()).items():
        np.testing.assert_allclose(column, table[key], atol=1e-12)
    reversed_ = loop_table(turned.surface())
    assert reversed_["vector_area_z"][0] == pytest.approx(-table["vector_area_z"][0])
    for key in ("length", "total_curvature", "sum_kappa_g", "writhe", "force_x", "torque_y"):
        assert reversed_[key][0] == pytest.approx(table[key][0])


def test_thousands_of_loops_are_each_as_alone() -> None:
    one = meshes.fan(7)
    copies = 3000
    points = np.vstack([one.points + 3.0 * k for k in range(copies)])
    faces = np.vstack([one.faces + 8 * k for k in range(copies)])
    order = np.random.default_rng(1).permutation(len(points))
    moved = np.empty_like(points)
    moved[order] = points
    table = loop_table(mesh(moved, order[faces]).surface())
    assert len(table["loop"]) == copies
    alone = loop_table(one.surface())
    for key in ("length", "total_curvature", "sum_kappa_g", "vector_area_z", "twist"):
        np.testing.assert_allclose(table[key], alone[key][0], atol=1e-9)
    np.testing.assert_array_equal(table["vertices"], 7)

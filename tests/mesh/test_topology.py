"""Counting, orienting and splitting, against the definitions applied one face at a time."""

from __future__ import annotations

from unittest import mock

import numpy as np
import pytest
from hypothesis import example, given, settings

import curvcli
from curvcli.errors import InputError
from tests.helpers import meshes, strategies
from tests.helpers.brute import Complex, clashing_pairs
from tests.helpers.meshes import Mesh, mesh


def counted(given: Mesh) -> dict[str, object]:
    return dict(curvcli.analyze(given.surface(), "topology").report()["topology"])


@settings(max_examples=150)
@given(strategies.any_mesh())
@example(meshes.book(2))
@example(mesh(np.eye(3), [[0, 1, 2], [0, 1, 2]]))
@example(mesh(np.eye(3), [[0, 1, 2], [0, 2, 1]]))
def test_the_report_counts_what_there_is(given: Mesh) -> None:
    report = curvcli.analyze(given.surface(), "topology").report()
    brute = Complex(given)
    wanted = brute.facts()
    assert {key: report["topology"][key] for key in wanted} == wanted
    assert report["topology"]["unreferenced_vertices"] == len(given.points) - len(brute.vertices)
    assert len(report["components"]) == brute.components
    for number, piece in enumerate(report["components"]):
        wanted = brute.facts(number)
        assert {key: piece["topology"][key] for key in wanted} == wanted


@settings(max_examples=60)
@given(strategies.any_mesh())
@example(meshes.book(3))
@example(meshes.mobius())
@example(meshes.two_bodies())
def test_edges_that_were_let_go_change_nothing(given: Mesh) -> None:
    """They are let go unless a quantity comes by way of them."""
    with mock.patch("curvcli.mesh.surface.Surface.release_edges"):
        kept = curvcli.analyze(given.surface(), "paper")
    found = curvcli.analyze(given.surface(), "core")
    assert "edges" not in vars(found.surface)
    again = curvcli.analyze(found.surface, "paper")
    assert "edges" in vars(again.surface)
    wanted = kept.report()
    wanted.pop("timings")
    assert {key: again.report()[key] for key in wanted} == wanted
    assert found.report()["topology"] == wanted["topology"]


@settings(max_examples=150)
@given(strategies.any_mesh())
def test_edges_and_components(given: Mesh) -> None:
    surface, brute = given.surface(), Complex(given)
    edges = surface.edges
    assert list(zip(edges.a.tolist(), edges.b.tolist(), strict=True)) == brute.edges
    assert edges.valence.tolist() == [len(brute.at_edge[edge]) for edge in brute.edges]
    assert surface.components.face.tolist() == brute.component
    degree = [sum(v in edge for edge in brute.edges) for v in range(len(given.points))]
    assert surface.degree.tolist() == degree
    conflicts = {edge for edge, flag in zip(brute.edges, surface.winding_conflicts, strict=True) if flag}
    assert conflicts == clashing_pairs(brute.faces)


@settings(max_examples=150)
@given(strategies.any_mesh())
def test_what_the_stars_say_is_what_the_edges_say(given: Mesh) -> None:
    surface, brute = given.surface(), Complex(given)
    half_edges = [(a, b) for face in brute.faces for a, b in zip(face, face[1:] + face[:1], strict=True)]
    assert surface.coherent == (len(set(half_edges)) == len(half_edges))
    assert surface.n_edges == len(surface.edges) == len(brute.edges)
    assert [tuple(sorted(half_edges[rim])) for rim in surface.boundary_half_edges] == brute.rim
    for mask, wanted in ((surface.boundary_edges, brute.rim), (surface.nonmanifold_edges, brute.crowded)):
        assert [edge for edge, flag in zip(brute.edges, mask, strict=True) if flag] == wanted


@settings(max_examples=150)
@given(strategies.any_mesh())
def test_patches_and_their_orientation(given: Mesh) -> None:
    surface, brute = given.surface(), Complex(given)
    found = surface.orientation
    assert found.patch.tolist() == brute.patch_of
    assert found.orientable.tolist() == [patch.orientable for patch in brute.patches]
    sign = [1] * surface.n_faces if found.face_sign is None else found.face_sign.tolist()
    assert sign == brute.sign
    assert surface.orientable == all(patch.orientable for patch in brute.patches)
    for number, patch in enumerate(brute.patches):
        if patch.orientable:
            assert surface.closed_patches[number] == patch.closed
        if patch.closed and patch.orientable and abs(patch.volume) > 1e-9:
            assert surface.inside_out[number] == (patch.volume < 0)
        if not patch.closed or not patch.orientable:
            assert not surface.inside_out[number]


@settings(max_examples=150)
@given(strategies.any_mesh())
def test_the_status_of_vertices_follows_the_definition(given: Mesh) -> None:
    found = curvcli.analyze(given.surface(), "status")
    brute = Complex(given)
    flat = set(given.faces[found.columns["degenerate_face"]].ravel().tolist())
    wanted = [brute.status(v, flat.__contains__) for v in range(len(given.points))]
    assert found.vertices["status"].tolist() == wanted


@given(strategies.closed())
def test_outward_turns_exactly_what_is_inside_out(given: Mesh) -> None:
    brute = Complex(given)
    inner = meshes.reversed_faces(given)
    plain, turned = inner.surface(), inner.surface("outward")
    sign = np.ones(len(given.faces), int) if turned.orientation.face_sign is None else turned.orientation.face_sign
    for patch in brute.patches:
        if patch.orientable and abs(patch.volume) > 1e-9:
            assert set(sign[patch.faces].tolist()) == {-1 if patch.volume > 0 else 1}
    one, other = (curvcli.analyze(surface, "h_signed") for surface in (given.surface("outward"), turned))
    np.testing.assert_allclose(one.vertices["h_signed"], other.vertices["h_signed"], rtol=1e-9)
    assert [notice.code for notice in curvcli.analyze(plain).notices].count("inside_out") == any(
        patch.orientable and patch.volume > 0 for patch in brute.patches
    )


def test_outward_leaves_open_patches_alone() -> None:
    given = meshes.reversed_faces(meshes.cap())
    assert given.surface("outward").orientation.face_sign is None


@pytest.mark.parametrize("degree", [3, 8, 9, 15, 16, 17, 18, 200])
@pytest.mark.parametrize("open_by", [0, 1])
def test_large_stars_are_one_fan(degree: int, open_by: int) -> None:
    whole = meshes.fan(degree)
    surface = whole.with_faces(whole.faces[open_by:]).surface()
    assert not surface.split_stars.any()
    assert surface.boundary[0] == bool(open_by)
    assert surface.coherent


@pytest.mark.parametrize("degree", [5, 8, 13, 14, 200])
@pytest.mark.parametrize("other", [3, 4, 40, 200])
@pytest.mark.parametrize("turned", [False, True])
def test_two_large_fans_at_one_vertex_are_split(degree: int, other: int, turned: bool) -> None:
    """Two closed fans, and one closed and one open, share nothing but the apex."""
    second = meshes.fan(other, rise=0.2)
    if turned:
        second = meshes.reversed_faces(second)
    first = meshes.fan(degree)
    for one in (first, first.with_faces(first.faces[1:])):
        for mixed in (False, True):
            joined = meshes.joined(one, second.moved(second.points + np.array([0.0, 0.0, 2.0])), shared=[(0, 0)])
            if mixed:
                joined = joined.with_faces(np.random.default_rng(5).permutation(joined.faces))
            assert np.flatnonzero(joined.surface().split_stars).tolist() == [0]


def test_the_book_is_counted_as_an_edge() -> None:
    found = counted(meshes.book())
    assert (found["nonmanifold_edges"], found["nonmanifold_vertices"], found["manifold"]) == (1, 0, False)
    assert (found["boundary_loops"], found["genus"], found["crosscaps"]) == (None, None, None)


def test_the_pinch_is_counted_as_a_vertex() -> None:
    found = counted(meshes.pinched())
    assert (found["nonmanifold_edges"], found["nonmanifold_vertices"], found["manifold"]) == (0, 1, False)
    assert found["components"] == 1
    assert found["euler_characteristic"] == 3


@pytest.mark.parametrize(("name", "crosscaps", "loops"), [("mobius", 1, 1), ("klein_bottle", 2, 0)])
def test_one_sided_surfaces(name: str, crosscaps: int, loops: int) -> None:
    found = counted(meshes.zoo(name))
    assert (found["orientable"], found["genus"], found["crosscaps"]) == (False, None, crosscaps)
    assert (found["boundary_loops"], found["closed"]) == (loops, loops == 0)


def test_faces_with_a_repeated_corner_are_dropped_and_counted() -> None:
    body = meshes.tetrahedron()
    surface = body.with_faces([*body.faces.tolist(), [1, 1, 2], [3, 0, 3]]).surface()
    assert surface.n_faces == 4
    assert [(notice.code, notice.count, notice.examples) for notice in surface.notices] == [
        ("repeated_corner_faces", 2, (4, 5))
    ]
    found = counted(body.with_faces([[1, 1, 2], *body.faces.tolist()]))
    assert (found["euler_characteristic"], found["faces"], found["closed"]) == (2, 4, True)


@pytest.mark.parametrize(
    ("points", "faces", "words"),
    [
        (np.eye(3), [[0, 1, 3]], "corner 3 does not exist"),
        (np.eye(3), [[0, 1, -1]], "corner -1 does not exist"),
        (np.eye(3), np.zeros((0, 3), int), "no faces"),
        (np.eye(3), [[1, 1, 2]], "every face has a repeated corner"),
        (np.diag([1.0, np.nan, 1.0]), [[0, 1, 2]], "not finite"),
        (np.diag([1.0, np.inf, 1.0]), [[0, 1, 2]], "not finite"),
        (np.eye(3)[:, :2], [[0, 1, 2]], "points have shape"),
        (np.eye(3), [[0, 1, 2, 0]], "faces have shape"),
        (np.eye(3), [[0.0, 1.0, 2.0]], "expected indices"),
    ],
)
def test_what_is_no_surface_is_refused(points: object, faces: object, words: str) -> None:
    with pytest.raises(InputError, match=words) as raised:
        curvcli.Surface(points, faces)  # type: ignore[arg-type]
    assert "\n" not in str(raised.value)


def test_a_point_that_is_nowhere_is_accepted_where_no_face_uses_it() -> None:
    found = counted(mesh([*np.eye(3), [np.nan, np.inf, 0]], [[0, 1, 2]]))
    assert (found["unreferenced_vertices"], found["faces"]) == (1, 1)


def test_two_vertices_at_one_place_are_counted_and_not_merged() -> None:
    found = counted(mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [-0.0, 0, 0], [0, 0, 1]], [[0, 1, 2], [3, 2, 4]]))
    assert (found["duplicate_vertices"], found["vertices"]) == (1, 5)

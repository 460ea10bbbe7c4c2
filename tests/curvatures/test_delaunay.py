"""Cells of the intrinsic Voronoi diagram: closed forms, isometries, hostile triangles, and flips one by one."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial import Delaunay, Voronoi

import curvcli
from curvcli.curvatures.delaunay import circumcentric_areas, delaunay
from curvcli.curvatures.kernels.gluing import glue
from curvcli.curvatures.kernels.intrinsic_delaunay import IntrinsicTriangulation
from curvcli.mesh.topology import next_corner, previous_corner
from tests.helpers import exact_values as exact
from tests.helpers import strategies
from tests.helpers.meshes import ZOO, Mesh, mesh, mobius, of_sample, relabelled, reversed_faces, rotation, torus, zoo
from tests.helpers.slow_delaunay import slow_areas

Floats = NDArray[np.float64]


def cells(given: Mesh) -> Floats:
    area, unfinished = delaunay.compute(given.surface())
    assert not unfinished.any()
    return np.asarray(area)


def agrees_with_slow(given: Mesh, tolerance: float = 1e-13) -> None:
    found, wanted = cells(given), slow_areas(given)
    np.testing.assert_array_equal(np.isnan(found), np.isnan(wanted))
    if not np.isnan(wanted).all():
        np.testing.assert_allclose(found, wanted, rtol=0, atol=tolerance * np.nanmax(abs(wanted)))


def lattice(across: int, along: int, shear: float = 0.0, width: float = 1.0, seed: int | None = None) -> Mesh:
    """A plane lattice; the diagonals of its cells are drawn by lot if a seed is given."""
    i, j = np.meshgrid(np.arange(across + 1), np.arange(along + 1), indexing="ij")
    points = np.stack([(i + shear * j).ravel() * width, 1.0 * j.ravel(), 0.0 * i.ravel()], axis=1)
    corner = i * (along + 1) + j
    a, b, c, d = (x.ravel() for x in (corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]))
    swap = np.zeros(len(a), bool) if seed is None else np.random.default_rng(seed).random(len(a)) < 0.5
    one = np.where(swap, [a, b, d], [a, b, c])
    other = np.where(swap, [b, c, d], [a, c, d])
    return mesh(points, np.concatenate([one.T, other.T]))


# ---------------------------------------------------------------------------- against flips one by one


@pytest.mark.parametrize("name", ZOO)
def test_every_kind_of_surface(name: str) -> None:
    agrees_with_slow(zoo(name))


@settings(max_examples=30)
@given(strategies.any_mesh())
def test_areas_of_random_surfaces_match_flips_one_by_one(given: Mesh) -> None:
    agrees_with_slow(given)


@settings(max_examples=20)
@given(strategies.any_mesh(), st.sampled_from([1e-6, 1e-3, 1e3, 1e6]))
def test_random_surfaces_of_needles(given: Mesh, factor: float) -> None:
    agrees_with_slow(given.moved(given.points @ rotation() * [factor, 1, 1]))


@pytest.mark.parametrize("factor", [1e-8, 1e-6, 1e-4, 1e4, 1e6, 1e8])
@pytest.mark.parametrize("name", ["torus", "mobius", "klein_bottle", "grid", "two_bodies"])
def test_needles_and_caps(name: str, factor: float) -> None:
    body = zoo(name)
    agrees_with_slow(body.moved(body.points * [factor, 1, 1]))


@pytest.mark.parametrize("shear", [0.3, 3.3, 17.3, 1000.3])
def test_a_sheared_lattice(shear: float) -> None:
    agrees_with_slow(lattice(7, 3, shear))


@pytest.mark.parametrize("seed", range(5))
def test_random_triangles_glued_all_round(seed: int) -> None:
    """Pillows, tetrahedra and other bodies of few faces, of any shape: loops and double edges come up."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(5, 3)) * 10.0 ** rng.uniform(-3, 3, (5, 1))
    for faces in (
        [[0, 1, 2], [0, 2, 1]],
        [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        [[0, 1, 2], [0, 2, 3], [0, 3, 1], [4, 2, 1], [4, 3, 2], [4, 1, 3]],
    ):
        agrees_with_slow(mesh(points, faces))


@pytest.mark.parametrize("name", exact.NAMES)
def test_the_number_of_flips(name: str) -> None:
    """That of flips one by one, where one round does; those of a Möbius strip are made on both sides."""
    surface = curvcli.load(exact.MESHES[name])
    triangulation = IntrinsicTriangulation(surface)
    wanted = exact.expected(name)["global"]["idt_flips"]
    if name == "catenoid_minimal":
        wanted = 0  # its quads are cocircular but for the rounding of their corners
    assert triangulation.flips == wanted * (1 if surface.orientable else 2)


# ---------------------------------------------------------------------------- closed forms


@pytest.mark.parametrize("height", [1e-9, 1e-6, 1e-3, 0.2, 0.4])
def test_an_obtuse_pillow(height: float) -> None:
    """Two copies of a triangle: the cell of each acute corner is cut from both by the bisector of its short edge."""
    pillow = mesh([[0, 0, 0], [1, 0, 0], [0.5, height, 0]], [[0, 1, 2], [0, 2, 1]])
    acute = (0.25 + height**2) * height / 2
    np.testing.assert_allclose(cells(pillow), [acute, acute, height - 2 * acute], rtol=1e-13)
    triangulation = IntrinsicTriangulation(pillow.surface())
    assert triangulation.flips == 1
    tail = triangulation.tail
    assert np.any(tail == tail[next_corner(np.arange(6))])  # the new edge is a loop at the obtuse corner


@pytest.mark.parametrize("width", [1.0, 3.0, 1e-6, 1e6])
@pytest.mark.parametrize("seed", range(3))
def test_cocircular_cells_are_left_alone(width: float, seed: int) -> None:
    """In a square grid either diagonal will do, and the cells are the same."""
    grid = lattice(6, 5, width=width, seed=seed)
    x, y = np.meshgrid([0.5, 1, 1, 1, 1, 1, 0.5], [0.5, 1, 1, 1, 1, 0.5], indexing="ij")
    np.testing.assert_allclose(cells(grid), (x * y).ravel() * width, rtol=1e-13)
    assert IntrinsicTriangulation(grid.surface()).flips == 0


def test_a_regular_polygon_is_left_alone() -> None:
    angle = 2 * np.pi * np.arange(60) / 60
    disk = mesh(np.stack([np.cos(angle), np.sin(angle), 0 * angle], 1), [[0, i, i + 1] for i in range(1, 59)])
    found = cells(disk)
    np.testing.assert_allclose(found, found[0], rtol=1e-11)


@pytest.mark.parametrize("seed", range(3))
def test_points_in_the_plane(seed: int) -> None:
    """Bounded Voronoi cells, and the same from a triangulation as bad as can be."""
    rng = np.random.default_rng(seed)
    flat = np.vstack([rng.uniform(0, 1, (60, 2)), [[-3, -3], [4, -3], [4, 4], [-3, 4]]])
    diagram = Voronoi(flat)
    wanted = np.full(len(flat), np.nan)
    for p, region in enumerate(diagram.point_region[:60]):
        corners = diagram.vertices[diagram.regions[region]]
        if -1 in diagram.regions[region] or abs(corners - 0.5).max() > 3.5:
            continue  # it reaches beyond the outline
        around = np.argsort(np.arctan2(*(corners - corners.mean(0)).T))
        x, y = corners[around].T
        wanted[p] = abs(x @ np.roll(y, 1) - y @ np.roll(x, 1)) / 2
    good = mesh(np.column_stack([flat, np.zeros(64)]), Delaunay(flat).simplices)
    shorn = Delaunay(flat @ [[1.0, 40.0], [0.0, 1.0]]).simplices
    known = ~np.isnan(wanted)
    assert known.sum() > 30
    np.testing.assert_allclose(cells(good)[known], wanted[known], rtol=1e-11)
    np.testing.assert_allclose(cells(good.with_faces(shorn))[known], wanted[known], rtol=1e-11)
    assert IntrinsicTriangulation(good.with_faces(shorn).surface()).flips > 50


def test_a_point_on_an_edge_belongs_to_both_faces() -> None:
    """A face without area on one line is mended by a flip; where it is on the boundary, it stays."""
    points = [[0, 0, 0], [2, 0, 0], [1, 0, 0], [1, 2, 0], [1, -2, 0]]
    inside = mesh(points, [[0, 1, 3], [0, 2, 1], [0, 4, 2], [2, 4, 1]])
    proper = mesh(points, [[0, 2, 3], [2, 1, 3], [0, 4, 2], [2, 4, 1]])
    np.testing.assert_allclose(cells(inside), cells(proper), rtol=1e-14)
    alone = mesh([*points, [5, 0, 0], [6, 0, 0], [5.5, 0, 0]], [*inside.faces, [5, 6, 7]])
    np.testing.assert_array_equal(np.isnan(cells(alone)), [False] * 5 + [True] * 3)


def test_coincident_corners_leave_no_cell() -> None:
    found = cells(mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [3, 3, 3]], [[0, 1, 2], [1, 3, 2]]))
    np.testing.assert_array_equal(np.isnan(found), [False, True, True, True, True])


# ---------------------------------------------------------------------------- what must hold


@pytest.mark.parametrize("name", ["torus", "ellipsoid", "klein_bottle", "mobius", "book", "inconsistent", "pinched"])
def test_the_cells_fill_the_surface(name: str) -> None:
    given = zoo(name)
    squashed = given.moved(given.points * [0.01, 1, 1])
    for body in (given, squashed):
        result = curvcli.analyze(tuple(body), ["A_voronoi"])
        assert float(result.vertices["A_voronoi"].sum()) == pytest.approx(result.totals["area"], rel=1e-12)
        if result.surface.boundary_edges.sum() == 0:
            assert (result.vertices["A_voronoi"] > 0).all()


@pytest.mark.parametrize("name", ["torus", "mobius", "klein_bottle", "inconsistent", "grid"])
def test_names_and_winding_do_not_matter(name: str) -> None:
    given = zoo(name)
    found = cells(given)
    rng = np.random.default_rng(0)
    order = rng.permutation(len(given.points))
    np.testing.assert_allclose(cells(relabelled(given, order)), found[order], rtol=1e-12)
    np.testing.assert_allclose(cells(reversed_faces(given)), found, rtol=1e-12)
    turned = given.faces.copy()
    some = rng.random(len(turned)) < 0.5
    turned[some] = turned[some][:, [1, 0, 2]]
    np.testing.assert_allclose(cells(given.with_faces(turned)), found, rtol=1e-12)


def test_bending_a_sheet_moves_nothing() -> None:
    """A plane of slanted strips folded like a fan, edges across the folds flipped or not."""
    rng = np.random.default_rng(5)
    flat = lattice(8, 6, seed=1).points.reshape(9, 7, 3).copy()
    flat[:, 1:-1, 1] += rng.uniform(-0.45, 0.45, (9, 5))
    faces = lattice(8, 6, seed=1).faces
    turn = np.cumsum(np.r_[0.0, rng.uniform(-1.5, 1.5, 7)])
    folded = flat.copy()
    folded[1:, :, 0] = np.cumsum(np.cos(turn))[:, None]
    folded[1:, :, 2] = np.cumsum(np.sin(turn))[:, None]
    before_bending, bent = mesh(flat.reshape(-1, 3), faces), mesh(folded.reshape(-1, 3), faces)
    assert IntrinsicTriangulation(bent.surface()).flips > 5
    np.testing.assert_allclose(cells(bent), cells(before_bending), rtol=1e-12)


@pytest.mark.parametrize("name", ["torus", "klein_bottle", "mobius"])
def test_the_triangulation_is_sound(name: str) -> None:
    """Every side is glued to one other at the same ends, no edge fails, and lengths are those of both faces."""
    body = zoo(name)
    t = IntrinsicTriangulation(body.moved(body.points * [0.03, 1, 1]).surface())
    assert t.flips > 20
    side = np.arange(len(t.tail))
    free = t.mates[t.edge] >= 0
    other = t.mates[t.edge] - side
    assert (t.edge[other[free]] == t.edge[free]).all()
    assert (other[other[free]] == side[free]).all()
    np.testing.assert_array_equal(t.tail[other[free]], t.tail[next_corner(side[free])])
    np.testing.assert_array_equal(previous_corner(next_corner(side)), side)
    np.testing.assert_array_equal(t.edge[t.side], np.arange(len(t.side)))
    assert (t.weight[t.mates >= 0] >= -1e-12).all()
    squares = t.lengths_squared(slice(None))[t.edge].reshape(-1, 3)
    a, b, c = np.sqrt(squares).T
    assert (np.maximum(np.maximum(a, b), c) < (a + b + c) / 2).all()


def test_a_one_sided_surface_is_covered_twice() -> None:
    strip = mobius().surface()
    glued = glue(strip)
    assert len(glued.tail) == 6 * strip.n_faces
    assert glued.twofold is not None
    assert glued.twofold.all()
    assert len(glued.single) == 2 * strip.boundary_edges.sum()
    np.testing.assert_array_equal(glued.tail[glued.half_edge], glued.tail[next_corner(glued.twin)])
    np.testing.assert_array_equal(np.bincount(glued.tail), 2 * strip.corner_count)


# ---------------------------------------------------------------------------- giving up


def test_flips_can_be_given_up() -> None:
    body = torus()
    t = IntrinsicTriangulation(body.surface(), most_flips=0)
    assert t.flips == 0
    assert t.failing.any()
    marked = t.unfinished_corners()
    assert marked.any()
    flat = np.flatnonzero(t.failing)
    assert marked[t.tail[t.side[flat]]].all()
    # What is left is the circumcentric area of the triangulation as it is.
    assert circumcentric_areas(t).sum() == pytest.approx(cells(body).sum(), rel=1e-13)


def test_what_was_given_up_is_null_and_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("curvcli.curvatures.kernels.intrinsic_delaunay._MOST_FLIPS", 0)
    monkeypatch.setattr("curvcli.curvatures.kernels.intrinsic_delaunay._MOST_FLIPS_PER_EDGE", 0)
    result = curvcli.analyze(tuple(torus()), ["A_voronoi"])
    notice = next(notice for notice in result.notices if notice.code == "voronoi_unfinished")
    assert notice.count == np.isnan(result.vertices["A_voronoi"]).sum() > 0


def test_a_finished_triangulation_is_no_news() -> None:
    result = curvcli.analyze(tuple(of_sample("icosphere", size=42)), ["A_voronoi"])
    assert "voronoi_unfinished" not in [notice.code for notice in result.notices]

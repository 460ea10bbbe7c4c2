"""Estimates look at one sheet: what hangs on an edge with more than two faces, or on a vertex of several fans, is
another surface, and neither reversing it nor removing it changes what is said of the first."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

import curvcli
from curvcli.curvatures.catalogue import presets
from curvcli.curvatures.registry import passes
from curvcli.errors import UsageError
from curvcli.mesh.file import MeshFile
from curvcli.mesh.surface import Surface
from curvcli.samples import get, names
from tests.helpers import meshes
from tests.helpers.meshes import Mesh, joined

Floats = NDArray[np.float64]
Columns = dict[str, Floats]

presets()  # has the passes loaded
ESTIMATES = [one.name for one in passes.quantities("vertex") if passes.depends_on_scale(one.name)]


def estimates(surface: Surface, **scale: object) -> Columns:
    found = curvcli.analyze(surface, ESTIMATES, checks=[], **scale)  # type: ignore[arg-type]
    return {name: np.asarray(found.column(name)) for name in ESTIMATES}


def assert_same(here: Columns, there: Columns, kept: NDArray[np.bool_], vertices: int, reversed_: bool = False) -> None:
    """Of the first vertices those that are kept; reversed_: whether the second surface has the other orientation."""
    for name in ESTIMATES:
        one, other = here[name][:vertices][kept], there[name][:vertices][kept]
        if reversed_:
            quantity = passes.quantity(name)
            other = there[quantity.partner or name][:vertices][kept] * (-1 if quantity.parity == "odd" else 1)
        np.testing.assert_array_equal(np.isnan(one), np.isnan(other), err_msg=name)
        size = np.nanmax(np.abs(one), initial=1.0)
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-9 * size, err_msg=name)


@cache
def small(name: str) -> Mesh:
    for size in (60, 100, 200):
        try:
            return meshes.of_sample(name, size=size)
        except UsageError:
            continue
    return meshes.of_sample(name)


@cache
def alone(name: str) -> Columns:
    return estimates(small(name).surface())


def frame(tail: Floats, head: Floats, aside: Floats) -> tuple[float, Floats]:
    """The length of an edge, and axes of which the first runs along it."""
    along = head - tail
    upright = np.cross(along, aside)
    axes = np.array([along, np.cross(upright, along), upright])
    return float(np.linalg.norm(along)), axes / np.linalg.norm(axes, axis=1)[:, None]


def at_a_vertex(one: Mesh, other: Mesh) -> Mesh:
    here, there = (int(np.median(np.flatnonzero(given.surface().referenced))) for given in (one, other))
    return joined(one, other.moved(other.points - other.points[there] + one.points[here]), [(here, there)])


def along_an_edge(one: Mesh, other: Mesh) -> Mesh:
    """At an edge of two faces of the first, of which it stays one patch: not from boundary to boundary."""
    ends = []
    for given, least in ((one, 2), (other, 1)):
        surface = given.surface()
        edges = surface.edges
        chord = surface.boundary[edges.a] & surface.boundary[edges.b]
        usable = np.flatnonzero((edges.valence >= least) & ~chord)
        if not len(usable):
            usable = np.flatnonzero(edges.valence >= least)
        edge = usable[len(usable) // 2]
        ends.append((int(edges.a[edge]), int(edges.b[edge])))
    (a, b), (c, d) = ends
    aside = np.array([0.31, 0.52, 0.73])
    length, axes = frame(one.points[a], one.points[b], aside)
    length_there, axes_there = frame(other.points[c], other.points[d], aside)
    moved = (other.points - other.points[c]) @ axes_there.T @ axes * (length / length_there) + one.points[a]
    return joined(one, other.moved(moved), [(a, c), (b, d)])


def glued_keeps_estimates(name: str, other: str) -> None:
    first, known = small(name), alone(name)
    n = len(first.points)
    for glued in (at_a_vertex(first, small(other)), along_an_edge(first, small(other))):
        faces = glued.faces.copy()
        faces[len(first.faces) :] = faces[len(first.faces) :, ::-1]
        for surface in (glued.surface(), glued.with_faces(faces).surface()):
            if surface.is_manifold:
                continue  # two boundaries make one surface
            assert_same(known, estimates(surface), ~surface.nonmanifold[:n], n)


@pytest.mark.parametrize("name", names())
def test_a_sample_glued_to_another_keeps_its_estimates(name: str) -> None:
    """At a vertex and along an edge, the other one wound both ways; against the sample by itself."""
    every = names()
    for step in (0, 7):
        glued_keeps_estimates(name, every[(every.index(name) + step) % len(every)])


@pytest.mark.slow
@pytest.mark.parametrize("name", names())
def test_every_sample_glued_to_every_other(name: str) -> None:
    for other in names():
        glued_keeps_estimates(name, other)


NONMANIFOLD: dict[str, Mesh] = {
    "pinched": meshes.of_sample("pinched", size=200),
    "book of 3": meshes.of_sample("book", size=200),
    "book of 5": meshes.of_sample("book", size=300, pages=5),
    "two bodies": meshes.pinched(),
    "pages": meshes.book(4),
}


@pytest.mark.parametrize("scale", [{"rings": 1}, {"rings": 2}, {"rings": 4}, {"radius": 0.35}], ids=str)
@pytest.mark.parametrize("name", NONMANIFOLD)
def test_a_patch_is_as_it_is_by_itself_and_whichever_way_the_others_are_wound(
    name: str, scale: dict[str, object]
) -> None:
    given = NONMANIFOLD[name]
    surface = given.surface()
    whole, patch, n = estimates(surface, **scale), surface.orientation.patch, len(given.points)
    assert not surface.is_manifold
    for each in range(patch.max() + 1):
        inside = np.zeros(n, bool)
        inside[given.faces[patch == each].ravel()] = True
        kept = inside & ~surface.nonmanifold
        assert_same(whole, estimates(given.with_faces(given.faces[patch == each]).surface(), **scale), kept, n)
        for turned, reversed_ in ((patch != each, False), (patch == each, True)):
            faces = given.faces.copy()
            faces[turned] = faces[turned][:, ::-1]
            assert_same(whole, estimates(given.with_faces(faces).surface(), **scale), kept, n, reversed_)


@pytest.mark.parametrize("seed", range(25))
def test_estimates_of_random_complexes_are_those_of_each_sheet(seed: int) -> None:
    """Triangles thrown together: with edges of many faces, several fans of one patch, and patches of one side."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(5, 14))
    faces = [rng.choice(n, 3, replace=False) for _ in range(int(rng.integers(4, 30)))]
    given = meshes.mesh(rng.normal(size=(n, 3)), faces)
    surface = given.surface()
    whole, patch = estimates(surface), surface.orientation.patch
    for each, oriented in enumerate(surface.orientation.orientable):
        alone = given.with_faces(given.faces[patch == each]).surface()
        if alone.orientable == oriented:  # what cuts a strip open may be all that gives it a side
            kept = alone.referenced & ~surface.nonmanifold
            assert_same(whole, estimates(alone), kept, n)


@pytest.mark.parametrize("page", range(5))
def test_a_page_taken_out_of_a_book(page: int) -> None:
    given = NONMANIFOLD["book of 5"]
    surface = given.surface()
    left = given.with_faces(given.faces[surface.orientation.patch != page]).surface()
    kept = left.referenced & ~surface.nonmanifold
    assert_same(estimates(surface), estimates(left), kept, len(given.points))


def test_spheres_that_touch_and_pages_that_meet() -> None:
    """The exact values, right up to the vertices where sheets meet."""
    ball = meshes.of_sample("irregular_sphere", size=400)
    touching = at_a_vertex(ball, ball.moved(ball.points * [-1, -1, 1])).surface()
    found = estimates(touching)
    other = ~touching.nonmanifold
    assert np.count_nonzero(~other) == 1
    np.testing.assert_allclose(found["K_corrected"][other], 1, rtol=0, atol=1e-9)
    np.testing.assert_allclose(found["h_corrected"][other], 2, rtol=0, atol=1e-9)
    assert np.abs(found["K_fit"][other] - 1).max() < 0.15
    assert np.isnan(found["K_corrected"][~other]).all()
    pages = meshes.of_sample("book", size=200).surface()
    found, other = estimates(pages), ~pages.nonmanifold
    for name in ("K_corrected", "h_corrected", "K_fit", "h_fit"):
        assert np.abs(found[name][other]).max() < 1e-12


def test_a_flap_along_many_edges_leaves_the_sphere_whole() -> None:
    """Its faces are two of one patch at each of these edges; without the flap nothing is different."""
    ball = get("uv_sphere")(size=240)
    rim = np.flatnonzero(np.abs(ball.points[:, 2]) < 1e-9)
    rim = rim[np.argsort(np.arctan2(ball.points[rim, 1], ball.points[rim, 0]))]
    n, after = len(ball.points), np.roll(np.arange(len(rim)), -1)
    outer = n + np.arange(len(rim))
    collar = np.vstack([np.stack([rim, rim[after], outer], 1), np.stack([rim[after], outer[after], outer], 1)])
    points = np.vstack([ball.points, 1.4 * ball.points[rim]])
    # All the way round, it cuts the sphere in two patches; with a gap, it does not.
    part = np.vstack([collar[: len(rim) // 2], collar[len(rim) : len(rim) + len(rim) // 2]])
    surface = Surface(points, np.vstack([ball.faces, part]))
    assert len(surface.orientation.orientable) == 2
    whole = estimates(Surface(ball.points, ball.faces))
    assert_same(whole, estimates(surface), ~surface.nonmanifold[:n], n)
    cut = Surface(points, np.vstack([ball.faces, collar]))
    assert len(cut.orientation.orientable) == 3
    upper = ball.points[ball.faces][:, :, 2].mean(axis=1) > 0
    found = estimates(cut)
    for half in (upper, ~upper):
        piece = Surface(ball.points, ball.faces[half])
        assert_same(estimates(piece), found, piece.referenced & ~cut.nonmanifold[:n], n)


def test_a_patch_without_orientation_does_not_change_how_others_are_estimated() -> None:
    strip, ball = meshes.mobius(), meshes.torus()
    n = len(ball.points)
    apart = joined(ball, strip.moved(strip.points + 9)).surface()
    assert apart.is_manifold
    assert_same(estimates(ball.surface()), estimates(apart), np.ones(n, bool), n)
    folded = meshes.grid(6, seed=3)
    x, y, _ = folded.points.T
    folded = folded.moved(np.stack([np.abs(x - 3), y, 0.2 * x], axis=1))
    apart = joined(folded, strip.moved(strip.points + 9)).surface()
    n = len(folded.points)
    assert_same(estimates(folded.surface()), estimates(apart), np.ones(n, bool), n)


def test_edges_far_shorter_than_another_patch_is_wide() -> None:
    """The choice of sums that are taken pair by pair is made for each vertex."""
    tiny = meshes.of_sample("irregular_ellipsoid", size=200)
    wide = meshes.of_sample("plane", size=400, width=1.0)
    shape = wide.points * [1e6, 1.0, 1.0]
    glued = at_a_vertex(tiny, wide.moved(shape)).surface()
    n = len(tiny.points)
    assert_same(estimates(tiny.surface()), estimates(glued), ~glued.nonmanifold[:n], n)


def test_normals_of_the_file_belong_to_every_sheet_that_meets_there() -> None:
    ball = meshes.of_sample("irregular_sphere", size=300)
    glued = at_a_vertex(ball, ball.moved(-ball.points))
    centre = np.zeros_like(glued.points)
    centre[len(ball.points) :] = glued.points[len(ball.points) :].mean(axis=0)
    normal = glued.points - centre
    file = MeshFile("ply", np.ascontiguousarray(glued.points.T), glued.faces.ravel())
    file.vertex_properties.update(zip(("nx", "ny", "nz"), normal.T, strict=True))
    surface = Surface(glued.points, glued.faces, file=file)
    found = curvcli.analyze(surface, "K_corrected", normals="file", rings=1).vertices["K_corrected"]
    first = ~surface.nonmanifold[: len(ball.points)]
    np.testing.assert_allclose(found[: len(ball.points)][first], 1, rtol=0, atol=1e-12)

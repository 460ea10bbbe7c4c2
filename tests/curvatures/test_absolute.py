"""K⁺, K⁻ and |K|: convex hulls of stars against exact and independent ones, and what their sums count."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

import curvcli
from curvcli.curvatures.kernels import normal_cones as cones
from curvcli.curvatures.kernels.normal_cones import normal_cone_areas
from tests.helpers import meshes
from tests.helpers.exact_cones import by_integers
from tests.helpers.meshes import Mesh, mesh

Floats = NDArray[np.float64]
TURN = 2 * np.pi


def areas(stars: Floats) -> Floats:
    """Of an array (n, d, 3) of directions."""
    return normal_cone_areas(np.ascontiguousarray(stars.transpose(2, 1, 0), np.float64))


def angle(a: Floats, b: Floats) -> float:
    return float(np.arctan2(np.linalg.norm(np.cross(a, b)), np.dot(a, b)))


def by_qhull(directions: Floats) -> float:
    """2π less the angles at the apex of the facets that the hull of the star has there; 0 if the apex is inside."""
    unit = directions / np.linalg.norm(directions, axis=1)[:, None]
    hull = ConvexHull(np.vstack([np.zeros(3), unit]))
    corners = [[unit[k - 1] for k in facet if k] for facet in hull.simplices if 0 in facet]
    return TURN - sum(angle(*pair) for pair in corners) if corners else 0.0


@pytest.mark.parametrize("degree", [3, 4, 5, 6, 7, 9, 16, 40, 200])
@pytest.mark.parametrize("height", [0.0, 0.3, 1.0, 3.0])
def test_random_stars_against_qhull(degree: int, height: float) -> None:
    rng = np.random.default_rng(degree)
    stars = rng.normal(size=(60, degree, 3)) * rng.uniform(0.1, 10, size=(60, degree, 1))
    stars[..., 2] += height * np.linalg.norm(stars, axis=2)
    found = areas(stars)
    np.testing.assert_allclose(found, [by_qhull(star) for star in stars], rtol=0, atol=1e-10)
    assert (found > 0).any() or degree > 9
    assert (found == 0).any() == (height < 1 and degree > 3)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("degree", [2, 3, 4, 5, 6, 8, 12])
@pytest.mark.parametrize(("low", "high"), [(-1, 1), (-2, 2), (0, 2), (-1, 3), (0, 1)])
def test_stars_of_integers(degree: int, low: int, high: int, turned: bool) -> None:
    """Coplanar, repeated and opposite directions, doubly covered sectors and lines, all decided exactly."""
    rng = np.random.default_rng(degree)
    stars = rng.integers(low, high, size=(200, degree, 3), endpoint=True)
    stars[::2] = stars[::2] @ rng.integers(-2, 2, size=(100, 3, 3), endpoint=True)
    stars = stars[(stars != 0).any(axis=2).all(axis=1)]
    wanted = [float(by_integers([tuple(d) for d in star])) for star in stars.tolist()]
    found = areas(stars @ meshes.rotation().T if turned else stars)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=2e-14)


@pytest.mark.parametrize("noise", [1e-6, 1e-9, 1e-12, 1e-14, 1e-15, 1e-16])
def test_decisions_within_rounding_move_the_result_by_rounding(noise: float) -> None:
    """Disturbed in ever later digits, degenerate stars keep their value: nothing jumps where a decision turns."""
    rng = np.random.default_rng(3)
    octant = np.array([[1, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [2, 0, 2], [1, 1, 1]], float)
    flat = np.array([[1, 0, 0], [1, 1, 0], [0, 1, 0], [-1, 0, 0], [-1, -1, 0], [0, -1, 0]], float)
    edge = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, -1], [1, 1, -1], [0, -1, -1], [-1, -1, -1]], float)
    folded = np.array([[1, 0, 0], [2, 1, 0], [1, 1, 0], [1, 3, 0]], float)
    needle = np.ones((5, 3)) * np.arange(1, 6)[:, None]
    wide = TURN - 2 * angle(folded[0], folded[3])
    for star, value in ((octant, np.pi / 2), (flat, 0.0), (edge, 0.0), (folded, wide), (needle, TURN)):
        stars = star + noise * rng.normal(size=(300, *star.shape))
        np.testing.assert_allclose(areas(stars), value, rtol=0, atol=40 * noise + 2e-14)


@pytest.mark.parametrize("degree", [3, 4, 6, 9, 16])
@pytest.mark.parametrize("height", [1e-6, 1e-2, 1.0])
def test_counting_and_building_agree(degree: int, height: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Caps, saddles and what is between, nearly flat and steep, by their facets and with their hulls built up."""
    rng = np.random.default_rng(degree)
    turn = TURN * np.arange(degree) / degree + rng.normal(scale=0.1, size=(200, degree))
    bend, saddle = rng.normal(size=(2, 200, 1))
    stars = np.stack([np.cos(turn), np.sin(turn), height * (bend + saddle * np.cos(2 * turn))], axis=2)
    stars *= rng.uniform(0.5, 2, size=(200, degree, 1))
    counted = areas(stars)
    monkeypatch.setattr(cones, "_COUNTED", 0)
    np.testing.assert_allclose(counted, areas(stars), rtol=0, atol=1e-14)
    assert (counted > 0).any()
    assert (counted == 0).any() or degree == 3


def test_size_of_the_edges_does_not_matter() -> None:
    rng = np.random.default_rng(4)
    stars = rng.normal(loc=(0, 0, 1), size=(50, 6, 3))
    sizes = np.ldexp(1.0, rng.integers(-900, -100, size=(50, 6, 1)))
    np.testing.assert_allclose(areas(stars * sizes), areas(stars), rtol=0, atol=1e-14)
    for exponent in range(-1000, 61, 20):
        np.testing.assert_allclose(areas(np.ldexp(stars, exponent)), areas(stars), rtol=0, atol=1e-14)


def columns(given: Mesh) -> tuple[Floats, Floats, Floats, Floats]:
    result = curvcli.analyze(given.surface(), "K,K_plus,K_minus,K_abs")
    plus, minus, size = (np.asarray(result.vertices[name]) for name in ("K_plus", "K_minus", "K_abs"))
    K = np.asarray(result.vertices["K"])
    np.testing.assert_array_equal(plus + minus, size)
    known = ~np.isnan(plus)
    np.testing.assert_allclose((plus - minus)[known], K[known], rtol=0, atol=2e-15)
    assert not (minus < 0).any()
    assert not (plus < 0).any()
    return K, plus, minus, size


@pytest.mark.parametrize("given", [meshes.icosphere(), meshes.ellipsoid(), meshes.tetrahedron()])
def test_convex_bodies_are_tight(given: Mesh) -> None:
    """Nothing negative at all, and Chern and Lashof's bound is attained."""
    K, plus, minus, size = columns(given)
    assert not minus.any()
    assert abs(plus.sum() - 2 * TURN) <= 16 * 2.0**-52 * (len(given.faces) + len(given.points))
    np.testing.assert_array_equal(size, K)


def bipyramid(rim: Floats, top: float, bottom: float) -> Mesh:
    """Two apices, the first two vertices, joined to a closed curve (n, 3)."""
    n = len(rim)
    ring = np.arange(n) + 2
    after = np.roll(ring, -1)
    up = np.stack([np.zeros(n, int), ring, after], axis=1)
    down = np.stack([np.ones(n, int), after, ring], axis=1)
    return mesh(np.vstack([[0, 0, top], [0, 0, bottom], rim]), np.vstack([up, down]))


def circle(n: int, turns: int = 1) -> Floats:
    t = TURN * turns * np.arange(n) / n
    return np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)


def star_of(given: Mesh, vertex: int) -> Floats:
    around = np.unique(given.faces[(given.faces == vertex).any(axis=1)])
    return np.asarray(given.points[around[around != vertex]] - given.points[vertex])


@pytest.mark.parametrize("n", [7, 24, 25, 33, 100, 1000])
def test_apexes_of_high_degree_are_split_rightly(n: int) -> None:
    """A convex apex, one dent in it, and a rugged one."""
    _, plus, minus, _ = columns(bipyramid(circle(n), 0.7, -1.0))
    assert not minus.any()
    dented = circle(n)
    dented[3] *= 0.5
    rugged = circle(n)
    rugged[:, 2] += np.random.default_rng(n).uniform(-0.2, 0.2, n)
    for rim in (rugged, dented):
        given = bipyramid(rim, 0.7, -1.0)
        _, plus, minus, _ = columns(given)
        np.testing.assert_allclose(plus[:2], [by_qhull(star_of(given, k)) for k in (0, 1)], rtol=0, atol=1e-10)
    assert (minus[:2] > 1e-3).all()


def test_a_link_that_winds_twice_is_not_convex() -> None:
    """All its dihedral angles have one sign and its angles sum to less than 2π, but it is no convex cone's boundary."""
    given = bipyramid(circle(7, 2), 4.0, -5.0)
    K, plus, minus, _ = columns(given)
    assert (K[:2] > 0).all()
    np.testing.assert_allclose(plus[:2], [by_qhull(star_of(given, k)) for k in (0, 1)], rtol=0, atol=1e-10)
    assert (minus[:2] > 0.1).all()


def test_two_sided_polygon() -> None:
    """A flat body carries its curvature where its outline turns, and none where it is flat or straight."""
    outline = np.array([[0, 0, 0], [2, 0, 0], [4, 0, 0], [3, 3, 0], [0, 4, 0]], float)
    ring, after = np.arange(5), np.roll(np.arange(5), -1)
    sides = [np.stack([np.full(5, 5), ring, after], axis=1), np.stack([np.full(5, 6), after, ring], axis=1)]
    given = mesh(np.vstack([outline, np.array([[1.5, 1.5, 0], [1, 1, 0]])]), np.vstack(sides))
    for moved in (given, given.moved(given.points @ meshes.rotation().T)):
        K, plus, _, _ = columns(moved)
        np.testing.assert_allclose(plus, K, rtol=0, atol=1e-14)
        np.testing.assert_allclose(plus[[1, 5, 6]], 0, rtol=0, atol=1e-14)
        assert abs(plus.sum() - 2 * TURN) < 1e-13


def test_saddles_have_no_positive_part() -> None:
    n = 12
    rim = circle(n)
    rim[:, 2] = 0.4 * np.cos(2 * TURN * np.arange(n) / n)
    K, plus, minus, _ = columns(bipyramid(rim, 0.0, -9.0))
    assert plus[0] == 0
    assert minus[0] == -K[0] > 0


def test_what_is_flat_or_contains_a_line() -> None:
    """Inside a plane and along the edge of a roof there is nothing of either sign."""
    x, y = np.meshgrid(np.arange(5.0), np.arange(5.0), indexing="ij")
    for height in (0 * x, np.abs(x - 2), -2 * np.abs(x - 2)):
        sheet = meshes.grid(4).moved(np.stack([x, y, height], axis=2).reshape(-1, 3))
        for given in (sheet, sheet.moved(sheet.points @ meshes.rotation().T)):
            _, plus, minus, _ = columns(given)
            inside = np.isfinite(plus)
            assert inside.sum() == 9
            assert np.abs(plus[inside]).max() < 1e-14
            assert np.abs(minus[inside]).max() < 1e-14


def test_no_orientation_is_needed() -> None:
    body = meshes.torus()
    faces = body.faces.copy()
    faces[::3] = faces[::3, ::-1]
    for one, other in zip(columns(body), columns(body.with_faces(faces)), strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-14)
    for given in (meshes.klein_bottle(), meshes.mobius()):
        _, plus, _, _ = columns(given)
        for vertex in np.flatnonzero(np.isfinite(plus)).tolist():
            assert abs(plus[vertex] - by_qhull(star_of(given, vertex))) < 1e-10
        assert np.isfinite(plus).any()


def test_undefined_parts_are_null() -> None:
    """On the boundary, at vertices that are not manifold, at those no face uses, and where corners coincide."""
    _, plus, _, _ = columns(meshes.grid())
    np.testing.assert_array_equal(np.isnan(plus), meshes.grid().surface().boundary)
    _, plus, _, _ = columns(meshes.pinched())
    np.testing.assert_array_equal(np.isnan(plus), meshes.pinched().surface().nonmanifold)
    body = meshes.tetrahedron()
    _, plus, _, _ = columns(mesh(np.vstack([body.points, [[9, 9, 9]]]), body.faces))
    assert np.isnan(plus).tolist() == [False] * 4 + [True]
    rim = circle(6)
    rim[2] = rim[1]
    K, plus, _, _ = columns(bipyramid(rim, 1.0, -1.0))
    assert np.flatnonzero(np.isnan(plus)).tolist() == [3, 4]
    assert np.flatnonzero(np.isnan(K)).tolist() == [3, 4]
    np.testing.assert_allclose(plus[:3], K[:3], rtol=0, atol=1e-14)


def critical_points(given: Mesh, direction: Floats) -> tuple[int, int]:
    """Extrema and saddles, with their multiplicity, of the height in a direction (Banchoff's index)."""
    height = given.points @ direction
    middle = given.faces[np.arange(len(given.faces)), height[given.faces].argsort(axis=1)[:, 1]]
    index = 1 - np.bincount(middle, minlength=len(given.points)) // 2
    return int(index[index > 0].sum()), -int(index[index < 0].sum())


def bumpy_sphere() -> Mesh:
    body = meshes.of_sample("icosphere", size=400)
    x, y, z = body.points.T
    return body.moved(body.points * (1 + 0.2 * np.sin(5 * x) * np.cos(4 * y) + 0.1 * np.sin(7 * z))[:, None])


@pytest.mark.parametrize("given", [bumpy_sphere(), meshes.of_sample("irregular_torus", size=300)])
def test_the_mean_number_of_critical_points(given: Mesh) -> None:
    """ΣK⁺ and ΣK⁻ over 2π are the mean numbers of extrema and of saddles of height functions."""
    rng = np.random.default_rng(5)
    counts = np.array([critical_points(given, v) for v in rng.normal(size=(3000, 3))], float)
    _, plus, minus, _ = columns(given)
    error = counts.std(axis=0, ddof=1) / np.sqrt(len(counts))
    expected = np.array([plus.sum(), minus.sum()]) / TURN
    assert (np.abs(counts.mean(axis=0) - expected) <= 3 * error).all()
    assert (expected - [2, 0]).min() > 3 * error.max()

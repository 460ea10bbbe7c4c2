"""Faces without area, corners that coincide, slivers, and coordinates at the ends of the range of doubles."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import curvcli
from curvcli.api import Analysis
from curvcli.curvatures.registry import passes
from tests.helpers import meshes
from tests.helpers.columns import PUBLIC
from tests.helpers.meshes import Mesh, mesh
from tests.helpers.reference import COLUMNS, column, stars

EPSILON = 2.0**-52

# Everything made of the mean curvature of the star; it and only it is undefined at the corners of a face without area.
_OF_THE_STAR = [q for q in PUBLIC.values() if q.on == "vertex" and not passes.depends_on_scale(q.name)]
FOLLOWS_FROM_H = {q.name for q in _OF_THE_STAR if q.mean_degree} | {
    *("kappa_1", "kappa_2", "shape_index", "curvedness", "willmore_conformal", "area_gradient")
}
STAYS = {"K", "A", "A_vec", "K_density", "K_comb", "degree", "K_plus", "K_minus", "K_abs"}


def octahedron() -> Mesh:
    """With corners at ±1 and ±2, so that midpoints are exact."""
    points = [[1, 0, 0], [-1, 0, 0], [0, 2, 0], [0, -2, 0], [0, 0, 1], [0, 0, -1]]
    faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    return mesh(points, faces)


def split(at: object) -> Mesh:
    """The octahedron whose edge 0-2 is opened, with a face (0, 2, 6) across the gap and vertex 6 where told."""
    body = octahedron()
    faces = [face for face in body.faces.tolist() if face != [0, 2, 4]]
    return mesh(np.vstack([body.points, np.array(at, float)]), [*faces, [0, 6, 4], [6, 2, 4], [0, 2, 6]])


def nulls(result: Analysis, name: str) -> list[int]:
    values = result.column(name).astype(np.float64)
    return np.flatnonzero(np.isnan(values).reshape(len(values), -1).any(axis=1)).tolist()


def test_collinear_corners_keep_K_and_lose_H() -> None:
    """Angles 0, 0, π: K stays, what the edges' mean curvature enters is null at the three corners."""
    result = curvcli.analyze(split([0.5, 1.0, 0.0]).surface(), "all")
    plain = curvcli.analyze(octahedron().surface(), "all")
    corners = [0, 2, 6]
    for name in sorted(FOLLOWS_FROM_H):
        assert nulls(result, name) == corners, name
    for name in sorted(STAYS & PUBLIC.keys()):
        assert nulls(result, name) == [], name
    np.testing.assert_allclose(result.vertices["K"], [*plain.vertices["K"], 0.0], rtol=0, atol=5e-14)
    assert result.vertices["status"].tolist() == ["degenerate", "interior"] * 2 + ["interior"] * 2 + ["degenerate"]
    assert result.faces["area"][-1] == 0
    assert np.isnan(result.faces["normal"][-1]).all()
    edges = result.surface.edges
    lost = [(0, 2), (0, 6), (2, 6)]
    for name in ("theta", "edge_H_vec", "H_sin", "H_theta", "H_tan", "beta"):
        where = nulls(result, name)
        assert [(edges.a[e], edges.b[e]) for e in where] == lost, name
    assert result.report()["topology"]["degenerate_faces"] == 1
    assert [notice.count for notice in result.notices if notice.code == "degenerate_faces"] == [1]
    status = {check.name: (check.status, check.detail) for check in result.checks}
    assert status["gauss_bonnet"][0] == status["vector_area"][0] == status["volume"][0] == "pass"
    for name in ("force_balance", "torque_balance", "position_balance"):
        assert status[name][0] == "not_applicable"
        assert "H_vec is undefined at 3 vertices, the first is 0" in status[name][1]


def test_corners_in_one_place() -> None:
    """K is null at the corners that coincide, and only there."""
    result = curvcli.analyze(split([1.0, 0.0, 0.0]).surface(), "all")
    assert nulls(result, "K") == [0, 6]
    assert nulls(result, "K_density") == [0, 6]
    assert nulls(result, "A") == nulls(result, "A_vec") == []
    assert nulls(result, "H_vec") == nulls(result, "area_gradient") == [0, 2, 4, 6]
    plain = curvcli.analyze(octahedron().surface(), "K").vertices["K"]
    np.testing.assert_allclose(result.vertices["K"][1:6], plain[1:6], rtol=0, atol=5e-14)
    (check,) = [check for check in result.checks if check.name == "gauss_bonnet"]
    assert check.status == "not_applicable"
    assert "undefined at 2 vertices, the first is 0" in check.detail
    report = result.report()["topology"]
    assert (report["degenerate_faces"], report["duplicate_vertices"]) == (2, 1)


@pytest.mark.parametrize("seed", range(20))
def test_corners_in_one_place_anywhere(seed: int) -> None:
    """Rounding of coordinates gives the face no area and its corners no angle."""
    rng = np.random.default_rng(seed)
    points = octahedron().points + rng.normal(size=(6, 3))
    points[:, 0] *= 1e11
    points[4] = points[2]
    result = curvcli.analyze((points, octahedron().faces), "all")
    assert nulls(result, "K") == [2, 4] == nulls(result, "K_plus")
    assert np.flatnonzero(result.faces["area"] == 0).tolist() == [0, 1]
    assert result.passed


def test_the_volume_of_needles() -> None:
    """Long products that cancel cost the volume nothing: it is known as well as the areas."""
    faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
    points = [[-0.7, 0.1, -0.7], [-7e-108, -9e-109, 0.0], [0.0, -2e-159, 0.0], [1.8e-9, -6.3e-9, -4.1e-9]]
    result = curvcli.analyze((np.array(points), faces), "core")
    (volume,) = (check for check in result.checks if check.name == "volume")
    assert volume.status == "pass"
    assert volume.tolerance is not None
    assert volume.tolerance < 1e-21


def test_all_corners_in_one_place() -> None:
    result = curvcli.analyze(mesh([[3, 1, 2]] * 3 + [[0, 0, 0]], [[0, 1, 2], [0, 1, 3]]).surface(), "all")
    assert nulls(result, "kappa_g") == [0, 1, 2]
    assert result.vertices["A"].tolist() == [0, 0, 0, 0]
    assert result.passed


@pytest.mark.parametrize("scale", [2.0**-500, 1e-9, 1.0, 1e9, 2.0**500])
@pytest.mark.parametrize(("ulps", "flat"), [(0, True), (3.5, True), (4, True), (4.5, False), (100, False)])
def test_where_a_face_begins(ulps: float, flat: bool, scale: float) -> None:
    """|u × v| ≤ 4 ε · (longest edge)², whatever the size."""
    points = scale * np.array([[0, 0, 0], [1, 0, 0], [0.5, ulps * EPSILON, 0]])
    # The longest edge has length 1, so |u × v| is the height.
    result = curvcli.analyze((points, np.array([[0, 1, 2]])), "all")
    assert result.report()["topology"]["degenerate_faces"] == flat
    assert set(result.vertices["status"]) == {"degenerate" if flat else "boundary"}


def matches(given: Mesh, names: list[str] | None = None) -> None:
    """K to 5e-14, everything else to 1e-11 of the column's largest value."""
    result, known = curvcli.analyze(given.surface(), "all"), stars(given)
    for name in names or COLUMNS:
        found, wanted = result.column(name), column(known, name)
        defined = ~np.isnan(wanted)
        np.testing.assert_array_equal(np.isnan(found), ~defined, err_msg=name)
        if not defined.any():
            continue
        quantity = passes.quantity(name)
        largest = 5e-3 if quantity.name in ("K", "kappa_g") else np.abs(wanted[defined]).max() or 1.0
        gap = np.abs(found[defined] / largest - wanted[defined] / largest).max()
        assert gap <= 1e-11, (name, gap)


def needles(width: float) -> Mesh:
    """A bumpy grid two of whose columns are as near to each other as told."""
    given = meshes.grid(4)
    points = given.points.copy()
    points[10:15] = points[5:10] + width * np.random.default_rng(9).uniform(0.5, 1.0, (5, 3))
    return given.moved(points)


def caps(height: float) -> Mesh:
    """A bumpy grid, some of whose corners lie as near to the opposite edge as told."""
    given = meshes.grid(4)
    points = given.points.copy()
    for a, b, c in given.faces[[5, 10, 15, 20]]:
        points[a] = 0.4 * points[b] + 0.6 * points[c] + height * np.array([0.3, -0.5, 0.7])
    return given.moved(points)


@pytest.mark.parametrize("aspect", [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12])
@pytest.mark.parametrize("kind", [needles, caps])
def test_slivers_match_sums_in_60_digits(kind: object, aspect: float) -> None:
    given: Mesh = kind(aspect)  # type: ignore[operator]
    matches(given, ["K", "kappa_g", "A", "A_vec", "H_vec", "area_gradient"])
    matches(given.moved(np.ldexp(given.points, 40)), ["K", "kappa_g", "A", "A_vec", "H_vec", "area_gradient"])


@pytest.mark.parametrize("scale", [1e-150, 1e-140, 1e-100, 1e100, 1e140, 1e150, 1e160, 1e-160])
@pytest.mark.parametrize("name", ["tetrahedron", "grid", "torus"])
def test_ends_of_the_range(name: str, scale: float) -> None:
    """Values beyond the range of doubles are null, all others as exact as elsewhere."""
    given = meshes.zoo(name)
    matches(given.moved(given.points * scale))


@pytest.mark.parametrize("name", ["grid", "cap", "torus"])
def test_small_and_far_away(name: str) -> None:
    """Size 1e-3 at an offset of 1e12: few digits are left, and those that are count exactly."""
    given = meshes.zoo(name)
    size = 1e-3 if name == "grid" else 4e-3
    matches(given.moved(given.points * size + np.array([1e12, -0.7e12, 0.4e12])))


@pytest.mark.slow
@pytest.mark.parametrize("degree", [100, 1000, 5000])
@pytest.mark.parametrize("regular", [True, False])
@pytest.mark.parametrize("closed", [True, False])
def test_apex_of_many_faces(degree: int, regular: bool, closed: bool) -> None:
    """The error of a sum of angles does not grow with their number."""
    rng = np.random.default_rng(11)
    given = meshes.fan(degree)
    if not regular:
        given = given.moved(given.points + rng.uniform(-0.1, 0.1, given.points.shape) * [[0, 0, 1]])
        given = given.moved(given.points * rng.uniform(0.5, 2, (len(given.points), 1)))
    if not closed:
        given = mesh(given.points[: degree // 2 + 2], given.faces[: degree // 2])
    matches(given, ["K", "kappa_g", "A", "A_vec", "H_vec"])


def test_a_large_fan_sums_to_its_defect() -> None:
    """A flat fan of equal faces: every angle is the same, and so is the error of each."""
    degree = 5000
    found: NDArray[np.float64] = curvcli.analyze(meshes.fan(degree, rise=0.0).surface(), "K").vertices["K"]
    assert abs(found[0]) <= 5e-14


@pytest.mark.parametrize("scale", [2.0**-100, 1.0, 2.0**100])
@pytest.mark.parametrize(("ratio", "lost"), [(0.9e-12, True), (1.1e-12, False), (1e-6, False)])
def test_where_the_vector_area_is_lost(ratio: float, lost: bool, scale: float) -> None:
    """Only quotients by |**A**_p| are null where it is below 1e-12 A_p."""
    # The area vector of the first corner's star is minus that of the opposite face, which is as thin as told.
    height = ratio * np.sqrt(2)
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, 0.5, height]])
    body = mesh(scale * corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    column = curvcli.analyze(body.surface(), "all").vertices
    assert column["status"].tolist() == ["interior"] * 4
    size = np.linalg.norm(column["A_vec"][0]) / column["A"][0]
    assert size == pytest.approx(ratio, rel=1e-3)
    for name in ("h", "h_signed", "h_perp", "h_normal", "willmore", "willmore_perp", "willmore_normal", "curvedness"):
        assert np.isnan(column[name][0]) == lost, name
    assert not any(np.isnan(column[name][0]) for name in ("h_hks", "willmore_hks", "K_density", "willmore_conformal"))


@pytest.mark.parametrize(("cosine", "lost"), [(0.9e-12, True), (-0.9e-12, True), (1.1e-12, False), (-1.1e-12, False)])
def test_where_the_normals_are_at_right_angles(cosine: float, lost: bool) -> None:
    """h_normal is null where |**H**·**A**| < 1e-12 |**H**||**A**|, and has the sign of −**H**·**A** elsewhere."""
    surface, ones = octahedron().surface(), np.ones(6)
    H_vec, A_vec = np.outer([3.0, 0, 0], ones), np.outer([cosine, 1, 0], ones)
    found = curvcli.passes.normal_ratio.compute(surface.interior, H_vec, A_vec, ones)
    np.testing.assert_allclose(found, np.full(6, np.nan if lost else -3 / cosine), rtol=1e-9)

"""Statistics by region and component against numpy on the vertex table and against closed values."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import curvcli
from curvcli.analysis.statistics import REPORTED
from tests.helpers import meshes
from tests.helpers.meshes import Mesh, of_sample


def halves(given: Mesh, axis: int = 2) -> NDArray[np.int64]:
    """Label of each face by the side of its centre."""
    return (given.points[given.faces].mean(axis=1)[:, axis] > 0).astype(np.int64)


def inside(given: Mesh, labels: NDArray[np.int64], label: int) -> NDArray[np.bool_]:
    """Vertices whose faces are all of one region."""
    other = np.zeros(len(given.points), bool)
    other[given.faces[labels != label].ravel()] = True
    mine = np.zeros(len(given.points), bool)
    mine[given.faces[labels == label].ravel()] = True
    return mine & ~other


def divided_cube(n: int) -> tuple[Mesh, NDArray[np.int64]]:
    """A cube of edge n with n × n squares on each side, and the side of each face."""
    steps = np.arange(n + 1.0)
    points, faces, labels = [], [], []
    for axis in range(3):
        u, v = np.meshgrid(steps, steps, indexing="ij")
        corner = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
        a, b, c, d = (part.ravel() for part in (corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]))
        for side in (0, 1):
            turned = [(a, b, c), (a, c, d)] if side else [(a, c, b), (a, d, c)]
            faces.append(np.concatenate([np.stack(each, 1) for each in turned]) + len(points) * corner.size)
            points.append(np.roll(np.stack([np.full(u.size, n * side), u.ravel(), v.ravel()], 1), axis, axis=1))
            labels.append(np.full(2 * n * n, 2 * axis + side))
    corners, index = np.unique(np.concatenate(points), axis=0, return_inverse=True)
    return Mesh(corners, index.ravel()[np.concatenate(faces)].astype(np.int32)), np.concatenate(labels)


@pytest.mark.parametrize("sample", ["icosphere", "irregular_torus", "irregular_ellipsoid"])
def test_a_region_has_the_statistics_of_the_vertices_inside_it(sample: str) -> None:
    """A vertex on the cut is a null, as on any boundary; inside, the values are those of the whole surface."""
    given = of_sample(sample)
    labels = halves(given)
    whole = curvcli.analyze((given.points, given.faces), "core")
    report = curvcli.analyze((given.points, given.faces), "core", regions=labels).report()
    area = whole.vertices["A"]
    for region in report["regions"]:
        mask = inside(given, labels, int(region["name"]))
        for column in ("K", "h_signed", "kappa_1", "willmore", "K_density"):
            x, w = whole.vertices[column][mask], area[mask]
            got = region["columns"][column]
            assert tuple(got) == REPORTED
            assert got["count"] == len(x)
            assert got["count"] + got["nulls"] == region["topology"]["vertices"]
            want = {"min": x.min(), "max": x.max(), "mean": x.mean(), "area_mean": np.average(x, weights=w)}
            want |= {"std": x.std(), "p02": np.quantile(x, 0.02), "median": np.median(x), "p98": np.quantile(x, 0.98)}
            # The surface that is cut has its own rounding.
            assert {name: got[name] for name in want} == pytest.approx(want, rel=1e-9, abs=1e-12)


def test_columns_that_a_boundary_has_count_vertices_on_the_cut() -> None:
    given = of_sample("icosphere")
    region = curvcli.analyze((given.points, given.faces), "core", regions=halves(given)).report()["regions"][0]
    assert region["columns"]["A"]["count"] == region["topology"]["vertices"]
    assert region["columns"]["kappa_g"]["count"] == region["topology"]["boundary_edges"]


def test_the_faces_of_a_cube_are_flat() -> None:
    """Six regions of a finely divided cube: no curvature inside a face, all of it on the cuts."""
    given, labels = divided_cube(6)
    side = 6.0
    regions = curvcli.analyze((given.points, given.faces), "core", regions=labels).report()["regions"]
    assert len(regions) == 6
    for region in regions:
        assert region["totals"]["area"] == pytest.approx(side**2, rel=1e-14)
        for name in ("K", "h", "h_signed", "willmore"):
            statistics = region["columns"][name]
            assert [statistics[key] for key in ("min", "max", "mean", "area_mean", "std")] == pytest.approx(
                [0] * 5, abs=1e-12
            )


@pytest.mark.parametrize("radius", [1e-3, 1.0, 1e3])
def test_a_sphere_of_known_radius(radius: float) -> None:
    """Mean curvature 2/r and Gaussian curvature 1/r² in every region."""
    given = of_sample("icosphere", size=2562)
    labels = np.arange(len(given.faces)) * 7 // len(given.faces)
    report = curvcli.analyze((given.points * radius, given.faces), "core", regions=labels).report()
    for region in report["regions"]:
        for name, exact in (("h_signed", 2 / radius), ("K_density", radius**-2)):
            assert region["columns"][name]["area_mean"] == pytest.approx(exact, rel=0.01)
            assert region["columns"][name]["median"] == pytest.approx(exact, rel=0.01)


def test_components_have_statistics_only_where_some_are_named() -> None:
    one, other = of_sample("icosphere", size=162), of_sample("icosphere", size=42)
    points = np.concatenate([one.points, 2 * other.points + 10])
    both = Mesh(points, np.concatenate([one.faces, other.faces + len(one.points)]).astype(np.int32))
    report = curvcli.analyze((both.points, both.faces), "core").report()
    assert all("columns" not in component for component in report["components"])
    report = curvcli.analyze((both.points, both.faces), "core", stat="count,area_mean").report()
    columns = [component["columns"]["h_signed"] for component in report["components"]]
    assert [each["count"] for each in columns] == [162, 42]
    for each, alone in zip(columns, (one, Mesh(2 * other.points, other.faces)), strict=True):
        mean = curvcli.analyze((alone.points, alone.faces), "core").report()["columns"]["h_signed"]["area_mean"]
        assert each["area_mean"] == pytest.approx(mean, rel=1e-12)


def test_a_single_component_has_the_statistics_of_the_whole() -> None:
    """An unreferenced vertex is a null of the whole and of no component."""
    given = of_sample("icosphere", size=42)
    points = np.concatenate([given.points, [[9, 9, 9]]])
    report = curvcli.analyze((points, given.faces), "core", stat="mean,nulls,std").report()
    (component,) = report["components"]
    whole = report["columns"]["K"]
    assert component["columns"]["K"] == {"mean": whole["mean"], "nulls": 0, "std": whole["std"]}
    assert whole["nulls"] == 1


def test_very_many_regions_have_statistics_only_where_some_are_named() -> None:
    """A report of 100,000 regions stays as long as their topology and totals."""
    one = meshes.tetrahedron()
    points = np.concatenate([one.points + np.array([9 * k, 0, 0]) for k in range(1001)])
    faces, labels = np.concatenate([one.faces + 4 * k for k in range(1001)]), np.repeat(np.arange(1001), 4)
    for count, stat, expected in ((1000, (), True), (1001, (), False), (1001, "mean", True)):
        options = {"regions": labels[: 4 * count], "stat": stat}
        report = curvcli.analyze((points[: 4 * count], faces[: 4 * count]), "K", **options).report()
        assert [("columns" in region) for region in report["regions"]] == [expected] * count


def test_a_region_without_a_value() -> None:
    """A single face has no vertex inside: undefined, counted, never 0."""
    given = meshes.tetrahedron()
    region = curvcli.analyze((given.points, given.faces), "core", regions=np.arange(4)).report()["regions"][0]
    statistics = region["columns"]["K"]
    assert (statistics["count"], statistics["nulls"]) == (0, 3)
    assert all(statistics[name] is None for name in REPORTED if name not in ("count", "nulls"))

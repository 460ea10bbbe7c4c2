"""Triangles of polygons: area, winding and border are kept, in any plane and at any scale."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from curvcli.mesh.file import MeshFile
from curvcli.mesh.polygons import triangulate

ARROW = [(0, 0), (4, 0), (4, 4), (2, 1), (0, 4)]
COMB = [(0, 0), (9, 0), (9, 5), (8, 1), (7, 5), (6, 1), (5, 5), (4, 1), (3, 5), (2, 1), (1, 5)]
SPIRAL = [
    (0, 0),
    (6, 0),
    (6, 6),
    (1, 6),
    (1, 2),
    (4, 2),
    (4, 4),
    (3, 4),
    (3, 3),
    (2, 3),
    (2, 5),
    (5, 5),
    (5, 1),
    (0, 1),
]
HOLE = [(0, 0), (6, 0), (6, 6), (0, 6), (0, 0), (2, 2), (2, 4), (4, 4), (4, 2), (2, 2)]  # joined by a bridge
CONCAVE = [ARROW, COMB, SPIRAL, HOLE]


def mesh(points: np.ndarray, *polygons: list[int]) -> MeshFile:
    sizes = np.array([len(p) for p in polygons], np.int32)
    return MeshFile("obj", np.ascontiguousarray(points.T, float), np.concatenate(polygons).astype(np.int32), sizes)


def areas(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    a, b, c = points[faces].transpose(1, 0, 2)
    return np.asarray(np.cross(b - a, c - a) / 2)


def rotation(seed: int) -> np.ndarray:
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return np.asarray(q * np.sign(np.linalg.det(q)))


def border(faces: list[tuple[int, ...]]) -> Counter[tuple[int, int]]:
    steps = Counter((f[k - 1], f[k]) for f in faces for k in range(len(f)))
    return Counter({step: n for step, n in ((s, n - steps[s[::-1]]) for s, n in steps.items()) if n > 0})


@given(
    st.sampled_from(CONCAVE), st.integers(0, 20), st.integers(0, 99), st.sampled_from([1e-9, 1.0, 1e9]), st.booleans()
)
def test_concave_polygons_are_covered_once(
    outline: list[tuple[int, int]], first: int, seed: int, scale: float, reverse: bool
) -> None:
    outline = np.roll(outline, first, axis=0).tolist()
    if reverse:
        outline.reverse()
    points = np.column_stack([np.array(outline, float), np.zeros(len(outline))]) @ rotation(seed).T * scale
    whole = areas(points, np.array([[0, k, k + 1] for k in range(1, len(outline) - 1)])).sum(0)
    faces, polygon, notices = triangulate(mesh(points, list(range(len(outline)))))
    assert faces.shape == (len(outline) - 2, 3)
    assert polygon is not None
    assert polygon.tolist() == [0] * len(faces)
    each = areas(points, faces)
    np.testing.assert_allclose(each.sum(0), whole, rtol=0, atol=float(1e-12 * np.linalg.norm(whole)))
    assert (each @ whole >= 0).all()
    np.testing.assert_allclose(np.linalg.norm(each, axis=1).sum(), np.linalg.norm(whole), rtol=1e-12)
    assert border([tuple(f) for f in faces.tolist()]) == border([tuple(range(len(outline)))])
    assert [(n.code, n.count) for n in notices] == [("polygons_triangulated", 1)]
    assert "; 1 not convex" in notices[0].message


def test_convex_polygons_become_fans_from_the_first_corner() -> None:
    t = np.arange(6) * np.pi / 3
    points = np.column_stack([np.cos(t), np.sin(t), np.zeros(6)])
    faces, polygon, notices = triangulate(mesh(points, [0, 1, 2], [5, 0, 1, 2, 3, 4], [3, 2, 1, 0], [2, 3, 4]))
    assert faces.tolist() == [
        *[[0, 1, 2]],
        *[[5, 0, 1], [5, 1, 2], [5, 2, 3], [5, 3, 4]],
        *[[3, 2, 1], [3, 1, 0]],
        *[[2, 3, 4]],
    ]
    assert polygon is not None
    assert polygon.tolist() == [0, 1, 1, 1, 1, 2, 2, 3]
    assert [(n.code, n.count, n.examples) for n in notices] == [("polygons_triangulated", 2, (1, 2))]


def test_triangles_alone_are_left_as_they_are() -> None:
    corners = np.arange(6, dtype=np.int32)
    faces, polygon, notices = triangulate(MeshFile("ply", np.zeros((3, 6)), corners))
    assert faces.tolist() == [[0, 1, 2], [3, 4, 5]]
    assert polygon is None
    assert notices == ()


def test_collinear_corners_count_as_convex() -> None:
    points = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)], float)
    faces, _, notices = triangulate(mesh(points, [0, 1, 2, 3, 4]))
    assert faces.tolist() == [[0, 1, 2], [0, 2, 3], [0, 3, 4]]
    assert "; 0 not convex" in notices[0].message


@pytest.mark.parametrize("bad", [np.nan, np.inf, 0.0])
def test_polygons_without_a_plane_still_become_triangles(bad: float) -> None:
    points = np.array([(0, 0, 0), (1, 0, 0), (bad, bad, 0), (0, 0, 0), (bad, 0, bad)], float)
    faces, _, _ = triangulate(mesh(points, [0, 1, 2, 3, 4]))
    assert border([tuple(f) for f in faces.tolist()]) == border([(0, 1, 2, 3, 4)])


def test_a_polygon_that_crosses_itself_is_counted() -> None:
    star = [(np.cos(a), np.sin(a), 0) for a in np.arange(5) * 4 * np.pi / 5]
    faces, _, notices = triangulate(mesh(np.array(star), [0, 1, 2, 3, 4]))
    assert border([tuple(f) for f in faces.tolist()]) == border([(0, 1, 2, 3, 4)])
    assert "polygons_not_simple" in [n.code for n in notices]


def test_a_polygon_of_many_corners_is_cut_in_linear_time() -> None:
    n = 20_000
    t = np.arange(n) * 2 * np.pi / n
    r = 1 + 0.3 * np.cos(n / 2 * t)
    points = np.column_stack([r * np.cos(t), r * np.sin(t), np.zeros(n)])
    faces, _, notices = triangulate(mesh(points, list(range(n))))
    x, y, _ = points.T
    whole = (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2
    each = areas(points, faces)[:, 2]
    assert (each > 0).all()
    np.testing.assert_allclose(each.sum(), whole, rtol=1e-12)
    assert [n.code for n in notices] == ["polygons_triangulated"]

"""The texture of a file as a map: isometric where the surface is unrolled, cut along its seams."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest

import curvcli
from curvcli.analysis.maps import SurfaceMap
from curvcli.analysis.texture import TextureMap
from curvcli.errors import InputError
from curvcli.loading.load import load
from tests.helpers.meshes import Mesh, grid

N, M = 12, 5


def obj(points: np.ndarray, uv: np.ndarray, polygons: list[list[tuple[int, int]]], form: str = "{v}/{t}") -> bytes:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    lines += ["vt " + " ".join(map(repr, row)) for row in uv.tolist()] + ["vn 0 0 1"]
    for polygon in polygons:
        lines.append(
            "f " + " ".join(form.format(v=v + 1, t=t + 1, w=v - len(points), s=t - len(uv)) for v, t in polygon)
        )
    return ("\n".join(lines) + "\n").encode()


def cylinder(quads: bool = False) -> tuple[np.ndarray, np.ndarray, list[list[tuple[int, int]]]]:
    """A prism of N sides and height 1 with M rings, unrolled: one seam from the bottom to the top."""
    side = 2 * np.sin(np.pi / N)
    turn = 2 * np.pi * np.arange(N) / N
    points = np.array([[np.cos(a), np.sin(a), h / (M - 1)] for h in range(M) for a in turn])
    uv = np.array([[k * side, h / (M - 1)] for h in range(M) for k in range(N + 1)])
    polygons = []
    for h in range(M - 1):
        for k in range(N):
            v = [(h * N + k), (h * N + (k + 1) % N), ((h + 1) * N + (k + 1) % N), ((h + 1) * N + k)]
            t = [h * (N + 1) + k, h * (N + 1) + k + 1, (h + 1) * (N + 1) + k + 1, (h + 1) * (N + 1) + k]
            quad = list(zip(v, t, strict=True))
            polygons += [quad] if quads else [quad[:3], [quad[0], quad[2], quad[3]]]
    return points, uv, polygons


def texture(data: bytes, **options: str) -> TextureMap:
    return TextureMap(load(io.BytesIO(data), input_format="obj", texture=True, **options))  # type: ignore[arg-type]


@pytest.mark.parametrize("form", ["{v}/{t}", "{v}/{t}/1", "{w}/{s}", "{w}/{s}/-1", "{v}/{s}/1"])
@pytest.mark.parametrize("quads", [False, True])
def test_an_unrolled_prism_is_isometric(form: str, quads: bool) -> None:
    points, uv, polygons = cylinder(quads)
    f = texture(obj(points, uv, polygons, form))
    assert f.seams == M - 1
    assert len(f.vertex) == len(uv)
    np.testing.assert_allclose(f.sigma_1, 1, rtol=1e-13)
    np.testing.assert_allclose(f.area_distortion, 1, rtol=1e-13)
    assert f.totals["dirichlet"] == pytest.approx(f.totals["area"], rel=1e-13)
    assert (f.orientation == 1).all()
    assert {check.status for check in f.checks} == {"pass"}
    assert [notice.code for notice in f.notices] == ["texture_seams"]
    assert f.harmonic[0] <= f.harmonic[2]
    assert np.isnan(f.harmonic_residual[np.isin(f.vertex, np.arange(0, N * M, N))]).all()


def planar(given: Mesh, uv: np.ndarray) -> bytes:
    return obj(given.points, uv, [[(v, v) for v in face] for face in given.faces.tolist()])


def test_without_seams_it_is_the_map_to_the_plane() -> None:
    given = grid()
    rng = np.random.default_rng(0)
    uv = given.points[:, :2] + rng.normal(size=(len(given.points), 2)) * 0.1
    f, g = texture(planar(given, uv)), SurfaceMap(given.surface(), np.column_stack([uv, np.zeros(len(uv))]))
    assert f.seams == 0
    assert f.totals == g.totals
    for name in ("sigma_1", "sigma_2", "orientation", "area_distortion", "harmonic_residual"):
        np.testing.assert_array_equal(getattr(f, name), getattr(g, name))
    assert f.harmonic == g.harmonic
    assert f.vertex.tolist() == list(range(len(given.points)))


def test_seams_are_where_places_differ_not_their_numbers() -> None:
    """A program that writes every corner's coordinates anew cuts nothing."""
    given = grid()
    uv = given.points[:, :2][given.faces.ravel()]
    corners = np.stack([given.faces.ravel(), np.arange(given.faces.size)], axis=1).reshape(-1, 3, 2)
    f = texture(obj(given.points, uv, [[(v, t) for v, t in face] for face in corners.tolist()]))
    assert f.seams == 0
    assert len(f.vertex) == len(given.points)


def test_charts_are_told_apart() -> None:
    """Every triangle a chart of its own, half of them mirrored: nothing is turned over against its chart."""
    given = grid()
    count = given.faces.size
    uv = np.tile([[0.0, 0], [1, 0], [0, 1]], (len(given.faces), 1)) + np.repeat(np.arange(len(given.faces)), 3)[:, None]
    uv[: count // 2, 0] *= -1
    corners = np.stack([given.faces.ravel(), np.arange(count)], axis=1).reshape(-1, 3, 2)
    f = texture(obj(given.points, uv, [[(v, t) for v, t in face] for face in corners.tolist()]))
    assert (f.orientation == 1).all()
    assert f.seams == int((given.surface().edges.valence == 2).sum())
    assert len(f.turned_over) == 0


def test_a_fold_in_a_texture_is_found() -> None:
    given = grid()
    uv = given.points[:, :2].copy()
    inside = np.flatnonzero(given.surface().interior)[len(given.points) // 9]
    uv[inside] += 2.5 * np.ptp(uv[:, 0]) * np.array([1.0, 0.3])
    f = texture(planar(given, uv))
    a, b, c = (uv[given.faces[:, k]] for k in range(3))
    area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    sign = np.sign(area.sum())
    assert f.turned_over.tolist() == np.flatnonzero(area * sign < 0).tolist() != []


def test_what_is_missing_is_said() -> None:
    given = grid()
    plain = planar(given, given.points[:, :2])
    some = plain.replace(b"f 1/1 ", b"f 1 ", 1)
    assert some != plain
    with pytest.raises(InputError, match=r"1 of \d+ faces have a corner without texture coordinates"):
        texture(some)
    for without in (b"\n".join(line for line in plain.splitlines() if not line.startswith(b"vt")),):
        with pytest.raises(InputError, match="has no texture coordinates"):
            texture(without.replace(b"/", b" ").replace(b"f", b"#f") + b"\nf 1 2 3\n")
    with pytest.raises(InputError, match="texture index 9999 found"):
        texture(plain.replace(b"f 1/1 ", b"f 1/9999 ", 1))
    with pytest.raises(InputError, match="has no texture coordinates"):
        TextureMap(given.surface())


def test_short_faces_and_untidy_text() -> None:
    data = b"v 0 0 0\nv 1 0 0\nv 0 1 0\n  vt  0 0 0.5 # w\nvt 2\t0\nvt 0 2\nf 1/1 2/2\nf  1/1\t2/2  3/3 # all\n"
    f = texture(data)
    np.testing.assert_allclose(f.sigma_1, 2)
    assert f.totals["image_area"] == 2


def test_a_texture_of_one_number_is_a_line() -> None:
    f = texture(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0\nvt 1\nvt 2\nf 1/1 2/2 3/3\n")
    assert f.stretch.collapsed.all()


def test_welding_closes_the_surface_and_not_the_texture() -> None:
    """Vertices doubled along the seam: welded, they are one, and the seam is one of the texture alone."""
    points, uv, polygons = cylinder()
    doubled = [[(t, t) for _, t in polygon] for polygon in polygons]
    place = np.zeros((len(uv), 3))
    for polygon in polygons:
        for v, t in polygon:
            place[t] = points[v]
    apart, joined = (texture(obj(place, uv, doubled), weld=weld) for weld in ("none", "exact"))
    assert (apart.seams, joined.seams) == (0, M - 1)
    assert apart.totals == joined.totals


@pytest.mark.parametrize("names", [("s", "t"), ("u", "v"), ("texture_u", "texture_v")])
def test_coordinates_of_a_ply_file(names: tuple[str, str], tmp_path: Path) -> None:
    given = grid()
    rows = [" ".join(map(repr, [*p, 2 * p[0], p[1]])) for p in given.points.tolist()]
    header = ["ply", "format ascii 1.0", f"element vertex {len(rows)}"]
    header += [f"property double {name}" for name in ("x", "y", "z", *names)]
    header += [f"element face {len(given.faces)}", "property list uchar int vertex_indices", "end_header"]
    faces = [f"3 {a} {b} {c}" for a, b, c in given.faces.tolist()]
    path = tmp_path / "m.ply"
    path.write_text("\n".join([*header, *rows, *faces, ""]))
    f = TextureMap(curvcli.load(path))
    flat = given.points * [2, 1, 0]
    np.testing.assert_allclose(f.image_area, SurfaceMap(given.surface(), flat).image_area)

"""Points and faces as a program has them: of every type, order and layout, its own to change, or not arrays at all."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest
import trimesh

import curvcli
from curvcli.errors import InputError
from curvcli.mesh import arrays
from tests.helpers import meshes

# Of whole numbers, which every type holds.
POINTS = np.array([[0, 0, 0], [2, 0, 0], [0, 3, 0], [0, 0, 5]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
WANTED = curvcli.analyze((POINTS, FACES), "K,H_vec")


def same(given: Any) -> None:
    found = curvcli.analyze(given, "K,H_vec")
    for name in ("K", "H_vec"):
        np.testing.assert_array_equal(found.vertices[name], WANTED.vertices[name])


@pytest.mark.parametrize(
    "kind", ["f2", "<f4", ">f4", "<f8", ">f8", "longdouble", "i1", "u1", "<i2", ">i4", "<i8", ">u8"]
)
def test_types_of_points(kind: str) -> None:
    same((POINTS.astype(kind), FACES))


@pytest.mark.parametrize("kind", ["i1", "u1", "<i2", ">i2", "<i4", ">i4", "<u4", "<i8", ">i8", "<u8", ">u8"])
def test_types_of_faces(kind: str) -> None:
    same((POINTS, FACES.astype(kind)))


def test_arrays_of_every_layout_are_the_same_mesh() -> None:
    """Columns apart, backwards, with gaps, out of a table of records, and out of something that is larger."""
    apart, faces = np.asfortranarray(POINTS, float), np.asfortranarray(FACES)
    gaps = np.repeat(np.repeat(POINTS, 2, axis=0), 3, axis=1)[::2, ::3]
    records = np.zeros(4, [("xyz", float, 3), ("red", "u1")])
    records["xyz"] = POINTS
    for points in (apart, POINTS[::-1].copy()[::-1], gaps, records["xyz"], np.hstack([POINTS, POINTS])[:, 3:]):
        same((points, FACES))
        same((points, faces[:, ::-1][:, ::-1]))


def test_what_stands_for_a_pair_of_arrays() -> None:
    same((POINTS.tolist(), FACES.tolist()))
    same([POINTS, FACES])
    same((POINTS, tuple(map(tuple, FACES))))
    same((np.ma.masked_array(POINTS), np.ma.masked_array(FACES, False)))
    same(trimesh.Trimesh(POINTS, FACES, process=False))


@pytest.mark.parametrize(
    ("points", "faces", "words"),
    [
        ([[0, 0, 0], [1, 0]], FACES, "points have rows of different lengths, expected numbers of shape"),
        (POINTS, [[0, 1, 2], [0, 1]], "faces have rows of different lengths, expected indices of shape"),
        (np.ma.masked_equal(POINTS, 5), FACES, "points have masked entries"),
        (POINTS, np.ma.masked_equal(FACES, 3), "faces have masked entries"),
        (POINTS > 0, FACES, "points have shape (4, 3) and type bool"),
        (POINTS * 1j, FACES, "type complex128"),
        (POINTS.astype(object), FACES, "type object"),
        (POINTS, FACES.astype(str), "faces have shape (4, 3) and type <U21"),
        (POINTS, FACES.astype(float), "type float64, expected indices"),
        (POINTS, FACES > 0, "type bool, expected indices"),
        (POINTS, np.array([[0, 1, 2**63 + 5]], np.uint64), "face 0: corner 9223372036854775813 does not exist"),
        ([], [], "points have shape (0,)"),
        (POINTS, [], "faces have shape (0,)"),
    ],
)
def test_what_is_refused(points: Any, faces: Any, words: str) -> None:
    with pytest.raises(InputError) as raised:
        curvcli.Surface(points, faces)
    assert words in str(raised.value)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize("given", [None, 3, (POINTS,), (POINTS, FACES, FACES), POINTS, trimesh.Scene()])
def test_what_is_no_surface_at_all(given: Any) -> None:
    with pytest.raises(
        TypeError,
        match=r"expected a Surface, a path, a binary stream, a mesh of trimesh, .* or \(points, faces\), not ",
    ):
        curvcli.analyze(given)


def test_a_read_only_view_of_what_may_change_is_copied() -> None:
    """Its owner may still change it; a surface stays as it was made."""
    points, faces = np.asfortranarray(POINTS, float), FACES.astype(np.int32)
    views = points[:], faces[:]
    for view in views:
        view.setflags(write=False)
    surface = curvcli.Surface(*views)
    points *= 2
    faces[:] = 0
    np.testing.assert_array_equal(surface.points, POINTS)
    np.testing.assert_array_equal(surface.faces, FACES)


def test_what_nobody_can_change_is_shared() -> None:
    points, faces = np.array(POINTS.T, float, order="C"), FACES.astype(np.int32)
    for array in (points, faces):
        array.setflags(write=False)
    surface = curvcli.Surface(points.T, faces)
    assert np.shares_memory(surface.points, points)
    assert np.shares_memory(surface.faces, faces)
    turned = curvcli.analyze(surface, orient="outward").surface
    assert np.shares_memory(turned.points, points)


def test_what_a_surface_has_worked_out_is_read_only() -> None:
    """Its arrays are kept, and whoever asks next must find them as they were."""
    surface = meshes.zoo("cap").surface()
    edges = surface.edges
    arrays = [edges.a, edges.b, edges.valence, edges.order, surface.components.face, surface.orientation.patch]
    arrays += [value for name in dir(surface) if isinstance(value := getattr(surface, name), np.ndarray)]
    assert len(arrays) > 20
    for array in arrays:
        assert not array.flags.writeable


# ---------------------------------------------------------------------------- between processes


def test_results_can_be_pickled_and_copied() -> None:
    """Surfaces, results and passes go to another process and back, and may be copied."""
    result = curvcli.analyze(
        meshes.zoo("two_bodies").surface(), "all", regions=meshes.zoo("two_bodies").faces[:, 0] % 2
    )
    for travelled in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result)):
        assert {**travelled.report(), "timings": None} == {**result.report(), "timings": None}
        np.testing.assert_array_equal(travelled.vertices["h"], result.vertices["h"])
    assert pickle.loads(pickle.dumps(curvcli.passes.h)) is curvcli.passes.h
    assert copy.copy(curvcli.passes) == curvcli.passes
    surface = pickle.loads(pickle.dumps(result.surface))
    np.testing.assert_array_equal(curvcli.passes.K(surface), result.vertices["K"])


# ---------------------------------------------------------------------------- options


def test_labels_in_a_file_may_be_named_by_a_path(tmp_path: Path) -> None:
    np.save(tmp_path / "labels.npy", [3, 3, 4, 4])
    report = curvcli.analyze((POINTS, FACES), regions=tmp_path / "labels.npy").report()
    assert [region["name"] for region in report["regions"]] == ["3", "4"]
    assert report["conventions"]["regions"] == str(tmp_path / "labels.npy")


def test_one_check_may_be_named_by_a_word() -> None:
    for names in ("gauss_bonnet", ["gauss_bonnet"], {"gauss_bonnet"}):
        assert {check.name for check in curvcli.analyze((POINTS, FACES), checks=names).checks} == {"gauss_bonnet"}
    found = {check.name for check in curvcli.analyze((POINTS, FACES), checks="volume, gauss_bonnet").checks}
    assert found == {"gauss_bonnet", "volume"}
    with pytest.raises(curvcli.errors.UsageError, match="unknown check 'gauss_bonet'; nearest: gauss_bonnet"):
        curvcli.analyze((POINTS, FACES), checks="gauss_bonet")


@pytest.mark.parametrize("weld", ["exact", "none", 1e-6])
def test_only_files_are_welded(tmp_path: Path, weld: str | float) -> None:
    """Another way of welding is refused for arrays, and for a file that was read with its own."""
    file = tmp_path / "mesh.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nf 1 2 3\nf 4 3 2\n")
    same = curvcli.load(file, weld=weld)
    assert curvcli.analyze(same, "topology", weld=weld).surface is same
    others = [curvcli.load(file, weld=other) for other in ("exact", "none", 1e-6) if other != weld]
    pair = (POINTS, FACES), trimesh.Trimesh(POINTS, FACES, process=False), curvcli.Surface(POINTS, FACES)
    for given in [*others, *(pair if weld != "none" else ())]:
        curvcli.analyze(given, "topology")
        with pytest.raises(curvcli.errors.UsageError, match="merged when a file is read"):
            curvcli.analyze(given, "topology", weld=weld)


@pytest.mark.parametrize("kind", ["i8", ">i4", "u4", "i4"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_arrays_are_taken_over_in_blocks(monkeypatch: pytest.MonkeyPatch, kind: str, order: Literal["C", "F"]) -> None:
    monkeypatch.setattr("curvcli.mesh.arrays.LONG", 4)
    faces = np.random.default_rng(0).integers(0, 30, (19, 3))
    triangles = arrays.as_triangles(np.array(faces, kind, order=order), 30)
    np.testing.assert_array_equal(triangles, faces)
    points = np.random.default_rng(1).normal(size=(30, 3)).astype(np.float32)
    np.testing.assert_array_equal(arrays.as_components(np.array(points, order=order)), points.T.astype(np.float64))
    twice = [i for i, corners in enumerate(faces.tolist()) if len(set(corners)) < 3]
    assert twice
    assert arrays.with_repeated_corner(triangles).tolist() == twice
    faces[17, 1] = 30
    with pytest.raises(InputError, match=r"corner 30 does not exist.*to 29") as caught:
        arrays.as_triangles(faces, 30)
    assert caught.value.place == "face 17"

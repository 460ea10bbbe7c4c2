"""Every sample is the complex it says it is, at every size it can be made in."""

from __future__ import annotations

import numpy as np
import pytest

from curvcli.errors import UsageError
from curvcli.samples import get, names
from tests.samples.brute import topology

NAMES = names()
SIZED = [name for name in NAMES if "size" in {parameter.name for parameter in get(name).parameters}]
TOPOLOGY = tuple(topology([(0, 1, 2)]))


def faces_of(sample: object) -> list[tuple[int, int, int]]:
    return [tuple(face) for face in sample.faces.tolist()]  # type: ignore[attr-defined]


@pytest.mark.parametrize("name", NAMES)
def test_facts_are_those_of_the_mesh(name: str) -> None:
    sample = get(name)()
    assert {key: sample.facts[key] for key in TOPOLOGY} == topology(faces_of(sample))
    assert set(np.unique(sample.faces)) == set(range(len(sample.points)))


@pytest.mark.parametrize("size", [1, 7, 13, 30, 100, 333])
@pytest.mark.parametrize("name", SIZED)
def test_small_meshes_are_sound_or_refused(name: str, size: int) -> None:
    try:
        sample = get(name)(size=size)
    except UsageError as refusal:
        assert "size" in str(refusal) or "seed" in str(refusal)  # noqa: PT017
        assert size < 100
        return
    assert {key: sample.facts[key] for key in TOPOLOGY} == topology(faces_of(sample))
    assert len(np.unique(sample.points, axis=0)) == len(sample.points)


@pytest.mark.parametrize("size", [300, 2000, 20000])
@pytest.mark.parametrize("name", SIZED)
def test_size_is_kept_within_a_factor_two(name: str, size: int) -> None:
    assert size / 2 <= len(get(name)(size=size).points) <= 2 * size


@pytest.mark.parametrize("name", NAMES)
def test_shapes_and_types(name: str) -> None:
    sample = get(name)()
    assert sample.points.dtype == np.float64
    assert sample.points.shape == (len(sample.points), 3)
    assert np.isfinite(sample.points).all()
    assert sample.faces.dtype == np.int32
    assert sample.faces.shape == (len(sample.faces), 3)
    assert sample.points.flags.c_contiguous
    assert sample.faces.flags.c_contiguous
    for column in sample.exact.values():
        assert column.dtype == np.float64
        assert column.shape == (len(sample.points),)


@pytest.mark.parametrize("name", NAMES)
def test_no_vertex_is_doubled_and_no_face_flat(name: str) -> None:
    sample = get(name)()
    assert len(np.unique(sample.points, axis=0)) == len(sample.points)
    a, b, c = (sample.points[corner] for corner in sample.faces.T)
    longest = np.max([((p - q) ** 2).sum(1) for p, q in ((a, b), (b, c), (c, a))], axis=0)
    assert (np.linalg.norm(np.cross(b - a, c - a), axis=1) > 1e-6 * longest).all()


@pytest.mark.parametrize("name", NAMES)
def test_closed_surfaces_are_wound_outward(name: str) -> None:
    sample = get(name)()
    if sample.facts["closed"] and sample.facts["orientable"]:
        volume = np.linalg.det(sample.points[sample.faces]).sum() / 6
        assert volume > 0
        if "volume" in sample.facts:
            assert volume == pytest.approx(sample.facts["volume"], rel=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_convex_means_every_vertex_behind_every_face(name: str) -> None:
    sample = get(name)()
    if "convex" not in sample.facts:
        return
    a, b, c = (sample.points[corner] for corner in sample.faces.T)
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    highest = (normal @ sample.points.T - np.einsum("ij,ij->i", normal, a)[:, None]).max()
    assert (highest < 1e-13 * np.ptp(sample.points)) == sample.facts["convex"]


@pytest.mark.parametrize("name", NAMES)
def test_made_twice_is_the_same(name: str) -> None:
    first, second = get(name)(), get(name)()
    assert first.points.tobytes() == second.points.tobytes()
    assert first.faces.tobytes() == second.faces.tobytes()


@pytest.mark.parametrize("name", ["irregular_sphere", "irregular_torus", "irregular_ellipsoid"])
def test_another_seed_is_another_mesh(name: str) -> None:
    first, second = get(name)(seed=1), get(name)(seed=2)
    assert not np.array_equal(first.points, second.points)
    assert {key: second.facts[key] for key in TOPOLOGY} == topology(faces_of(second))


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in SIZED if name not in {"pinched", "book"}])
def test_a_hundred_thousand_vertices(name: str) -> None:
    sample = get(name)(size=100_000)
    edges = np.sort(np.concatenate([sample.faces[:, [0, 1]], sample.faces[:, [1, 2]], sample.faces[:, [2, 0]]]), axis=1)
    keys, users = np.unique(edges[:, 0].astype(np.int64) * len(sample.points) + edges[:, 1], return_counts=True)
    assert users.max() == 2
    assert (users.min() == 2) == sample.facts["closed"]
    assert len(sample.points) - len(keys) + len(sample.faces) == sample.facts["euler_characteristic"]

"""Self-intersections against rational arithmetic: small complexes that touch, overlap, cross and share corners."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from itertools import combinations

import numpy as np
import pytest

from curvcli.mesh.intersections.pairs import KINDS
from curvcli.mesh.intersections.search import face_contacts
from curvcli.mesh.surface import Surface
from curvcli.samples.catalogue import names
from tests.helpers import meshes
from tests.helpers.meshes import Floats, Ints, Mesh
from tests.helpers.rational_contacts import has_area, kind_of_contact

Place = Callable[[Floats], Floats]

TURN = np.linalg.qr(np.random.default_rng(7).normal(size=(3, 3)))[0]
PLACES: dict[str, Place] = {
    "on a grid": lambda x: x,
    "turned": lambda x: x @ TURN,
    "turned and far away": lambda x: x @ TURN + 1e6,
    "large": lambda x: x * 1e9 / 3,
    "small": lambda x: x * 1e-9 / 3,
    "needles": lambda x: x * [1, 1e-7, 1e7],
    "tiny": lambda x: x * 2.0**-320,
}


def small_complex(seed: int) -> tuple[Floats, Ints]:
    """Up to 12 faces over few grid points, some of them at one position, flat or in space; none without area."""
    rng = np.random.default_rng(seed)
    points = rng.integers(-2, 3, (rng.integers(5, 9), 3)).astype(float)
    if rng.random() < 0.5:
        points[:, 2] = 0
        points = points @ rng.integers(-1, 2, (3, 3)) if rng.random() < 0.5 else points
    faces = [face for face in combinations(range(len(points)), 3) if has_area(points[list(face)])]
    chosen = rng.permutation(len(faces))[:12]
    return points, np.array([faces[k] for k in sorted(chosen)], np.int32).reshape(-1, 3)


def expected(points: Floats, faces: Ints) -> dict[tuple[int, int], str]:
    """The contacts of every two faces with different corners."""
    result = {}
    for one, other in combinations(range(len(faces)), 2):
        p, q = points[faces[one]], points[faces[other]]
        if {*map(tuple, p)} != {*map(tuple, q)} and has_area(p) and has_area(q):
            kind = kind_of_contact(p.tolist(), q.tolist())
            if kind != "apart":
                result[one, other] = kind
    return result


def contacts_of(points: Floats, faces: Ints) -> dict[tuple[int, int], str]:
    contacts = face_contacts(Surface(points, faces))
    pairs = zip(contacts.one.tolist(), contacts.other.tolist(), strict=True)
    return dict(zip(pairs, [KINDS[kind] for kind in contacts.kind], strict=True))


def check_against_rationals(seeds: range, place: Place) -> Counter[str]:
    seen: Counter[str] = Counter()
    for seed in seeds:
        points, faces = small_complex(seed)
        if len(faces):
            points = place(points)
            wanted = expected(points, faces)
            assert contacts_of(points, faces) == wanted, seed
            seen.update(wanted.values())
    return seen


@pytest.mark.parametrize("place", PLACES)
def test_small_complexes_agree_with_rationals(place: str) -> None:
    seen = check_against_rationals(range(12), PLACES[place])
    assert seen["crossing"] > 5
    if place in ("on a grid", "tiny"):
        assert min(seen[kind] for kind in KINDS[1:]) > 5, seen


@pytest.mark.slow
@pytest.mark.parametrize("place", PLACES)
def test_many_small_complexes_agree_with_rationals(place: str) -> None:
    check_against_rationals(range(1000, 1040), PLACES[place])


# Immersions that cross themselves: no closed one-sided surface is embedded, and a nodoid winds through itself.
IMMERSED = ("nodoid", "klein_bottle", "projective_plane")


@pytest.mark.parametrize("sample", names())
def test_samples_are_embedded_but_for_immersions(sample: str) -> None:
    kinds = set(contacts_of(*meshes.of_sample(sample)).values())
    assert "crossing" in kinds if sample in IMMERSED else not kinds


def test_a_flat_turned_grid_has_no_contact() -> None:
    """Every two neighbours lie in one plane within rounding."""
    mesh = meshes.grid(12)
    assert not contacts_of((mesh.points * [1, 1, 0]) @ TURN, mesh.faces)


def test_seams_are_no_contacts() -> None:
    """Faces that meet at corners of one position, without common vertices."""
    mesh = meshes.of_sample("icosphere")
    apart = np.arange(mesh.faces.size, dtype=np.int32).reshape(-1, 3)
    assert not contacts_of(mesh.points[mesh.faces].reshape(-1, 3), apart)


def test_faces_without_area_and_duplicates_are_no_contacts() -> None:
    mesh = meshes.tetrahedron()
    points = np.concatenate([mesh.points, [[1.0, 1.5, 0.0]]])
    faces = np.concatenate([mesh.faces, mesh.faces[:1], [[1, 4, 2]]])
    assert not contacts_of(points, faces.astype(np.int32))


def crossing_planes(n: int) -> Mesh:
    """Two square sheets of 2 n² faces that cross at a right angle along x = ½, away from their edges' ends."""
    sheet = meshes.grid(n)
    flat = sheet.points * [1 / n, 1 / n, 0]
    upright = np.stack([np.full(len(flat), 0.5 + 1e-3), flat[:, 1] * 1.1 - 0.05, flat[:, 0] - 0.5], axis=1)
    return Mesh(np.concatenate([flat, upright]), np.concatenate([sheet.faces, sheet.faces + len(flat)]))


def test_points_of_contact_lie_in_both_faces() -> None:
    mesh = crossing_planes(20)
    contacts = face_contacts(mesh.surface())
    points = contacts.points(mesh.surface())
    assert len(points) > 40
    np.testing.assert_allclose(points[:, 0], 0.5 + 1e-3, atol=1e-15)
    np.testing.assert_allclose(points[:, 2], 0, atol=1e-15)
    assert ((points[:, 1] >= 0) & (points[:, 1] <= 1)).all()


def test_the_kind_does_not_depend_on_order_or_winding() -> None:
    points, faces = small_complex(3)
    wanted = contacts_of(points, faces)
    turned = contacts_of(points, faces[::-1, ::-1])
    last = len(faces) - 1
    assert {(last - other, last - one): kind for (one, other), kind in turned.items()} == wanted

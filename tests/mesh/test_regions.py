"""Regions: any set of faces keeps every identity, its totals add up, and a label out of place is noticed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given as drawn
from hypothesis import settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import curvcli
from curvcli.api import Analysis
from curvcli.checks.catalogue import identities as known_identities
from curvcli.curvatures.registry import passes
from curvcli.errors import InputError, UsageError
from tests.helpers import meshes, strategies
from tests.helpers.meshes import Mesh, of_sample

Labels = NDArray[np.int64]


def analyse(given: Mesh, labels: Labels) -> Analysis:
    return curvcli.analyze((given.points, given.faces), "all", regions=labels)


def codes(result: Analysis) -> dict[str, int]:
    return {notice.code: notice.count for notice in result.notices}


def test_every_identity_is_run_on_every_region() -> None:
    """Also the ones whose needs come last; the names are those of the interface."""
    identities = {"gauss_bonnet", "gauss_bonnet_combinatorial", "force_balance", "torque_balance", "position_balance"}
    identities |= {"vector_area", "area_gradient", "volume", "dirichlet", "first_variation", "holonomy"}
    identities |= {"total_absolute_curvature", "fenchel"}
    assert identities <= known_identities().keys()
    result = analyse(meshes.torus(), np.arange(200) % 3)
    scopes = {(check.name, check.scope) for check in result.checks}
    assert scopes >= {(name, scope) for name in identities for scope in ("whole", "region 0", "region 1", "region 2")}


@settings(max_examples=80)
@drawn(strategies.any_mesh(), st.integers(1, 6), st.integers(0, 2**32 - 1), st.booleans())
def test_any_labelling_keeps_every_identity(given: Mesh, many: int, seed: int, some_without: bool) -> None:
    labels = np.random.default_rng(seed).integers(-1 if some_without else 0, many, len(given.faces))
    labels[0] = 0
    result = analyse(given, labels)
    assert not [check for check in result.checks if check.status == "fail"]
    named = [f"region {label}" for label in np.unique(labels[labels >= 0])]
    for name in ("gauss_bonnet", "force_balance", "area_gradient"):
        of_regions = [check for check in result.checks if check.name == name and check.scope.startswith("region")]
        assert [check.scope for check in of_regions] == named
        assert all(check.status != "not_applicable" or "null" in check.detail for check in of_regions), of_regions
    adds_up(result, labels)


def adds_up(result: Analysis, labels: Labels) -> None:
    """Areas of regions are those of their faces; what has no label is missing from their sum and from nothing else."""
    regions = result.report()["regions"]
    face_area = result.faces["area"]
    areas = [face_area[labels == label].sum() for label in np.unique(labels[labels >= 0])]
    np.testing.assert_allclose([region["totals"]["area"] for region in regions], areas, rtol=1e-12)
    counted = [region["topology"]["faces"] for region in regions]
    assert sum(counted) == np.count_nonzero(labels >= 0)
    if (labels >= 0).all():
        assert sum(areas) == pytest.approx(result.totals["area"], rel=1e-12)


@settings(max_examples=30)
@drawn(strategies.any_mesh())
def test_one_region_is_the_whole(given: Mesh) -> None:
    result = analyse(given, np.full(len(given.faces), 7))
    # Where a face lies on another one the surface is folded by π, which is convex or hollow by rounding alone.
    folded = {"H_theta", "H_sin", "H_tan"} if "duplicate_faces" in codes(result) else set()
    (region,), whole = result.report()["regions"], result.report()
    assert region["name"] == "7"
    for key in whole["totals"].keys() - folded:
        value, found = whole["totals"][key], region["totals"][key]
        if value is None or found is None or None in np.atleast_1d(value).tolist():
            assert np.atleast_1d(found).tolist() == np.atleast_1d(value).tolist(), key
        else:
            np.testing.assert_allclose(found, value, rtol=1e-10, atol=1e-10 * whole["totals"]["area"], err_msg=key)
    counted = whole["topology"] | {"unreferenced_vertices": 0}
    # Reoriented for the computation, the copy is wound consistently from the start.
    for key in counted.keys() - {"consistent_winding"}:
        assert region["topology"][key] == counted[key], key


def test_a_moebius_strip_cut_from_a_klein_bottle() -> None:
    bottle = of_sample("klein_bottle", size=400)
    columns = int(np.flatnonzero(np.abs(np.diff(np.arctan2(bottle.points[:, 1], bottle.points[:, 0]))) > 1e-9)[0]) + 1
    place = bottle.faces % columns
    labels = (place.max(axis=1) > columns // 2).astype(np.int64)
    report = analyse(bottle, labels).report()
    assert not [check for check in report["checks"] if check["status"] == "fail"]
    assert [region["topology"]["boundary_loops"] for region in report["regions"]].count(0) == 0
    assert sum(region["topology"]["euler_characteristic"] for region in report["regions"]) == 0
    assert not all(region["topology"]["orientable"] for region in report["regions"])


def test_integrals_of_two_halves_add_up() -> None:
    """K + κ_g of both, cut along a curve, is 2π(χ + χ): the two geodesic curvatures of the cut cancel."""
    body = of_sample("irregular_torus", size=300)
    upper = body.points[body.faces].mean(axis=1)[:, 2] > 0.05
    report = analyse(body, upper.astype(np.int64)).report()
    for region in report["regions"]:
        chi = region["topology"]["euler_characteristic"]
        assert region["totals"]["K"] + region["totals"]["kappa_g"] == pytest.approx(2 * np.pi * chi, abs=1e-11)
    for key in ("area", "dirichlet", "A_vec"):
        parts = np.array([region["totals"][key] for region in report["regions"]])
        np.testing.assert_allclose(parts.sum(axis=0), report["totals"][key], rtol=1e-12, atol=1e-12)


# ---------------------------------------------------------------------------- labels out of place


def halves() -> tuple[Mesh, Labels]:
    body = of_sample("icosphere", size=300)
    return body, (body.points[body.faces].mean(axis=1)[:, 0] > 0.01).astype(np.int64)


def touching(given: Mesh) -> NDArray[np.bool_]:
    """(F, F) whether two faces share a vertex."""
    at = np.zeros((len(given.faces), len(given.points)), np.int32)
    np.put_along_axis(at, given.faces, 1, axis=1)
    return np.asarray(at @ at.T > 0)


def test_halves_are_sound() -> None:
    assert not codes(analyse(*halves())).keys() & {"regions_in_pieces", "regions_pinched"}


@pytest.mark.parametrize("seed", range(6))
def test_one_label_moved(seed: int) -> None:
    """A face all of whose neighbours carry the other label: its new region falls into two pieces."""
    body, labels = halves()
    near = touching(body)
    deep = np.flatnonzero([len(np.unique(labels[row])) == 1 for row in near])
    face = int(np.random.default_rng(seed).choice(deep))
    labels[face] = 1 - labels[face]
    result = analyse(body, labels)
    assert codes(result)["regions_in_pieces"] == 1
    (notice,) = [notice for notice in result.notices if notice.code == "regions_in_pieces"]
    assert notice.examples == (str(labels[face]),)
    assert result.passed


def test_one_label_moved_beside_the_border() -> None:
    """A face that touches the other region in one vertex alone: pinched there."""
    body, labels = halves()
    seam = np.intersect1d(body.faces[labels == 0], body.faces[labels == 1])
    on_seam = np.isin(body.faces, seam).sum(axis=1)
    found = 0
    for face in np.flatnonzero(on_seam == 1)[:10]:
        moved = labels.copy()
        moved[face] = 1 - moved[face]
        result = analyse(body, moved)
        assert codes(result)["regions_pinched"] >= 1
        assert result.passed
        found += 1
    assert found == 10


# ---------------------------------------------------------------------------- what labels may be


@pytest.mark.parametrize("kind", ["int8", "uint8", "int64", "uint64", "float32", "float64", "bool"])
def test_kinds_of_numbers(kind: str) -> None:
    body, labels = halves()
    plain = analyse(body, labels).report()["regions"]
    assert analyse(body, labels.astype(kind)).report()["regions"] == plain


def test_labels_need_not_be_consecutive() -> None:
    body, labels = halves()
    report = analyse(body, np.where(labels == 0, 2**40, 12)).report()
    assert [region["name"] for region in report["regions"]] == ["12", str(2**40)]


@pytest.mark.parametrize(
    ("labels", "words"),
    [
        (np.zeros(3), "3 labels, expected 4"),
        (np.zeros(0), "0 labels"),
        (np.zeros((4, 1)), "shape (4, 1)"),
        (np.zeros(()), "shape ()"),
        (np.array([0, 0.5, 1, 1]), "label 0.5 of face 1"),
        (np.array([0, 1, np.nan, 1]), "label nan of face 2"),
        (np.array([0, 1, 1, np.inf]), "label inf of face 3"),
        (np.array([0, 1e300, 1, 1]), "label 1e+300 of face 1"),
        (
            np.array([0, 2**63, 1, 1], np.uint64),
            "9223372036854775808 of face 1, expected a whole number below 2^63",
        ),
        (np.array([0, 2.0**53, 1, 1]), "below 2^53, or integers in a .npy file"),
        (np.array([0, 1, -(2.0**24), 1], np.float32), "below 2^24"),
        (np.array(["a", "b", "c", "d"]), "<U1"),
        (np.array([0, None, 1, 1], object), "object"),
        (np.ones(4, complex), "complex128"),
        (-np.ones(4), "no face has a label"),
    ],
)
def test_what_is_no_labelling(labels: NDArray[Any], words: str) -> None:
    with pytest.raises(InputError) as raised:
        curvcli.analyze(tuple(meshes.tetrahedron()), regions=labels)
    assert words in str(raised.value)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize("name", ["groups", "quality", "labels.dat", ""])
def test_a_surface_of_arrays_has_no_records(name: str) -> None:
    with pytest.raises(UsageError, match="--regions"):
        curvcli.analyze(tuple(meshes.tetrahedron()), regions=name)


def test_edges_of_regions_are_boundary() -> None:
    """Densities and energies of a region are those of its inner vertices; nothing reaches across the cut."""
    body, labels = halves()
    report = analyse(body, labels).report()
    column = curvcli.analyze((body.points, body.faces), "all").vertices
    corners = [np.unique(body.faces[labels == label]) for label in (0, 1)]
    seam = np.intersect1d(corners[0], corners[1])
    for region, own in zip(report["regions"], corners, strict=True):
        inner = np.setdiff1d(own, seam)
        for quantity in ("K", "K_plus", "K_minus", "willmore", "willmore_hks", "willmore_perp", "willmore_conformal"):
            assert passes.quantity(quantity).total == quantity
            assert region["totals"][quantity] == pytest.approx(column[quantity][inner].sum(), rel=1e-11, abs=1e-12)


@pytest.mark.parametrize("orient", ["file", "outward"])
@pytest.mark.parametrize("first", [0, 1])
def test_regions_are_oriented_as_the_whole_is(first: int, orient: Any) -> None:
    """The lowest face of the whole decides, or the outside, also where all of a region is wound the other way."""
    body, labels = halves()
    sound = analyse(body, labels).report()["regions"]
    faces = body.faces.copy()
    faces[labels == first] = faces[labels == first][:, ::-1]
    turned = curvcli.analyze((body.points, faces), "all", regions=labels, orient=orient)
    side = -1 if orient == "file" and labels[0] == first else 1
    for region, known in zip(turned.report()["regions"], sound, strict=True):
        for key in ("H_theta", "H_sin", "A_vec"):
            wanted = side * np.array(known["totals"][key])
            np.testing.assert_allclose(region["totals"][key], wanted, rtol=1e-12, atol=1e-13, err_msg=key)


def test_what_is_said_of_regions_names_their_labels() -> None:
    body, labels = halves()
    deep = np.flatnonzero([len(np.unique(labels[row])) == 1 for row in touching(body)])
    labels[deep[0]] = 1 - labels[deep[0]]
    result = analyse(body, labels * 100 + 8)
    (notice,) = [notice for notice in result.notices if notice.code == "regions_in_pieces"]
    assert notice.examples == (str(labels[deep[0]] * 100 + 8),)


def test_labels_of_dropped_faces_alone(tmp_path: Path) -> None:
    """A face with a repeated corner is dropped, and with it the one label or group that it had."""
    (tmp_path / "m.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\ng whole\nf 1 2 3\ng lost\nf 1 2 2\ng empty\n")
    for regions, label in (("groups", "lost"), (np.array([1, 2]), "2")):
        result = curvcli.analyze(tmp_path / "m.obj", regions=regions)
        (notice,) = [notice for notice in result.notices if notice.code == "labels_without_faces"]
        assert (notice.count, notice.examples) == (1, (label,))
        assert len(result.report()["regions"]) == 1

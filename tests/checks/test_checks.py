"""Checks that can fail do: one wrong value, one flipped, missing or doubled face, one NaN — each is reported."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import curvcli
from curvcli.checks.base import Check
from curvcli.checks.catalogue import identities
from curvcli.curvatures.catalogue import loaded
from curvcli.curvatures.engine import evaluate
from curvcli.errors import InputError
from curvcli.mesh.groups import Groups
from curvcli.mesh.surface import Surface
from tests.helpers import meshes
from tests.helpers.meshes import Mesh

Columns = dict[str, NDArray[Any]]

# Which check notices one disturbed value of a column; vectors are disturbed in each component.
GUARDS = {
    "K": "gauss_bonnet",
    "kappa_g": "gauss_bonnet",
    "K_comb": "gauss_bonnet_combinatorial",
    "A_vec": "vector_area",
    "H_vec": "force_balance",
    "area_gradient": "area_gradient",
    "face_area": "area_gradient",
}


def columns(surface: Surface) -> Columns:
    wanted = {need for rule in identities().values() for need in rule.needs}
    return evaluate(loaded(), surface, wanted)


def run(name: str, surface: Surface, found: Columns) -> list[Check]:
    groups = [surface.whole, *([surface.components] if surface.components.count > 1 else [])]
    return [check for group in groups for check in identities()[name].run(surface, group, found)]


def disturbed(found: Columns, column: str, element: int, component: int | None, surface: Surface) -> Columns:
    """The columns with one value off by a millionth of the size of its column."""
    values = found[column].copy()
    size = np.nanmax(np.abs(values)) or 1.0
    where = element if component is None else (component, element)
    assert not np.isnan(values[where])
    values[where] += 1e-6 * size
    return found | {column: values}


def places(found: Columns, column: str, many: int = 12) -> list[tuple[int, int | None]]:
    """Some elements where the column is defined, and each of its components."""
    values = found[column]
    defined = np.flatnonzero(~np.isnan(values).reshape(-1, values.shape[-1]).any(axis=0))
    each: list[int | None] = [None] if values.ndim == 1 else [0, 1, 2]
    return [(int(element), k) for element in defined[:: max(1, len(defined) // many)] for k in each]


@pytest.mark.parametrize("name", ["ellipsoid", "cap", "grid", "torus", "two_bodies"])
@pytest.mark.parametrize("column", GUARDS)
def test_one_disturbed_value_is_noticed(column: str, name: str) -> None:
    guard = GUARDS[column]
    surface = meshes.zoo(name).surface()
    found = columns(surface)
    assert [check.status for check in run(guard, surface, found)].count("pass") >= 1
    for element, component in places(found, column):
        after = run(guard, surface, disturbed(found, column, element, component, surface))
        assert any(check.status == "fail" for check in after if check.scope == "whole"), (element, component)
        if surface.components.count > 1:
            assert [check.status for check in after].count("fail") == 2


@pytest.mark.parametrize("name", ["ellipsoid", "torus"])
def test_the_volume_notices_a_disturbed_vector_area(name: str) -> None:
    """Along the vertex as seen from the base point, which is all that the volume sees."""
    surface = meshes.zoo(name).surface()
    found = columns(surface)
    arm = surface.xyz - surface.base[:, None]
    for element in np.flatnonzero(np.abs(arm).sum(axis=0))[::5]:
        values = found["A_vec"].copy()
        values[:, element] += 1e-6 * arm[:, element]
        (check,) = run("volume", surface, found | {"A_vec": values})
        assert check.status == "fail"


@pytest.mark.parametrize("name", ["ellipsoid", "cap", "klein_bottle"])
def test_values_at_the_wrong_vertices_are_noticed(name: str) -> None:
    """The sum of forces is the same; their moments are not."""
    surface = meshes.zoo(name).surface()
    found = columns(surface)
    one, other = np.flatnonzero(surface.interior)[[2, 9]]
    values = found["H_vec"].copy()
    values[:, [one, other]] = values[:, [other, one]]
    swapped = found | {"H_vec": values}
    for check, status in {"force_balance": "pass", "torque_balance": "fail", "position_balance": "fail"}.items():
        assert [result.status for result in run(check, surface, found)] == ["pass"]
        assert [result.status for result in run(check, surface, swapped)] == [status], check


@pytest.mark.parametrize("name", ["ellipsoid", "cap", "klein_bottle"])
@pytest.mark.parametrize("change", [1e-9, np.pi])
def test_transport_round_a_vertex_notices_its_curvature(change: float, name: str) -> None:
    surface = meshes.zoo(name).surface()
    found = columns(surface)
    assert [result.status for result in run("holonomy", surface, found)] == ["pass"]
    for vertex in np.flatnonzero(surface.interior)[::7]:
        values = found["K"].copy()
        values[vertex] += change
        assert [result.status for result in run("holonomy", surface, found | {"K": values})] == ["fail"]


@pytest.mark.parametrize("column", ["area_gradient", "A_vec"])
def test_first_variations_notice_gradients_that_are_none(column: str) -> None:
    """Off by a millionth, at any of the vertices that are moved."""
    surface = meshes.tetrahedron().surface()
    found = columns(surface)
    assert [result.status for result in run("first_variation", surface, found)] == ["pass"]
    for vertex in range(surface.n_vertices):
        values = found[column].copy()
        values[:, vertex] *= 1 + 1e-6
        assert [result.status for result in run("first_variation", surface, found | {column: values})] == ["fail"]


def test_every_public_integral_is_guarded_by_a_check() -> None:
    """A column whose sum is an identity's side is named in the needs of some check."""
    from curvcli.curvatures.registry import passes

    needed = {need for rule in identities().values() for need in rule.needs}
    assert {q.name for q in passes.quantities() if q.name in GUARDS} <= needed


@pytest.mark.parametrize("column", ["K", "H_vec", "A_vec", "area_gradient"])
def test_an_undefined_value_is_not_passed_over(column: str) -> None:
    """A null in a term leaves nothing to test: not applicable, with the place, and never pass."""
    surface = meshes.zoo("ellipsoid").surface()
    found = columns(surface)
    values = found[column].copy()
    values[..., 7] = np.nan
    for check in run(GUARDS[column], surface, found | {column: values}):
        assert check.status == "not_applicable"
        assert "vertex 7" in check.detail


def told(surface: Surface, groups: Groups, found: Columns, name: str) -> list[tuple[str, str]]:
    return [(check.status, check.detail) for check in identities()[name].run(surface, groups, found)]


def test_each_piece_is_told_of_its_own_vertices() -> None:
    """Counts and the first place of a component are its own; regions, whose vertices are copies, have no place."""
    surface = meshes.two_bodies().surface()
    found, n = columns(surface), len(meshes.torus().points)
    values = found["K"].copy()
    values[[3, n + 5, n + 8]] = np.nan
    disturbed = found | {"K": values}
    null = "the angle defect is undefined at "
    assert told(surface, surface.whole, disturbed, "gauss_bonnet") == [
        ("not_applicable", f"{null}3 vertices, the first is 3")
    ]
    assert told(surface, surface.components, disturbed, "gauss_bonnet") == [
        ("not_applicable", f"{null}vertex 3"),
        ("not_applicable", f"{null}2 vertices, the first is {n + 5}"),
    ]
    region = replace(surface.components, kind="region")
    assert told(surface, region, disturbed, "gauss_bonnet") == [
        ("not_applicable", f"{null}one vertex"),
        ("not_applicable", f"{null}2 vertices"),
    ]
    values[n:] = found["K"][n:]
    assert [status for status, _ in told(surface, surface.components, disturbed, "gauss_bonnet")] == [
        "not_applicable",
        "pass",
    ]


def test_each_piece_is_told_of_what_was_tried_on_it() -> None:
    """Vertices of very large stars are not walked, and of many vertices some are moved."""
    one, other = meshes.fan(300), meshes.fan(20)
    surface = meshes.joined(one, other.moved(other.points + 5.0)).surface()
    found = columns(surface)
    first, second = told(surface, surface.components, found, "holonomy")
    assert first == ("not_applicable", "no interior vertex whose faces all have an area")
    assert second == ("pass", "largest deviation of the rotation from K")
    (whole,) = told(surface, surface.whole, found, "holonomy")
    assert whole == ("pass", "largest deviation of the rotation from K; 1 vertex not walked")
    moved = [detail.split()[3] for _, detail in told(surface, surface.components, found, "first_variation")]
    assert sum(map(int, moved)) == 64


def test_loops_of_a_region_have_no_number() -> None:
    surface = meshes.grid().surface()
    ((_, whole),) = told(surface, surface.whole, {}, "fenchel")
    ((_, region),) = told(surface, replace(surface.whole, kind="region", names=("0",)), {}, "fenchel")
    assert (whole.split("; ")[1], region.split("; ")[1]) == ("loop 0 turns least", "told of the loop that turns least")


def test_an_infinite_value_fails() -> None:
    surface = meshes.zoo("ellipsoid").surface()
    found = columns(surface)
    values = found["K"].copy()
    values[3] = np.inf
    (check,) = run("gauss_bonnet", surface, found | {"K": values})
    assert check.status == "fail"
    assert (check.value, check.residual) == (None, None)


def warned(given: Mesh) -> dict[str, int]:
    result = curvcli.analyze(given.surface(), "all")
    assert result.passed
    return {notice.code: notice.count for notice in result.notices}


@pytest.mark.parametrize("face", [0, 1, 30, 75])
def test_one_flipped_face(face: int) -> None:
    """Three edges disagree; curvatures are those of the mesh as it was, up to the side it is seen from."""
    body = meshes.zoo("ellipsoid")
    faces = body.faces.copy()
    faces[face] = faces[face][::-1]
    flipped = body.with_faces(faces)
    assert warned(flipped)["inconsistent_winding"] == 3
    result, plain = curvcli.analyze(flipped.surface()), curvcli.analyze(body.surface())
    assert not result.report()["topology"]["consistent_winding"]
    np.testing.assert_allclose(result.vertices["K"], plain.vertices["K"], rtol=0, atol=5e-14)
    # The first face decides: flipped itself, it turns the whole surface.
    side = -1 if face == 0 else 1
    np.testing.assert_allclose(result.vertices["h_signed"], side * plain.vertices["h_signed"], rtol=1e-11)
    assert ("inside_out" in warned(flipped)) == (face == 0)


def test_a_missing_face() -> None:
    body = meshes.zoo("ellipsoid")
    result = curvcli.analyze(body.with_faces(body.faces[1:]).surface(), "all")
    found = result.report()["topology"]
    assert (found["closed"], found["boundary_edges"], found["boundary_loops"]) == (False, 3, 1)
    assert found["euler_characteristic"] == 1
    assert result.vertices["status"].tolist().count("boundary") == 3
    assert result.totals["volume"] is None
    status = {check.name: check.status for check in result.checks}
    assert status["volume"] == "not_applicable"
    assert status["gauss_bonnet"] == "pass"


@pytest.mark.parametrize("turn", [[0, 1, 2], [1, 2, 0], [2, 1, 0]])
def test_a_doubled_face(turn: list[int]) -> None:
    body = meshes.zoo("ellipsoid")
    again = body.with_faces(np.vstack([body.faces, body.faces[5][turn]]))
    found = warned(again)
    assert (found["duplicate_faces"], found["nonmanifold_edges"]) == (1, 3)
    (notice,) = [n for n in curvcli.analyze(again.surface()).notices if n.code == "duplicate_faces"]
    assert notice.examples == (len(body.faces),)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_coordinate_that_is_no_number(value: float) -> None:
    body = meshes.zoo("ellipsoid")
    points = body.points.copy()
    points[11, 2] = value
    with pytest.raises(InputError, match="vertex 11") as raised:
        curvcli.analyze((points, body.faces))
    assert "not finite" in str(raised.value)


def test_a_sound_mesh_has_no_warning() -> None:
    """But of its own coarseness: two rings of its 40 vertices reach round half of it."""
    assert set(warned(meshes.zoo("ellipsoid"))) <= {"clamped_radicand", "no_graph"}

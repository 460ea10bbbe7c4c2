"""True statements about a mesh: digits that are lost, results beyond doubles, the effect of welding."""

from __future__ import annotations

import dataclasses
import json
import re
from pathlib import Path

import numpy as np
import pytest

import curvcli
from curvcli.api import Analysis
from curvcli.checks.catalogue import identities
from curvcli.errors import InputError, Notice
from curvcli.mesh.seams import describe_exact_welding
from curvcli.mesh.surface import Surface
from curvcli.mesh.welding import weld_exact
from curvcli.report.build import model
from curvcli.report.conclusion import conclusion
from tests.helpers import meshes
from tests.helpers.meshes import Mesh
from tests.process.meshes import HOSTILE, cut_apart, scaled, seam, shifted


def analysis(given: Mesh, passes: str = "core", noise: float | None = None) -> Analysis:
    return curvcli.analyze((given.points, given.faces), passes, noise=noise)


def notice(of: Analysis, code: str) -> Notice | None:
    return next((found for found in of.notices if found.code == code), None)


# ---------------------------------------------------------------------------- the range of doubles


@pytest.mark.parametrize("exponent", [100, 332, 498, 664, 1000, -100, -332, -498, -664, -1000])
def test_results_that_no_double_holds_are_counted_and_named(exponent: int) -> None:
    """A sphere in units of powers of two: the same digits where there is a double, null where there is none."""
    unit, far = (analysis(scaled(power), "all", noise=2.0 ** (power - 30)) for power in (0, exponent))
    expected = 0
    for name in far.chosen:
        quantity = curvcli.passes.quantity(name)
        if quantity.labels:
            continue
        with np.errstate(over="ignore", under="ignore"):
            given = np.asarray(unit.column(name), np.float64)
            exact = np.ldexp(given, exponent * quantity.length_exponent)
        lost = ~np.isfinite(exact) | ((np.abs(exact) < np.finfo(float).tiny) & (given != 0))
        np.testing.assert_array_equal(far.column(name), np.where(lost, np.nan, exact))
        expected += int(np.count_nonzero(lost & ~np.isnan(given)))
    told = notice(far, "out_of_range")
    for key, value in unit.totals.items():
        first, second = (np.array(x, np.float64) for x in (value, far.totals[key]))
        expected += bool((np.isnan(second) & ~np.isnan(first)).any())
    assert (told.count if told else 0) == expected
    if abs(exponent) == 100:
        assert expected == 0
    if exponent == 498:
        assert told is not None
        assert told.message.endswith("left undefined: volume")
        assert far.totals["volume"] is None


@pytest.mark.parametrize("exponent", [100, 498, 664, 1000, -498, -664, -1000])
def test_no_check_passes_on_numbers_that_no_double_holds(exponent: int) -> None:
    """A check that passes shows all its numbers; one that cannot says for which there is no double."""
    plain, far = (analysis(scaled(power), "paper") for power in (0, exponent))
    assert [check.name for check in far.checks] == [check.name for check in plain.checks]
    changed = 0
    for check, known in zip(far.checks, plain.checks, strict=True):
        shown = [check.value, check.expected, check.residual, check.tolerance]
        if check.status == "pass":
            assert not np.isnan(np.hstack([np.array(side, float) for side in shown])).any()
        elif known.status == "pass":
            assert (check.status, shown) == ("not_applicable", [None] * 4)
            assert re.fullmatch(r"no double holds its [a-z, ]+ in the file's unit", check.detail)
            changed += 1
    assert bool(changed) == (exponent != 100)


def test_a_failing_check_fails_in_any_unit() -> None:
    """A residual beyond rounding in the unit of computation fails, even if no double holds it in the file's."""
    surface = Surface(scaled(-1000).points, scaled(-1000).faces)
    columns = dict(analysis(scaled(-1000), "paper").columns)
    columns["area_gradient"] = columns["area_gradient"] + 1.0
    (check,) = identities()["area_gradient"].run(surface, surface.whole, columns)
    assert (check.status, check.tolerance) == ("fail", None)


def test_nothing_is_out_of_range_where_it_was_never_defined() -> None:
    """Values that are null for another reason are not counted: no area, no boundary curvature, no volume."""
    flat = meshes.grid()
    far = analysis(flat.moved(np.ldexp(flat.points, 300)))
    assert far.totals["volume"] is None
    assert notice(far, "out_of_range") is None


# ---------------------------------------------------------------------------- the rounding of coordinates


@pytest.mark.parametrize("size", [1e-3, 1.0])
@pytest.mark.parametrize("offset", [0.0, 1e-3, 1e3, 1e6, 1e8, 1e10, 1e12, 1e13])
def test_K_is_right_or_its_loss_is_said(offset: float, size: float) -> None:
    exact, far = analysis(shifted(0, size)), analysis(shifted(offset, size))
    known = ~np.isnan(far.vertices["K"])
    moved = np.abs(far.vertices["K"] - exact.vertices["K"])[known].max(initial=0)
    told = notice(far, "coordinate_rounding")
    if moved > 1e-6:
        assert told is not None
        assert "distance from the origin" in (told.hint or "")
    if offset <= 1e3 * size:
        assert told is None
        assert moved < 1e-11


def test_short_edges_lose_digits_too_and_no_move_helps() -> None:
    speck = meshes.icosphere()
    beside = meshes.joined(meshes.tetrahedron(), speck.moved(speck.points * 1e-12 + 1.0))
    told = notice(analysis(beside), "coordinate_rounding")
    assert told is not None
    assert "origin" not in (told.hint or "")


def test_subnormal_coordinates_have_fewer_digits() -> None:
    told = notice(analysis(scaled(-1060)), "coordinate_rounding")
    assert told is not None
    assert "scale" in (told.hint or "")


def test_float32_coordinates_far_from_the_origin() -> None:
    """As a scan in national coordinates that a program wrote as float32: its vertices lie on a grid."""
    sphere = meshes.icosphere()
    single = sphere.moved((sphere.points + 3e6).astype(np.float32).astype(np.float64))
    told = notice(analysis(single), "coordinate_rounding")
    assert told is not None
    assert "float32" in told.message
    for harmless in (sphere.points.astype(np.float32).astype(np.float64), sphere.points + 3e6):
        assert notice(analysis(sphere.moved(harmless)), "coordinate_rounding") is None


# ---------------------------------------------------------------------------- welding


def welded(surface: Surface) -> tuple[int, int]:
    """Boundary edges and edges with more than two faces after welding, by really doing it."""
    first, number = weld_exact(surface.xyz_given)
    faces = first[number][surface.faces]
    faces = faces[[len({*face}) == 3 for face in faces.tolist()]]
    if not len(faces):
        return 0, 0
    after = Surface(surface.points, faces)
    return int(after.boundary_edges.sum()), int(after.nonmanifold_edges.sum())


def test_the_hint_says_what_welding_really_does() -> None:
    """Random soups on the corners of a cube, many of them in one place."""
    random = np.random.default_rng(5)
    closing = crowding = 0
    for _ in range(300):
        count = int(random.integers(4, 14))
        points = random.integers(0, 2, (count, 3)).astype(float)
        try:
            surface = Surface(points, random.integers(0, count, (int(random.integers(1, 15)), 3)))
        except InputError:  # every face has a repeated corner
            continue
        words = describe_exact_welding(surface)
        boundary, crowded = welded(surface)
        closed = int(surface.boundary_edges.sum()) - boundary
        more = crowded - int(surface.nonmanifold_edges.sum())
        said = re.search(r"would close (all )?(\d+) boundary edge", words)
        assert (int(said[2]) if said else 0) == max(closed, 0), words
        if said:
            assert (said[1] is not None) == (boundary == 0 and closed > 1)
            closing += 1
        if surface.boundary_edges.any() and "none lies" not in words:
            met = re.search(r"meet at (\d+) edge", words)
            assert (int(met[1]) if met else 0) == max(more, 0), words
            crowding += met is not None
    assert closing > 100
    assert crowding > 20


@pytest.mark.parametrize(("make", "closed"), [(seam, None), (cut_apart, 240)])
def test_from_hint_to_result(make: object, closed: int | None, tmp_path: Path) -> None:
    """Following the hint does what it says, on a file."""
    assert callable(make)
    path = make().write(tmp_path / "mesh.obj")
    before, after = curvcli.analyze(curvcli.load(path)), curvcli.analyze(curvcli.load(path, weld="exact"))
    told = notice(before, "duplicate_vertices")
    assert told is not None
    edges = [of.report()["topology"]["boundary_edges"] for of in (before, after)]
    assert edges[1] == 0
    assert closed in (None, edges[0])
    assert told.hint == f"--weld exact would close all {edges[0]} boundary edges"
    assert notice(after, "duplicate_vertices") is None
    merged = [found for found in after.notices if found.code == "welded_vertices"]
    assert [found.count for found in merged] == [told.count]


def test_what_welding_would_not_close() -> None:
    two = analysis(HOSTILE["two spheres in one place"]())
    told = notice(two, "duplicate_vertices")
    assert told is not None
    assert told.hint == "--weld exact merges them"


# ---------------------------------------------------------------------------- what is proved


def test_what_is_proved_of_a_sound_mesh() -> None:
    said = conclusion(model(analysis(meshes.icosphere())))
    assert said.startswith("Gauss–Bonnet certifies ΣK and χ")
    assert "warning" not in said


def test_what_is_proved_of_a_flawed_mesh() -> None:
    turned = meshes.icosphere().faces.copy()
    turned[20:] = turned[20:, ::-1]
    report = model(analysis(meshes.icosphere().with_faces(turned)))
    assert len(report.warnings) == 1
    assert "they hold on flawed meshes too: mind the warning above" in conclusion(report)
    report = model(analysis(cut_apart().with_faces(np.vstack([cut_apart().faces, [[0, 1, 2]]]))))
    assert f"mind the {len(report.warnings)} warnings above" in conclusion(report)
    assert len(report.warnings) > 1


def test_what_is_proved_where_K_is_undefined() -> None:
    said = conclusion(model(analysis(HOSTILE["all at a point"]())))
    assert said.startswith("Gauss–Bonnet certifies nothing here: the angle defect is undefined at 12 vertices")


def test_what_a_failure_means() -> None:
    """One disturbed value of a column."""
    disturbed = analysis(meshes.two_bodies())
    K = disturbed.columns["K"].copy()
    K[-1] += 1e-6
    disturbed.columns["K"] = K
    report = model(disturbed)
    failed = {(row.name, row.scope) for row in report.checks if row.status == "fail"}
    assert ("gauss_bonnet", "whole") in failed
    assert ("gauss_bonnet", "component 1") in failed
    said = conclusion(report)
    assert said.startswith("gauss_bonnet does not hold on component 1")
    assert "certifies" not in said
    assert "do not trust" in said


def test_warnings_are_the_same_in_every_form(tmp_path: Path) -> None:
    of = analysis(meshes.with_flat_face())
    of.write(tmp_path / "k.json")
    report = json.loads((tmp_path / "k.json").read_text())
    told = [dataclasses.asdict(found) | {"examples": list(found.examples)} for found in of.notices]
    assert report["warnings"] == told
    assert told

"""Each requirement on a mesh that meets it and on one that does not, and what is said of it."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from curvcli.api import analyze
from curvcli.checks.requirements.catalogue import defaults, requirements
from curvcli.checks.requirements.faults import Fault, FaultyElements, elements_of
from curvcli.errors import UsageError
from curvcli.report.check.judge import plan
from tests.helpers import meshes
from tests.helpers.gates import judged, outcome
from tests.helpers.meshes import Mesh, joined, mesh, of_sample, tetrahedron, zoo


def two_tetrahedra() -> Mesh:
    return joined(tetrahedron(), tetrahedron().moved(tetrahedron().points + 10.0))


def dented() -> Mesh:
    """A closed sphere with one vertex pushed in."""
    body = of_sample("icosphere", size=162)
    points = body.points.copy()
    points[0] *= 0.5
    return body.moved(points)


def with_point(given: Mesh, point: tuple[float, float, float]) -> Mesh:
    return given.moved(np.vstack([given.points, [point]]))


def sliver() -> Mesh:
    """Four corners, the last face without area."""
    return mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, 0, 0]], [[0, 1, 2], [0, 3, 1]])


def twice() -> Mesh:
    body = tetrahedron()
    return body.with_faces(np.vstack([body.faces, body.faces[1:2, ::-1]]))


def seam() -> Mesh:
    """Two triangles of a square that share no vertex, as texture seams leave them."""
    return mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [3, 4, 5]])


Make = Callable[[], Mesh]

CASES: list[tuple[str, Make, Make, str]] = [
    ("closed", tetrahedron, meshes.grid, "16 edges with only one face (first: edge 0-1)"),
    ("manifold", meshes.grid, meshes.book, "1 edge with more than two faces (edge 0-1)"),
    ("manifold", tetrahedron, meshes.pinched, "1 vertex whose star is not one fan (vertex 0)"),
    ("oriented", lambda: meshes.shell(20), meshes.mobius, "1 patch without an orientation (face 0)"),
    ("outward", tetrahedron, lambda: meshes.reversed_faces(tetrahedron()), "1 closed patch is inside out (face 0)"),
    ("outward", tetrahedron, meshes.grid, "no patch is closed and orientable, so that none has an outside"),
    ("connected", tetrahedron, two_tetrahedra, "2 components, expected 1 (the second starts at face 4)"),
    ("convex", meshes.icosphere, meshes.torus, "χ = 0, expected 2"),
    ("convex", tetrahedron, two_tetrahedra, "2 components, expected 1 (the second starts at face 4)"),
    ("genus=1", meshes.torus, tetrahedron, "the genus is 0, expected 1"),
    ("genus=0", meshes.grid, meshes.book, "the genus is undefined, expected 0: 1 edge with more than two faces"),
    ("genus=0", meshes.grid, meshes.klein_bottle, "the genus is undefined, expected 0: 1 patch without an orientation"),
    ("euler=-2", lambda: of_sample("genus_2"), meshes.torus, "χ = 0, expected -2"),
    ("components=2", two_tetrahedra, tetrahedron, "1 component, expected 2"),
    ("no-degenerate", tetrahedron, sliver, "1 face without area (face 1)"),
    ("no-duplicate-faces", tetrahedron, twice, "1 face with the corners of an earlier one (face 4)"),
    (
        "no-unreferenced",
        tetrahedron,
        lambda: with_point(tetrahedron(), (9, 9, 9)),
        "1 vertex that no face uses (vertex 4)",
    ),
    ("no-duplicate-vertices", tetrahedron, seam, "2 vertices at the position of an earlier one (first: vertex 3)"),
    ("minimal=0", lambda: of_sample("plane"), meshes.torus, "max |H_p|/A_p · √area = "),
    ("cmc=1e-12", lambda: of_sample("tetrahedron"), meshes.torus, "max |H_p + H A_p|/A_p ÷ |H| = "),
    ("minimal=100", meshes.torus, seam, "max |H_p|/A_p · √area is undefined: no vertex inside has a value"),
]


def without_positions(message: str) -> str:
    """A message without the coordinates of its places."""
    return re.sub(r" at \([^()]*\)", "", message)


@pytest.mark.parametrize(("name", "good", "bad", "message"), CASES, ids=[f"{c[0]}-{i}" for i, c in enumerate(CASES)])
def test_met_and_unmet(name: str, good: Make, bad: Make, message: str) -> None:
    met = outcome(judged(good(), name), name)
    assert (met.status, met.kind) == ("pass", "requirement")
    assert met.message == requirements()[name.partition("=")[0]].statement
    unmet = judged(bad(), name)
    assert outcome(unmet, name).status == "fail"
    assert without_positions(outcome(unmet, name).message).startswith(message)
    assert (unmet.status, unmet.exit_code) == ("fail", 1)


def test_every_requirement_has_a_case() -> None:
    """Here, or in a file of its own beside this one."""
    named = {case[0].partition("=")[0] for case in CASES} | {"consistent-winding"}
    others = "".join(path.read_text(encoding="utf-8") for path in Path(__file__).parent.glob("test_*.py"))
    assert named <= requirements().keys()
    assert {name for name in requirements() if f'"{name}' in others} == requirements().keys()


def test_reversed_faces_fail_consistent_winding() -> None:
    found = outcome(judged(meshes.shell(20)), "consistent-winding")
    assert found.status == "fail"
    assert "along which both faces run the same way (first: edge " in found.message
    assert outcome(judged(meshes.zoo("ellipsoid")), "consistent-winding").status == "pass"


def test_a_dent_is_not_convex_and_the_worst_vertex_is_named() -> None:
    found = outcome(judged(dented(), "convex"), "convex")
    assert found.status == "fail"
    assert found.message.startswith("ΣK⁻ = ")
    assert "most at vertex " in found.message


def test_dropped_faces_are_degenerate_too() -> None:
    body = tetrahedron()
    found = outcome(judged(body.with_faces(np.vstack([body.faces, [[1, 1, 2]]]))), "no-degenerate")
    assert found.message == "1 face with a repeated corner (face 4)"


def test_outward_judges_the_file_whatever_is_turned() -> None:
    body = meshes.reversed_faces(tetrahedron())
    assert outcome(judged(body, "outward", orient="outward"), "outward").status == "fail"


def test_tolerances_follow_the_convention_and_the_unit() -> None:
    body = meshes.torus()
    report = analyze((body.points, body.faces)).report()
    largest = report["minimal"]["H_vec_density_max"] * math.sqrt(report["totals"]["area"])
    ratio = report["cmc"]["residual_density_max"] / report["cmc"]["H"]
    for factor, status in ((1.01, "pass"), (0.99, "fail")):
        name, half, cmc = (f"{kind}={factor * value!r}" for kind, value in (
            ("minimal", largest), ("minimal", largest / 2), ("cmc", ratio)))  # fmt: skip
        for scale in (1.0, 1e-9, 1e9, 2.0**200, 2.0**-200):
            here = body.moved(body.points * scale)
            assert outcome(judged(here, name), name).status == status
            assert outcome(judged(here, half, mean="average"), half).status == status
            assert outcome(judged(here, cmc), cmc).status == status
            assert outcome(judged(here, cmc, mean="average"), cmc).status == status


def test_polygons_are_named_as_the_file_counts_them(tmp_path: Path) -> None:
    path = tmp_path / "square.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 3\n")
    found = outcome(judged(str(path), allow="manifold,consistent-winding"), "no-duplicate-faces")
    assert found.message == "1 face with the corners of an earlier one (polygon 1 at (0.666667, 0.333333, 0))"


def test_defaults_and_allow() -> None:
    names = [one.name for one in plan().requirements]
    assert names == defaults() == ["manifold", "consistent-winding", "no-degenerate", "no-duplicate-faces"]
    some = plan(["closed, genus=2", "genus=2"], ["manifold,no-degenerate", "genus", "holonomy"])
    assert [one.name for one in some.requirements] == ["consistent-winding", "no-duplicate-faces", "closed"]
    assert "holonomy" not in some.identities
    assert "gauss_bonnet" in some.identities
    assert judged(meshes.book(), allow="manifold").status == "pass"


@pytest.mark.parametrize("name", meshes.ZOO)
def test_every_identity_that_applies_holds_on_every_kind_of_surface(name: str) -> None:
    found = judged(zoo(name))
    assert not [one for one in found.outcomes if one.kind == "identity" and one.status == "fail"]
    assert outcome(found, "gauss_bonnet").status in ("pass", "not_applicable")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("clsed", "nearest: closed"),
        ("genus", "expected genus=N with a whole number"),
        ("genus=one", "expected genus=N"),
        ("genus=1.5", "expected genus=N"),
        ("closed=1", "takes no number"),
        ("minimal=-1", "0 or more"),
        ("cmc=nan", "0 or more"),
        ("minimal=inf", "0 or more"),
        ("", "unknown requirement ''"),
    ],
)
def test_requirements_that_are_none(text: str, words: str) -> None:
    with pytest.raises(UsageError) as caught:
        plan([text])
    assert words in str(caught.value)


def test_allowing_what_does_not_exist() -> None:
    with pytest.raises(UsageError, match="nearest: gauss_bonnet"):
        plan(allow=["gaus_bonet"])
    with pytest.raises(UsageError, match="nearest: manifold"):
        plan(allow=["closed,manifolt"])


def test_places_are_elements_with_positions() -> None:
    """The rim of an open cube: four edges of its missing square, each at the middle of its ends."""
    cube = of_sample("cube")
    centre, half = cube.points.mean(axis=0), np.ptp(cube.points[:, 2]) / 2
    top = np.isclose(cube.points[cube.faces][..., 2], centre[2] + half).all(axis=1)
    found = outcome(judged(cube.with_faces(cube.faces[~top]), "closed"), "closed")
    assert found.elements == len(found.places) == 4
    for place in found.places:
        kind, _, ends = place.element.partition(" ")
        assert kind == "edge"
        a, b = (cube.points[int(end)] for end in ends.split("-"))
        assert place.position == pytest.approx((a + b) / 2)
    first = ", ".join(f"{x + 0.0:.6g}" for x in found.places[0].position if x is not None)
    assert f"(first: {found.places[0].element} at ({first}))" in found.message


def test_a_plain_text_is_a_fault_without_elements() -> None:
    assert elements_of("no patch is closed") == ()
    joined_faults = "lost: " + Fault("1 face", FaultyElements("face", np.array([3]))) + "; remesh"
    assert (joined_faults, elements_of(joined_faults)[0].numbers.tolist()) == ("lost: 1 face; remesh", [3])

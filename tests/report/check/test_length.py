"""The length of what `check` prints: bounded whatever passes, and by the first failures of each check."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from curvcli.errors import Notice
from curvcli.report.check.github import write_github
from curvcli.report.check.junit import write_junit
from curvcli.report.check.lines import FIRST, MOST
from curvcli.report.check.model import CheckedMesh, CheckReport, Outcome, Rule, report_of
from curvcli.report.check.sarif import write_sarif
from curvcli.report.terminal.check import write_text
from tests.helpers.cli.program import CUBE, DISK, MOBIUS, curvcli
from tests.helpers.gates import judged
from tests.helpers.meshes import Mesh, icosphere, tetrahedron
from tests.helpers.meshes import mesh as mesh_of

MANY = 10_000
RULES = [Rule("gauss_bonnet", "identity", "ΣK = 2πχ"), Rule("closed", "requirement", "No edge has only one face")]


def bodies(count: int) -> Mesh:
    """Spheres side by side that do not touch."""
    body = tetrahedron()
    points = [body.points + np.array([4.0 * k, 0.0, 0.0]) for k in range(count)]
    faces = [body.faces + len(body.points) * k for k in range(count)]
    return mesh_of(np.concatenate(points), np.concatenate(faces))


def mesh(path: str, failing: int, passing: int = 0) -> CheckedMesh:
    outcomes = [
        Outcome("gauss_bonnet", "identity", f"component {k}", "fail" if k < failing else "pass", f"ΣK is off by {k}")
        for k in range(failing + passing)
    ]
    closed = Outcome("closed", "requirement", "whole", "fail" if failing else "pass", "2 edges with only one face")
    remark = Notice("duplicate_vertices", 3, "vertices twice", "--weld exact merges them", (4, 7))
    status = "fail" if failing else "pass"
    return CheckedMesh(path, "0" * 64, status, int(failing > 0), {}, [*outcomes, closed], [remark])


def lines(report: CheckReport, verbose: int = 0) -> list[str]:
    return write_text(report, verbose).decode().splitlines()


@pytest.mark.parametrize("count", [1, 30, 120])
def test_a_passing_mesh_prints_a_screenful_however_many_bodies_it_has(count: int, tmp_path: Path) -> None:
    path = bodies(count).write(tmp_path / "bodies.obj")
    ended = curvcli("check", path, "--require", "closed,outward")
    assert ended.code == 0
    assert len(ended.out.splitlines()) < 50
    if count == 30:
        assert "whole, 30 components" in ended.out
        told = curvcli("check", path, "-v").out
        assert "component 29" in told
        assert len(told.splitlines()) > 300
        complete = json.loads(curvcli("check", path, "--format", "json").out)["meshes"][0]["outcomes"]
        assert sum(one["name"] == "gauss_bonnet" for one in complete) == 31


@pytest.mark.slow
def test_ten_thousand_failing_components_are_the_first_few_and_a_count() -> None:
    report = report_of(RULES, [mesh("bed.stl", MANY, 5)], 1)
    told = lines(report)
    failed = [line for line in told if line.startswith("FAIL ")]
    assert len(told) < 40
    assert len(failed) == FIRST + 2
    assert failed[FIRST] == f"FAIL bed.stl: gauss_bonnet fails on {MANY - FIRST:,} more components"
    assert failed[0] == "FAIL bed.stl: gauss_bonnet fails on component 0: ΣK is off by 0"
    assert any(line.startswith("FAIL bed.stl: closed fails: ") for line in failed)
    assert len(lines(report, 1)) > MANY
    assert 5 < len(write_github(report).decode().splitlines()) < 20


def test_the_last_failure_is_listed_where_its_count_would_be_as_long() -> None:
    told = lines(report_of(RULES, [mesh("bed.stl", FIRST + 1)], 1))
    assert sum(line.startswith("FAIL bed.stl: gauss_bonnet fails on component ") for line in told) == FIRST + 1


def test_reports_for_programs_are_complete() -> None:
    report = report_of(RULES, [mesh("bed.stl", 50, 5)], 1)
    assert len(json.loads(write_sarif(report))["runs"][0]["results"]) == 51
    assert write_junit(report).count(b"<testcase ") == 56


@pytest.mark.slow
def test_many_meshes_are_summed_up() -> None:
    passing = [mesh(f"{k}.stl", 0, 3) for k in range(1000)]
    told = lines(report_of(RULES, passing, 0))
    assert len(told) < 40
    assert not any(line.startswith("warning") for line in told)
    assert "980 more meshes" in "".join(told)
    assert "1,000 of 1,000 meshes pass" in "".join(told)
    failing = [mesh(f"{k}.stl", MANY, 3) for k in range(300)]
    told = lines(report_of(RULES, [*passing, *failing], 1))
    assert len(told) < MOST + 60
    assert "more failures in 286 meshes; -v lists all of them" in "".join(told)


def test_failing_meshes_come_first_in_the_table() -> None:
    told = lines(report_of(RULES, [*(mesh(f"{k}.stl", 0) for k in range(100)), mesh("bad.stl", 2)], 1))
    rows = [line.split()[0] for line in told if ".stl " in line and not line.startswith(("FAIL", "warning"))]
    assert rows[0] == "bad.stl"


def test_warnings_have_places_and_hints() -> None:
    told = lines(report_of(RULES, [mesh("a.stl", 0)], 0))
    expected = "warning a.stl: duplicate_vertices: 3 vertices twice (first: 4, 7); --weld exact merges them"
    assert expected in told
    several = lines(report_of(RULES, [mesh("a.stl", 0), mesh("b.stl", 1)], 1))
    assert [line.split()[1] for line in several if line.startswith("warning ")] == ["b.stl:"]
    annotated = write_github(report_of(RULES, [mesh("b.stl", 1)], 1)).decode()
    assert "::warning file=b.stl,title=curvcli duplicate_vertices::b.stl: duplicate_vertices: 3" in annotated


def test_a_report_in_a_file_tells_failures_and_hints_on_stderr(tmp_path: Path) -> None:
    ended = curvcli("check", MOBIUS, DISK, "--require", "closed", "-o", tmp_path / "check.json")
    assert ended.code == 1
    told = ended.err.splitlines()
    assert told[0].startswith(f"curvcli: {MOBIUS}: consistent-winding fails: ")
    assert any(line.startswith(f"curvcli: warning: {MOBIUS}: not_orientable: 1 patch") for line in told)


def test_a_pass_says_what_it_proves() -> None:
    checked = judged(icosphere())
    told = lines(report_of(RULES, [checked], 0))
    assert told[-1] == "Gauss–Bonnet certifies the curvatures and χ, not that the mesh is sound."
    assert any("ΣK + Σκ_g = 2πχ" in line for line in told)
    assert curvcli("check", CUBE, "-q").out == ""

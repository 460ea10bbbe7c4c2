"""Labels of shared/cases through the command line: per vertex, as words, by property and by file."""

from __future__ import annotations

import json

import pytest

from tests.helpers.cli.program import curvcli
from tests.helpers.shared import case, needs_shared

pytestmark = needs_shared


def regions(mesh: str, labels: str) -> dict[str, int]:
    ended = curvcli("analyze", case(mesh), "--regions", labels, "-p", "topology", "--json")
    assert ended.code == 0, ended.err
    report = json.loads(ended.out)
    assert all(check["status"] != "fail" for check in report["checks"])
    return {region["name"]: region["topology"]["faces"] for region in report["regions"]}


def test_labels_of_vertices_by_property_and_by_file() -> None:
    by_property = regions("atlas_per_vertex.ply", "parcel")
    assert sorted(by_property) == ["0", "1", "2"]
    assert sum(by_property.values()) == 1280
    assert regions("atlas_per_vertex.ply", case("atlas_per_vertex.txt")) == by_property


def test_words_as_labels() -> None:
    assert sorted(regions("atlas_per_vertex.ply", case("names.csv"))) == ["cuneus", "insula", "lingual"]


def test_what_vertices_decide_is_counted() -> None:
    ended = curvcli("analyze", case("atlas_per_vertex.ply"), "--regions", "parcel")
    assert "164 faces with corners of different labels" in ended.out


@pytest.mark.parametrize("name", ["sulc", "parcels"])
def test_values_that_are_no_labels(name: str) -> None:
    ended = curvcli("analyze", case("atlas_per_vertex.ply"), "--regions", name)
    assert ended.code == (3 if name == "sulc" else 2)
    assert "vertex 0, expected a whole number" in ended.complaint or "nearest: parcel" in ended.complaint


def test_solids_of_an_stl() -> None:
    ended = curvcli("analyze", case("duct_patches.stl"), "--regions", "solids", "--json")
    assert ended.code == 0, ended.err
    areas = {region["name"]: region["totals"]["area"] for region in json.loads(ended.out)["regions"]}
    assert areas == pytest.approx({"inlet": 1, "outlet": 1, "walls": 4}, rel=1e-12)

"""`curvcli compare` as a gate: meshes, stored reports and tables against each other, its exit codes and refusals."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.cli.program import ROOT, Ended, curvcli, wrote
from tests.helpers.cli.within import within_this

TORUS = ROOT / "sample_meshes" / "torus.obj"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A baseline of the torus in every form, and the torus with one vertex out of place."""
    made = tmp_path_factory.mktemp("compare")
    lines = TORUS.read_text().splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("v "))
    x, y, z = map(float, lines[first].split()[1:4])
    lines[first] = f"v {x!r} {y!r} {z + 1e-3!r}"
    (made / "torus.obj").write_text(TORUS.read_text())
    (made / "moved.obj").write_text("\n".join(lines) + "\n")
    outputs = [part for name in ("base.json", "base.csv", "base.parquet") for part in ("-o", name)]
    curvcli("analyze", "torus.obj", "-q", *outputs, "-p", "core,K_plus", folder=made)
    curvcli("analyze", "torus.obj", "-q", "-o", "average.json", "--mean", "average", folder=made)
    return made


Compare = Callable[..., Ended]


@pytest.fixture
def compare(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Compare:
    """The command in this process, run in a folder."""

    def call(folder: Path, *arguments: str) -> Ended:
        monkeypatch.chdir(folder)
        return within_this(monkeypatch, capfd, "compare", *arguments)

    return call


def as_json(ended: Ended) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(ended.out)
    assert ended.err == ""
    assert ended.code == (0 if found["equal"] else 1)
    return found


@pytest.mark.parametrize(
    ("a", "b"),
    [
        ("torus.obj", "torus.obj"),
        ("torus.obj", "base.json"),
        ("base.json", "torus.obj"),
        ("torus.obj", "base.csv"),
        ("base.parquet", "torus.obj"),
        ("base.csv", "base.parquet"),
        ("torus.obj", "average.json"),
    ],
)
def test_the_same_is_the_same_to_the_last_bit(compare: Compare, folder: Path, a: str, b: str) -> None:
    found = as_json(compare(folder, a, b, "--rtol", "0", "--json"))
    assert found["equal"]
    assert found["compared"] > 20
    assert (found["differences"], found["columns"], found["notes"]) == ([], [], [])


def test_a_stored_report_guards_a_mesh(compare: Compare, folder: Path) -> None:
    found = as_json(compare(folder, "moved.obj", "base.json", "--json"))
    keys = {one["key"]: one for one in found["differences"]}
    assert {"totals.area", "totals.volume", "totals.willmore", "columns.K.max"} & keys.keys()
    assert "totals.K_plus" in keys  # the passes of the report, not the default ones
    # Gauss–Bonnet: no move of a vertex moves these
    assert not any(key.startswith(("topology", "checks", "totals.K.", "totals.A_vec")) for key in keys)
    area = keys["totals.area"]
    assert area["moved"] == abs(area["a"] - area["b"]) > area["allowed"]
    assert (found["a"]["kind"], found["b"]["kind"]) == ("mesh", "report")
    assert as_json(compare(folder, "moved.obj", "base.json", "--json", "--only", "totals.K", "--only", "topology"))[
        "equal"
    ]


def test_vertices_that_moved_are_named(compare: Compare, folder: Path) -> None:
    found = as_json(compare(folder, "torus.obj", "moved.obj", "--json", "--only", "vertices"))
    columns = {one["name"]: one for one in found["columns"]}
    assert found["differences"] == []
    assert columns["z"]["differing"] == 1
    assert (columns["z"]["vertex"], columns["z"]["rows"]) == (0, 800)
    assert columns["z"]["moved"] == pytest.approx(1e-3)
    # K moves at the vertex and its neighbours, and nowhere else
    assert 1 < columns["K"]["differing"] < 15
    assert "x" not in columns
    assert "status" not in columns
    table = as_json(compare(folder, "base.csv", "moved.obj", "--json"))
    assert {one["name"]: one for one in table["columns"]}["z"] == columns["z"]
    assert as_json(compare(folder, "torus.obj", "moved.obj", "--json", "--only", "vertices.z", "--atol", "2e-3"))[
        "equal"
    ]


def test_other_conventions_are_said(compare: Compare, folder: Path) -> None:
    ended = compare(folder, "torus.obj", "average.json", "--mean", "sum")
    assert ended.code == 1
    assert "the conventions differ" in ended.out
    assert "conventions.mean" in ended.out
    assert compare(folder, "base.json", "average.json", "--common", "-q") == (1, "", "")
    even = as_json(compare(folder, "base.json", "average.json", "--common", "--only", "columns.K", "--json"))
    assert even["equal"]


def test_the_summary_names_what_differs(compare: Compare, folder: Path) -> None:
    same = compare(folder, "torus.obj", "base.json")
    assert (same.code, same.err) == (0, "")
    assert "same: " in same.out
    other = compare(folder, "torus.obj", "moved.obj")
    assert (other.code, other.err) == (1, "")
    for words in ("totals.area", "vertices.z: 1 of 800, most at vertex 0", "DIFFERENT", "-v"):
        assert words in other.out
    assert len(compare(folder, "torus.obj", "moved.obj", "-v").out.splitlines()) > len(other.out.splitlines())
    assert compare(folder, "torus.obj", "moved.obj", "-q") == (1, "", "")


def test_differences_are_written_as_csv_and_json(compare: Compare, folder: Path, tmp_path: Path) -> None:
    written, report = tmp_path / "d.csv", tmp_path / "d.json"
    ended = compare(folder, "base.json", "moved.obj", "-q", "-o", str(written), "-o", str(report))
    assert (ended.code, ended.out, ended.err) == (1, "", "")
    found = json.loads(report.read_text())
    rows = list(csv.DictReader(written.read_text(encoding="utf-8").splitlines()))
    assert [row["key"] for row in rows] == [one["key"] for one in found["differences"]]
    assert all(row["status"] == "moved" for row in rows)
    assert [float(row["moved"]) for row in rows] == [one["moved"] for one in found["differences"]]
    assert compare(folder, "base.json", "moved.obj", "-o", str(report)).code == 4
    assert compare(folder, "base.json", "moved.obj", "--get", "equal") == (1, "false\n", "")
    wrote(compare(folder, "base.json", "torus.obj", "-q", "-o", str(report), "--force"))
    assert json.loads(report.read_text())["equal"]


def test_other_vertex_counts(compare: Compare, folder: Path) -> None:
    other = ROOT / "sample_meshes" / "sphere.obj"
    found = as_json(compare(folder, "base.csv", str(other), "--json"))
    assert [one["key"] for one in found["differences"]] == ["vertices.count"]
    assert found["notes"]
    found = as_json(compare(folder, "torus.obj", str(other), "--json"))
    keys = {one["key"]: one for one in found["differences"]}
    assert (keys["topology.genus"]["a"], keys["topology.genus"]["b"]) == (1, 0)
    assert keys["totals.K"]["moved"] == pytest.approx(12.566370614359172)


NEWER = '{"schema_version": 2, "topology": {}, "checks": []}'


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("newer.json", NEWER, "schema_version 2 found, 1 expected; a newer curvcli"),
        ("odd.json", NEWER.replace("2", '"one"'), "schema_version 'one' found"),
        ("torn.json", '{"schema_version": 1, "topology"', "no JSON"),
        ("deep.json", "[" * 100_000, "no JSON"),
        ("foreign.json", '{"name": "package"}', "no report of `curvcli analyze`"),
        ("list.json", "[{}, {}]", "a list of 2 reports found, one report expected"),
        ("hollow.json", '{"schema_version": 1, "topology": {}, "checks": []}', "a damaged report"),
        ("latin.json", '{"\udcff": 1}', "no JSON"),
        ("empty.json", "", "no data found"),
        ("empty.csv", "", "no data found"),
        ("foreign.csv", "name,size\na,1\n", "no column `vertex` found among name, size"),
        ("shuffled.csv", "vertex,K\n1,0.5\n0,0.5\n", "column `vertex` is not 0, 1, 2"),
        ("torn.parquet", "PAR1 and no more", "cannot be read as a table"),
    ],
)
def test_damaged_and_foreign_files_are_refused(
    compare: Compare, tmp_path: Path, name: str, text: str, words: str
) -> None:
    (tmp_path / name).write_bytes(text.encode("utf-8", "surrogateescape"))
    for pair in ((str(TORUS), name), (name, str(TORUS))):
        ended = compare(tmp_path, *pair)
        assert ended.code == 3
        assert ended.complaint.startswith(f"{name}: ")
        assert words in ended.complaint


def test_what_cannot_be_compared_has_its_exit_code(compare: Compare, folder: Path) -> None:
    assert "no values in common" in compare(folder, "base.json", "base.csv").complaint
    assert compare(folder, "base.json", "base.csv").code == 2
    assert compare(folder, "base.json", "torus.obj", "--only", "totals.aera").code == 2
    assert compare(folder, "base.json", "torus.obj", "--rtol", "-1").code == 2
    assert compare(folder, "base.json", "torus.obj", "-o", "x.ply").code == 2
    assert compare(folder, "missing.json", "torus.obj").code == 3
    assert compare(folder, "base.json", "missing.obj").code == 3

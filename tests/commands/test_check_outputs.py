"""Outputs of `curvcli check`: several reports of one run, and the failing elements alone."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from curvcli.loading.load import load
from tests.helpers import meshes
from tests.helpers.cli.program import curvcli


@pytest.fixture(scope="module")
def open_cube(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The unit cube without the two faces in z = 1, and with a point that no face uses."""
    cube = meshes.of_sample("cube")
    points = (cube.points - cube.points.min(axis=0)) / np.ptp(cube.points, axis=0)
    kept = cube.faces[~(points[cube.faces][..., 2] == 1).all(axis=1)]
    return meshes.mesh([*points.tolist(), [5, 6, 7]], kept).write(tmp_path_factory.mktemp("open") / "cube.obj")


def test_one_run_writes_every_output(open_cube: Path, tmp_path: Path) -> None:
    names = ["r.sarif", "r.xml", "r.json", "r.txt", "f.csv", "f.ply"]
    outputs = [argument for name in names for argument in ("-o", str(tmp_path / name))]
    ended = curvcli("check", str(open_cube), "--require", "closed,no-unreferenced", "--json", *outputs)
    assert ended.code == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(names)
    assert json.loads(ended.out) == json.loads((tmp_path / "r.json").read_text())
    assert json.loads((tmp_path / "r.sarif").read_text())["version"] == "2.1.0"
    assert (tmp_path / "r.xml").read_text().count("<failure") == 2
    assert "the mesh does not pass" in (tmp_path / "r.txt").read_text()


def test_the_table_of_failures_names_the_rim_and_the_loose_point(open_cube: Path, tmp_path: Path) -> None:
    out = tmp_path / "failures.csv"
    curvcli("check", str(open_cube), "--require", "closed,no-unreferenced", "-o", str(out))
    with out.open() as stream:
        rows = list(csv.DictReader(stream))
    middles = {(row["kind"], *(float(row[axis]) for axis in "xyz")) for row in rows if row["rule"] == "closed"}
    assert middles == {("edge", x, y, 1.0) for x, y in ((0.5, 0), (0.5, 1), (0, 0.5), (1, 0.5))}
    (loose,) = (row for row in rows if row["rule"] == "no-unreferenced")
    assert (loose["element"], loose["x"], loose["y"], loose["z"]) == ("vertex 8", "5.0", "6.0", "7.0")


def test_the_mesh_of_failures_has_the_failing_elements_alone(open_cube: Path, tmp_path: Path) -> None:
    out = tmp_path / "failures.ply"
    curvcli("check", str(open_cube), "--require", "closed,no-unreferenced", "-o", str(out))
    surface = load(str(out))
    assert surface.n_faces == 4  # at each edge of the rim one face
    assert (surface.points[surface.faces][..., 2].max(axis=1) == 1).all()
    assert surface.points[-1].tolist() == [5, 6, 7]


def test_several_meshes_share_no_file_of_failures(open_cube: Path, tmp_path: Path) -> None:
    other = meshes.tetrahedron().write(tmp_path / "sound.obj")
    ended = curvcli("check", str(open_cube), str(other), "-o", str(tmp_path / "f.csv"))
    assert (ended.code, "{stem}" in ended.complaint) == (2, True)
    ended = curvcli("check", str(open_cube), str(other), "--require", "closed", "-o", str(tmp_path / "f-{stem}.csv"))
    assert len((tmp_path / "f-cube.csv").read_text().splitlines()) == 5
    assert len((tmp_path / "f-sound.csv").read_text().splitlines()) == 1


def test_two_reports_on_stdout_are_refused(open_cube: Path) -> None:
    ended = curvcli("check", str(open_cube), "--json", "-o", "-")
    assert (ended.code, "two reports would go to stdout" in ended.complaint) == (2, True)


def test_gitlab_gets_a_list_of_issues(open_cube: Path, tmp_path: Path) -> None:
    lost = tmp_path / "lost.obj"
    ended = curvcli("check", str(open_cube), str(lost), "--require", "closed", "--format", "gitlab")
    first, second = json.loads(ended.out)
    assert (first["check_name"], first["severity"], first["location"]["lines"]) == ("closed", "major", {"begin": 1})
    assert (second["check_name"], second["severity"]) == ("input", "blocker")
    assert first["fingerprint"] != second["fingerprint"]

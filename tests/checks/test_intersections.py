"""Requirements of embedding and sets of requirements, by the command line."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from curvcli.checks.requirements.catalogue import SETS, parse, parse_sets
from curvcli.errors import UsageError
from tests.helpers import meshes
from tests.helpers.cli.program import curvcli
from tests.helpers.meshes import Mesh


def two_cubes(offset: tuple[float, float, float], size: float = 1.0) -> Mesh:
    """The unit cube, and a cube with its lowest corner at the offset."""
    cube = meshes.of_sample("cube")
    unit = (cube.points - cube.points.min(axis=0)) / np.ptp(cube.points, axis=0)
    return Mesh(np.concatenate([unit, size * unit + offset]), np.concatenate([cube.faces, cube.faces + len(unit)]))


def outcomes(path: Path, *arguments: str) -> dict[str, tuple[str, str]]:
    """Status and message of each requirement."""
    report = json.loads(curvcli("check", str(path), *arguments, "--format", "json").out)
    return {
        outcome["name"]: (outcome["status"], outcome["message"])
        for outcome in report["meshes"][0]["outcomes"]
        if outcome["kind"] == "requirement"
    }


@pytest.mark.parametrize(
    ("mesh", "crossing", "contact"),
    [
        (two_cubes((3, 0, 0)), "", ""),
        (two_cubes((0.3, 0.4, 0.45), 0.5), "", ""),
        (two_cubes((0.6, 0.3, 0.2)), "faces cross", "faces cross"),
        (two_cubes((1, 0.25, 0.25)), "overlap in a plane", "overlap in a plane"),
        (two_cubes((1, 1, 0.5)), "", "touch"),
    ],
    ids=["apart", "inside", "crossing", "face on face", "edge on edge"],
)
def test_two_cubes(mesh: Mesh, crossing: str, contact: str, tmp_path: Path) -> None:
    result = outcomes(mesh.write(tmp_path / "m.obj"), "--require", "no-self-intersections,no-self-contacts")
    for name, fault in (("no-self-intersections", crossing), ("no-self-contacts", contact)):
        status, message = result[name]
        assert status == ("fail" if fault else "pass"), message
        assert fault in message


def test_a_folded_face_is_named_with_its_place(tmp_path: Path) -> None:
    """The corner (0, 1) of a square is moved to (0.9, 0.2), across the diagonal."""
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0.9, 0.2, 0]]
    path = meshes.mesh(points, [[0, 1, 2], [0, 2, 3]]).write(tmp_path / "folded.obj")
    status, message = outcomes(path, "--require", "no-self-intersections")["no-self-intersections"]
    assert (status, message.split(" (")[0]) == ("fail", "1 pair of neighbours is folded over")
    assert "face 0 and face 1 at (" in message


def test_the_table_has_a_row_for_each_pair(tmp_path: Path) -> None:
    path, out = two_cubes((0.6, 0.3, 0.2)).write(tmp_path / "m.obj"), tmp_path / "pairs.csv"
    assert curvcli("analyze", str(path), "-q", "--table", f"intersections={out}").code == 0
    with out.open() as stream:
        rows = list(csv.DictReader(stream))
    assert {row["kind"] for row in rows} == {"crossing"}
    assert {(row["component_a"], row["component_b"]) for row in rows} == {("0", "1")}
    for row in rows:
        assert int(row["face_a"]) < 12 <= int(row["face_b"])
        point = np.array([float(row[axis]) for axis in "xyz"])
        assert ((point >= np.array([0.6, 0.3, 0.2]) - 1e-15) & (point <= 1 + 1e-15)).all()


def test_sets_are_their_members(tmp_path: Path) -> None:
    path = two_cubes((0.6, 0.3, 0.2)).write(tmp_path / "m.obj")
    result = outcomes(path, "--require", "watertight")
    assert {*SETS["watertight"]} <= {*result}
    assert {name for name, (status, _) in result.items() if status == "fail"} == {"outward", "no-self-intersections"}
    allowed = outcomes(path, "--require", "watertight", "--allow", "outward")
    assert "outward" not in allowed


def test_a_configuration_defines_sets(tmp_path: Path) -> None:
    path = meshes.of_sample("hemisphere").write(tmp_path / "m.obj")
    (tmp_path / "curvcli.toml").write_text('[check.sets]\nours = ["closed", "euler=2"]\nmore = "ours,connected"\n')
    arguments = [
        "--config",
        str(tmp_path / "curvcli.toml"),
        "check",
        str(path),
        "--require",
        "more",
        "--format",
        "json",
    ]
    report = json.loads(curvcli(*arguments).out)
    status = {outcome["name"]: outcome["status"] for outcome in report["meshes"][0]["outcomes"]}
    assert (status["closed"], status["euler=2"], status["connected"]) == ("fail", "fail", "pass")


def test_a_set_may_extend_the_one_of_its_name() -> None:
    sets = parse_sets(["watertight=watertight,connected"])
    names = [required.name for required in parse(["watertight"], sets)]
    assert names == [*SETS["watertight"], "connected"]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("ours", "expected NAME="),
        ("closed=manifold", "a requirement has this name"),
        ("ours=clozed", "nearest: closed"),
        ("ours=genus", "expected genus=N"),
    ],
)
def test_sets_that_make_no_sense(text: str, problem: str) -> None:
    with pytest.raises(UsageError, match=problem):
        parse_sets([text])

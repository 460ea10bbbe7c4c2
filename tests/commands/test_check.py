"""`curvcli check` as CI starts it: exit codes one by one, several meshes, reports in files."""

from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import junitparser
import pytest

from tests.helpers import meshes
from tests.helpers.cli.program import CUBE, DISK, MOBIUS, Ended, command, curvcli, environment
from tests.helpers.shared import SHARED, needs_shared


@pytest.fixture
def bad(tmp_path: Path) -> Path:
    path = tmp_path / "bad.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
    return path


def disturbed(program: str, *arguments: str | Path) -> Ended:
    """The program with something changed in it before it starts."""
    code = f"{program}\nimport sys\nsys.argv = ['curvcli', *{[str(a) for a in arguments]!r}]\n"
    code += "from curvcli.commands.main import main\nmain()\n"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment(), timeout=120)
    return Ended(done.returncode, done.stdout, done.stderr)


def test_0_everything_holds() -> None:
    ended = curvcli(
        "check", CUBE, "--require", "closed,oriented,outward,connected,convex,genus=0", "--require", "euler=2"
    )
    assert (ended.code, ended.err) == (0, "")
    assert "FAIL" not in ended.out
    assert "Gauss–Bonnet certifies the curvatures and χ, not that the mesh is sound." in ended.out
    assert curvcli("check", CUBE, "-q") == (0, "", "")


def test_0_a_closed_pipe() -> None:
    read, write = os.pipe()
    os.close(read)
    with os.fdopen(write, "wb") as pipe:
        done = subprocess.run(
            command("check", CUBE, "--format", "json"),
            stdout=pipe,
            stderr=subprocess.PIPE,
            env=environment(),
            timeout=120,
        )
    assert (done.returncode, done.stderr) == (0, b"")


def test_1_something_fails() -> None:
    ended = curvcli("check", MOBIUS, "--require", "closed")
    assert (ended.code, ended.err) == (1, "")
    first, second = ended.out.splitlines()[:2]
    assert first.startswith(f"FAIL {MOBIUS}: consistent-winding fails: ")
    assert second.startswith(f"FAIL {MOBIUS}: closed fails: ")
    assert curvcli("check", MOBIUS, "--allow", "consistent-winding").code == 0
    ended = curvcli("check", CUBE, "--assert", "max(K) < 1.5", "-q")
    assert ended == (1, "", "")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], "no MESH given"),
        ([CUBE, "--require", "clsed"], "nearest: closed"),
        ([CUBE, "--allow", "manifolds"], "nearest: manifold"),
        ([CUBE, "--assert", "max(kapa_1) < 1"], "nearest: kappa_1"),
        ([CUBE, "--format", "xml"], "junit"),
        ([CUBE, "--regions", "nothing"], "--regions nothing"),
        (["nope.obj", "--require", "genus=x"], "genus=N"),
    ],
)
def test_2_the_command_line_is_wrong(arguments: list[str], words: str, tmp_path: Path) -> None:
    report = tmp_path / "check.json"
    ended = curvcli("check", *arguments, "-o", report)
    assert ended.code == 2
    assert words in ended.complaint
    assert not report.exists()


def test_3_an_input_cannot_be_read(bad: Path, tmp_path: Path) -> None:
    ended = curvcli("check", bad)
    assert ended.code == 3
    assert ended.complaint.startswith(str(bad))
    report = tmp_path / "check.json"
    ended = curvcli("check", bad, "-o", report)
    assert ended.code == 3
    read = json.loads(report.read_text())
    assert read["exit_code"] == 3
    (outcome,) = read["meshes"][0]["outcomes"]
    assert (outcome["name"], outcome["status"]) == ("input", "error")
    assert f"{bad}: {outcome['message']}" == ended.complaint


def test_4_an_output_exists(tmp_path: Path) -> None:
    report = tmp_path / "check.sarif"
    report.write_text("mine")
    ended = curvcli("check", "nope.obj", "-o", report)
    assert ended.code == 4
    assert "--force" in ended.complaint
    assert report.read_text() == "mine"
    ended = curvcli("check", MOBIUS, "-o", report, "--force")
    assert ended.code == 1
    assert ended.out == ""
    assert ended.err.startswith(f"curvcli: {MOBIUS}: consistent-winding fails: ")
    assert json.loads(report.read_text())["version"] == "2.1.0"
    assert list(tmp_path.iterdir()) == [report]


def test_4_no_folder_for_the_output(tmp_path: Path) -> None:
    assert curvcli("check", CUBE, "-o", tmp_path / "none" / "check.json").code == 4


BROKEN = """
from curvcli.checks.requirements.base import registered as kinds
from curvcli.checks.requirements.catalogue import requirements
requirements()
from dataclasses import replace
def broken(analysis): raise RuntimeError("a defect\\nof ours")
kinds["connected"] = replace(kinds["connected"], test=broken)
"""


def test_70_a_defect_of_the_program(bad: Path) -> None:
    ended = disturbed(BROKEN, "check", CUBE, "--require", "connected")
    assert (ended.code, ended.out) == (70, "")
    assert ended.complaint.startswith("internal error: RuntimeError: a defect of ours")
    for twice in (["-vv"], ["-v", "--verbose"]):
        ended = disturbed(BROKEN, "check", CUBE, "--require", "connected", *twice)
        assert (ended.code, ended.err.startswith("Traceback")) == (70, True)
        assert ended.err.splitlines()[-1].startswith("curvcli: internal error: RuntimeError: a defect of ours")
    ended = disturbed(BROKEN, "check", CUBE, bad, MOBIUS, "--require", "connected", "--format", "json")
    assert ended.code == 70
    read = json.loads(ended.out)
    assert [mesh["exit_code"] for mesh in read["meshes"]] == [70, 3, 70]
    assert ended.err.count("\n") == 3


def test_130_the_run_is_interrupted(tmp_path: Path) -> None:
    program = """
import os, signal
from curvcli.loading import load
load.load = lambda *a, **k: os.kill(os.getpid(), signal.SIGINT)
"""
    ended = disturbed(program, "check", CUBE, "-o", tmp_path / "check.json")
    assert ended.code == 130
    assert ended.complaint == "interrupted"
    assert list(tmp_path.iterdir()) == []


def test_the_worst_of_several_decides(bad: Path, tmp_path: Path) -> None:
    """And a bad one does not stop the rest."""
    report = tmp_path / "check.xml"
    ended = curvcli("check", CUBE, bad, MOBIUS, tmp_path / "nope.obj", DISK, "-q", "-o", report)
    assert ended.code == 3
    assert [line.split(": ")[1] for line in ended.err.splitlines()] == [str(bad), str(tmp_path / "nope.obj")]
    suites = list(junitparser.JUnitXml.fromfile(str(report)))
    assert [suite.name for suite in suites] == [CUBE, str(bad), MOBIUS, str(tmp_path / "nope.obj"), DISK]
    assert [(suite.failures, suite.errors) for suite in suites] == [(0, 0), (0, 1), (1, 0), (0, 1), (0, 0)]
    assert curvcli("check", CUBE, MOBIUS, "-q").code == 1


def test_a_stream_has_no_place_in_sarif(tmp_path: Path) -> None:
    data = Path(CUBE).read_bytes()
    ended = curvcli("check", "-", "--input-format", "obj", "--format", "sarif", "--require", "genus=1", given=data)
    assert ended.code == 1
    (result,) = json.loads(ended.out)["runs"][0]["results"]
    assert "locations" not in result


def test_regions_are_checked_one_by_one(tmp_path: Path) -> None:
    body = meshes.torus()
    path, labels = body.write(tmp_path / "torus.obj"), tmp_path / "labels.txt"
    labels.write_text("".join(f"{face % 3}\n" for face in range(len(body.faces))))
    ended = curvcli("check", path, "--regions", labels, "--format", "json")
    assert ended.code == 0
    scopes = {one["scope"] for one in json.loads(ended.out)["meshes"][0]["outcomes"] if one["name"] == "force_balance"}
    assert scopes == {"whole", "region 0", "region 1", "region 2"}


def test_equal_calls_give_equal_bytes() -> None:
    for name in ("json", "junit"):
        one, other = (curvcli("check", CUBE, MOBIUS, "--format", name) for _ in range(2))
        assert one == other


def test_the_schema_is_printed() -> None:
    ended = curvcli("check", "--schema")
    assert ended.code == 0
    assert json.loads(ended.out)["$ref"] == "#/$defs/CheckReport"


# What the index counts otherwise, and why.
APART = {
    "Offset1.obj": "slivers whose |u × v| is above 4 ε · longest²",
    "fuze_ascii.ply": "measured by one who reads on into the next row",
    "notenoughindices.obj": "faces with fewer than three corners are dropped, and count as degenerate here",
}

# What the index has as refused: binary STL that begins with `solid` and has a byte too many.
ACCEPTED = ("HalfDonut.stl",)


@needs_shared
def test_a_poisoned_list() -> None:
    """Every file of a folder of good and damaged meshes is accounted for, and judged as its index counts it."""
    assert SHARED is not None
    folder = SHARED / "meshes"
    with (folder / "index.csv").open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    ended = curvcli("check", *(row["file"] for row in rows), "--format", "json", folder=folder)
    assert ended.code == 3
    read = json.loads(ended.out)
    assert [mesh["path"] for mesh in read["meshes"]] == [row["file"] for row in rows]
    errors = [mesh for mesh in read["meshes"] if mesh["status"] == "error"]
    assert len(ended.err.splitlines()) == len(errors) > 0
    for mesh, row in zip(read["meshes"], rows, strict=True):
        assert (mesh["exit_code"] == 3) == (mesh["status"] == "error")
        if row["file"] in ACCEPTED:
            assert mesh["exit_code"] in (0, 1)
            continue
        assert mesh["exit_code"] in {"0": (0, 1), "3": (3,)}.get(row["exit"], (0, 1, 3))
        if mesh["exit_code"] == 3 or row["file"] in APART:
            continue
        found = {one["name"]: one["status"] == "pass" for one in mesh["outcomes"] if one["kind"] == "requirement"}
        assert found == {
            "manifold": row["nonmanifold_edges"] == row["nonmanifold_vertices"] == "0",
            "consistent-winding": row["inconsistent_edges"] == "0",
            "no-degenerate": row["degenerate_faces"] == "0",
            "no-duplicate-faces": row["duplicate_faces"] == "0",
        }
        assert all(one["status"] != "fail" for one in mesh["outcomes"] if one["kind"] == "identity")

"""What other systems start: the hook, the action and the image name commands that there are, and the action's script
does what its inputs say."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
import yaml

from curvcli.commands.main import COMMANDS
from tests.cli.program import ROOT, environment, served


@pytest.fixture(scope="module")
def action() -> dict[str, Any]:
    found: dict[str, Any] = yaml.safe_load((ROOT / "action.yml").read_text(encoding="utf-8"))
    return found


@pytest.fixture
def check(action: dict[str, Any], tmp_path: Path) -> Any:
    """The action's step, run as the runner runs it."""
    (step,) = (one for one in action["runs"]["steps"] if "curvcli check" in one.get("run", ""))
    defaults = {name: one.get("default", "") for name, one in action["inputs"].items()}
    shutil.copytree(ROOT / "sample_meshes", tmp_path / "a b" / "parts")
    program = tmp_path / "curvcli"
    program.write_text(f'#!/bin/sh\nexec {shlex.join(served())} "$@"\n')
    program.chmod(0o755)

    def run(**inputs: str) -> subprocess.CompletedProcess[str]:
        given = defaults | inputs
        named = {
            name: re.sub(r"\$\{\{ inputs\.(\w+) \}\}", lambda m: given[m[1]], v) for name, v in step["env"].items()
        }
        env = environment(PATH=f"{tmp_path}:{environment()['PATH']}", **named)
        command = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]]
        return subprocess.run(command, cwd=tmp_path, env=env, capture_output=True, text=True, timeout=120)

    return run


def test_the_hook_names_a_command() -> None:
    (hook,) = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text(encoding="utf-8"))
    program, command = hook["entry"].split()
    assert program == "curvcli"
    assert command in COMMANDS
    taken = ("a/b.stl", "c.ply", "d.obj", "E.STL", "F.Obj", "g.ply.gz", "H.PLY.GZ")
    left = ("obj.txt", "a.objx", "a.gz", "stl", "a.ply.gz.bak", "objgz")
    assert [bool(re.search(hook["files"], name)) for name in (*taken, *left)] == [
        *(True for _ in taken),
        *(False for _ in left),
    ]


def test_the_action_writes_sarif_and_fails_as_check_does(check: Any, tmp_path: Path) -> None:
    done = check(
        meshes="a b/**/cube.*\na b/parts/saddle.ply", require="closed", **{"assert": "max(K) <= 4\nmin(K) >= -4"}
    )
    assert done.returncode == 1, done.stderr
    report = json.loads((tmp_path / "curvcli.sarif").read_text(encoding="utf-8"))
    failed = [one for one in report["runs"][0]["results"] if one.get("kind", "fail") == "fail"]
    places = {one["locations"][0]["physicalLocation"]["artifactLocation"]["uri"] for one in failed}
    assert places == {"a%20b/parts/saddle.ply"}
    assert check(meshes="a b/**/cube.*", require="closed,outward").returncode == 0


def test_the_action_annotates_without_sarif(check: Any, tmp_path: Path) -> None:
    done = check(meshes="a b/parts/saddle.ply", require="closed", sarif="")
    assert done.returncode == 1
    assert done.stdout.startswith("::error ")
    assert not (tmp_path / "curvcli.sarif").exists()


def test_the_action_refuses_patterns_without_a_match_and_takes_nothing_for_code(check: Any, tmp_path: Path) -> None:
    assert check(meshes="nowhere/*.ply").returncode != 0
    done = check(meshes="a b/parts/cube.obj", require="$(touch gone)", **{"assert": "`touch gone`"})
    assert done.returncode == 2
    assert not (tmp_path / "gone").exists()


def test_inputs_reach_the_script_through_the_environment(action: dict[str, Any]) -> None:
    """An expression inside a script would be text that is executed."""
    for step in action["runs"]["steps"]:
        assert "${{" not in step.get("run", "")


def test_the_image_is_slim_and_without_root() -> None:
    lines = (ROOT / "Dockerfile").read_text(encoding="utf-8").splitlines()
    assert [line.split()[1] for line in lines if line.startswith("FROM")] == ["python:3.12-slim"] * 2
    (user,) = (line.split()[1] for line in lines if line.startswith("USER"))
    assert int(user) > 0
    assert 'ENTRYPOINT ["curvcli"]' in lines
    # What the build copies is all that the wheel needs.
    kept = {line[1:] for line in (ROOT / ".dockerignore").read_text(encoding="utf-8").splitlines() if line[0] == "!"}
    assert kept == {"curvcli", "pyproject.toml", "README.md", "LICENSE"}

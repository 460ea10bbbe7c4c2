"""Files for other systems: the hook, the action and the image name existing commands, and the script of the action
follows its inputs."""

from __future__ import annotations

import gzip
import json
import re
import shlex
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
import yaml

from curvcli.commands.names import COMMANDS
from curvcli.loading.registry import suffixes
from docs.pages import HOOKS, current
from tests.helpers.cli.program import ROOT, environment, served


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
            name: re.sub(r"\$\{\{ inputs\.([\w-]+) \}\}", lambda m: given[m[1]], v) for name, v in step["env"].items()
        }
        files = {"GITHUB_OUTPUT": str(tmp_path / "outputs"), "GITHUB_STEP_SUMMARY": str(tmp_path / "summary.md")}
        env = environment(PATH=f"{tmp_path}:{environment()['PATH']}", **named, **files)
        command = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]]
        return subprocess.run(command, cwd=tmp_path, env=env, capture_output=True, text=True, timeout=120)

    return run


def test_the_hook_names_a_command() -> None:
    text = (ROOT / HOOKS).read_text(encoding="utf-8")
    (hook,) = yaml.safe_load(text)
    program, command = hook["entry"].split()
    assert program == "curvcli"
    assert command in COMMANDS
    taken = ["E.STL", "F.Obj", "H.PLY.GZ"]
    taken += [name for end in suffixes() for name in (f"a/b.{end}", f"c.{end.upper()}", f"g.{end}.gz")]
    assert current(HOOKS, text) == text
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


def test_every_option_of_check_has_an_input(action: dict[str, Any], check: Any, tmp_path: Path) -> None:
    from curvcli.commands.check import command

    options = {max(one.opts, key=len).removeprefix("--") for one in command.params if one.opts[0].startswith("-")}
    options -= {"schema", "help"}
    assert options <= action["inputs"].keys()
    (step,) = (one for one in action["runs"]["steps"] if one.get("id") == "check")
    used = set(re.findall(r"inputs\.([\w-]+)", " ".join(step["env"].values())))
    assert options <= used
    # And each reaches the program as its own argument.
    (tmp_path / "curvcli").write_text('#!/bin/sh\n[ "$1" = check ] && printf "%s\\n" "$@" > told\nexit 0\n')
    values = {name: f"a b {name}" for name in options - {"force", "quiet", "verbose", "output", "json"}}
    flags = {"quiet": "true", "json": "true", "verbose": "2", "output": "o p", "arguments": "--x='y z' $(id)\n-q"}
    done = check(meshes="a b/parts/cube.obj", **values, **flags)
    assert done.returncode == 0, done.stderr
    told = (tmp_path / "told").read_text().splitlines()
    assert {f"--{name}={value}" for name, value in values.items() if value.startswith("a b")} <= set(told)
    assert {"--force", "--quiet", "--json", "--verbose", "--output=o p", "--x=y z", "$(id)", "-q"} <= set(told)
    assert told.count("--verbose") == 2
    assert told[-2:] == ["--", "a b/parts/cube.obj"]


@pytest.mark.parametrize(
    ("inputs", "code"),
    [
        ({"meshes": "a b/parts/cube.obj"}, 0),
        ({"meshes": "a b/parts/saddle.ply", "require": "closed"}, 1),
        ({"meshes": "a b/parts/saddle.ply", "require": "closed", "allow": "closed"}, 0),
        ({"meshes": "a b/parts/cube.obj", "require": "clsed"}, 2),
        ({"meshes": "a b/parts/none.obj"}, 3),
        ({"meshes": "a b/parts/*.off"}, 5),
        ({"meshes": "a b/parts/cube.obj", "max-faces": "3"}, 3),
        ({"meshes": "a b/parts/cube.obj", "arguments": "--require=genus=1\n--allow=manifold"}, 1),
        ({"meshes": "a b/parts/cube.obj", "arguments": "--require closed,genus=0 --allow 'manifold'"}, 0),
        ({"meshes": "a b/parts/cube.obj", "arguments": "--require 'closed"}, 2),
        ({"meshes": "a b/parts/cube.obj", "arguments": "--require $(touch${IFS}gone) `touch gone`"}, 2),
        ({"meshes": "a b/parts/cube.obj", "verbose": "a[$(touch gone)]"}, 2),
        ({"meshes": "a b/parts/cube.obj", "summary": "x[$(touch gone)0]"}, 2),
    ],
)
def test_the_exit_code_is_an_output(
    action: dict[str, Any], check: Any, tmp_path: Path, inputs: dict[str, str], code: int
) -> None:
    done = check(**inputs)
    assert done.returncode == code, done.stderr
    assert (tmp_path / "outputs").read_text() == f"exit-code={code}\n"
    assert "steps.check.outputs.exit-code" in action["outputs"]["exit-code"]["value"]
    assert not (tmp_path / "gone").exists()


def test_the_summary_of_the_job_is_the_report_in_markdown(check: Any, tmp_path: Path) -> None:
    assert check(meshes="a b/parts/cube.obj\na b/parts/saddle.ply", unit="mm", mean="average").returncode == 0
    page = (tmp_path / "summary.md").read_text("utf-8")
    assert [line for line in page.splitlines() if line.startswith("### ")] == [
        "### curvcli: `a b/parts/cube.obj`",
        "### curvcli: `a b/parts/saddle.ply`",
    ]
    assert "mm" in page
    (tmp_path / "summary.md").unlink()
    check(meshes="a b/parts/*.obj", summary="0")
    assert not (tmp_path / "summary.md").exists()


def test_patterns_of_the_action_know_suffixes_in_any_case_and_packed(check: Any, tmp_path: Path) -> None:
    parts = tmp_path / "a b" / "parts"
    data = (parts / "cube.obj").read_bytes()
    (parts / "X Y.OBJ").write_bytes(data)
    (parts / "z.Obj.GZ").write_bytes(gzip.compress(data))
    done = check(meshes="a b/**/*.obj\na b/parts/cube.obj", format="json", output="o.json", summary="0")
    assert done.returncode in (0, 1), done.stderr
    names = [mesh["path"].split("/")[-1] for mesh in json.loads((tmp_path / "o.json").read_text())["meshes"]]
    assert {"X Y.OBJ", "z.Obj.GZ", "cube.obj"} <= set(names)
    assert len(names) == len(set(names))


def test_the_steps_of_others_are_current(action: dict[str, Any]) -> None:
    used = [step["uses"] for step in action["runs"]["steps"] if "uses" in step]
    assert used == ["actions/setup-python@v6", "github/codeql-action/upload-sarif@v4"]


def test_the_script_is_bash(action: dict[str, Any]) -> None:
    for step in action["runs"]["steps"]:
        if "run" in step:
            assert step["shell"] == "bash"
            subprocess.run(["bash", "-n", "-c", step["run"]], check=True, timeout=60)


@pytest.mark.skipif(shutil.which("actionlint") is None, reason="actionlint is not installed")
def test_actionlint_finds_nothing(action: dict[str, Any], tmp_path: Path) -> None:
    """The steps as those of a workflow with the same inputs, for actionlint reads workflows alone."""
    inputs = {
        name: {"type": "string", "required": one.get("required", False)} for name, one in action["inputs"].items()
    }
    outputs = {name: one["value"] for name, one in action["outputs"].items()}
    job = {"runs-on": "ubuntu-latest", "outputs": outputs, "steps": action["runs"]["steps"]}
    workflow = {"on": {"workflow_call": {"inputs": inputs}}, "jobs": {"check": job}}
    (tmp_path / "workflow.yml").write_text(yaml.safe_dump(workflow, sort_keys=False), "utf-8")
    done = subprocess.run(["actionlint", "workflow.yml"], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.stdout + done.stderr == ""


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

"""Defaults from curvcli.toml and [tool.curvcli]: which file applies, what wins, and what is refused."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from curvcli.commands.config import configure, nearest
from curvcli.commands.main import cli
from curvcli.commands.names import COMMANDS
from curvcli.errors import UsageError
from tests.helpers.cli.program import CUBE, MOBIUS, curvcli, environment

PYPROJECT = """
[project]
name = "of somebody else"

[tool.curvcli.check]
require = ["closed", "genus=1"]
allow = "consistent-winding"
format = "github"
"""


def defaults(path: Path) -> dict[str, dict[str, object]]:
    import click

    context = click.Context(cli)
    configure(context, str(path), lambda name: cli.get_command(context, name))
    return dict(context.default_map or {})


def test_the_nearest_file_upward(tmp_path: Path) -> None:
    below = tmp_path / "a" / "b" / "c"
    below.mkdir(parents=True)
    shared = tmp_path / "pyproject.toml"
    shared.write_text(PYPROJECT)
    assert nearest(str(below)) == str(shared)
    # One that says nothing of us is passed over, one that only speaks of us too.
    (tmp_path / "a" / "pyproject.toml").write_text("[project]\nname = 'x'\n")
    (tmp_path / "a" / "b" / "pyproject.toml").write_text("[project]\nname = 'curvcli-user'\n")
    assert nearest(str(below)) == str(shared)
    own = tmp_path / "a" / "curvcli.toml"
    own.write_text("")
    assert nearest(str(below)) == str(own)
    # In one folder the file of our own comes first.
    (tmp_path / "curvcli.toml").write_text("")
    assert nearest(str(tmp_path)) == str(tmp_path / "curvcli.toml")


def test_it_applies_and_the_command_line_wins(tmp_path: Path) -> None:
    (tmp_path / "pyproject.toml").write_text(PYPROJECT)
    below = tmp_path / "below"
    below.mkdir()
    ended = curvcli("check", CUBE, MOBIUS, "-v", folder=below)
    assert ended.code == 1
    assert ended.err == (
        f"curvcli: configuration: {tmp_path / 'pyproject.toml'}: [tool.curvcli.check] sets require, allow, format\n"
    )
    titles = [line.split("title=")[1].split("::")[0] for line in ended.out.splitlines() if line.startswith("::error")]
    assert titles == ["curvcli genus=1", "curvcli closed", "curvcli genus=1"]
    assert curvcli("check", CUBE, "--require", "genus=0", "--format", "text", "-q", folder=below) == (0, "", "")
    ended = curvcli("passes", "K", "--json", folder=below)
    assert (ended.code, ended.err) == (0, "")
    ended = curvcli("analyze", CUBE, "--get", "totals.area", "-v", folder=below)
    assert (ended.code, ended.err) == (
        0,
        f"curvcli: configuration: {tmp_path / 'pyproject.toml'}: nothing for analyze\n",
    )


def test_a_file_that_is_named(tmp_path: Path) -> None:
    (tmp_path / "curvcli.toml").write_text("[check]\nrequire = ['genus=1']\n")
    other = tmp_path / "other.toml"
    other.write_text("[check]\nassert = ['max(degree) <= 3', 'min(degree) >= 3']\n[analyze]\npass = 'K,A'\n")
    assert curvcli("check", CUBE, "-q", folder=tmp_path).code == 1
    assert curvcli("--config", "/dev/null", "check", CUBE, "-q", folder=tmp_path).code == 0
    ended = curvcli("--config", other, "check", CUBE, "--format", "github", folder=tmp_path)
    assert ended.code == 1
    assert "max(degree) <= 3" in ended.out
    assert "genus" not in ended.out
    ended = curvcli("--config", other, "analyze", CUBE, "-o", "-", "--format", "csv", folder=tmp_path)
    assert ended.out.startswith("vertex,x,y,z,K,A\n")


def test_every_kind_of_value(tmp_path: Path) -> None:
    path = tmp_path / "curvcli.toml"
    path.write_text(
        "[check]\nquiet = true\nverbose = 2\nmax-faces = 10\nmax_bytes = 20\narea = 'mixed'\nrequire = 'closed'\n"
        "assert = ['max(K) < 1']\nweld = 'exact'\n[sample]\n"
    )
    assert defaults(path) == {
        "check": {
            "quiet": True,
            "verbose": 2,
            "max_faces": 10,
            "max_bytes": 20,
            "area": "mixed",
            "require": ("closed",),
            "asserted": ("max(K) < 1",),
            "weld": "exact",
        },
        "sample": {},
    }


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[chek]\n", "[chek]: there is no such command; nearest: check"),
        ("quiet = true\n", "quiet: stands in no table; keys belong to the table of a command, such as [analyze]"),
        ("check = 3\n", "check: expected a table, headed [check]"),
        ("[check]\nreqire = ['closed']\n", "[check] reqire: there is no such option; nearest: require"),
        ("[check]\nREQUIRE = ['closed']\n", "[check] REQUIRE: there is no such option; nearest: require"),
        ("[Check]\nrequire = ['closed']\n", "[Check]: there is no such command; nearest: check"),
        ("[check]\nxyzzy = 1\n", "[check] xyzzy: there is no such option; `curvcli check --help` lists them"),
        ("[passes]\nrequire = ['closed']\n", "[passes] require: there is no such option"),
        ("[check]\nmeshes = ['a.obj']\n", "[check] meshes: there is no such option"),
        ("[check]\nhelp = true\n", "[check] help: there is no such option"),
        ("[check]\nschema = true\n", "[check] schema: there is no such option"),
        ("[check]\nquiet = 'yes'\n", "[check] quiet: is 'yes', expected true or false"),
        ("[check]\nquiet = 1\n", "[check] quiet: is 1, expected true or false"),
        ("[check]\nmax-faces = true\n", "[check] max-faces: is True, expected a whole number"),
        ("[check]\nmax-faces = 1.5\n", "[check] max-faces: is 1.5, expected a whole number"),
        ("[check]\nmax-faces = 0\n", "[check] max-faces: 0 is not in the range"),
        ("[check]\nverbose = -1\n", "[check] verbose: -1 is not in the range"),
        ("[check]\nweld = 1e-9\n", "[check] weld: is 1e-09, expected a string"),
        ("[check]\nrequire = ['closed', 1]\n", "[check] require: is 1, expected a string or a list of them"),
        ("[check]\nformat = 'xml'\n", "[check] format: 'xml' is not one of"),
        ("[check]\nmax_faces = 1\nmax-faces = 2\n", "[check] max-faces: is given twice"),
        ("[check\n", "the configuration is not TOML"),
    ],
)
def test_what_is_refused(text: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "curvcli.toml"
    path.write_text(text)
    with pytest.raises(UsageError) as caught:
        defaults(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert words in str(caught.value)


def test_refusals_end_with_2_before_any_work(tmp_path: Path) -> None:
    path = tmp_path / "pyproject.toml"
    for text in ("[tool.curvcli.chek]\n", "[tool]\ncurvcli = 3\n", "[tool.curvcli.check]\nreqire = 1\n"):
        path.write_text(text)
        ended = curvcli("analyze", CUBE, "-o", "t.csv", folder=tmp_path)
        assert ended.code == 2
        assert str(path) in ended.complaint
    ended = curvcli("--config", tmp_path / "none.toml", "check", CUBE)
    assert ended.code == 2
    assert "none.toml: the configuration cannot be read" in ended.complaint
    path.write_text("[project]\n")
    ended = curvcli("--config", path, "check", CUBE)
    assert (ended.code, "no table [tool.curvcli]" in ended.complaint) == (2, True)
    assert list(tmp_path.iterdir()) == [path]


def test_a_value_that_only_the_command_can_refuse_is_blamed_on_the_file(tmp_path: Path) -> None:
    path = tmp_path / "curvcli.toml"
    path.write_text("[check]\nrequire = 'clsed'\n")
    ended = curvcli("check", CUBE, folder=tmp_path)
    assert ended.code == 2
    assert "nearest: closed" in ended.complaint
    assert ended.complaint.endswith(f"; [check] of {path} sets require")
    path.write_text("[check]\nweld = 'firmly'\n")
    assert f"; [check] of {path} sets weld" in curvcli("check", CUBE, folder=tmp_path).complaint


def test_help_needs_no_sound_configuration(tmp_path: Path) -> None:
    (tmp_path / "curvcli.toml").write_text("[chek\n")
    assert curvcli("--help", folder=tmp_path).code == 0
    assert curvcli("--version", folder=tmp_path).code == 0
    assert curvcli("check", "--help", folder=tmp_path).code == 0


def test_the_environment_is_not_asked(tmp_path: Path) -> None:
    settings = {"CURVCLI_CHECK_REQUIRE": "genus=1", "CURVCLI_CONFIG": str(tmp_path / "none.toml")}
    assert curvcli("check", CUBE, "-q", folder=tmp_path, **settings).code == 0


def test_toml_is_read_only_where_there_is_some(tmp_path: Path) -> None:
    program = "import sys; sys.argv = ['curvcli', 'sample', 'nothing']\nfrom curvcli.commands.main import main\n"
    program += "try:\n    main()\nexcept SystemExit:\n    print('tomllib' in sys.modules)\n"
    for text, read in (("[project]\nname = 'x'\n", "False"), ("[tool.curvcli.check]\n", "True")):
        (tmp_path / "pyproject.toml").write_text(text)
        done = subprocess.run(
            [sys.executable, "-c", program], capture_output=True, text=True, env=environment(), cwd=tmp_path, timeout=60
        )
        assert done.stdout == f"{read}\n"


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_may_have_a_table(name: str, tmp_path: Path) -> None:
    path = tmp_path / "curvcli.toml"
    path.write_text(f"[{name}]\n")
    assert defaults(path) == {name: {}}

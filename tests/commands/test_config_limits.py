"""Limits of configuration: no files, no search beyond the repository, and its part in a verdict is named."""

from __future__ import annotations

import json
import os
import xml.etree.ElementTree as ET
from pathlib import Path

import click
import pytest

from curvcli.commands.config import configure, nearest
from curvcli.commands.main import cli
from curvcli.commands.names import COMMANDS
from curvcli.errors import UsageError
from tests.helpers.cli.program import CUBE, MOBIUS, curvcli


def find(name: str) -> click.Command | None:
    return cli.get_command(click.Context(cli), name)


OUTPUTS = [
    ("analyze", "output = '{there}'"),
    ("analyze", "output = ['{there}']"),
    ("analyze", "table = 'faces={there}'"),
    ("analyze", "force = true"),
    ("analyze", "force = false"),
    ("analyze", "regions = '{there}'"),
    ("analyze", "regions = 'labels.txt'"),
    ("batch", "output = '{there}'"),
    ("batch", "force = true"),
    ("batch", "files-from = '{there}'"),
    ("batch", "files_from = '{there}'"),
    ("batch", "scheduler = 'tcp://127.0.0.1:1'"),
    ("batch", "regions = '{there}'"),
    ("check", "output = '{there}'"),
    ("check", "force = true"),
    ("check", "regions = '../labels.npy'"),
    ("compare", "output = '{there}'"),
    ("compare", "table = 'faces={there}'"),
    ("compare", "force = true"),
    ("curves", "output = '{there}'"),
    ("curves", "table = 'points={there}'"),
    ("curves", "force = true"),
    ("sample", "output = '{there}'"),
    ("sample", "force = true"),
]


@pytest.mark.parametrize(("command", "line"), OUTPUTS)
@pytest.mark.parametrize("name", ["curvcli.toml", "pyproject.toml"])
def test_a_configuration_names_no_outputs_and_no_inputs(tmp_path: Path, command: str, line: str, name: str) -> None:
    there = tmp_path / "there.csv"
    head = f"[{command}]" if name == "curvcli.toml" else f"[tool.curvcli.{command}]"
    (tmp_path / name).write_text(f"{head}\n{line.format(there=there)}\n")
    with pytest.raises(UsageError, match=r"a configuration names no .*give it on the command line"):
        configure(click.Context(cli), str(tmp_path / name), find)


def test_no_file_is_overwritten_from_above(tmp_path: Path) -> None:
    there = tmp_path / "there.csv"
    there.write_text("mine")
    (tmp_path / "curvcli.toml").write_text(f"[analyze]\noutput = '{there}'\nforce = true\n")
    below = tmp_path / "a" / "b"
    below.mkdir(parents=True)
    ended = curvcli("analyze", CUBE, folder=below)
    assert ended.code == 2
    assert f"{tmp_path / 'curvcli.toml'}: [analyze] output: a configuration names no outputs" in ended.complaint
    assert there.read_text() == "mine"
    assert curvcli("--no-config", "analyze", CUBE, "-q", folder=below) == (0, "", "")


def test_the_search_ends_at_the_root_of_the_repository(tmp_path: Path) -> None:
    (tmp_path / "curvcli.toml").write_text("[check]\nallow = 'manifold'\n")
    for kind in ("folder", "file"):
        below = tmp_path / kind / "src" / "deep"
        below.mkdir(parents=True)
        assert nearest(str(below)) == str(tmp_path / "curvcli.toml")
        git = tmp_path / kind / ".git"
        git.mkdir() if kind == "folder" else git.write_text("gitdir: elsewhere\n")
        assert nearest(str(below)) is None
        own = tmp_path / kind / "curvcli.toml"
        own.touch()
        assert nearest(str(below)) == str(own)


def test_the_search_ends_at_the_home_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "curvcli.toml").touch()
    home = tmp_path / "home" / "me"
    below = home / "work" / "deep"
    below.mkdir(parents=True)
    assert nearest(str(below)) == str(tmp_path / "curvcli.toml")
    (tmp_path / "link").symlink_to(home)
    for name in (home, tmp_path / "link"):
        monkeypatch.setenv("HOME", str(name))
        assert nearest(str(below)) is None
        assert nearest(str(tmp_path / "home")) == str(tmp_path / "curvcli.toml")
    (home / "curvcli.toml").touch()
    assert nearest(str(below)) == str(home / "curvcli.toml")


@pytest.mark.skipif(os.name != "posix", reason="modes are POSIX's")
def test_the_search_does_not_go_where_everybody_writes(tmp_path: Path) -> None:
    shared = tmp_path / "shared"
    (shared / "mine").mkdir(parents=True)
    (shared / "curvcli.toml").touch()
    assert nearest(str(shared / "mine")) == str(shared / "curvcli.toml")
    shared.chmod(0o1777)
    assert nearest(str(shared / "mine")) is None
    assert nearest(str(shared)) == str(shared / "curvcli.toml")


def test_without_a_configuration(tmp_path: Path) -> None:
    (tmp_path / "curvcli.toml").write_text("[check]\nrequire = 'genus=1'\n")
    assert curvcli("check", CUBE, "-q", folder=tmp_path).code == 1
    assert curvcli("--no-config", "check", CUBE, "-q", folder=tmp_path).code == 0
    ended = curvcli("--no-config", "--config", "curvcli.toml", "check", CUBE, folder=tmp_path)
    assert ended.code == 2
    assert "exclude each other" in ended.complaint
    (tmp_path / "curvcli.toml").write_text("[chek\n")
    assert curvcli("--no-config", "check", CUBE, "-q", folder=tmp_path).code == 0


@pytest.fixture
def allowing(tmp_path: Path) -> Path:
    text = "[check]\nallow = ['manifold', 'consistent-winding']\nquiet = false\nassert = 'max(degree) <= 9'\n"
    (tmp_path / "curvcli.toml").write_text(text)
    return tmp_path


WORDS = 'allow = ["manifold", "consistent-winding"], assert = "max(degree) <= 9"'


def test_every_format_of_a_verdict_names_what_the_file_sets(allowing: Path) -> None:
    path = str(allowing / "curvcli.toml")
    sentence = f"configuration: {path} sets {WORDS}"
    for form, more in (("text", ()), ("text", ("-v",)), ("github", ())):
        ended = curvcli("check", CUBE, MOBIUS, "--format", form, *more, folder=allowing)
        assert ended.code == 0
        assert sentence in ended.out.replace("::notice title=curvcli configuration::", "")
    found = json.loads(curvcli("check", CUBE, "--format", "json", folder=allowing).out)
    assert found["configuration"] == {
        "file": path,
        "sets": {"allow": ["manifold", "consistent-winding"], "assert": "max(degree) <= 9"},
    }
    suite = ET.fromstring(curvcli("check", CUBE, "--format", "junit", folder=allowing).out).find("testsuite")
    assert suite is not None
    properties = {one.get("name"): one.get("value") for one in suite.iter("property")}
    assert properties == {"curvcli.configuration": path, "curvcli.configuration.sets": WORDS}
    (run,) = json.loads(curvcli("check", CUBE, "--format", "sarif", folder=allowing).out)["runs"]
    (note,) = run["invocations"][0]["toolConfigurationNotifications"]
    assert note["message"]["text"] == sentence
    assert run["invocations"][0]["properties"]["configuration"] == found["configuration"]


def test_what_the_command_line_sets_is_not_the_file_s(allowing: Path) -> None:
    given = ("--allow", "manifold", "--assert", "max(degree) <= 10")
    assert "configuration" not in curvcli("check", CUBE, *given, folder=allowing).out
    ended = curvcli("check", CUBE, "--allow", "manifold", folder=allowing)
    assert 'sets assert = "max(degree) <= 9"' in ended.out
    assert "allow =" not in ended.out
    for form in ("text", "json", "junit", "sarif", "github"):
        assert "configuration" not in curvcli("--no-config", "check", CUBE, "--format", form, folder=allowing).out


def test_the_other_verdicts_name_it_too(tmp_path: Path) -> None:
    (tmp_path / "curvcli.toml").write_text(
        "[analyze]\npass = 'K'\nunit = 'mm'\n[compare]\nrtol = 1e-3\n[batch]\nmean = 'average'\n"
        "[curves]\nmax-writhe = 10\n"
    )
    told = f"configuration: {tmp_path / 'curvcli.toml'} sets "
    outputs = [word for suffix in ("json", "md", "html") for word in ("-o", f"k.{suffix}")]
    assert curvcli("analyze", CUBE, *outputs, "-q", folder=tmp_path).code == 0
    assert json.loads((tmp_path / "k.json").read_text())["configuration"]["sets"] == {"pass": "K"}
    page, markdown = (tmp_path / "k.html").read_text(), (tmp_path / "k.md").read_text()
    assert f"<p>{told}pass = &#34;K&#34;</p>" in page
    assert 'pass = "K"' in markdown
    assert "configuration" in markdown
    assert f'{told}pass = "K"' in curvcli("analyze", CUBE, folder=tmp_path).out
    assert f"{told}rtol = 0.001" in curvcli("compare", CUBE, "k.json", folder=tmp_path).out
    assert f"{told}rtol = 0.001" in curvcli("compare", CUBE, CUBE, folder=tmp_path).out
    found = json.loads(curvcli("compare", CUBE, CUBE, "--json", folder=tmp_path).out)
    assert found["configuration"]["sets"] == {"rtol": 0.001}
    assert f"{told}max-writhe = 10" in curvcli("curves", MOBIUS, folder=tmp_path).out
    ended = curvcli("batch", CUBE, "-o", "out", "--save", "json", "-j", "1", folder=tmp_path)
    assert f'{told}mean = "average"' in ended.out
    (report,) = (tmp_path / "out").glob("*.json")
    assert json.loads(report.read_text())["configuration"]["sets"] == {"mean": "average"}


def test_a_hostile_name_of_the_file_is_text(tmp_path: Path) -> None:
    folder = tmp_path / "a\x1b[31m\u202eb"
    folder.mkdir()
    (folder / "curvcli.toml").write_text("[check]\nallow = '\\u001b[2J\u202emanifold'\n")
    for form in ("text", "github", "junit", "sarif", "json"):
        ended = curvcli("check", CUBE, "--format", form, folder=folder)
        assert not {"\x1b", "\u202e"} & set(ended.out + ended.err), form


def test_no_option_that_names_files_is_forgotten(tmp_path: Path) -> None:
    """A new option is refused, or named in the verdict as a baseline is."""
    for name in COMMANDS:
        command = cli.get_command(click.Context(cli), name)
        assert command is not None
        for option in command.params:
            words = (option.metavar or "").upper() if isinstance(option, click.Option) else ""
            if not any(word in words for word in ("FILE", "PATH", "DIR", "LIST|", "ADDRESS", "URL")):
                continue
            if option.name in ("regions", "baseline"):
                continue
            key = option.opts[-1].removeprefix("--")
            (tmp_path / "curvcli.toml").write_text(f"[{name}]\n{key} = 'x.csv'\n")
            with pytest.raises(UsageError, match="a configuration names no"):
                configure(click.Context(cli), str(tmp_path / "curvcli.toml"), find)

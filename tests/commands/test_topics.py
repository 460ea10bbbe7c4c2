"""`curvcli help`: every topic tells what the program does now, each thing from one source."""

from __future__ import annotations

import json
import re
from pathlib import Path

import jsonschema
import pytest
from click.testing import CliRunner

import curvcli as package
from curvcli.checks.catalogue import identities
from curvcli.checks.requirements.catalogue import requirements
from curvcli.commands.main import cli
from curvcli.commands.names import COMMANDS
from curvcli.commands.schemas import SCHEMAS, path_of
from curvcli.commands.topics import TOPICS
from curvcli.curvatures.registry import passes
from curvcli.errors import EXIT_CODES
from curvcli.output.registry import output_formats
from tests.helpers.cli.program import CUBE, DISK, ROOT, curvcli


def said(*arguments: str) -> str:
    """The stdout of a call in this process that went well."""
    result = CliRunner().invoke(cli, arguments, standalone_mode=False, prog_name="curvcli")
    assert result.exception is None, result.exception
    assert not result.return_value
    return result.stdout


def test_the_list_has_every_topic_and_summary() -> None:
    listed = said("help")
    for name, topic in TOPICS.items():
        assert re.search(rf"^ +{name} +{re.escape(topic.summary)}$", listed, re.MULTILINE)


@pytest.mark.parametrize("name", TOPICS)
def test_a_topic_is_a_page_of_narrow_lines(name: str) -> None:
    text = TOPICS[name].text()
    assert text.startswith("# ")
    assert text.endswith("\n")
    assert max(map(len, text.splitlines())) <= 120


def test_as_it_is_typed() -> None:
    ended = curvcli("help", "Exit_Codes")
    assert (ended.code, ended.out, ended.err) == (0, TOPICS["exit-codes"].text(), "")


def test_topics_are_complete() -> None:
    _ = package.passes
    assert all(f"\n{name} " in TOPICS["checks"].text() for name in identities())
    assert all(f"\n{kind.usage}" in TOPICS["checks"].text() for kind in requirements().values())
    assert all(f"\n{quantity.name} " in TOPICS["quantities"].text() for quantity in passes.quantities())
    assert all(f"\n{suffix} " in TOPICS["formats"].text() for suffix in (*output_formats(), ".obj", ".ply", ".stl"))
    assert all(f"\n{code} " in TOPICS["exit-codes"].text() for code in EXIT_CODES)


@pytest.mark.parametrize("name", COMMANDS)
def test_commands_are_topics(name: str) -> None:
    assert said("help", name) == said(name, "--help")


def test_no_such_topic() -> None:
    ended = curvcli("help", "convention")
    assert ended.code == 2
    assert "nearest: conventions" in ended.complaint


def test_help_stands_above_a_broken_configuration(tmp_path: Path) -> None:
    folder = tmp_path
    (folder / "curvcli.toml").write_text("[analyze]\nno-such-key = 1\n")
    assert curvcli("help", folder=folder).code == 0
    assert curvcli("analyze", CUBE, folder=folder).code == 2


def test_python_as_it_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """The lines of the topic run as they stand."""
    monkeypatch.chdir(tmp_path)
    said("sample", "icosphere", "--size", "50", "-q", "-o", "bunny.ply")
    lines = [line[4:] for line in TOPICS["python"].text().splitlines() if line.startswith("    ")]
    exec("\n".join(lines), {})


def test_the_formats_page_lists_every_exit_code() -> None:
    text = (ROOT / "docs" / "formats.md").read_text(encoding="utf-8")
    part = text.partition("## Exit codes")[2].partition("##")[0]
    assert [int(code) for code in re.findall(r"^\| (\d+) \|", part, re.MULTILINE)] == list(EXIT_CODES)


# ---------------------------------------------------------------------------- schemas


@pytest.mark.parametrize("name", SCHEMAS)
def test_the_files_are_current(name: str) -> None:
    """`python -m curvcli.commands.schemas` makes them again."""
    assert path_of(name).read_bytes() == SCHEMAS[name].stored()
    jsonschema.Draft202012Validator.check_schema(json.loads(path_of(name).read_bytes()))


@pytest.mark.parametrize("name", [name for name in SCHEMAS if name != "batch"])
def test_the_option_prints_one(name: str) -> None:
    jsonschema.Draft202012Validator.check_schema(json.loads(said(name, "--schema")))


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("analyze", ["analyze", DISK, "-p", "all", "--json"]),
        ("check", ["check", DISK, "--format", "json"]),
        ("compare", ["compare", CUBE, CUBE, "--json"]),
        ("compare", ["compare", CUBE, CUBE, "--map", "--json"]),
        ("curves", ["curves", DISK, "--json"]),
        ("passes", ["passes", "--json"]),
        ("passes", ["passes", "K", "--json"]),
    ],
)
def test_what_is_written_fits(name: str, arguments: list[str]) -> None:
    schema = json.loads(path_of(name).read_bytes())
    jsonschema.Draft202012Validator(schema).validate(json.loads(said(*arguments)))
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.Draft202012Validator(schema).validate({"schema_version": "1"})


def test_lines_of_the_manifest_fit(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    assert curvcli("batch", CUBE, DISK, "-o", str(folder), "-q", "-j", "1").code == 0
    schema = json.loads(path_of("batch").read_bytes())
    lines = (folder / "manifest.jsonl").read_text().splitlines()
    assert len(lines) == 2
    for line in lines:
        jsonschema.Draft202012Validator(schema).validate(json.loads(line))

"""No text from outside is obeyed: every source against every sink."""

from __future__ import annotations

import csv
import json
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from curvcli.support.words import escape_cell, escape_json, escape_sarif, unescape_cell
from tests.commands.conftest import Run
from tests.commands.text_sources import PAYLOADS, SOURCES, Source, ply, stored
from tests.curvatures.test_plugin import install

ENDS = (0, 1, 2, 3)
ids = [source.name for source in SOURCES]
every = pytest.mark.parametrize("source", SOURCES, ids=ids)
FORMULA = re.compile(r"[=+\-@\t\r＝＋－＠]")
NUMBER = re.compile(r"[+-]?[0-9.]+([eE][+-]?[0-9]+)?")


def plain(text: str, what: object = "") -> None:
    """It is lines of what can be printed."""
    odd = {c for c in text if not c.isprintable() and c != "\n"}
    assert not odd, (what, odd)


class Page(HTMLParser):
    """The elements of a page and its text; scripts and styles apart."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.said: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        self.said.append(data)


@pytest.mark.slow
@every
def test_pipes_and_files(source: Source, within: Run, tmp_path: Path) -> None:
    arguments = source.make(tmp_path)
    (tmp_path / "out").mkdir()
    suffixes = ("json", "md", "html", "csv", "ply", "vtp", "vtu", "obj", "glb", "png", "hist.png", "npz", "parquet")
    outputs = [word for suffix in suffixes for word in ("-o", f"out/k.{suffix}")]
    tables = ["--table", "faces=out/f.csv", "--table", "components=out/c.tsv"]
    if "--regions" in arguments:
        tables += ["--table", "regions=out/r.csv", "--table", "regions=out/r.tsv", "--table", "regions=out/r.npz"]
    for more in ([*outputs, *tables], ["-v"], ["--json"], ["--get", "input.path", "--get", "regions"]):
        ended = within("analyze", *arguments, *more)
        assert ended.code == 0, (more, ended.err)
        plain(ended.out, more)
        plain(ended.err, more)
        if "--get" not in more:  # whose value is data
            assert not re.search(r"^\s*::", ended.out + ended.err, re.MULTILINE)
    for path in (tmp_path / "out").iterdir():
        if path.suffix in (".json", ".md", ".html"):
            plain(path.read_text().replace("\t", ""), path.name)  # the engine of a page is indented by tabs
        if path.suffix in (".csv", ".tsv"):
            _spreadsheet(path)
    report = json.loads((tmp_path / "out" / "k.json").read_text())
    if source.rows:
        names = [region["name"] for region in report["regions"]]
        # What the format itself gives a meaning to: comments and continued lines.
        kept = (text for text in source.texts if not {"#", "\0"} & set(text) and not text.endswith("\\"))
        assert set(names) >= {text for text in kept if text == text.strip()}
        for suffix in ("csv", "tsv"):
            with (tmp_path / "out" / f"r.{suffix}").open(newline="") as stream:
                rows = list(csv.DictReader(stream, delimiter="\t" if suffix == "tsv" else ","))
            assert len(rows) == len(names)
            for name, row in zip(names, rows, strict=True):
                assert unescape_cell(row["region"]) == name or not name.isprintable()
        labels = np.load(tmp_path / "out" / "r.npz")["region_names"].tolist()
        assert [name.rstrip("\0") for name in names] == labels
    _page((tmp_path / "out" / "k.html").read_text())


def _spreadsheet(path: Path) -> None:
    with path.open(newline="") as stream:
        for row in csv.reader(stream, delimiter="\t" if path.suffix == ".tsv" else ","):
            for cell in row:
                assert not FORMULA.match(cell) or NUMBER.fullmatch(cell), (path.name, cell)
                plain(cell.replace("\t", ""), path.name)


def _page(text: str) -> None:
    page = Page(text)
    scripts = [attributes for tag, attributes in page.tags if tag == "script"]
    assert all("src" not in attributes for attributes in scripts)
    bare = [attributes for attributes in scripts if not attributes.get("type")]
    assert len(bare) == 2  # the engine and the program of the page
    assert not any(tag == "img" for tag, _ in page.tags)
    assert not any(name.startswith("on") for _, attributes in page.tags for name in attributes)


@pytest.mark.slow
@every
def test_every_format_of_check(source: Source, within: Run, tmp_path: Path) -> None:
    arguments = [*source.make(tmp_path), "--require", "genus=7,outward", "--assert", "max(K) < -99"]
    if "--regions" in arguments:
        arguments += ["--assert", "sum(K) < -99"]
    for form in ("text", "json", "junit", "sarif", "github"):
        for more in ([], ["-v"]):
            ended = within("check", *arguments, "--format", form, *more)
            assert ended.code in (1, 3), (form, ended)
            plain(ended.out.replace("\t", "") if form == "junit" else ended.out, form)
            plain(ended.err, form)
            match form:
                case "json":
                    json.loads(ended.out)
                case "sarif":
                    for result in json.loads(ended.out)["runs"][0]["results"]:
                        assert not re.search(r"(?<!\\)\]\(", result["message"]["text"])
                case "junit":
                    ET.fromstring(ended.out)
                case "github":
                    commands = [line for line in ended.out.split("\n") if line and not line.startswith("curvcli: ")]
                    assert all(re.match(r"::(error|warning|notice) (file|title)=[^:]*::", line) for line in commands)
                    assert all(set(_properties(line)) <= {"file", "title"} for line in commands)
                case _:
                    assert not re.search(r"^\s*::", ended.out, re.MULTILINE)


def _properties(line: str) -> list[str]:
    return [one.split("=")[0] for one in line.split("::")[1].split(" ", 1)[1].split(",")]


def test_what_was_stored(within: Run, tmp_path: Path) -> None:
    for pair in stored(tmp_path):
        for more in ([], ["-v"], ["--json"], ["-o", "d.csv", "-o", "d.json", "--force"], ["--get", "differences"]):
            ended = within("compare", *pair, *more)
            assert ended.code in ENDS, (pair, more, ended.err)
            plain(ended.out, (pair, more))
            plain(ended.err, (pair, more))
            if "--json" in more and ended.out:
                json.loads(ended.out)
        if (tmp_path / "d.csv").exists():
            _spreadsheet(tmp_path / "d.csv")


@pytest.mark.slow
def test_batches_escape_names_of_files(within: Run, tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    for number, text in enumerate(PAYLOADS):
        if "/" in text or "\x00" in text:
            continue
        if number % 3:
            (tmp_path / "in" / f"{text}.ply").write_bytes(b"ply\nno mesh " + text.encode())
        else:
            ply(tmp_path / "in", f"{text}.ply")
    ended = within("batch", "in/*", "-o", "out[/x]", "--save", "csv,md,html,json", "-j", 2)
    assert ended.code == 3
    plain(ended.out)
    plain(ended.err)
    assert "out[/x]" in ended.out
    _spreadsheet(tmp_path / "out[/x]" / "summary.csv")
    plain((tmp_path / "out[/x]" / "summary.csv").read_text())
    for path in (tmp_path / "out[/x]").rglob("*.md"):
        plain(path.read_text())
    ended = within("batch", "=1.ply", "[/x].ply", "-o", "o")
    assert ended.code == 5


@pytest.mark.parametrize("text", PAYLOADS)
def test_arguments_and_errors(text: str, within: Run, tmp_path: Path) -> None:
    if "\x00" in text:
        return
    ply(tmp_path)
    for arguments in (
        ["analyze", f"none{text}.ply"],
        ["analyze", "m.ply", "-p", text],
        ["analyze", "m.ply", "--regions", text],
        ["analyze", "m.ply", "--get", text],
        ["analyze", "m.ply", "-o", f"none/{text}"],
        ["check", "m.ply", "--require", text],
        ["check", "m.ply", "--assert", text],
        ["check", "m.ply", f"--{text}"],
        [text],
        ["passes", text],
        ["sample", text],
    ):
        ended = within(*arguments)
        assert ended.code != 70, (arguments, ended)
        plain(ended.out, arguments)
        plain(ended.err, arguments)
    (tmp_path / "c.toml").write_text(f"[check]\n{json.dumps(text)} = 1\n[{json.dumps(text)}]\n")
    ended = within("--config", "c.toml", "check", "m.ply", "-vv")
    assert ended.code == 2
    plain(ended.err)


def test_json_is_the_same_value() -> None:
    text = "".join(PAYLOADS) + "ü😀\U000e0041"
    data = json.dumps({text: text}, ensure_ascii=False, indent=1).encode()
    shown = escape_json(data)
    assert json.loads(shown) == {text: text}
    plain(shown.decode())
    assert "ü😀".encode() in shown
    assert escape_json(b'{"a": 1}') == b'{"a": 1}'


@pytest.mark.parametrize("text", [*PAYLOADS, "", "'", "''", "''=1", "'a", "a", "-", "+", "1", "-1.5e-3", "−1", "\n=1"])
def test_cells_are_no_formulas(text: str) -> None:
    cell = escape_cell(text)
    assert not FORMULA.match(cell) or NUMBER.fullmatch(cell)
    if text.isprintable() or text in ("\t=1", "\n=1"):
        assert unescape_cell(cell) == text
    if NUMBER.fullmatch(text):
        assert cell == text


def test_links_of_sarif() -> None:
    assert escape_sarif("see [a](b) and [c]") == r"see \[a\](b) and [c]"
    assert escape_sarif("faces [0, 3)") == "faces [0, 3)"


@pytest.mark.skipif(sys.platform != "linux", reason="names that are not UTF-8 are Linux's")
def test_names_that_are_no_text_stand_in_reports(within: Run, tmp_path: Path) -> None:
    ply(tmp_path)
    labels = os.fsdecode(b"l\xff.txt")
    (tmp_path / labels).write_text("1\n2\n3\n1\n")
    ended = within("analyze", "m.ply", "--regions", labels, "--json")
    assert ended.code == 0
    assert json.loads(ended.out)["conventions"]["regions"] == "l\\xff.txt"
    for more in (["--get", "conventions"], ["-o", "k.html", "-o", "k.md", "-o", "k.json"]):
        assert within("analyze", "m.ply", "--regions", labels, *more).code == 0
    assert within("check", "m.ply", "--regions", labels, "--format", "json").code == 0


PLUG_IN = '''
from curvcli.declare import curvature_pass
TEXT = "[/x]\\x1b]0;t\\x07\\u202e<script>x</script>`|=1"

@curvature_pass(symbol=TEXT, formula=TEXT, length_exponent=-2, total=TEXT, preserves=TEXT, boundary=TEXT, source=TEXT)
def odd(K, A):
    """Text."""
    return K * K / A
'''


@pytest.mark.slow
def test_texts_of_plug_ins_are_escaped(tmp_path: Path) -> None:
    ply(tmp_path)
    there = install(tmp_path, PLUG_IN)
    outputs = [word for suffix in ("html", "md", "json", "csv", "png", "hist.png") for word in ("-o", f"k.{suffix}")]
    for arguments in (
        ["passes"],
        ["passes", "odd"],
        ["passes", "--json"],
        ["passes", "--markdown"],
        ["analyze", "--schema"],
        ["analyze", "m.ply", "-p", "odd"],
        ["analyze", "m.ply", "-p", "odd,core", "--color-by", "odd", *outputs, "--table", "components=c.csv"],
    ):
        line = [sys.executable, "-m", "curvcli", *arguments]
        ended = subprocess.run(line, capture_output=True, text=True, env=there, cwd=tmp_path, timeout=120, check=False)
        assert ended.returncode == 0, ended.stderr
        plain(ended.stdout + ended.stderr, arguments)
    for name in ("k.md", "k.json", "k.html", "k.csv", "c.csv"):
        plain((tmp_path / name).read_text().replace("\t", ""), name)
    _page((tmp_path / "k.html").read_text())

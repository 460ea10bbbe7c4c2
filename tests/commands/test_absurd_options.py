"""Options that make no sense: one short line and the right code, whatever is asked for."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.fuzz.contract import in_process
from tests.helpers.cli.program import CUBE

ANALYZE = ("analyze", "m.obj", "-q")
CHECK = ("check", "m.obj")
BATCH = ("batch", "m.obj", "-o", "out")
ABSURD: list[tuple[int, tuple[str, ...]]] = [
    *((2, (*ANALYZE, "--weld", value)) for value in ("1e400", "-1", "nan", "inf", "0", "", "1_0", "2")),
    *((2, (*ANALYZE, "--max-faces", value)) for value in ("0", "-1", "1e3", "nan", "")),
    *((2, (*ANALYZE, "--precision", value, "-o", "o.csv")) for value in ("99", "-1", "0", "18", "nan", "1e1", "")),
    *((2, (*ANALYZE, "--range", value, "-o", "o.ply")) for value in ("nan:1", "1:0", ":", "-inf:inf", "p101", "pnan")),
    *((2, (*ANALYZE, "--regions", value)) for value in ("", "-", "nothing", "/dev/zero", "http://x/y")),
    *((3, (*ANALYZE, "--regions", value)) for value in ("missing.npy", "words.txt", "empty.txt")),
    *((2, ("analyze", "m.obj", "--get", value)) for value in ("", ".", "..", "totals.K.", "a.__class__", "a" * 9000)),
    *((2, (*ANALYZE, "--unit", value)) for value in ("\x1b[31m", "\n", "\udcff")),
    *((2, (*ANALYZE, "-p", value)) for value in ("", ",", "K K", "*", "nope", "__init__")),
    *((2, (*ANALYZE, "-o", value)) for value in ("", "o", "o.", "o.xyz", ".csv", "o.csv/", "{stem", "/dev/full")),
    *((4, (*ANALYZE, "-o", value)) for value in ("m.obj", "none/o.csv", "x" * 300 + ".csv", "o\0.csv", "http://x/o.csv")),
    *((2, (*ANALYZE, "--table", value)) for value in ("edges", "edges=", "=o.csv", "nope=o.csv", "edges=o.ply")),
    (4, (*ANALYZE, "-o", "o.csv", "-o", "./o.csv")),
    (4, (*ANALYZE[:2], "./m.obj", "-q", "-o", "{stem}.csv")),
    *((2, (*CHECK, "--assert", value)) for value in ("", "max", "max(K)", "max(K) <= nan", "foo(K) < 1", "max(x) < 1")),
    *((2, (*CHECK, "--assert", value)) for value in ("max(K) < 1;import os", "__import__('os')", "max(K)" * 2000)),
    *((2, (*CHECK, "--require", value)) for value in ("genus=", "genus=x", "cmc=nan", "closed=1", "", "nope")),
    *((2, (*BATCH, "--timeout", value)) for value in ("0", "nan", "inf", "1e300", "-1")),
    *((2, (*BATCH, "--max-memory", value)) for value in ("0", "1", "9" * 30)),
    *((2, (*BATCH, "--save", value)) for value in ("", "xyz", "edges.ply", "nope.csv")),
    *((2, ("compare", "m.obj", "m.obj", "--rtol", value)) for value in ("nan", "inf", "-1", "")),
    (2, ("batch", "m.obj", "-o", "")),
    (5, ("batch", "nothing*", "-o", "out")),
    (2, ("analyze", "-", "m.obj", "-")),
    (2, ("check", "-", "-")),
    *((2, (*command, "m.obj", "--format", "csv")) for command in (("analyze",), ("curves",), ("compare", "m.obj"))),
    (2, ("sample", "torus", "--format", "ply")),
    (2, ("sample", "torus", "-o", "-")),
    (3, ("analyze", "")),
    (3, ("analyze", "a\0b.obj")),
    (2, ("",)),
]  # fmt: skip
CONFIGURATIONS = {
    "nested": "a=" + "[" * 9000 + "]" * 9000,
    "digits": "[analyze]\nmax-faces=" + "9" * 9000,
    "zeros": "\0",
    "infinite": "[analyze]\nmax-faces=inf",
    "table": "[analyze]\n[analyze.unit]\na=1",
    "lists": "[analyze]\noutput=[['a']]",
    "no table": "analyze=1",
    "unit": '[analyze]\nunit="\\u001b"',
}


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    shutil.copy(CUBE, tmp_path / "m.obj")
    (tmp_path / "words.txt").write_text("1\nx\n")
    (tmp_path / "empty.txt").write_text("")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def refused(place: Path, code: int, words: tuple[str, ...]) -> None:
    before = sorted(place.iterdir())
    ran = in_process(list(words))
    assert (ran.code, ran.out) == (code, b""), ran
    assert ran.err.startswith("curvcli: ")
    assert ran.err.endswith("\n")
    assert ran.err[:-1].isprintable(), ran.err
    assert len(ran.err) < 2500
    assert sorted(place.iterdir()) == before


@pytest.mark.parametrize(("code", "words"), ABSURD, ids=lambda what: str(what)[:60].encode("unicode_escape").decode())
def test_an_absurd_option_is_refused_in_one_line(place: Path, code: int, words: tuple[str, ...]) -> None:
    refused(place, code, words)


@pytest.mark.parametrize("name", CONFIGURATIONS)
def test_an_absurd_configuration_is_refused_in_one_line(place: Path, name: str) -> None:
    (place / "c.toml").write_text(CONFIGURATIONS[name])
    refused(place, 2, ("--config", "c.toml", *ANALYZE))

"""The worst meshes through the whole program: an answer for each, and no word for infinite or undefined numbers."""

from __future__ import annotations

import json
import math
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from curvcli.commands.main import cli
from tests.helpers.cli.program import environment
from tests.process.meshes import HOSTILE

WORDS = re.compile(r"(?<![A-Za-z])[-+]?(?:nan|inf|infinity|1\.#\w+)(?![A-Za-z])", re.IGNORECASE)
TABLES = ("edges", "faces", "loops", "components")


def numbers(value: Any) -> Iterator[float]:
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        for part in value:
            yield from numbers(part)
    elif isinstance(value, float):
        yield value


@pytest.mark.parametrize("name", HOSTILE)
def test_an_answer_without_words_for_numbers(name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """Warnings of numpy and of Python are errors here; the summary, the report and every table are read."""
    mesh = HOSTILE[name]().write(tmp_path / "mesh.obj")
    outputs = {kind: tmp_path / f"{kind}.csv" for kind in TABLES}
    tables = [word for kind, path in outputs.items() for word in ("--table", f"{kind}={path}")]
    files = [word for suffix in ("csv", "json", "ply", "obj") for word in ("-o", str(tmp_path / f"k.{suffix}"))]
    assert cli.main(["analyze", str(mesh), "-p", "all", *files, *tables], standalone_mode=False) == 0
    summary, complaint = capfd.readouterr()
    assert complaint == ""
    assert "Gauss–Bonnet" in summary

    report = json.loads((tmp_path / "k.json").read_text())
    assert all(map(math.isfinite, numbers(report)))
    assert [check for check in report["checks"] if check["status"] == "fail"] == []
    loose = name == "loose vertices"  # their coordinates are the file's own: the row of a NaN has none
    for path in (tmp_path / "k.csv", tmp_path / "k.json", *outputs.values()):
        assert not WORDS.search(path.read_text()), path.name
    assert not WORDS.search(summary)
    rows = (tmp_path / "k.csv").read_text().splitlines()
    assert len(rows) == 1 + report["input"]["vertices"]
    assert any(row.split(",")[1] == "" for row in rows) == loose

    for warning in report["warnings"]:
        assert re.fullmatch(r"[a-z_0-9]+", warning["code"])
        assert warning["count"] >= max(1, len(warning["examples"]))
        assert len(warning["examples"]) <= 5
        assert warning["message"].isprintable()
        assert warning["hint"] is None or warning["hint"].isprintable()
        assert warning["code"] in summary
    codes = [warning["code"] for warning in report["warnings"]]
    assert len(codes) == len({*codes})


def test_as_a_process_no_warning_reaches_the_user(tmp_path: Path) -> None:
    names = ("2^664", "2^-1060", "all at a point", "needles", "a speck", "3000 pages")
    given = [str(HOSTILE[name]().write(tmp_path / f"{name}.obj")) for name in names]
    line = [sys.executable, "-W", "error", "-m", "curvcli", "analyze", *given, "-q", "-p", "all", "-o", "{stem}.csv"]
    done = subprocess.run(line, cwd=tmp_path, env=environment(), capture_output=True, timeout=120)
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")
    assert {path.stem for path in tmp_path.glob("*.csv")} == set(names)


def test_an_index_far_beyond_the_list(tmp_path: Path) -> None:
    """Refused, and nothing of that size is allocated."""
    given = [tmp_path / f"{k}.obj" for k in range(3)]
    for mesh, index in zip(given, ("2147483647", "99999999999999999999", "-99999999999"), strict=True):
        mesh.write_text(f"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 {index}\n")
    line = [sys.executable, "-W", "error", "-m", "curvcli", "analyze", *map(str, given)]
    done = subprocess.run(line, env=environment(), capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout) == (3, "")
    assert [": ".join(one.split(": ")[:3]) for one in done.stderr.splitlines()] == [
        f"curvcli: {mesh}: line 4" for mesh in given
    ]

"""One range of colours over a batch: the hull of the ranges of the meshes, the same after a resume."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

import curvcli
from curvcli.output.appearance import Appearance
from curvcli.output.coloring import colored
from curvcli.output.pictures.colors import parse_range
from curvcli.output.pictures.legend import range_words
from tests.batch.conftest import Run
from tests.helpers.meshes import of_sample


@pytest.fixture
def frames(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    sphere = of_sample("icosphere", size=42)
    (tmp_path / "frames").mkdir()
    for k in range(3):
        sphere.moved(sphere.points * [1, 1, 1 + k]).write(tmp_path / "frames" / f"{k}.ply")
    (tmp_path / "frames" / "bad.ply").write_text("ply\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def ranges(folder: Path) -> set[tuple[float, float]]:
    """Ends of the colours in the comments of the meshes."""
    found = set()
    for path in folder.glob("*.ply.ply"):
        match = re.search(rb"comment colour: h from (\S+) to (\S+),", path.read_bytes())
        assert match
        found.add((float(match[1]), float(match[2])))
    return found


def own(path: str) -> tuple[float, float]:
    scale = colored(curvcli.analyze(path), "h", Appearance()).scale
    assert scale.low is not None
    assert scale.high is not None
    return scale.low, scale.high


def test_all_meshes_have_the_hull_of_their_ranges(frames: Path, run: Run) -> None:
    words = ("batch", "frames/*.ply", "--save", "ply", "--color-by", "h", "--range", "common", "-q")
    assert run(*words, "-o", "out", "-j", "2").code == 3  # of the bad mesh
    each = [own(f"frames/{k}.ply") for k in range(3)]
    hull = min(low for low, _ in each), max(high for _, high in each)
    assert ranges(frames / "out") == {hull}
    assert run(*words, "-o", "again", "-j", "1").code == 3
    for path in (frames / "out").glob("*.ply.ply"):
        assert (frames / "again" / path.name).read_bytes() == path.read_bytes()
    lines = (frames / "out" / "manifest.jsonl").read_bytes()
    assert run(*words, "-o", "out", "-j", "1", "--resume").code == 3
    assert (frames / "out" / "manifest.jsonl").read_bytes() == lines
    rows = [json.loads(line) for line in lines.splitlines()]
    assert {row["path"]: tuple(row["ranges"]["h"]) for row in rows if row["ranges"]} == {
        f"frames/{k}.ply": each[k] for k in range(3)
    }


@pytest.mark.slow
def test_a_new_mesh_that_widens_the_range_changes_all(frames: Path, run: Run) -> None:
    words = ("--save", "ply", "--color-by", "h", "--range", "common", "-q", "-j", "1", "-o", "out")
    assert run("batch", "frames/[01].ply", *words).code == 0
    before = ranges(frames / "out")
    assert run("batch", "frames/[012].ply", *words, "--resume").code == 0
    after = ranges(frames / "out")
    assert len(before) == len(after) == 1
    assert before != after


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("batch", "frames/*.ply", "-o", "out", "--range", "common"), "no output of --save has colours"),
        (("analyze", "frames/0.ply", "-o", "x.ply", "--range", "common"), "`curvcli batch` computes it"),
    ],
)
def test_where_there_is_no_common_range(frames: Path, run: Run, words: tuple[str, ...], message: str) -> None:
    ended = run(*words)
    assert (ended.code, message in ended.err) == (2, True), ended.err


def test_legends_name_the_rule() -> None:
    appearance = Appearance(value_range="p90", ranges=(("h", -1.5, 2.5),))
    assert parse_range(appearance.range_of("h")) == (-1.5, 2.5, None)
    assert appearance.range_of("K") == "p90"
    assert range_words(appearance.range_rule, signed=True) == "common to all meshes"
    assert range_words("0:1", signed=True) == "range as asked"

"""Patterns name meshes by their suffix in any case, packed or not; what is spelled out is taken as it stands."""

from __future__ import annotations

import gzip
import os
from pathlib import Path

import pytest

from curvcli.batch.locations import expand
from curvcli.batch.walk import spellings
from tests.helpers.cli.program import curvcli
from tests.helpers.meshes import tetrahedron

NAMES = ["a.ply", "b.PLY", "c.Ply.gz", "d.PLY.GZ", "e.stl", "f.STL", "g.OBJ.gz", "h.obj", "i.ply.bak", "j.plyx", "k.gz"]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "deep" / "er").mkdir(parents=True)
    for place in ("", "deep/", "deep/er/"):
        for name in NAMES:
            (tmp_path / f"{place}{name}").touch()
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("pattern", "found"),
    [
        ("*.ply", "abcd"),
        ("*.PLY", "abcd"),
        ("*.ply.gz", "cd"),
        ("*.Ply.GZ", "cd"),
        ("*.stl", "ef"),
        ("*.obj", "gh"),
        ("[a-c].ply", "abc"),
        ("?.stl", "ef"),
        ("*", "abcdefghijk"),
        ("*.bak", "i"),
        ("*.pl?", "a"),
        ("*.gz", "cgk"),
        ("b.*", "b"),
    ],
)
@pytest.mark.parametrize("place", ["", "deep/", "d*p/er/"])
def test_a_pattern_ignores_the_case_of_suffixes(folder: Path, pattern: str, found: str, place: str) -> None:
    assert "".join(os.path.basename(name)[0] for name in expand(place + pattern)) == found


def test_two_stars_match_at_any_depth(folder: Path) -> None:
    assert len(expand("**/*.stl")) == 6
    assert len(expand(f"{folder}/**/*.ply")) == 12


def test_patterns_apply_to_urls_too(folder: Path) -> None:
    pytest.importorskip("fsspec")
    assert [name[-1] for name in expand(f"file://{folder}/*.stl")] == ["l", "L"]
    assert len(expand(f"file://{folder}/**/*.obj")) == 6


def test_a_name_without_wildcards_is_the_name(folder: Path) -> None:
    assert expand("b.PLY") == ["b.PLY"]
    assert spellings("*.txt") == ["*.txt"]
    assert spellings("stl") == ["stl"]


def test_a_batch_reads_them_all_and_outputs_never_meet(tmp_path: Path) -> None:
    scans = tmp_path / "scans"
    scans.mkdir()
    data = tetrahedron().write(tmp_path / "t.obj").read_bytes()
    for name in ("a.obj", "a.OBJ.gz", "b.Obj", "c.OBJ.GZ"):
        (scans / name).write_bytes(gzip.compress(data) if name.lower().endswith(".gz") else data)
    ended = curvcli("batch", "scans/*.obj", "-o", "out", "--save", "csv", "-j", "1", folder=tmp_path)
    assert ended.code == 0, ended.err
    rows = (tmp_path / "out" / "summary.csv").read_text().splitlines()[1:]
    assert [row.split(",")[0] for row in rows] == ["scans/a.OBJ.gz", "scans/a.obj", "scans/b.Obj", "scans/c.OBJ.GZ"]
    assert len(list((tmp_path / "out").rglob("*.csv"))) == 5

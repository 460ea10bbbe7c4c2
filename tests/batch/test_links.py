"""Links: a folder is visited once and a file named once, whatever leads to it, in time proportional to the tree."""

from __future__ import annotations

import glob
import os
import random
import time
from pathlib import Path

import pytest

from curvcli.batch.plan import plan
from curvcli.batch.walk import files_of

PATTERNS = ("**/*.ply", "scans/**/*.ply", "**", "scans/**", "*/*/*.ply", "**/**/*.ply", "**/deep/**/*", "./scans/*.ply")


@pytest.fixture
def tree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name in ("z.ply", "deep/er/a.ply", "deep/b.ply", ".hidden/c.ply", "deep/.d.ply", "deep/[x].ply"):
        path = tmp_path / "scans" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    return tmp_path / "scans"


def named(*patterns: str) -> list[str]:
    return [item.path for item in plan(patterns, None, "out", [])]


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("level", [0, 1, 3])
def test_links_to_folders_above_add_nothing(tree: Path, pattern: str, level: int) -> None:
    before = files_of(pattern)
    assert before
    for number in range(40):
        for folder in (tree, tree / "deep", tree / "deep" / "er"):
            (folder / f"{number:02}").symlink_to(os.path.join(".", *[".."] * level), target_is_directory=True)
    start = time.perf_counter()
    found = files_of(pattern)
    assert time.perf_counter() - start < 5
    assert {os.path.realpath(one) for one in found} >= {os.path.realpath(one) for one in before}
    assert len({os.path.realpath(one) for one in found}) == len(found)
    assert {one for one in found if one in before} == set(before)


def test_one_mesh_has_one_row(tree: Path) -> None:
    (tree / "deep" / "loop").symlink_to("..", target_is_directory=True)
    (tree / "again.ply").symlink_to("z.ply")
    (tree / "a_link").symlink_to("deep", target_is_directory=True)
    assert named("scans/**/*.ply") == ["scans/deep/[x].ply", "scans/deep/b.ply", "scans/deep/er/a.ply", "scans/z.ply"]
    assert named("scans/again.ply", "scans/*.ply") == ["scans/again.ply"]
    Path("list").write_text("scans/z.ply\nscans/deep/loop/z.ply\nscans/again.ply\nscans/deep/loop/deep/loop/z.ply\n")
    assert [item.path for item in plan([], "list", "out", [])] == ["scans/z.ply"]


def test_links_that_lead_nowhere_are_named(tree: Path) -> None:
    (tree / "gone.ply").symlink_to("nothing")
    (tree / "self.ply").symlink_to("self.ply")
    assert named("scans/*.ply") == ["scans/gone.ply", "scans/self.ply", "scans/z.ply"]


def test_a_folder_that_only_links_reach_is_visited(tree: Path) -> None:
    away = tree.parent / "away" / "far"
    away.mkdir(parents=True)
    (away / "m.ply").touch()
    for name in ("one", "two"):
        (tree / name).symlink_to(away.parent, target_is_directory=True)
    assert [one for one in named("scans/**/*.ply") if "far" in one] == ["scans/one/far/m.ply"]


def test_outputs_behind_a_link_are_no_inputs(tree: Path) -> None:
    (tree.parent / "out").mkdir()
    (tree.parent / "out" / "old.ply").touch()
    (tree / "link").symlink_to(tree.parent / "out", target_is_directory=True)
    assert not [one for one in named("scans/**/*.ply") if "old" in one]


@pytest.mark.parametrize("seed", range(20))
def test_without_links_the_same_as_glob(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, seed: int) -> None:
    monkeypatch.chdir(tmp_path)
    chance = random.Random(seed)
    names = ["a", "b", ".h", "a.ply", "[1]", "1", "ab"]
    for _ in range(30):
        path = Path(*chance.choices(names, k=chance.randint(1, 4)))
        if not any(parent.is_file() for parent in path.parents) and not path.exists():
            path.parent.mkdir(parents=True, exist_ok=True)
            path.touch() if chance.random() < 0.7 else path.mkdir()
    parts = ["**", "*", "a", "a*", "[1]", "[[]1]", "?", ".*", "*.ply", ".", "b"]
    for _ in range(200):
        pattern = os.path.join(*chance.choices(parts, k=chance.randint(1, 4)))
        pattern = os.path.join(tmp_path, pattern) if chance.random() < 0.3 else pattern
        wanted = {one for one in glob.glob(pattern, recursive=True) if not os.path.isdir(one)}
        wanted = {one for one in wanted if not one.endswith("/")}  # a file, which glob takes for a folder
        found = files_of(pattern)
        assert {os.path.realpath(one) for one in found} == {os.path.realpath(one) for one in wanted}, pattern
        assert set(found) <= wanted, pattern
        assert found == sorted(found)

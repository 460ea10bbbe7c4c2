"""Refusals: exit code, one line of text, and no output written."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from curvcli.loading.registry import input_formats
from tests.helpers.cli.program import CUBE, DISK, MOBIUS, ROOT, command, curvcli, environment, wrote


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["analzye", CUBE], "analyze"),
        (["analyze"], "MESH"),
        (["analyze", CUBE, "--bogus"], "--bogus"),
        (["analyze", CUBE, "-p", "kapa_1"], "kappa_1"),
        (["analyze", CUBE, "-p", ""], "unknown pass"),
        (["analyze", CUBE, "--area", "circular"], "barycentric"),
        (["analyze", CUBE, "--mean", "median"], "average"),
        (["analyze", CUBE, "--orient", "inward"], "outward"),
        (["analyze", CUBE, "--weld", "-1"], "--weld"),
        (["analyze", CUBE, "-o", "t.xyz"], ".csv"),
        (["analyze", CUBE, "-o", "t"], "suffix"),
        (["analyze", CUBE, DISK, "-o", "t.csv"], "{stem}"),
        (["analyze", CUBE, "--max-faces", "0"], "--max-faces"),
        (["passes", "kapa_1"], "kappa_1"),
        (["sample", "toruss", "-o", "t.obj"], "torus"),
    ],
)
def test_a_wrong_command_line_writes_nothing(arguments: list[str], words: str, tmp_path: Path) -> None:
    ended = curvcli(*arguments, folder=tmp_path)
    assert ended.code == 2
    assert words in ended.complaint
    assert list(tmp_path.iterdir()) == []


def test_two_meshes_of_one_name(tmp_path: Path) -> None:
    """{stem} cannot tell them apart; batch can."""
    for folder in ("xx", "yy"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "a.obj").write_bytes(Path(CUBE).read_bytes())
    for option in (("-o", "{stem}.csv"), ("--table", "edges={stem}.csv")):
        ended = curvcli("analyze", "xx/a.obj", "yy/a.obj", *option, folder=tmp_path)
        assert ended.code == 4
        assert ended.complaint.startswith("a.csv: xx/a.obj and yy/a.obj would share this output; `curvcli batch` ")
    assert not (tmp_path / "a.csv").exists()


@pytest.mark.parametrize("suffix", [".csv", ".ply", ".stl", ".json", ".md"])
def test_the_page_says_what_analyze_does_not_write(suffix: str, tmp_path: Path) -> None:
    page = (ROOT / "docs" / "formats.md").read_text(encoding="utf-8")
    (row,) = [line for line in page.splitlines() if line.startswith(f"| `{suffix}` |")]
    ended = curvcli("analyze", CUBE, "-q", "-o", f"t{suffix}", folder=tmp_path)
    assert (ended.code == 0) == ("`curvcli sample` only" not in row)


def test_what_can_be_compared_is_listed(tmp_path: Path) -> None:
    (tmp_path / "t.npz").write_bytes(b"")
    ended = curvcli("compare", CUBE, "t.npz", folder=tmp_path)
    assert ended.code == 3
    assert ended.complaint.startswith("t.npz: suffix `.npz` found, ")
    assert all(f"{suffix}, " in ended.complaint for suffix in (".obj", ".ply", ".vtp"))
    assert ", or .json, .csv, .tsv, .parquet, .jsonl; --input-format" in ended.complaint


@pytest.mark.parametrize("arguments", [["analyze", CUBE, "--mean"], ["check", CUBE, "-o"], ["batch", "x", "--jobs"]])
def test_an_option_without_its_value(arguments: list[str], tmp_path: Path) -> None:
    ended = curvcli(*arguments, folder=tmp_path)
    assert (ended.code, ended.complaint.endswith(f"; `curvcli {arguments[0]} --help` explains the options")) == (
        2,
        True,
    )


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("none.obj", None, "no such file"),
        ("empty.obj", "", "no data found"),
        ("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "no faces"),
        ("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "line 4: vertex index `9` found"),
        ("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n", "not finite"),
        ("short.ply", "ply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nend_header\n", "properties x, y, z"),
        ("t.stl", "v 0 0 0\nf 1 1 1\n", "no faces"),
        ("mesh.xyz", "1 2 3\n", "suffix `.xyz` found"),
    ],
)
def test_a_bad_input_is_named_with_its_fault(name: str, content: str | None, words: str, tmp_path: Path) -> None:
    mesh = tmp_path / name
    if content is not None:
        mesh.write_text(content)
    ended = curvcli("analyze", mesh, "-o", tmp_path / "t.csv")
    assert ended.code == 3
    path, _, problem = ended.complaint.partition(": ")
    assert path == str(mesh)
    assert words in problem
    assert not (tmp_path / "t.csv").exists()


def test_folders_and_pipes_are_no_meshes(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.obj"
    os.mkfifo(pipe)
    for place in (tmp_path, pipe, Path("/dev/null")):
        ended = curvcli("analyze", place)
        assert ended.code == 3
        assert str(place) in ended.complaint


def test_a_name_that_is_not_text(tmp_path: Path) -> None:
    """Control characters in a name do not break the line."""
    ended = curvcli("analyze", tmp_path / "two\nlines\x1b[31m.obj")
    assert ended.code == 3
    assert "\x1b" not in ended.complaint


def test_an_output_that_exists_is_refused_before_any_work(tmp_path: Path) -> None:
    old, new = tmp_path / "old.csv", tmp_path / "new.csv"
    old.write_text("mine\n")
    for mesh in (CUBE, str(tmp_path / "none.obj")):
        ended = curvcli("analyze", mesh, "-o", new, "-o", old)
        assert ended.code == 4
        assert str(old) in ended.complaint
        assert "--force" in ended.complaint
    assert old.read_text() == "mine\n"
    assert not new.exists()
    wrote(curvcli("analyze", CUBE, "-q", "-o", old, "--force"))
    assert old.read_text().startswith("vertex,")


def test_force_keeps_what_is_there_when_the_mesh_is_bad(tmp_path: Path) -> None:
    old = tmp_path / "old.csv"
    old.write_text("mine\n")
    assert curvcli("analyze", tmp_path / "none.obj", "-o", old, "--force").code == 3
    assert old.read_text() == "mine\n"
    assert list(tmp_path.iterdir()) == [old]


def test_a_place_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    (tmp_path / "folder.csv").mkdir()
    for place in (tmp_path / "none" / "t.csv", tmp_path / "file" / "t.csv", tmp_path / "folder.csv"):
        ended = curvcli("analyze", tmp_path / "no-mesh.obj", "-o", place)
        assert ended.code == 4
        assert str(place) in ended.complaint


def test_one_output_is_not_written_twice(tmp_path: Path) -> None:
    ended = curvcli("analyze", CUBE, "-o", tmp_path / "t.csv", "-o", tmp_path / "x" / ".." / "t.csv")
    assert ended.code == 4
    other = tmp_path / "cube.obj"
    other.write_bytes(Path(CUBE).read_bytes())
    ended = curvcli("analyze", CUBE, other, "-o", tmp_path / "{stem}.csv")
    assert ended.code == 4
    assert "cube.csv" in ended.complaint
    assert list(tmp_path.iterdir()) == [other]


def test_one_bad_mesh_does_not_stop_the_others(tmp_path: Path) -> None:
    bad = tmp_path / "bad.obj"
    bad.write_text("v 0 0 0\n")
    ended = curvcli("analyze", CUBE, bad, MOBIUS, "-q", "-o", tmp_path / "{stem}.csv", "-o", tmp_path / "{stem}.json")
    assert ended.code == 3
    assert ended.complaint.startswith(str(bad))
    written = {f"{stem}.{suffix}" for stem in ("cube", "mobius") for suffix in ("csv", "json")}
    assert {path.name for path in tmp_path.iterdir()} == {"bad.obj"} | written


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere a folder that somebody is in may not be removed")
def test_a_working_folder_that_is_gone(tmp_path: Path) -> None:
    """A mesh with an absolute path is analysed, a mesh with a relative one is not found."""

    def run(*arguments: str) -> tuple[int, str]:
        (tmp_path / "gone").mkdir()
        line = ["sh", "-c", 'cd "$0" && rmdir "$0" && exec "$@"', str(tmp_path / "gone"), *command(*arguments)]
        done = subprocess.run(line, capture_output=True, text=True, env=environment(), timeout=120)
        assert len(done.stderr.splitlines()) == (done.returncode != 0), done.stderr
        return done.returncode, done.stderr

    assert run("analyze", CUBE, "-q", "-o", str(tmp_path / "k.csv"))[0] == 0
    assert run("check", CUBE, "--format", "sarif")[0] == 0
    assert run("check", "cube.obj", "--format", "sarif")[0] == 3
    assert run("batch", CUBE, "-q", "-o", str(tmp_path / "out"))[0] == 0
    assert run("analyze", "cube.obj") == (3, "curvcli: cube.obj: no such file\n")
    assert run("analyze", CUBE, "-o", "k.csv")[0] == 4
    code, words = run("batch", CUBE, "-o", "out")
    assert (code, words.startswith("curvcli: out: the working folder was removed")) == (3, True)


def test_a_stem_may_stand_amid_a_name(tmp_path: Path) -> None:
    wrote(curvcli("analyze", CUBE, "-q", "-o", tmp_path / "k-{stem}-k.csv"))
    assert [path.name for path in tmp_path.iterdir()] == ["k-cube-k.csv"]


def test_an_error_names_the_way_out(tmp_path: Path) -> None:
    mesh = tmp_path / "mesh.data"
    mesh.write_bytes(Path(CUBE).read_bytes())
    ended = curvcli("analyze", mesh)
    way_out = f"; --input-format {'|'.join(input_formats())} reads a file of such a format under another name"
    assert (ended.code, ended.complaint.endswith(way_out)) == (3, True)
    wrote(curvcli("analyze", mesh, "--input-format", "obj", "-q"))

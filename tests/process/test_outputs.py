"""Outputs under adversity: a disk that is full, two runs on one name, readers that have seen enough."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.helpers.cli.program import command, curvcli, environment, served, start
from tests.helpers.meshes import ellipsoid, torus
from tests.process.watch import feed


@pytest.fixture(scope="module")
def tiny(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A file system of 256 kB."""
    place = tmp_path_factory.mktemp("tiny")
    done = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", place], capture_output=True, text=True)
    if done.returncode:
        pytest.skip(f"no small file system can be mounted here: {done.stderr.strip()}")
    yield place
    subprocess.run(["umount", place], check=True)


@pytest.mark.parametrize("suffix", ["csv", "tsv", "parquet", "npz", "ply", "obj"])
def test_a_full_disk(suffix: str, small: Path, tiny: Path) -> None:
    output = tiny / f"k.{suffix}"
    ended = curvcli("analyze", small, "-q", "-o", output)
    assert (ended.code, ended.complaint) == (4, f"{output}: cannot be written: No space left on device")
    assert os.listdir(tiny) == []


def test_a_disk_full_at_the_second_output(small: Path, tiny: Path) -> None:
    """An output that fits is not kept without the others, and existing files stay."""
    report, table = tiny / "k.json", tiny / "k.csv"
    report.write_text("mine")
    ended = curvcli("analyze", small, "-q", "--force", "-o", report, "-o", table)
    assert (ended.code, ended.complaint) == (4, f"{table}: cannot be written: No space left on device")
    assert report.read_text() == "mine"
    assert os.listdir(tiny) == ["k.json"]
    report.unlink()


@pytest.mark.parametrize("what", [[], ["--json"], ["--get", "topology"], ["-o", "-", "--format", "csv"]])
@pytest.mark.parametrize("stdout", ["full", "closed"])
def test_a_stdout_that_takes_nothing(what: list[str], stdout: str, small: Path) -> None:
    if stdout == "full" and not os.path.exists("/dev/full"):
        pytest.skip("there is no /dev/full here")
    where, program = {"full": (">/dev/full", served), "closed": (">&-", command)}[stdout]
    line = ["sh", "-c", f'"$@" {where}', "sh", *program("analyze", small, *what)]
    done = subprocess.run(line, capture_output=True, env=environment(), timeout=120)
    assert done.returncode == 4
    assert done.stderr.startswith(b"curvcli: stdout: cannot be written: ")
    assert done.stderr.count(b"\n") == 1


def test_closed_streams_do_not_become_outputs(small: Path, tmp_path: Path) -> None:
    """Without stdin, stdout and stderr the first files opened would get their numbers."""
    line = ["sh", "-c", '"$@" <&- >&- 2>&-', "sh", *command("analyze", small, "-q", "-o", tmp_path / "k.csv")]
    assert subprocess.run(line, env=environment(), timeout=120).returncode == 0
    assert curvcli("analyze", small, "-q", "-o", tmp_path / "open.csv") == (0, "", "")
    assert (tmp_path / "k.csv").read_bytes() == (tmp_path / "open.csv").read_bytes()


@pytest.mark.parametrize("what", [["-v"], ["--json"], ["-o", "-", "--format", "csv"]])
def test_a_reader_that_leaves_after_one_line_is_no_error(what: list[str], small: Path) -> None:
    """A reader that leaves after the first line."""
    process = start("analyze", small, *what, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    head = subprocess.run(["head", "-1"], stdin=process.stdout, capture_output=True, timeout=120)
    assert process.stdout is not None
    process.stdout.close()
    _, words = process.communicate(timeout=120)
    assert (process.returncode, words) == (0, b"")
    assert head.stdout.count(b"\n") == 1


def test_outputs_outlive_a_reader_of_the_summary(small: Path, tmp_path: Path) -> None:
    """`curvcli analyze MESH -o TABLE | head`: the reader leaves while the summary is told."""
    read, write = os.pipe()
    os.close(read)
    arguments = ["analyze", small, "-o", tmp_path / "k.csv", "-o", tmp_path / "k.json"]
    process = start(*arguments, stdout=write, stderr=subprocess.PIPE)
    os.close(write)
    _, words = process.communicate(timeout=120)
    assert (process.returncode, words) == (0, b"")
    assert curvcli("analyze", small, "-q", "-o", tmp_path / "alone.csv") == (0, "", "")
    assert (tmp_path / "k.csv").read_bytes() == (tmp_path / "alone.csv").read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["alone.csv", "k.csv", "k.json"]


@pytest.mark.slow
@pytest.mark.parametrize("force", [[], ["--force"]])
def test_two_runs_on_one_output(force: list[str], tmp_path: Path) -> None:
    """Both have looked at the output before either writes; then one mesh is given, then the other."""
    given = {}
    for name, made in (("torus", torus()), ("ellipsoid", ellipsoid())):
        given[name] = made.write(tmp_path / f"{name}.obj").read_bytes()
        alone = curvcli(
            "analyze", "-", "--input-format", "obj", "-q", "-o", tmp_path / f"{name}.csv", given=given[name]
        )
        assert alone == (0, "", "")
    alone_bytes = {(tmp_path / f"{name}.csv").read_bytes() for name in given}

    arguments = ["analyze", "-", "--input-format", "obj", "-q", "-o", str(tmp_path / "shared.csv"), *force]
    runs = [start(*arguments, stdin=subprocess.PIPE, stderr=subprocess.PIPE) for _ in given]
    for process in runs:
        feed(process, b"# both wait\n")
    for process, content in zip(runs, given.values(), strict=True):
        assert process.stdin is not None
        process.stdin.write(content)
        process.stdin.flush()
    for process in runs:
        assert process.stdin is not None
        process.stdin.close()
        process.stdin = None
    words = [process.communicate(timeout=120)[1] for process in runs]
    codes = [process.returncode for process in runs]
    assert (tmp_path / "shared.csv").read_bytes() in alone_bytes
    if force:
        assert (codes, words) == ([0, 0], [b"", b""])
    else:
        assert sorted(codes) == [0, 4]
        loser = words[codes.index(4)].decode()
        assert loser == f"curvcli: {tmp_path / 'shared.csv'}: appeared while it was computed; --force overwrites it\n"
    assert not [name for name in os.listdir(tmp_path) if name.endswith(".part")]

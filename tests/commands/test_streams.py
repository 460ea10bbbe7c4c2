"""stdin, stdout, terminals, pipes that close and keys that interrupt."""

from __future__ import annotations

import contextlib
import os
import pty
import signal
import subprocess
from pathlib import Path

import pytest

from tests.helpers.cli.program import CUBE, DISK, Ended, curvcli, environment, served, start, wrote


def test_from_stdin_to_stdout(tmp_path: Path) -> None:
    content = Path(DISK).read_bytes()
    ended = curvcli("analyze", "-", "--input-format", "obj", "-o", "-", "--format", "csv", given=content)
    wrote(ended)
    file = tmp_path / "t.csv"
    wrote(curvcli("analyze", DISK, "-q", "-o", file))
    assert ended.out == file.read_text()


def test_a_report_from_stdin() -> None:
    ended = curvcli("analyze", "-", "--input-format", "obj", "--get", "input.path", given=Path(CUBE).read_bytes())
    assert ended == (0, "-\n", "")


def test_nothing_on_stdin() -> None:
    ended = curvcli("analyze", "-", "--input-format", "ply", given=b"")
    assert ended.code == 3
    assert ended.complaint.startswith("-: ")


@pytest.mark.parametrize("format", ["csv", "tsv", "json", "ply", "obj"])
def test_every_format_goes_to_stdout(format: str, tmp_path: Path) -> None:
    """The very bytes that a file gets, timings apart."""
    done = subprocess.run(
        served("analyze", CUBE, "-o", "-", "--format", format), capture_output=True, env=environment()
    )
    assert (done.returncode, done.stderr) == (0, b"")
    file = tmp_path / f"t.{format}"
    wrote(curvcli("analyze", CUBE, "-q", "-o", file))
    if format != "json":
        assert done.stdout == file.read_bytes()
    else:
        assert done.stdout.startswith(b"{")


def test_a_sample_goes_to_stdout_and_on(tmp_path: Path) -> None:
    line = served("sample", "cube", "-o", "-", "--format", "ply")
    done = subprocess.run(line, capture_output=True, env=environment(), timeout=120)
    assert (done.returncode, done.stderr) == (0, b"")
    wrote(curvcli("sample", "cube", "-o", tmp_path / "cube.ply"))
    assert done.stdout == (tmp_path / "cube.ply").read_bytes()
    ended = curvcli("analyze", "-", "--input-format", "ply", "--get", "topology.faces", given=done.stdout)
    assert ended == (0, "12\n", "")


def test_a_quiet_sample_says_nothing(tmp_path: Path) -> None:
    assert "float32" in curvcli("sample", "octahedron", "-o", tmp_path / "one.stl").err
    assert curvcli("sample", "octahedron", "-q", "-o", tmp_path / "two.stl") == (0, "", "")


@pytest.mark.parametrize(
    "options",
    [
        ["-o", "-"],
        ["-o", "-", "--format", "doc"],
        ["-o", "-", "--format", "csv", "--json"],
        ["--json", "--get", "totals"],
    ],
)
def test_what_cannot_go_to_stdout(options: list[str]) -> None:
    ended = curvcli("analyze", CUBE, *options)
    assert ended.code == 2
    assert ended.complaint


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A mesh whose table is far longer than a pipe."""
    path = tmp_path_factory.mktemp("large") / "sphere.ply"
    wrote(curvcli("sample", "icosphere", "--size", "5000", "-q", "-o", path))
    return path


@pytest.mark.parametrize("what", [["-o", "-", "--format", "csv"], ["-o", "-", "--format", "ply"], ["--json"], []])
def test_a_pipe_that_closes_ends_quietly(large: Path, what: list[str]) -> None:
    closes(what, "analyze", str(large), *what)


@pytest.mark.parametrize("arguments", [["--help"], ["passes"], ["analyze", "--schema"], ["sample"]])
def test_a_pipe_that_closes_early_ends_quietly(arguments: list[str]) -> None:
    closes([], *arguments)


def closes(what: list[str], *arguments: str) -> None:
    process = start(*arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdout is not None
    if what[:1] == ["-o"]:
        process.stdout.read(10)
    process.stdout.close()
    _, complaint = process.communicate(timeout=120)
    assert (process.returncode, complaint) == (0, b"")


@pytest.mark.parametrize(("name", "code"), [("nothing.obj", 3), ("--nothing", 2)])
def test_a_full_stderr_changes_no_exit_code(name: str, code: int) -> None:
    if not os.path.exists("/dev/full"):
        pytest.skip("there is no /dev/full here")
    with open("/dev/full", "wb") as full:
        process = start("analyze", name, stdout=subprocess.PIPE, stderr=full)
        assert process.communicate(timeout=60) == (b"", None)
    assert process.returncode == code


def test_a_full_device() -> None:
    if not os.path.exists("/dev/full"):
        pytest.skip("there is no /dev/full here")
    with open("/dev/full", "wb") as full:
        process = start("analyze", CUBE, "-o", "-", "--format", "csv", stdout=full, stderr=subprocess.PIPE)
        _, complaint = process.communicate(timeout=120)
    assert process.returncode == 4
    assert complaint.count(b"\n") == 1
    assert b"Traceback" not in complaint


@pytest.mark.parametrize("outputs", [[], ["-o", "out.csv", "-o", "out.ply"]])
def test_an_interrupt_leaves_nothing_behind(outputs: list[str], tmp_path: Path) -> None:
    """SIGINT while it reads: more has been written than a pipe holds, so reading has begun."""
    process = start(
        *("analyze", "-", "--input-format", "obj", *outputs),
        cwd=tmp_path,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert process.stdin is not None
    process.stdin.write(b"# nothing yet\n" * 200_000)
    process.stdin.flush()
    for _ in range(10):
        # Python forgets a signal that comes just before a read blocks, and whoever presses Ctrl-C presses it again.
        process.send_signal(signal.SIGINT)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(timeout=5)
            break
    else:
        process.kill()
    out, complaint = process.communicate()
    assert process.returncode == 130
    assert (out, complaint) == (b"", b"curvcli: interrupted\n")
    assert list(tmp_path.iterdir()) == []


def on_a_terminal(*arguments: str, **more: str) -> Ended:
    """With stdout a terminal, stderr a pipe."""
    leader, follower = pty.openpty()
    process = subprocess.Popen(
        served(*arguments), stdout=follower, stderr=subprocess.PIPE, env=environment(TERM="xterm-256color", **more)
    )
    os.close(follower)
    shown = b""
    while True:
        try:
            part = os.read(leader, 65536)
        except OSError:  # the other end is gone
            break
        if not part:
            break
        shown += part
    os.close(leader)
    _, complaint = process.communicate(timeout=120)
    return Ended(process.returncode, shown.decode(), complaint.decode())


def test_colour_only_on_a_terminal_and_not_against_the_users_will() -> None:
    ended = on_a_terminal("analyze", CUBE)
    assert ended.code == 0
    assert "\x1b[3" in ended.out
    plain = on_a_terminal("analyze", CUBE, NO_COLOR="1")
    assert plain.code == 0
    assert "\x1b[3" not in plain.out
    assert "\x1b" not in curvcli("analyze", CUBE).out


@pytest.mark.parametrize("arguments", [["--json"], ["--get", "totals.K"], ["-o", "-", "--format", "csv"]])
def test_data_is_the_same_on_a_terminal(arguments: list[str]) -> None:
    shown = on_a_terminal("analyze", CUBE, *arguments)
    assert (shown.code, shown.err) == (0, "")
    plain = curvcli("analyze", CUBE, *arguments)
    assert "\x1b" not in shown.out
    if arguments != ["--json"]:
        assert shown.out.replace("\r\n", "\n") == plain.out

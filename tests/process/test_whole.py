"""Everything that goes to stdout arrives, or the exit code says that it did not; the verdict survives its reader."""

from __future__ import annotations

import contextlib
import fcntl
import os
import resource
import signal
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.cli.program import CUBE, DISK, command, curvcli, environment, served, start
from tests.process.watch import unread, until

# What each command writes to stdout, by every way that text and bytes take.
WRITERS: tuple[tuple[str, ...], ...] = (
    ("analyze", CUBE),
    ("analyze", CUBE, "--json"),
    ("analyze", CUBE, "--get", "checks"),
    ("analyze", CUBE, "-p", "paper", "-o", "-", "--format", "csv"),
    ("analyze", CUBE, "-p", "paper", "-o", "-", "--format", "parquet"),
    ("analyze", CUBE, "-p", "paper", "-o", "-", "--format", "npz"),
    ("analyze", CUBE, "-p", "paper", "-o", "-", "--format", "ply"),
    ("analyze", CUBE, "-p", "paper", "-o", "-", "--format", "md"),
    ("analyze", "--schema"),
    ("check", DISK, CUBE, "--require", "closed", "-v"),
    ("check", CUBE, "--format", "json"),
    ("check", CUBE, "--format", "junit", "-v"),
    ("check", DISK, "--format", "sarif", "--require", "closed"),
    ("compare", CUBE, DISK),
    ("compare", CUBE, DISK, "--json"),
    ("curves", DISK),
    ("curves", DISK, "--json"),
    ("passes",),
    ("passes", "--json"),
    ("passes", "K"),
    ("passes", "--markdown"),
    ("sample",),
    ("sample", "cube", "-o", "-", "--format", "obj"),
    ("help",),
    ("help", "formats"),
    ("--help",),
    ("analyze", "--help"),
    ("completion", "show", "bash"),
)
# Of these one each begins with a process of its own, which alone obeys PYTHONUNBUFFERED.
COLD = ((CUBE,), ("--schema",), ("--json",), ("K",), ("formats",), ("show",))
LONG = 1 << 10


def expected(arguments: Sequence[str]) -> tuple[int, bytes]:
    """Bytes in a pipe that takes everything."""
    done = subprocess.run(served(*arguments), capture_output=True, env=environment(), timeout=120)
    return done.returncode, done.stdout


def timeless(data: bytes) -> bytes:
    """Without the seconds that a report tells."""
    return data.partition(b'"timings"')[0]


@pytest.mark.slow
@pytest.mark.parametrize("arguments", [one for one in WRITERS if one[1:2] in COLD], ids=" ".join)
def test_a_short_write_is_continued_or_refused(arguments: tuple[str, ...], tmp_path: Path) -> None:
    """A file that may have 1,024 bytes and no more takes a part of the first write and refuses the next."""
    code, whole = expected(arguments)
    if len(whole) <= LONG:
        pytest.skip("shorter than what fits")
    place = tmp_path / "cut"
    with place.open("wb") as stream:
        done = subprocess.run(
            command(*arguments),
            stdout=stream,
            stderr=subprocess.PIPE,
            env=environment(PYTHONUNBUFFERED="1"),
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (LONG, LONG)),
            timeout=120,
        )
    assert code in (0, 1)
    assert done.returncode == 4
    assert done.stderr.endswith(b"curvcli: stdout: cannot be written: File too large\n")
    assert b"Traceback" not in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("arguments", WRITERS, ids=" ".join)
def test_a_pipe_that_does_not_block_gets_everything(arguments: tuple[str, ...]) -> None:
    code, whole = expected(arguments)
    read, write = os.pipe()
    fcntl.fcntl(write, fcntl.F_SETPIPE_SZ, 4096)
    os.set_blocking(write, False)
    process = subprocess.Popen(served(*arguments), stdout=write, stderr=subprocess.PIPE, env=environment())
    os.close(write)
    with os.fdopen(read, "rb", buffering=0) as pipe:
        got = b""
        while part := pipe.read(1000):
            got += part
            if len(got) < 10_000:
                time.sleep(0.002)  # a reader that pauses finds the pipe full
    _, words = process.communicate(timeout=120)
    assert process.returncode == code
    assert timeless(got) == timeless(whole)
    assert b"Traceback" not in words


@pytest.mark.parametrize("arguments", WRITERS, ids=" ".join)
def test_a_full_device_is_4(arguments: tuple[str, ...]) -> None:
    if not os.path.exists("/dev/full"):
        pytest.skip("there is no /dev/full here")
    with open("/dev/full", "wb") as full:
        done = subprocess.run(served(*arguments), stdout=full, stderr=subprocess.PIPE, env=environment(), timeout=120)
    assert done.returncode == 4
    assert done.stderr.endswith(b"curvcli: stdout: cannot be written: No space left on device\n")
    assert done.stderr.count(b"curvcli: stdout") == 1


# ---------------------------------------------------------------------------- readers that leave

NONE = "none.ply"
GATES: tuple[tuple[int, tuple[str, ...]], ...] = (
    (1, ("check", DISK, "--require", "closed")),
    (1, ("check", DISK, CUBE, "--require", "closed", "-v")),
    (1, ("check", CUBE, DISK, "--require", "closed", "--format", "sarif")),
    (1, ("check", CUBE, DISK, "--require", "closed", "--format", "junit")),
    (1, ("check", CUBE, DISK, "--require", "closed", "--format", "github")),
    (1, ("compare", CUBE, DISK)),
    (1, ("compare", CUBE, DISK, "--json")),
    (3, ("analyze", NONE, CUBE)),
    (3, ("analyze", NONE, CUBE, "--json")),
    (3, ("check", NONE, CUBE)),
    (0, ("analyze", CUBE, CUBE, "--get", "totals")),
    (0, ("passes", "--json")),
    (0, ("analyze", "--help")),
    (0, ("completion", "show", "fish")),
)
COLD_GATES = [(*GATES[place], command) for place in (0, 5, 7, -1)]


def closed_pipe() -> int:
    read, write = os.pipe()
    os.close(read)
    return write


@pytest.mark.parametrize(("code", "arguments", "program"), [(*gate, served) for gate in GATES] + COLD_GATES)
def test_a_reader_that_leaves_changes_no_verdict(code: int, arguments: tuple[str, ...], program: Any) -> None:
    pipe = closed_pipe()
    try:
        done = subprocess.run(
            program(*arguments),
            stdout=pipe,
            stderr=subprocess.PIPE,
            env=environment(PYTHONUNBUFFERED="1" if program is command else ""),
            timeout=120,
        )
    finally:
        os.close(pipe)
    assert done.returncode == code
    told = f"curvcli: {NONE}: no such file\n".encode() if NONE in arguments else b""
    assert done.stderr == told


def test_what_comes_after_the_reader_left_is_still_written(tmp_path: Path) -> None:
    """`analyze MESH -o - -o k.csv | true`: the table is there, and whole."""
    pipe = closed_pipe()
    more = ["-o", "-", "--format", "ply", "-o", tmp_path / "k.csv", "-o", tmp_path / "k.json"]
    done = subprocess.run(
        served("analyze", DISK, *more), stdout=pipe, stderr=subprocess.PIPE, env=environment(), timeout=120
    )
    os.close(pipe)
    assert (done.returncode, done.stderr) == (0, b"")
    assert curvcli("analyze", DISK, "-q", "-o", tmp_path / "alone.csv").code == 0
    assert (tmp_path / "k.csv").read_bytes() == (tmp_path / "alone.csv").read_bytes()
    assert (tmp_path / "k.json").read_bytes().endswith(b"}\n")


def test_a_named_pipe_whose_reader_leaves(small: Path, tmp_path: Path) -> None:
    """`analyze -o >(head -c 10) -o k.csv`."""
    fifo, table = tmp_path / "fifo.ply", tmp_path / "k.csv"
    os.mkfifo(fifo)
    process = start("analyze", small, "-q", "-o", fifo, "-o", table, stderr=subprocess.PIPE)
    with open(fifo, "rb", buffering=0) as stream:
        assert stream.read(3) == b"ply"
    _, words = process.communicate(timeout=120)
    assert (process.returncode, words) == (0, b"")
    assert table.read_bytes().count(b"\n") > 4000


@pytest.mark.parametrize("code", [1, 3])
@pytest.mark.parametrize("kind", ["full pipe", "closed pipe", "/dev/full", "closed"])
def test_a_stderr_that_takes_nothing_breaks_nothing(kind: str, code: int) -> None:
    arguments = ["check", DISK, NONE, "--require", "closed"] if code == 3 else ["check", DISK, "--require", "closed"]
    read, write = os.pipe()
    os.set_blocking(write, False)
    if kind == "full pipe":
        with contextlib.suppress(BlockingIOError):
            while True:
                os.write(write, bytes(4096))
        with contextlib.suppress(BlockingIOError):
            while True:
                os.write(write, b"0")
    elif kind == "closed pipe":
        os.close(read)
    elif kind == "/dev/full":
        os.close(write)
        write = os.open("/dev/full", os.O_WRONLY)
    words = command(*arguments)
    if kind == "closed":
        words = ["sh", "-c", '"$@" 2>&-', "sh", *words]
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=write, env=environment(), timeout=120)
    assert done.returncode == code
    assert b"FAIL" in done.stdout


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
@pytest.mark.parametrize("blocking", [True, False])
def test_a_reader_that_never_reads_can_be_left(number: signal.Signals, blocking: bool, small: Path) -> None:
    """The pipe is full and stays so: an interrupt ends the writer all the same."""
    read, write = os.pipe()
    os.set_blocking(write, blocking)
    fcntl.fcntl(write, fcntl.F_SETPIPE_SZ, 4096)
    process = start("analyze", small, "--json", stdout=write, stderr=subprocess.PIPE)
    until(lambda: unread(read) == 4096, process)
    time.sleep(0.2)  # until it waits
    process.send_signal(number)
    process.wait(timeout=60)
    assert process.stderr is not None
    assert (process.returncode, process.stderr.read()) == (128 + number, b"curvcli: interrupted\n")
    process.stderr.close()
    os.close(read)
    os.close(write)


def test_a_batch_keeps_its_verdict(tmp_path: Path) -> None:
    pipe = closed_pipe()
    (tmp_path / "bad.obj").write_text("v 0 0 0\n")
    line = served("batch", CUBE, str(tmp_path / "bad.obj"), "-o", str(tmp_path / "out"), "-j", "1")
    done = subprocess.run(line, stdout=pipe, stderr=subprocess.PIPE, env=environment(), timeout=120)
    os.close(pipe)
    assert done.returncode == 3
    assert done.stderr.count(b"\n") == 1
    assert (tmp_path / "out" / "summary.csv").exists()

"""--timeout and --max-memory of single commands: one line, exit code 3, nothing half-written, nobody left behind."""

from __future__ import annotations

import gzip
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.helpers.cli.program import CUBE, DISK, curvcli, environment, served, start
from tests.process.watch import feed, until

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux bounds time and memory alike")

LINES = (
    ("analyze", "-", "--input-format", "obj"),
    ("check", "-", "--input-format", "obj"),
    ("compare", CUBE, "-", "--input-format", "obj"),
    ("curves", "-", "--input-format", "obj"),
)


@pytest.mark.parametrize("arguments", LINES, ids=" ".join)
def test_what_takes_too_long(arguments: tuple[str, ...], tmp_path: Path) -> None:
    """A stream that never ends."""
    read, write = os.pipe()
    line = served(*arguments, "--timeout", "0.5", "-o", str(tmp_path / "k.json"))
    begin = time.monotonic()
    done = subprocess.run(line, stdin=read, capture_output=True, env=environment(), timeout=60)
    os.close(read)
    os.close(write)
    assert time.monotonic() - begin < 30
    assert (done.returncode, done.stdout) == (3, b"")
    assert done.stderr == b"curvcli: takes longer than the 0.5 s allowed; --timeout sets the limit\n"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("code", "arguments"),
    [
        (0, ("analyze", CUBE)),
        (0, ("analyze", CUBE, "-o", "-", "--format", "csv")),
        (1, ("check", DISK, "--require", "closed")),
        (1, ("compare", CUBE, DISK)),
        (0, ("curves", DISK)),
        (3, ("analyze", "none.ply")),
        (2, ("analyze", CUBE, "-p", "none")),
        (3, ("check", "none.ply", CUBE, "--format", "sarif")),
    ],
)
def test_what_keeps_its_bounds_is_as_without(code: int, arguments: tuple[str, ...]) -> None:
    bounded = curvcli(*arguments, "--timeout", "100", "--max-memory", "2000")
    assert bounded == curvcli(*arguments)
    assert bounded.code == code


@pytest.mark.slow
@pytest.mark.parametrize("command_line", [("analyze",), ("check",), ("curves",), ("compare", CUBE)], ids=" ".join)
def test_what_needs_too_much_memory(command_line: tuple[str, ...], tmp_path: Path) -> None:
    path = tmp_path / "large.obj.gz"
    with gzip.open(path, "wb", compresslevel=1) as stream:
        for _ in range(90):
            stream.write(b"#" + b" " * 9_999_998 + b"\n")
        stream.write(Path(DISK).read_bytes())
    words = ("--max-memory", "512", "--max-bytes", "2000000000")
    ended = curvcli(*command_line, path, *words)
    assert ended == (3, "", "curvcli: needs more memory than --max-memory allows; raise the limit\n")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_an_interrupt_ends_both(number: signal.Signals, tmp_path: Path) -> None:
    process = start(
        *LINES[0], "--timeout", "100", "-o", tmp_path / "k.csv", stdin=subprocess.PIPE, stdout=-1, stderr=-1
    )
    feed(process, b"# more will come\n")
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    until(lambda: bool(children.read_text()), process)
    (child,) = children.read_text().split()
    process.send_signal(number)
    process.wait(timeout=60)
    out, err = process.communicate()
    assert (process.returncode, out, err) == (128 + number, b"", b"curvcli: interrupted\n")
    assert not Path(f"/proc/{child}").exists()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("command_name", ["analyze", "check", "compare", "curves"])
@pytest.mark.parametrize(("option", "value"), [("--timeout", "0"), ("--timeout", "nan"), ("--max-memory", "511")])
def test_bounds_that_are_none(command_name: str, option: str, value: str) -> None:
    assert curvcli(command_name, CUBE, *[CUBE] * (command_name == "compare"), option, value).code == 2

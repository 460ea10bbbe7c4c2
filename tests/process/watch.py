"""Waiting for a state of another process, never for a time."""

from __future__ import annotations

import fcntl
import struct
import subprocess
import termios
import time
from collections.abc import Callable
from pathlib import Path


def until(state: Callable[[], bool], process: subprocess.Popen[bytes]) -> None:
    """Look again and again until it is so or the process has ended."""
    end = time.monotonic() + 120
    while not state() and process.poll() is None:
        assert time.monotonic() < end, "the state was never reached"
        time.sleep(0.0005)


def feed(process: subprocess.Popen[bytes], data: bytes) -> None:
    """Write to its stdin, and wait until it has taken everything and waits for more."""
    assert process.stdin is not None
    process.stdin.write(data)
    process.stdin.flush()
    pipe = process.stdin.fileno()
    until(lambda: unread(pipe) == 0 and _sleeps(process), process)
    assert process.poll() is None


def unread(pipe: int) -> int:
    """Bytes in a pipe."""
    (count,) = struct.unpack("i", fcntl.ioctl(pipe, termios.FIONREAD, b"\0" * 4))
    return int(count)


def _sleeps(process: subprocess.Popen[bytes]) -> bool:
    """Test for a waiting process; True where the system does not report it."""
    place = Path(f"/proc/{process.pid}/stat")
    return not place.exists() or place.read_text().rpartition(")")[2].split()[0] == "S"

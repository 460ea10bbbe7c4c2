"""The program as a user starts it: another process, its two streams apart."""

from __future__ import annotations

import atexit
import os
import subprocess
import sys
from functools import cache
from pathlib import Path
from subprocess import PIPE
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from tests.helpers.exact_values import MESHES

ROOT = Path(__file__).resolve().parents[3]
SERVER = Path(__file__).with_name("server.py")
STRICT = {"PYTHONWARNINGS": "error::RuntimeWarning"}
CUBE, DISK, MOBIUS, UNREFERENCED = (str(MESHES[name]) for name in ("cube", "disk", "mobius", "unreferenced"))


class Ended(NamedTuple):
    code: int
    out: str
    err: str

    @property
    def complaint(self) -> str:
        """The one line on stderr with which the program refused, nothing being on stdout."""
        assert self.out == ""
        assert self.err.startswith("curvcli: "), self.err
        assert self.err.count("\n") == 1, self.err
        assert "Traceback" not in self.err
        return self.err.removeprefix("curvcli: ").rstrip("\n")


def environment(**more: str) -> dict[str, str]:
    """Ours, without what would colour or widen the output, and with the package on the path."""
    kept = {key: value for key, value in os.environ.items() if key not in ("NO_COLOR", "FORCE_COLOR", "COLUMNS")}
    return kept | {"PYTHONPATH": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1", "PYTHONIOENCODING": "utf-8"} | more


def command(*arguments: str | Path) -> list[str]:
    return [sys.executable, "-m", "curvcli", *map(str, arguments)]


def served(*arguments: str | Path) -> list[str]:
    """The same command as a process that begins with all modules imported, in a twentieth of the time."""
    if sys.platform != "linux":  # elsewhere libraries may not survive a fork
        return command(*arguments)
    return [sys.executable, "-S", "-I", str(SERVER), address(), "--ask", *map(str, arguments)]


@cache
def address() -> str:
    """Address of a server that ends with these tests."""
    place = TemporaryDirectory(prefix="curvcli-")  # the name of a socket has to be short
    socket = Path(place.name, "socket")
    server = subprocess.Popen([sys.executable, SERVER, socket], stdin=PIPE, stdout=PIPE, env=environment(**STRICT))
    assert server.stdout is not None
    assert server.stdout.readline() == b"ready\n"
    atexit.register(place.cleanup)
    atexit.register(server.communicate)
    return str(socket)


def start(*arguments: str | Path, **settings: Any) -> subprocess.Popen[bytes]:
    return subprocess.Popen(command(*arguments), env=environment(), **settings)


def curvcli(*arguments: str | Path, given: bytes | None = None, folder: Path | None = None, **more: str) -> Ended:
    """Run to the end; `command` and `start` are for what depends on how the process begins or is told to end."""
    done = subprocess.run(
        served(*arguments), input=given, capture_output=True, env=environment(**more), cwd=folder, timeout=120
    )
    return Ended(done.returncode, done.stdout.decode(), done.stderr.decode())


def wrote(ended: Ended) -> None:
    """It ended well and had nothing to say."""
    assert (ended.code, ended.err) == (0, ""), ended

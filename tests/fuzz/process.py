"""curvcli as a process of its own, within bounds of memory and time."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import curvcli
from tests.fuzz.contract import Ran

SECONDS = 60

# A process inherits the peak of memory of the one it was forked from, so a small one stands between it and the tests.
_BETWEEN = """
import os, resource, subprocess, sys
code = subprocess.call(sys.argv[2:])
used = resource.getrusage(resource.RUSAGE_CHILDREN)
with open(sys.argv[1], "w") as file:
    file.write(f"{used.ru_maxrss} {used.ru_utime + used.ru_stime}")
sys.exit(code)
"""


def real(words: list[str], memory: float | None = None) -> Ran:
    """Run curvcli; it has a minute, and the given bytes of memory (200 MB beside 20 times the file)."""
    environment = os.environ | {
        "PYTHONPATH": str(Path(curvcli.__file__).parents[1]),
        "PYTHONWARNINGS": "error::RuntimeWarning",
    }
    with tempfile.NamedTemporaryFile() as used:
        between = [sys.executable, "-S", "-c", _BETWEEN, used.name]
        process = subprocess.Popen(
            [*between, sys.executable, "-m", "curvcli", *words],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment,
            start_new_session=True,
        )
        try:
            out, err = process.communicate(timeout=4 * SECONDS)
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.communicate()
        kilobytes, seconds = Path(used.name).read_text().split()
    assert float(seconds) < SECONDS
    allowed = 200 * 10**6 + 20 * Path(words[1]).stat().st_size if memory is None else memory
    assert int(kilobytes) * 1024 < allowed, (kilobytes, allowed)
    return Ran(process.returncode, out, err.decode())

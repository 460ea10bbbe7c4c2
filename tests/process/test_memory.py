"""Too little memory ends a run in one line, never in an abort, a hang, or half an output."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.helpers.cli.program import command, environment

SCARCE = b"curvcli: out of memory; use a machine with more memory or a smaller mesh\n"


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="only Linux bounds the address space of a process")
@pytest.mark.parametrize("suffix", ["obj", "ply", "stl"])
@pytest.mark.parametrize("megabytes", [int(size) for size in np.geomspace(200, 3000, 7)])
def test_a_limit_on_memory_ends_in_one_line(
    suffix: str, megabytes: int, middling: dict[str, Path], tmp_path: Path
) -> None:
    # No two formats meet the same limit, so that more limits are met.
    kilobytes = int(megabytes * {"obj": 1000, "ply": 1080, "stl": 1160}[suffix])
    run = command("analyze", middling[suffix], "-q", "-o", tmp_path / "k.csv", "-o", tmp_path / "k.ply")
    line = ["sh", "-c", 'ulimit -v "$0" && exec "$@"', str(kilobytes), *run]
    done = subprocess.run(line, capture_output=True, env=environment(), timeout=60)
    assert done.stdout == b""
    assert (done.returncode, done.stderr) in ((0, b""), (70, SCARCE))
    assert sorted(os.listdir(tmp_path)) == (["k.csv", "k.ply"] if done.returncode == 0 else [])


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux bounds the address space of a process")
def test_help_needs_no_memory() -> None:
    done = subprocess.run(["sh", "-c", 'ulimit -v 100000 && exec "$@"', "sh", *command("--help")], capture_output=True)
    assert done.returncode == 0
    assert b"analyze" in done.stdout

"""Every registered pass is among those that are timed, and can be called with what it is given there."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from curvcli.declare import passes
from curvcli.pipeline import load_passes
from tests.cli.program import ROOT


@pytest.mark.parametrize("shape", ["sphere", "plate"])
def test_every_pass_is_timed(tmp_path: Path, shape: str) -> None:
    timed = ["benchmarks/test_passes.py", "--size", "400", "--shape", shape]
    saved = tmp_path / "times.json"
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *timed, f"--benchmark-json={saved}"],
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout
    load_passes()
    names = [one["name"] for one in json.loads(saved.read_text())["benchmarks"]]
    assert sorted(names) == sorted(["test_topology", *(f"test_pass[{name}]" for name in passes)])

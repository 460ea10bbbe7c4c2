"""Every registered pass is among those that are timed, and can be called with what it is given there."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from curvcli.curvatures.catalogue import load_passes
from curvcli.curvatures.registry import passes
from tests.helpers.cli.program import ROOT


@pytest.mark.parametrize("shape", ["sphere", "plate"])
def test_every_pass_is_timed(tmp_path: Path, shape: str) -> None:
    timed = ["benchmarks/test_passes.py", "--benchmark-disable", "--size", "400", "--shape", shape]
    ran = tmp_path / "ran.xml"
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *timed, f"--junit-xml={ran}"],
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout
    load_passes()
    names = [case.attrib["name"] for case in ElementTree.parse(ran).iter("testcase")]
    assert sorted(names) == sorted(["test_topology", *(f"test_pass[{name}]" for name in passes)])

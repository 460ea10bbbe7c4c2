"""Modules that the commands never look into are not run, and are whole for whoever does."""

from __future__ import annotations

import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from curvcli.commands.deferred import NEVER_USED
from tests.helpers.cli.program import ROOT, environment

USED = """
import sys
from curvcli.commands.deferred import Deferred, defer_imports
defer_imports()
defer_imports()
assert sys.meta_path.count(Deferred) == 1
import numpy, scipy, scipy.sparse
assert "numpy.f2py.crackfortran" not in sys.modules
assert numpy.f2py.__name__ == "numpy.f2py" and callable(numpy.f2py.get_include)
numpy.testing.assert_array_equal(scipy.ndimage.shift([0.0, 1.0], 1, order=0), [0.0, 0.0])
from numpy.f2py import crackfortran
"""
AS_A_LIBRARY = """
import sys
import curvcli
curvcli.analyze("sample_meshes/torus.obj")
assert not [finder for finder in sys.meta_path if "curvcli" in repr(finder)]
"""


@pytest.mark.parametrize("code", [USED, AS_A_LIBRARY], ids=["used", "as a library"])
def test_in_a_process_of_its_own(code: str) -> None:
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, env=environment(), capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_run_does_without_them(tmp_path: Path) -> None:
    words = [sys.executable, "-X", "importtime", "-m", "curvcli", "analyze", str(ROOT / "sample_meshes" / "torus.obj")]
    words += ["-o", str(tmp_path / "k.csv"), "-o", str(tmp_path / "k.ply")]
    done = subprocess.run(words, env=environment(), capture_output=True, text=True)
    assert done.returncode == 0
    assert "trimesh.base" in done.stderr
    taken = {"scipy.optimize"} if find_spec("shapely") else set()  # by the polygons of trimesh, which need both
    run = re.findall(rf"\| +(?:{'|'.join(map(re.escape, {*NEVER_USED} - taken))})\.\w+", done.stderr)
    assert run == []

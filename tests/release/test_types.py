"""The types of the package as another project sees them: an installed copy, `py.typed`, mypy --strict."""

from __future__ import annotations

import shutil
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

import pytest

from tests.helpers.cli.program import environment

# Every wrong line is marked: were the package untyped, its marks would be superfluous, which is an error too.
PROGRAM = """
from pathlib import Path
from typing import Any, assert_type

import numpy as np
from numpy.typing import NDArray

import curvcli
from curvcli import Analysis, Surface

points, faces = np.eye(3), np.array([[0, 1, 2]])
surface = Surface(points, faces)
assert_type(curvcli.load(Path("bunny.ply")), Surface)
assert_type(curvcli.__version__, str)

analysis = curvcli.analyze(surface, "paper", mean="average", area="voronoi")
assert_type(analysis, Analysis)
assert_type(analysis.vertices["K"], NDArray[Any])
assert_type(analysis.passed, bool)
assert_type(analysis.report(), dict[str, Any])
assert_type(surface.points, NDArray[np.float64])
statuses: list[str] = [check.status for check in analysis.checks]
codes: list[str] = [notice.code for notice in analysis.notices]
willmore: float | list[float] | None = analysis.totals["willmore"]
curvature = curvcli.passes["K"](surface)
try:
    analysis.write("bunny.csv", force=True)
except curvcli.errors.OutputError as error:
    print(error)

curvcli.analyze(surface, area="voronoy")  # type: ignore[arg-type]
curvcli.analyze(surface, "core", mena="sum")  # type: ignore[call-arg]
analysis.vertexes  # type: ignore[attr-defined]
analysis.passed + "yes"  # type: ignore[operator]
"""


@pytest.mark.slow
def test_a_program_of_somebody_else_is_checked(installed: Path, tmp_path: Path) -> None:
    """In an environment of its own that has the wheel, and the dependencies of this one behind it."""
    home = tmp_path / "venv"
    venv.create(home, with_pip=False, symlinks=True)
    python = home / "bin" / "python"
    if not python.exists():
        python = home / "Scripts" / "python.exe"
    told = subprocess.run(
        [str(python), "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"], capture_output=True, text=True
    )
    packages = Path(told.stdout.strip())
    shutil.copytree(installed / "curvcli", packages / "curvcli")
    (packages / "dependencies.pth").write_text(sysconfig.get_path("purelib") + "\n")
    (tmp_path / "program.py").write_text(PROGRAM)
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--python-executable", str(python), "program.py"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=240,
        env={key: value for key, value in environment().items() if key not in ("PYTHONPATH", "MYPYPATH")},
    )
    assert done.returncode == 0, done.stdout + done.stderr

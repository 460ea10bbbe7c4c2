"""A quantity from another package appears everywhere with no edit of ours."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from tests.helpers.exact_values import MESHES

PLUG_IN = '''
import numpy as np
from curvcli.declare import curvature_pass

@curvature_pass(
    symbol="K²/A", formula="K_p² / A_p", length_exponent=-2, total="K_squared",
    preserves="nothing: an example", boundary="null", source="plug-in of the tests",
)
def K_squared(K, A):
    """Square of the Gauss curvature per area."""
    return K * K / A
'''

METADATA = "Metadata-Version: 2.1\nName: curvcli-example\nVersion: 1.0\n"


def install(folder: Path, module: str) -> dict[str, str]:
    """Lay out a package with an entry point as an installer would, and the environment that finds it."""
    (folder / "curvcli_example.py").write_text(module)
    about = folder / "curvcli_example-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(METADATA)
    (about / "entry_points.txt").write_text("[curvcli.passes]\nexample = curvcli_example\n")
    return os.environ | {"PYTHONPATH": os.pathsep.join([str(folder), str(Path(__file__).parents[2])])}


def run(environment: dict[str, str], *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "curvcli", *arguments]
    return subprocess.run(command, capture_output=True, text=True, env=environment, timeout=120, check=False)


def test_a_plug_in_adds_a_quantity(tmp_path: Path) -> None:
    environment = install(tmp_path, PLUG_IN)
    mesh, output = str(MESHES["cube"]), tmp_path / "k.csv"
    assert "K_p² / A_p" in run(environment, "passes", "K_squared").stdout
    what = ("--get", "totals.K_squared")
    total = run(environment, "analyze", mesh, "-p", "K_squared", "-o", str(output), *what).stdout
    table = output.read_text().splitlines()
    assert table[0].split(",")[-1] == "K_squared"
    squares = [float(row.split(",")[-1]) for row in table[1:]]
    assert abs(float(total) - sum(squares)) < 1e-12
    assert min(squares) > 0


def test_a_broken_plug_in_is_named_in_one_line(tmp_path: Path) -> None:
    environment = install(tmp_path, PLUG_IN.replace("(K, A)", "(K, Aera)"))
    ended = run(environment, "passes")
    assert ended.returncode == 2
    assert len(ended.stderr.splitlines()) == 1
    assert "plug-in example (curvcli_example)" in ended.stderr
    assert "Aera" in ended.stderr


def test_without_plug_ins_their_names_are_unknown(tmp_path: Path) -> None:
    ended = run(dict(os.environ), "passes", "K_squared")
    assert ended.returncode == 2
    assert "unknown quantity 'K_squared'" in ended.stderr

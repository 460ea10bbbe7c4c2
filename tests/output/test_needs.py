"""Outputs take every quantity from the one evaluation of the analysis, and none of them computes another."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from curvcli.analysis import result
from curvcli.commands.main import cli
from curvcli.curvatures.catalogue import UNCERTAINTIES
from tests.helpers.meshes import of_sample

OUTPUTS = (
    ["-o", "x.csv", "--table", "edges=e.csv", "--table", "faces=f.csv", "--table", "components=c.csv"],
    ["-o", "x.ply", "-o", "x.json", "-o", "x.md"],
    ["-o", "x.html", "--color-by", "theta"],
    ["-o", "x.html"],
)
PASSES = ("core", "K_density", "h_signed", "kappa_1", "K_fit,willmore_fit", "topology", "all")


@pytest.mark.parametrize("passes", PASSES)
@pytest.mark.parametrize("outputs", OUTPUTS, ids=" ".join)
def test_outputs_need_one_evaluation(
    outputs: list[str], passes: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Only the bounds on the rounding of colours are evaluated apart, with a noise of their own."""
    calls: list[set[str]] = []
    evaluate = result.evaluate

    def counted(passes: Any, surface: Any, names: Any, **options: Any) -> Any:
        calls.append({*names})
        return evaluate(passes, surface, names, **options)

    monkeypatch.setattr(result, "evaluate", counted)
    monkeypatch.chdir(tmp_path)
    mesh = of_sample("torus", size=200)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in mesh.points.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (mesh.faces + 1).tolist()]
    Path("mesh.obj").write_text("\n".join(lines) + "\n")
    ended = CliRunner().invoke(cli, ["analyze", "mesh.obj", "-p", passes, *outputs], standalone_mode=False)
    assert ended.exception is None
    assert len([names for names in calls if names != {*UNCERTAINTIES}]) == 1

"""`--get`: one value by its path, and what is said of a path that leads nowhere."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import curvcli
from curvcli.errors import UsageError
from curvcli.report.lookup import look_up
from tests.helpers.cli.program import CUBE, DISK, Ended, wrote

Run = Callable[..., Ended]


def refused(passes: str, path: str) -> str:
    with pytest.raises(UsageError) as error:
        look_up(curvcli.analyze(CUBE, passes).report(), path)
    return str(error.value)


def test_a_position_comes_before_a_name() -> None:
    """Labels may be numbers: regions.1 is the second, whatever they are called."""
    surface = curvcli.load(CUBE)
    report = curvcli.analyze(surface, regions=np.arange(surface.n_faces) % 3 + 1).report()
    assert [look_up(report, f"regions.{key}.name") for key in ("0", "1", "2", "3")] == ["1", "2", "3", "3"]
    assert look_up(report, "checks.gauss_bonnet.status") == look_up(report, "checks.0.status") == "pass"


@pytest.mark.parametrize(
    ("passes", "path", "way_out"),
    [
        ("core", "totals.H_theta", "-p paper or -p H_theta"),
        ("core", "components.0.totals.K_abs", "-p paper or -p K_abs"),
        ("core", "steiner.coefficients", "-p paper"),
        ("core", "components.0.steiner", "-p paper"),
        ("topology", "cmc.H", "-p paper"),
        ("topology", "columns.A_vec_x.max", "-p core or -p A_vec"),
        ("core", "columns.K_fit.max", "-p estimates or -p K_fit"),
        ("core", "totals.dirichlet", "-p paper or -p dirichlet"),
    ],
)
def test_what_was_not_computed(passes: str, path: str, way_out: str) -> None:
    assert refused(passes, path) == f"--get {path}: is not computed; {way_out} adds it"
    *_, name = way_out.split()
    # The last key need not be the one that lacks.
    look_up(curvcli.analyze(CUBE, name).report(), path)


def test_paths_that_lead_nowhere() -> None:
    assert "loops is empty" in refused("core", "loops.0.length")
    assert "totals.K is a single value" in refused("core", "totals.K.max")
    assert refused("core", "totals.k").endswith("no 'k' in totals; nearest: K")
    assert "nearest: totals" in refused("core", "total.K")


def test_a_map_has_no_passes(within: Run) -> None:
    ended = within("compare", CUBE, CUBE, "--map", "--get", "totals.H_theta")
    assert (ended.code, "not computed" in ended.complaint) == (2, False)


def test_a_line_for_each_key(within: Run) -> None:
    keys = ("topology.genus", "totals.K", "topology.genus")
    asked = [word for key in keys for word in ("--get", key)]
    alone = [within("analyze", CUBE, "--get", key).out for key in keys]
    together = within("analyze", CUBE, *asked)
    wrote(together)
    assert together.out == "".join(alone)
    lacking = within("analyze", CUBE, *asked, "--get", "totals.k")
    assert (lacking.code, lacking.out) == (2, "")
    of_curves = within("curves", DISK, "--get", "curves.0.closed", "--get", "curves.0.writhe")
    assert of_curves.out.splitlines() == ["true", within("curves", DISK, "--get", "curves.0.writhe").out.strip()]
    same = within("compare", CUBE, CUBE, "--get", "equal", "--get", "rtol")
    assert same.out == "".join(within("compare", CUBE, CUBE, "--get", key).out for key in ("equal", "rtol"))


def test_a_key_that_one_mesh_lacks(within: Run) -> None:
    """Of several meshes the others go on; of a single one it is wrong usage."""
    ended = within("analyze", CUBE, DISK, "--get", "loops.0.vertices", "-o", "{stem}.json")
    assert (ended.code, ended.err) == (3, f"curvcli: {CUBE}: --get loops.0.vertices: loops is empty\n")
    loops = [json.loads(Path(f"{Path(mesh).stem}.json").read_text())["loops"] for mesh in (CUBE, DISK)]
    assert loops[0] == []
    assert json.loads(ended.out) == loops[1][0]["vertices"]
    single = within("analyze", CUBE, "--get", "loops.0.vertices")
    assert (single.code, single.out) == (2, "")
    wrote(within("analyze", CUBE, DISK, "--get", "totals.K"))

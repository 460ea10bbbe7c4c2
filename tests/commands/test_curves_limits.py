"""`curvcli curves` at its limits: what it refuses, leaves out, warns of, and finds to be wrong."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from curvcli.curves.collect import curves_of_surface
from curvcli.curves.measure import CurveMeasures
from curvcli.loading.load import load
from curvcli.report.curves import LISTED_CURVES, model
from tests.curves.conftest import Cli, polyline
from tests.curves.shapes import trefoil
from tests.helpers import meshes
from tests.helpers.exact_values import MESHES

CLOSED = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (CLOSED, "no curve found: the surface has no boundary"),
        ("v 0 0 0\nv 1 nan 0\nl 1 2\n", "vertex 1: coordinates (1, nan, 0) are not finite"),
        ("v 0 0 0\nl 1 2\n", "vertex index `2`"),
        ("v 0 0 0\nv 1 0 0\n", "no faces"),
        ("", "no data"),
    ],
)
def test_what_has_no_curve_is_refused_in_one_line(cli: Cli, tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "bad.obj"
    path.write_text(text)
    out = tmp_path / "out.csv"
    done = cli.run(path, "-o", out)
    assert done.code == 3
    assert done.out == ""
    assert words in done.err
    assert done.err.startswith(f"curvcli: {path}: ")
    assert done.err.count("\n") == 1
    assert not out.exists()


@pytest.mark.parametrize(
    ("options", "code"),
    [
        (["-o", "out.ply"], 2),
        (["--table", "loops=out.csv"], 2),
        (["--table", "curves"], 2),
        (["--json", "--get", "curves"], 2),
        (["-o", "-", "--format", "csv", "--json"], 2),
        (["--max-writhe", "-1"], 2),
        (["--weld", "much"], 2),
        (["-o", "/nowhere/at/all/out.csv"], 4),
    ],
)
def test_options_are_checked_before_any_work(cli: Cli, tmp_path: Path, options: list[str], code: int) -> None:
    done = cli.run(tmp_path / "not_read.obj", *options)
    assert done.code == code
    assert done.err.count("\n") == 1
    assert "not_read" not in done.err


def test_a_key_that_is_not_there_leaves_no_output(cli: Cli, knot: Path, tmp_path: Path) -> None:
    assert cli.run(knot, "-o", tmp_path / "out.csv", "--get", "curves.0.colour").code == 2
    assert sorted(tmp_path.iterdir()) == [knot]


def test_existing_outputs_stay_without_force(cli: Cli, knot: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.csv"
    out.write_text("mine")
    assert cli.run(knot, "-o", out).code == 4
    assert out.read_text() == "mine"
    assert cli.run(knot, "-o", out, "--force").code == 0
    assert out.read_text().startswith("curve,")


def test_what_is_odd_is_said(cli: Cli, tmp_path: Path) -> None:
    path = tmp_path / "odd.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 0 0\nv 0 2 0\nl 1 2 3 4\nl 1 2 1\n")
    report = cli.told(path)
    assert {warning["code"]: warning["count"] for warning in report["warnings"]} == {
        "repeated_points": 1,
        "reversals": 2,
    }
    assert [row["repeated_points"] for row in report["curves"]] == [1, 0]
    digon = report["curves"][1]
    assert digon["total_curvature"] == pytest.approx(2 * np.pi)
    assert digon["holonomy"] is digon["turning_number"] is digon["total_tan2"] is None


@pytest.mark.parametrize("scale", ["1e200", "1.6e308", "1e-310", "5e-324"])
def test_any_scale_of_doubles(cli: Cli, tmp_path: Path, scale: str) -> None:
    text = "v 0 0 0\nv S 0 0\nv S S 0\nv -S S S\nf 1 2 3\nf 1 3 4\nl 1 2 3 4\nl 1 2 3 1\n"
    one, other = tmp_path / "one.obj", tmp_path / "other.obj"
    one.write_text(text.replace("S", "1"))
    other.write_text(text.replace("S", scale))
    plain, scaled = cli.told(one)["curves"], cli.told(other)["curves"]
    for row, expected in zip(scaled, plain, strict=True):
        for key in ("total_curvature", "total_torsion", "holonomy", "writhe", "turning_number", "plane"):
            assert row[key] == pytest.approx(expected[key], abs=1e-14), key
        length = expected["length"] * float(scale)
        assert row["length"] == (pytest.approx(length, rel=1e-12, abs=1e-323) if np.isfinite(length) else None)
    table = cli.run(other, "-o", "-", "--format", "csv")
    assert table.code == 0
    assert table.err == ""
    assert "inf" not in table.out


def test_large_double_sums_are_refused_and_said(cli: Cli, knot: Path) -> None:
    report = cli.told(knot, "--max-writhe", "79")
    assert report["curves"][0]["writhe"] is None
    assert report["curves"][1]["writhe"] is not None
    (warning,) = report["warnings"]
    assert warning["code"] == "writhe_refused"
    assert warning["count"] == 1
    assert "--max-writhe" in warning["hint"]
    reasons = {check["detail"] for check in report["checks"] if check["status"] == "not_applicable"}
    assert "the writhe was not computed" in reasons


def test_very_many_curves_are_checked_in_one_line_each(cli: Cli, tmp_path: Path) -> None:
    count = LISTED_CURVES + 20
    report = cli.told(polyline(tmp_path / "many.obj", *((trefoil(12) + k, True) for k in range(count))))
    assert len(report["curves"]) == count
    checks = {check["name"]: check for check in report["checks"]}
    assert len(checks) == len(report["checks"]) == 4
    assert checks["holonomy"]["status"] == "pass"
    assert f"{count} of {count} curves pass" in checks["holonomy"]["detail"]
    assert checks["turning_number"]["status"] == "not_applicable"


def test_a_disturbed_angle_fails_a_check() -> None:
    measures = CurveMeasures(curves_of_surface(load(MESHES["disk"])))
    angle = measures.turning.angle.copy()
    angle[5] *= 1 + 1e-9
    measures.turning.__dict__["angle"] = angle
    failed = {check.name for check in model(measures).checks if check.status == "fail"}
    assert failed == {"tangent_change"}


def test_a_disturbed_writhe_fails_a_check() -> None:
    measures = CurveMeasures(curves_of_surface(meshes.mobius().surface()))
    turns, error = measures.writhe
    measures.__dict__["writhe"] = turns + 1e-9, error
    failed = {check.name for check in model(measures).checks if check.status == "fail"}
    assert failed == {"holonomy"}

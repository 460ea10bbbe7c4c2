"""`curvcli curves` as a user types it: what it prints, writes and refuses."""

from __future__ import annotations

import io
import json
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import polars as pl
import pytest

from curvcli.commands.main import main
from curvcli.curves import Curve
from curvcli.curves.collect import curves_of_surface
from curvcli.curves.measure import CurveMeasures
from curvcli.loading.surfaces import load
from curvcli.report.curves import LISTED_CURVES, model
from tests import meshes
from tests.curves.shapes import Points, helix, trefoil
from tests.exact_values import MESHES

CLOSED = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


class Done(NamedTuple):
    returncode: int
    stdout: str
    stderr: str


class Cli:
    """The command in this process, as `python -m curvcli` runs it."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> None:
        self.monkeypatch, self.capfd = monkeypatch, capfd

    def run(self, *arguments: object) -> Done:
        self.monkeypatch.setattr(sys, "argv", ["curvcli", "curves", *map(str, arguments)])
        with pytest.raises(SystemExit) as stop:
            main()
        assert isinstance(stop.value.code, int)
        return Done(stop.value.code, *self.capfd.readouterr())

    def told(self, *arguments: object) -> dict[str, Any]:
        done = self.run(*arguments, "--json")
        assert done.returncode == 0, done.stderr
        found: dict[str, Any] = json.loads(done.stdout)
        return found


@pytest.fixture
def cli(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Cli:
    return Cli(monkeypatch, capfd)


def polyline(path: Path, *curves: tuple[Points, bool]) -> Path:
    """An OBJ file of polylines."""
    lines, records, count = [], [], 0
    for points, closed in curves:
        lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
        index = [*range(count + 1, count + len(points) + 1)]
        records.append("l " + " ".join(map(str, index + index[:1] if closed else index)))
        count += len(points)
    path.write_text("\n".join([*lines, *records, ""]))
    return path


@pytest.fixture
def knot(tmp_path: Path) -> Path:
    return polyline(tmp_path / "knot.obj", (trefoil(80), True), (helix(20), False))


def test_polylines_without_faces(cli: Cli, knot: Path) -> None:
    report = cli.told(knot)
    closed, open_ = report["curves"]
    expected = Curve(trefoil(80), closed=True)
    assert closed["kind"] == "polyline"
    assert closed["closed"] is True
    assert closed["vertices"] == 80
    assert closed["length"] == expected.length
    assert closed["total_curvature"] == expected.total_curvature > 4 * np.pi
    assert closed["unknotted"] is None
    assert closed["writhe"] == expected.writhe()
    assert closed["holonomy"] == expected.holonomy
    assert closed["sum_kappa_g"] is closed["linking"] is closed["component"] is None
    assert closed["force"] == [None, None, None]
    assert open_["closed"] is False
    assert open_["holonomy"] is None
    assert open_["total_torsion"] == pytest.approx(17 * Curve(helix(20)).torsion[1])
    change = Curve(helix(20)).tangents[[0, 18]]
    np.testing.assert_allclose(open_["tangent_change"], change[1] - change[0], atol=1e-15)
    status = {(check["name"], check["scope"]): check["status"] for check in report["checks"]}
    assert status[("holonomy", "curve 0")] == status[("fenchel", "curve 0")] == "pass"
    assert status[("holonomy", "curve 1")] == status[("fenchel", "curve 1")] == "not_applicable"
    assert report["input"]["polygons"] == 0
    assert report["warnings"] == []


def test_boundary_loops_come_before_polylines(cli: Cli, tmp_path: Path) -> None:
    path = tmp_path / "both.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nl 1 3\n")
    square, diagonal = cli.told(path)["curves"]
    assert (square["kind"], diagonal["kind"]) == ("boundary", "polyline")
    assert square["turning_number"] == 1
    assert square["sum_kappa_g"] == pytest.approx(2 * np.pi)
    assert square["unknotted"] is True
    assert square["vector_area"] == [0, 0, 1]
    assert square["linking"] == 0
    assert diagonal["length"] == pytest.approx(np.sqrt(2))


def test_a_row_per_vertex(cli: Cli, knot: Path, tmp_path: Path) -> None:
    out = tmp_path / "points.csv"
    done = cli.run(knot, "-o", out, "-o", tmp_path / "points.npz", "-o", tmp_path / "report.json")
    assert done.returncode == 0, done.stderr
    table = pl.read_csv(out)
    assert table.columns[:8] == ["curve", "position", "vertex", "x", "y", "z", "arc", "length"]
    assert len(table) == 100
    curve = Curve(trefoil(80), closed=True)
    first = table.filter(pl.col("curve") == 0)
    for column, values in (("turning", curve.turning), ("sin2", curve.sin2), ("torsion", curve.torsion)):
        np.testing.assert_array_equal(first[column].to_numpy(), values)
    np.testing.assert_allclose(first["arc"][-1] + first["length"][-1], curve.length, rtol=1e-14)
    np.testing.assert_array_equal(first.select("bishop_u_x", "bishop_u_y", "bishop_u_z").to_numpy(), curve.bishop[1])
    last = table.row(99, named=True)
    assert last["turning"] is last["length"] is last["kappa_g"] is None
    assert last["vertex"] == 99
    np.testing.assert_array_equal(np.load(tmp_path / "points.npz")["turning"][:80], curve.turning)
    assert json.loads((tmp_path / "report.json").read_text()) == cli.told(knot)


def test_a_row_per_curve(cli: Cli, tmp_path: Path) -> None:
    out = tmp_path / "loops.tsv"
    assert cli.run(MESHES["annulus"], "--table", f"curves={out}").returncode == 0
    table = pl.read_csv(out, separator="\t")
    report = cli.told(MESHES["annulus"])
    assert table["sum_kappa_g"].to_list() == [row["sum_kappa_g"] for row in report["curves"]]
    assert table["force_z"].to_list() == [row["force"][2] for row in report["curves"]]
    assert table["unknotted"].to_list() == [True, True]
    assert table["turning_number"].null_count() == 2


def test_darboux_columns_of_a_boundary(cli: Cli, tmp_path: Path) -> None:
    done = cli.run(MESHES["mobius"], "-o", "-", "--format", "csv")
    assert done.returncode == 0
    table = pl.read_csv(io.StringIO(done.stdout))
    assert table["kappa_g"].sum() == pytest.approx(cli.told(MESHES["mobius"])["curves"][0]["sum_kappa_g"], abs=1e-12)
    tangent, nu, eta = (
        table.select(f"{name}_{axis}" for axis in "xyz").to_numpy() for name in ("tangent", "nu", "eta")
    )
    np.testing.assert_allclose(np.cross(tangent, nu), eta, atol=1e-15)
    np.testing.assert_allclose((tangent * nu).sum(axis=1), 0, atol=1e-14)


def test_one_value_for_scripts(cli: Cli, knot: Path) -> None:
    done = cli.run(knot, "--get", "curves.0.closed")
    assert done.stdout == "true\n"
    assert float(cli.run(knot, "--get", "curves.0.writhe").stdout) == Curve(trefoil(80), closed=True).writhe()
    assert cli.run(knot, "--get", "curves.0.colour").returncode == 2


def test_the_summary_says_what_total_curvature_proves(cli: Cli, knot: Path) -> None:
    done = cli.run(knot)
    assert done.returncode == 0
    assert done.stderr == ""
    assert "0 boundary curves, 2 polylines" in done.stdout
    assert "more proves nothing" in done.stdout
    assert cli.run(knot, "-q").stdout == ""


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


def test_streams_in_a_process_of_its_own(knot: Path) -> None:
    command = [sys.executable, "-m", "curvcli", "curves", "-", "--input-format", "obj", "--get", "curves.1.vertices"]
    done = subprocess.run(command, capture_output=True, input=knot.read_bytes(), check=False, timeout=300)
    assert (done.returncode, done.stdout, done.stderr) == (0, b"20\n", b"")


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
    assert done.returncode == 3
    assert done.stdout == ""
    assert words in done.stderr
    assert done.stderr.startswith(f"curvcli: {path}: ")
    assert done.stderr.count("\n") == 1
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
    assert done.returncode == code
    assert done.stderr.count("\n") == 1
    assert "not_read" not in done.stderr


def test_existing_outputs_stay_without_force(cli: Cli, knot: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.csv"
    out.write_text("mine")
    assert cli.run(knot, "-o", out).returncode == 4
    assert out.read_text() == "mine"
    assert cli.run(knot, "-o", out, "--force").returncode == 0
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
    assert table.returncode == 0
    assert table.stderr == ""
    assert "inf" not in table.stdout


def test_the_same_input_gives_the_same_bytes(cli: Cli, knot: Path) -> None:
    assert cli.run(knot, "--json").stdout == cli.run(knot, "--json").stdout


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


def test_help_says_how(cli: Cli) -> None:
    done = cli.run("--help")
    assert done.returncode == 0
    assert "--max-writhe" in done.stdout

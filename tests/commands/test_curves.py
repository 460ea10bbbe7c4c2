"""`curvcli curves` as a user types it: what it prints and writes."""

from __future__ import annotations

import io
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import polars as pl
import pytest

from curvcli.curves import Curve
from tests.curves.conftest import Cli
from tests.curves.shapes import helix, trefoil
from tests.helpers.exact_values import MESHES


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
    assert closed["force"] is None
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
    assert done.code == 0, done.err
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
    assert cli.run(MESHES["annulus"], "--table", f"curves={out}").code == 0
    table = pl.read_csv(out, separator="\t")
    report = cli.told(MESHES["annulus"])
    assert table["sum_kappa_g"].to_list() == [row["sum_kappa_g"] for row in report["curves"]]
    assert table["force_z"].to_list() == [row["force"] and row["force"][2] for row in report["curves"]]
    assert table["unknotted"].to_list() == [True, True]
    assert table["turning_number"].null_count() == 2


def test_darboux_columns_of_a_boundary(cli: Cli, tmp_path: Path) -> None:
    done = cli.run(MESHES["mobius"], "-o", "-", "--format", "csv")
    assert done.code == 0
    table = pl.read_csv(io.StringIO(done.out))
    assert table["kappa_g"].sum() == pytest.approx(cli.told(MESHES["mobius"])["curves"][0]["sum_kappa_g"], abs=1e-12)
    tangent, nu, eta = (
        table.select(f"{name}_{axis}" for axis in "xyz").to_numpy() for name in ("tangent", "nu", "eta")
    )
    np.testing.assert_allclose(np.cross(tangent, nu), eta, atol=1e-15)
    np.testing.assert_allclose((tangent * nu).sum(axis=1), 0, atol=1e-14)


def test_one_value_for_scripts(cli: Cli, knot: Path) -> None:
    done = cli.run(knot, "--get", "curves.0.closed")
    assert done.out == "true\n"
    assert float(cli.run(knot, "--get", "curves.0.writhe").out) == Curve(trefoil(80), closed=True).writhe()
    assert cli.run(knot, "--get", "curves.0.colour").code == 2


def test_the_summary_says_what_total_curvature_proves(cli: Cli, knot: Path) -> None:
    done = cli.run(knot)
    assert done.code == 0
    assert done.err == ""
    assert "0 boundary curves, 2 polylines" in done.out
    assert "a larger Σψ proves nothing" in " ".join(done.out.split())
    assert cli.run(knot, "-q").out == ""


def test_streams_in_a_process_of_its_own(knot: Path) -> None:
    command = [sys.executable, "-m", "curvcli", "curves", "-", "--input-format", "obj", "--get", "curves.1.vertices"]
    done = subprocess.run(command, capture_output=True, input=knot.read_bytes(), check=False, timeout=300)
    assert (done.returncode, done.stdout, done.stderr) == (0, b"20\n", b"")


def test_the_same_input_gives_the_same_bytes(cli: Cli, knot: Path) -> None:
    assert cli.run(knot, "--json").out == cli.run(knot, "--json").out


def test_help_says_how(cli: Cli) -> None:
    done = cli.run("--help")
    assert done.code == 0
    assert "--max-writhe" in done.out

"""`curvcli compare --map` as a user types it: what it prints, writes and refuses."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import polars as pl
import pytest

from tests.helpers.cli.program import Ended

Run = Callable[..., Ended]
MORE = ("area_distortion", "orientation")


@pytest.fixture
def square(tmp_path: Path) -> Path:
    """The unit square about its centre, in four triangles."""
    path = tmp_path / "square.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 0\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n")
    return path


@pytest.fixture
def stretched(square: Path) -> Path:
    """The same, three times as long, with the centre out of place."""
    path = square.with_name("stretched.obj")
    path.write_text(
        square.read_text().replace("v 1 ", "v 3 ").replace("v .5 .5 0", "v 1.5 .5 0").replace("1.5", "1.25")
    )
    return path


def test_the_report_has_source_image_and_totals(within: Run, square: Path, stretched: Path) -> None:
    code, out, err = within("compare", square, stretched, "--map", "--json")
    assert (code, err) == (0, "")
    report = json.loads(out)
    assert report["source"]["path"] == str(square)
    assert report["image"]["vertices"] == 5
    totals = report["totals"]
    # Centre moved by -1/4: E = ½ (9 + 1) + ½ · 4 · (1/4)², each of the four cotangent sums at the centre being 2.
    assert totals == {
        "dirichlet": 5.125,
        "area": 1.0,
        "image_area": 3.0,
        "nonconformality": pytest.approx(2.125, rel=1e-15),
    }
    assert report["harmonic"]["vertex"] == 4
    assert report["harmonic"]["residual_max"] == 1.0
    assert {check["name"]: check["status"] for check in report["checks"]} == {
        "dirichlet_energy": "pass",
        "nonconformality": "pass",
    }


def test_results_that_no_double_holds(within: Run, square: Path) -> None:
    huge = square.with_name("huge.obj")
    huge.write_text(
        square.read_text().replace("v 1 ", "v 1e200 ").replace(" 1 0\n", " 1e200 0\n").replace(".5", ".5e200")
    )
    code, out, _ = within("compare", square, huge, "--map", "--json")
    report = json.loads(out)
    assert (code, report["totals"]["dirichlet"]) == (0, None)
    assert [check["status"] for check in report["checks"]] == ["not_applicable"] * 2
    (warning,) = report["warnings"]
    assert warning["code"] == "out_of_range"
    assert {"image_area", "dirichlet"} <= set(warning["message"].partition(": ")[2].split(", "))


def test_get_prints_one_value(within: Run, square: Path, stretched: Path) -> None:
    assert within("compare", square, stretched, "--map", "--get", "totals.area") == (0, "1.0\n", "")
    assert within("compare", square, stretched, "--map", "--get", "checks.nonconformality.status")[1] == "pass\n"
    code, out, err = within("compare", square, stretched, "--map", "--get", "totals.aera")
    assert (code, out) == (2, "")
    assert "nearest: area" in err


def test_the_summary_has_energies_and_checks(within: Run, square: Path, stretched: Path) -> None:
    code, out, err = within("compare", square, stretched, "--map")
    assert (code, err) == (0, "")
    for word in ("dirichlet", "5.125", "sigma_1", "nonconformality", "pass", "at vertex 4"):
        assert word in out
    assert within("compare", square, stretched, "--map", "-q") == (0, "", "")


def test_tables_of_vertices_and_faces_are_written(within: Run, square: Path, stretched: Path, tmp_path: Path) -> None:
    vertices, faces, report = tmp_path / "v.csv", tmp_path / "f.parquet", tmp_path / "r.json"
    written = within("compare", square, stretched, "--map", "-o", vertices, "--table", f"faces={faces}", "-o", report)
    assert written.code == 0
    frame = pl.read_csv(vertices)
    assert frame.columns == [*("vertex", "x", "y", "z"), *(f"gradient_{x}" for x in "xyz"), "harmonic_residual"]
    assert frame["harmonic_residual"].to_list() == [None, None, None, None, 1.0]
    frame = pl.read_parquet(faces)
    assert frame.columns == ["face", "sigma_1", "sigma_2", "nonconformality", "area", "image_area", *MORE]
    # det = σ₁ σ₂ is the ratio of the areas.
    np.testing.assert_allclose(frame["sigma_1"] * frame["sigma_2"], frame["image_area"] / frame["area"], rtol=1e-14)
    assert frame["nonconformality"].sum() == pytest.approx(json.loads(report.read_text())["totals"]["nonconformality"])


def test_table_on_stdout(within: Run, square: Path, stretched: Path) -> None:
    code, out, _ = within("compare", square, stretched, "--map", "--table", "faces=-", "--format", "csv")
    assert code == 0
    assert len(out.splitlines()) == 5
    assert within("compare", square, stretched, "--map", "-o", "-", "--format", "csv", "--json").code == 2


def test_failing_identity_is_exit_1(within: Run, square: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from curvcli.analysis import maps

    monkeypatch.setattr(maps, "rounding", lambda surface, terms: -terms)
    code, out, _ = within("compare", square, square, "--map")
    assert code == 1
    assert "FAIL" in out


def test_options_of_the_other_kind_are_refused(within: Run, square: Path) -> None:
    for arguments in (["--map", "--rtol", "1e-3"], ["--map", "--regions", "groups"], ["--table", "faces=f.csv"]):
        code, out, err = within("compare", square, square, *arguments)
        assert (code, out, err.count("\n")) == (2, "", 1)
        assert ("without --map" if "--map" in arguments else "with --map") in err


def test_meshes_with_other_faces_are_refused(within: Run, square: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.obj"
    other.write_text(square.read_text().replace("f 3 4 5", "f 4 5 3"))
    code, out, err = within("compare", square, other, "--map", "-o", tmp_path / "v.csv")
    assert (code, out) == (3, "")
    assert err == (
        f"curvcli: {other}: face 2: has corners 3 4 2, expected 2 3 4 as in {square}; "
        "a map needs the same vertices and faces in the same order\n"
    )
    assert not (tmp_path / "v.csv").exists()
    assert within("compare", square, tmp_path / "missing.obj", "--map").code == 3
    for wrong in ("faces", "edges=e.csv", "faces=f.ply", "faces="):
        refused = within("compare", square, square, "--map", "--table", wrong)
        assert (refused.code, refused.out, len(refused.err.splitlines())) == (2, "", 1)
    assert within("compare", "-", "-", "--map").code == 2
    square.with_name("v.csv").write_text("mine")
    refused = within("compare", square, square, "--map", "-o", tmp_path / "v.csv")
    assert refused.code == 4
    assert (tmp_path / "v.csv").read_text() == "mine"


def test_the_command_counts_them(within: Run, square: Path) -> None:
    """The centre pulled out over an edge: that triangle is turned over."""
    image = square.with_name("image.obj")
    image.write_text(square.read_text().replace("v .5 .5 0", "v .5 -.25 0"))
    code, out, _ = within("compare", square, image, "--map", "--json")
    report = json.loads(out)
    assert code == 0
    assert report["orientation"] == {"kept": 3, "turned_over": 1, "undefined": 0}
    assert report["area_distortion"] == {"min": 0.5, "max": 2.5, "nulls": 0}
    (warning,) = report["warnings"]
    assert (warning["code"], warning["count"], warning["examples"]) == ("turned_over_faces", 1, [0])
    table = within("compare", square, image, "--map", "--table", "faces=-", "--format", "csv").out.splitlines()
    assert table[0].split(",")[-2:] == ["area_distortion", "orientation"]
    assert [row.split(",")[-1] for row in table[1:]] == ["-1", "1", "1", "1"]
    assert "1 face that the map turns over" in within("compare", square, image, "--map").out


def test_the_texture_of_a_file(within: Run, tmp_path: Path) -> None:
    """A square whose right half is cut off in the texture and turned upside down."""
    path = tmp_path / "textured.obj"
    path.write_text(
        "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nvt 5 5\nvt 6 5\nvt 5 4\n"
        "vt 6 4\nf 1/1 2/2 5/4\nf 1/1 5/4 4/3\nf 2/5 3/6 6/8\nf 2/5 6/8 5/7\n"
    )
    code, out, _ = within("compare", path, "--map", "uv", "--json")
    report = json.loads(out)
    assert code == 0
    assert report["seams"] == 1
    assert report["orientation"] == {"kept": 4, "turned_over": 0, "undefined": 0}
    assert report["totals"] == {"dirichlet": 2.0, "area": 2.0, "image_area": 2.0, "nonconformality": 0.0}
    assert (report["source"]["vertices"], report["image"]["path"]) == (6, "texture coordinates")
    assert [warning["code"] for warning in report["warnings"]] == ["texture_seams"]
    rows = within("compare", path, "--map", "uv", "-o", "-", "--format", "csv").out.splitlines()
    assert [row.split(",")[0] for row in rows] == ["vertex", "0", "1", "1", "2", "3", "4", "4", "5"]
    code, _, _ = within("compare", tmp_path / "none.obj", "--map", "uv")
    assert code == 3


def test_a_file_without_texture(within: Run, square: Path) -> None:
    ended = within("compare", square, "--map", "uv")
    assert ended.code == 3
    assert "has no texture coordinates" in ended.complaint

"""`curvcli compare MESH EXACT.csv`: error norms, what is matched with what, and the exit code."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import polars as pl
import pytest

from curvcli.report.compare.exact import error_norms, match
from tests.helpers.cli.program import curvcli as run


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("exact")
    made = run("sample", "irregular_torus", "--size", "2000", "-o", path / "mesh.ply", "-o", path / "exact.csv")
    assert made.code == 0, made.err
    return path


def test_norms_of_a_known_error() -> None:
    exact, area = np.array([1.0, -2.0, 0.0, 4.0, np.nan]), np.array([1.0, 2.0, 1.0, 4.0, 1.0])
    found = np.array([1.5, -2.0, 1.0, np.nan, 7.0])
    norms = error_norms("K_fit", "K_density", found, exact, area)
    assert (norms.nulls, norms.compared, norms.vertex) == (1, 3, 2)
    assert norms.linf == 1.0
    assert norms.rms == pytest.approx(np.sqrt((0.25 + 1) / 4))
    assert norms.relative_l2 == pytest.approx(np.sqrt((0.25 + 1) / (1 + 8)))
    assert norms.bias == pytest.approx((0.5 + 1) / 4)
    assert norms.relative_bias == pytest.approx((0.5 + 1) / (1 + 4))


def test_what_is_matched_with_what() -> None:
    exact = dict.fromkeys(("h", "h_signed", "K_density", "kappa_1", "kappa_2"))
    columns = ("K", "K_density", "K_fit", "K_corrected", "K_sigma", "h", "h_hks", "h_perp", "h_fit_2e", "kappa_1_fit")
    matched = match(dict.fromkeys((*columns, "h_sigma", "A", "kappa_g", "dir_1_fit_x", "curvedness")), exact)
    assert matched == {
        "K_density": "K_density",
        "K_fit": "K_density",
        "K_corrected": "K_density",
        "h": "h",
        "h_hks": "h",
        "h_perp": "h_signed",
        "h_fit_2e": "h_signed",
        "kappa_1_fit": "kappa_1",
    }


def test_a_sample_against_its_exact_values(folder: Path) -> None:
    told = run("compare", folder / "mesh.ply", folder / "exact.csv", "--json", "--rings", "2")
    report = json.loads(told.out)
    assert told.code == 0
    assert report["scale"] == "2rings"
    errors = report["errors"]
    assert {"K_density", "K_corrected", "K_fit", "h_signed", "h_fit", "kappa_1_fit"} <= set(errors)
    assert errors["K_fit"]["relative_l2"] < 0.1 < errors["K_density"]["relative_l2"]
    assert errors["K_fit"]["exact"] == "K_density"
    shown = run("compare", folder / "exact.csv", folder / "mesh.ply", "-p", "K_fit,h_fit")
    assert shown.code == 0
    assert f"{errors['K_fit']['relative_l2']:.3g}" in shown.out
    assert "K_ring" not in shown.out


def test_a_limit_decides_the_exit_code(folder: Path) -> None:
    mesh, exact = folder / "mesh.ply", folder / "exact.csv"
    assert run("compare", mesh, exact, "-p", "K_fit", "--rtol", "0.5").code == 0
    assert run("compare", mesh, exact, "-p", "K_density", "--rtol", "0.01").code == 1
    assert run("compare", mesh, mesh, "--exact").code == 2
    table = folder / "errors.csv"
    assert run("compare", mesh, exact, "-p", "K_fit,h_fit", "--mean", "average", "-o", table).code == 0
    frame = pl.read_csv(table)
    assert frame["column"].to_list() == ["K_fit", "h_fit"]
    assert frame["relative_l2"].max() < 0.2  # type: ignore[operator]


def test_a_table_of_ones_own_and_one_that_does_not_fit(folder: Path, tmp_path: Path) -> None:
    own = tmp_path / "own.csv"
    pl.read_csv(folder / "exact.csv").select("vertex", "K_density").write_csv(own)
    told = run("compare", folder / "mesh.ply", own, "--exact", "-p", "K_fit", "--get", "errors.K_fit.compared")
    assert (told.code, told.out.strip()) == (0, "2000")
    short = tmp_path / "short.csv"
    pl.read_csv(folder / "exact.csv").head(5).write_csv(short)
    refused = run("compare", folder / "mesh.ply", short)
    assert refused.code == 3
    assert "5 rows found, 2,000 expected" in refused.complaint

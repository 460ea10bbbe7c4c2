"""Scales and normals on the command line, and what the outputs say of them."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import pytest

from tests.helpers.cli.program import CUBE, curvcli, wrote

RADII = ("--radius", "1.5e,3e")


@pytest.fixture(scope="module")
def torus(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = str(tmp_path_factory.mktemp("estimates") / "torus.ply")
    wrote(curvcli("sample", "irregular_torus", "--size", "400", "-o", path))
    return path


def header(*arguments: str) -> list[str]:
    ended = curvcli("analyze", *arguments, "-o", "-", "--format", "csv")
    wrote(ended)
    return next(csv.reader(io.StringIO(ended.out)))


def test_a_scale_adds_the_estimates_to_core(torus: str) -> None:
    plain, wide = header(torus), header(torus, "--rings", "3")
    added = wide[len(plain) :]
    assert wide[: len(plain)] == plain
    assert {"K_ring", "h_ring", "kappa_1_ring", "K_corrected", "h_corrected", "kappa_2_corrected"} <= set(added)


def test_a_scale_leaves_the_chosen_columns_alone(torus: str) -> None:
    assert header(torus, "--rings", "3", "-p", "K,h")[4:] == ["K", "h"]


def test_one_column_for_each_scale(torus: str) -> None:
    wanted = [f"{name}_{scale}" for name in ("K_ring", "K_corrected") for scale in ("2rings", "1.5e", "3e")]
    assert header(torus, "-p", "K_corrected,K_ring", "--rings", "2", *RADII)[4:] == wanted


def test_the_report_names_scales_and_normals(torus: str, tmp_path: Path) -> None:
    ended = curvcli("analyze", torus, "-p", "K_corrected,K_density", *RADII, "--json")
    wrote(ended)
    report = json.loads(ended.out)
    assert report["conventions"]["scale"] == "1.5e,3e"
    assert report["conventions"]["normals"] == "mesh"
    assert list(report["columns"]) == ["K_density", "K_corrected_1.5e", "K_corrected_3e"]
    stored = tmp_path / "report.json"
    stored.write_text(ended.out)
    assert curvcli("compare", torus, str(stored)).code == 0
    plain = json.loads(curvcli("analyze", torus, "--json").out)
    assert plain["conventions"]["scale"] is plain["conventions"]["normals"] is None


def test_the_summary_says_it_in_words(torus: str) -> None:
    ended = curvcli("analyze", torus, "-p", "K_corrected", "--radius", "3e")
    assert "estimates at radius of 3 mean edge lengths, normals of the mesh" in " ".join(ended.out.split())


def test_assertions_at_a_scale(torus: str) -> None:
    assert curvcli("check", torus, "--rings", "3", "--assert", "max(K_corrected) < 10").code == 0
    assert curvcli("check", torus, *RADII, "--assert", "max(K_corrected_3e) < 10").code == 0
    assert curvcli("check", torus, *RADII, "--assert", "max(K_corrected_3e) < -10").code == 1
    refused = curvcli("check", torus, *RADII, "--assert", "max(K_corrected) < 10")
    assert refused.code == 2
    assert "K_corrected_3e" in refused.complaint


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (("--rings", "0"), 2, "rings 0: expected a whole number"),
        (("--rings", "2,x"), 2, "rings 'x': expected a whole number"),
        (("--radius", "-3e"), 2, "radius '-3e': expected a positive length"),
        (("--normals", "file", "-p", "K_corrected"), 3, "no normals at the vertices"),
    ],
)
def test_what_is_refused(arguments: tuple[str, ...], code: int, words: str) -> None:
    ended = curvcli("analyze", CUBE, *arguments)
    assert ended.code == code
    assert words in ended.complaint


def test_a_batch_at_a_scale(torus: str, tmp_path: Path) -> None:
    wrote(curvcli("batch", torus, "-o", tmp_path / "out", "--save", "json", "--rings", "1,2", "-p", "K_ring", "-q"))
    (report,) = (tmp_path / "out").glob("*.json")
    assert list(json.loads(report.read_text())["columns"]) == ["K_ring_1rings", "K_ring_2rings"]

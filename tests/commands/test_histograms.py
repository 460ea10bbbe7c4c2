"""Histograms by the command line: the same numbers in every interface, several meshes in one table or picture."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

import curvcli
from tests.commands.conftest import Run
from tests.helpers.meshes import of_sample


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("irregular_torus", "icosphere"):
        of_sample(name, size=300).write(tmp_path / f"{name}.ply")
    return tmp_path


def test_the_command_line_and_batch_write_the_same_numbers(within: Run, folder: Path) -> None:
    options = ("--histogram", "h", "--histogram", "kappa_1,kappa_2", "--bins", "7", "-q")
    assert within("analyze", "irregular_torus.ply", "--table", "histogram=a.csv", *options).code == 0
    assert within("batch", "irregular*.ply", "-o", "out", "--save", "histogram.csv", "-j", "1", *options).code == 0
    text = (folder / "a.csv").read_bytes()
    assert (folder / "out" / "irregular_torus.ply.histogram.csv").read_bytes() == text
    expected = curvcli.analyze("irregular_torus.ply", "core").histogram("h", bins=7)
    rows = [row for row in rows_of(folder / "a.csv") if row["column"] == "h"]
    assert [float(row["area"]) for row in rows] == expected["area"].tolist()
    assert [row["part"] for row in rows] == expected["part"].tolist()


def test_several_meshes_share_edges(within: Run, folder: Path) -> None:
    words = ("analyze", "irregular_torus.ply", "icosphere.ply", "-q", "--histogram", "h")
    assert within(*words, "--table", "histogram=all.csv", "-o", "all.hist.svg").code == 0
    rows = rows_of(folder / "all.csv")
    edges = {
        mesh: [row["low"] for row in rows if row["mesh"] == mesh and row["part"] == "bin"]
        for mesh in ("irregular_torus.ply", "icosphere.ply")
    }
    assert edges["irregular_torus.ply"] == edges["icosphere.ply"] != []
    for name in edges:
        own = [row for row in rows if row["mesh"] == name]
        total = curvcli.analyze(name, "core").totals["area"]
        assert sum(float(row["area"]) for row in own) == pytest.approx(total, rel=1e-12)
    texts = (folder / "all.hist.svg").read_text()
    assert "irregular_torus.ply</text>" in texts
    assert "icosphere.ply</text>" in texts


def test_a_mesh_that_fails_is_left_out(within: Run, folder: Path) -> None:
    (folder / "broken.ply").write_text("ply\n")
    words = ("analyze", "broken.ply", "icosphere.ply", "-q", "--histogram", "h", "--table", "histogram=all.csv")
    assert within(*words).code == 3
    assert {row["mesh"] for row in rows_of(folder / "all.csv")} == {"icosphere.ply"}


def test_too_many_meshes_for_one_picture(within: Run, folder: Path) -> None:
    ended = within("analyze", *["icosphere.ply"] * 10, "-o", "all.hist.png")
    assert ended.code == 2
    assert "10 meshes in one picture, which has 9 colours" in ended.err

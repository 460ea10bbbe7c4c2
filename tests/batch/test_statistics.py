"""The long table of a batch: every number of every report, the same from every engine and after a resume."""

from __future__ import annotations

import csv
import shutil
from pathlib import Path
from typing import Any

import pytest

import curvcli
from curvcli.report.entries import entries
from tests.batch.conftest import Run

Key = tuple[str, str, str, str]


def read(path: Path) -> dict[Key, float | None]:
    with path.open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    table = {
        (row["mesh"], row["region"], row["column"], row["statistic"]): float(row["value"]) if row["value"] else None
        for row in rows
    }
    assert len(table) == len(rows)
    return table


def expected(paths: list[str], **options: Any) -> dict[Key, float | None]:
    return {
        (path, entry.region or "", entry.column, entry.statistic): entry.value
        for path in paths
        for entry in entries(curvcli.analyze(path, "core", **options).report())
    }


def test_the_table_has_the_numbers_of_every_report_in_input_order(scans: Path, run: Run) -> None:
    run("batch", "scans/**/*.obj", "scans/**/*.ply", "-o", "out", "--long", "-j", "2", "-q")
    table = read(scans.parent / "out" / "statistics.csv")
    paths = ["scans/a.obj", "scans/deep/m.obj", "scans/a.ply", "scans/deep/er/a.ply"]
    assert table == expected(paths)
    assert list(dict.fromkeys(key[0] for key in table)) == paths


def test_regions_have_rows_of_their_own(tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng left\nf 1 2 3\ng right\nf 1 3 4\n"
    (tmp_path / "square.obj").write_text(text)
    options = ("--regions", "groups", "--stat", "mean,count", "--long", "-q")
    run("batch", "square.obj", "-o", "out", *options)
    table = read(tmp_path / "out" / "statistics.csv")
    assert {key[1] for key in table} == {"", "left", "right"}
    assert table["square.obj", "left", "area", "total"] == 0.5
    assert table["square.obj", "", "A", "count"] == 4
    regional = {key: value for key, value in table.items() if key[1]}
    report = expected(["square.obj"], regions="groups", stat="mean,count")
    assert regional == {key: value for key, value in report.items() if key[1]}


@pytest.mark.slow
def test_equal_runs_and_resumed_runs_give_equal_bytes(scans: Path, run: Run) -> None:
    folder = scans.parent
    words = ("batch", "scans/**/*.ply", "scans/**/*.obj")
    run(*words, "-o", "first", "--long", "-j", "2", "-q")
    run(*words, "-o", "second", "--long", "-j", "1", "-q")
    names = ("statistics.csv", "statistics.parquet")
    whole = [(folder / "first" / name).read_bytes() for name in names]
    assert [(folder / "second" / name).read_bytes() for name in names] == whole
    lines = (folder / "second" / "manifest.jsonl").read_bytes().splitlines(keepends=True)
    (folder / "second" / "manifest.jsonl").write_bytes(b"".join(lines[:2]))
    (folder / "second" / "statistics.csv").unlink()
    run(*words, "-o", "second", "--long", "--resume", "-j", "1", "-q")
    assert [(folder / "second" / name).read_bytes() for name in names] == whole


def test_without_the_option_no_table_of_an_earlier_run_is_left(scans: Path, run: Run) -> None:
    out = scans.parent / "out"
    run("batch", "scans/a.obj", "-o", "out", "--long", "-q")
    assert (out / "statistics.csv").exists()
    run("batch", "scans/a.obj", "-o", "out", "--resume", "-q")
    assert sorted(path.name for path in out.iterdir()) == ["manifest.jsonl", "summary.csv", "summary.parquet"]


@pytest.mark.slow
def test_dask_gives_the_same_bytes(scans: Path, run: Run) -> None:
    pytest.importorskip("distributed")
    folder = scans.parent
    run("batch", "scans/*.obj", "-o", "here", "--long", "-j", "1", "-q")
    run("batch", "scans/*.obj", "-o", "there", "--long", "--scheduler", "local:1", "-q")
    tables = [(folder / name / "statistics.csv").read_bytes() for name in ("here", "there")]
    assert tables[0] == tables[1]
    shutil.rmtree(folder / "there")

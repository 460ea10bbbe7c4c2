"""`--stat`: the command line, Python and batch give the same statistics of regions, in the report and in tables."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import curvcli
from tests.helpers.cli.program import Ended, wrote
from tests.helpers.meshes import of_sample

Run = Callable[..., Ended]


def test_command_line_python_and_batch_give_the_same_numbers(within: Run, tmp_path: Path) -> None:
    given = of_sample("irregular_torus", size=100)
    labels = [int(x > 0) for x in given.points[given.faces].mean(axis=1)[:, 0]]
    given.write(tmp_path / "torus.obj")
    lines = (tmp_path / "torus.obj").read_text().splitlines()
    place = next(k for k, line in enumerate(lines) if line.startswith("f "))
    faces = [f"g part{label}\n{line}" for label, line in zip(labels, lines[place:], strict=True)]
    (tmp_path / "torus.obj").write_text("\n".join([*lines[:place], *faces]) + "\n")
    asked = ("--regions", "groups", "--stat", "count,area_mean,area_p10")
    wrote(within("analyze", "torus.obj", *asked, "-o", "r.json", "--table", "regions=r.csv", "-q"))
    wrote(within("batch", "torus.obj", *asked, "-o", "out", "--save", "json,regions.csv", "-q"))
    report = json.loads(Path("r.json").read_text())
    python = curvcli.analyze("torus.obj", regions="groups", stat=["count", "area_mean", "area_p10"]).report()
    batch = json.loads(next(Path("out").glob("torus.obj*.json")).read_text())
    assert report["regions"] == python["regions"] == batch["regions"]
    assert Path("r.csv").read_bytes() == next(Path("out").glob("torus.obj*regions.csv")).read_bytes()
    rows = {row["region"]: row for row in csv.DictReader(Path("r.csv").read_text().splitlines())}
    for region in report["regions"]:
        row: dict[str, Any] = rows[region["name"]]
        for column, statistics in region["columns"].items():
            assert {f"{column}_{name}": float(row[f"{column}_{name}"]) for name in statistics} == {
                f"{column}_{name}": value for name, value in statistics.items()
            }


def test_an_unknown_statistic_is_refused_before_any_work(within: Run) -> None:
    ended = within("analyze", "missing.obj", "--stat", "men")
    assert (ended.code, ended.out) == (2, "")
    assert "unknown statistic 'men'; nearest: mean, min, median" in ended.err

"""`--stat`: the command line, Python and batch give the same statistics of regions, in the report and in tables."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import curvcli
from tests.helpers.cli.program import Ended, wrote
from tests.helpers.meshes import Mesh, of_sample

Run = Callable[..., Ended]


def write_labelled(given: Mesh, path: Path) -> None:
    """As an OBJ file with the groups part0 and part1."""
    labels = [int(x > 0) for x in given.points[given.faces].mean(axis=1)[:, 0]]
    given.write(path)
    lines = path.read_text().splitlines()
    place = next(k for k, line in enumerate(lines) if line.startswith("f "))
    faces = [f"g part{label}\n{line}" for label, line in zip(labels, lines[place:], strict=True)]
    path.write_text("\n".join([*lines[:place], *faces]) + "\n")


def test_command_line_python_and_batch_give_the_same_numbers(within: Run, tmp_path: Path) -> None:
    given = of_sample("irregular_torus", size=100)
    write_labelled(given, tmp_path / "torus.obj")
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


def test_the_long_table_has_every_number_of_the_report(within: Run, tmp_path: Path) -> None:
    """The same as a batch's, with the totals and the shares."""
    given = of_sample("irregular_torus", size=100)
    write_labelled(given, tmp_path / "torus.obj")
    asked = ("--regions", "groups", "--stat", "mean,p10", "-q")
    wrote(within("analyze", "torus.obj", *asked, "-o", "r.json", "--table", "statistics=s.csv"))
    wrote(within("batch", "torus.obj", *asked, "-o", "out", "--long"))
    assert Path("s.csv").read_bytes() == Path("out/statistics.csv").read_bytes()
    report = json.loads(Path("r.json").read_text())
    rows = list(csv.DictReader(Path("s.csv").read_text().splitlines()))
    assert {row["mesh"] for row in rows} == {"torus.obj"}
    found = {(row["region"], row["column"], row["statistic"]): row["value"] for row in rows}
    assert len(found) == len(rows)
    assert float(found["", "willmore", "total"]) == report["totals"]["willmore"]
    for region in report["regions"]:
        name = region["name"]
        assert float(found[name, "willmore", "total"]) == region["totals"]["willmore"]
        assert float(found[name, "H_vec_y", "share"]) == region["shares"]["H_vec"][1]
        assert found[name, "volume", "total"] == ""
        for column, statistics in region["columns"].items():
            for statistic, value in statistics.items():
                assert float(found[name, column, statistic]) == value

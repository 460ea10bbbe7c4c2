"""`curvcli compare` of two groups: folders, patterns and batches give the same numbers; exit codes and messages."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import numpy as np
import pytest

import curvcli
from tests.commands.conftest import Run
from tests.helpers.meshes import of_sample


@pytest.fixture(scope="module")
def reports(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Spheres of radius 1 and 1.2 with noise of 1 %, five in each group: meshes and reports."""
    folder = tmp_path_factory.mktemp("groups")
    generator = np.random.default_rng(0)
    sphere = of_sample("icosphere", size=42)
    for name, radius in (("small", 1.0), ("large", 1.2)):
        (folder / name).mkdir()
        for k in range(5):
            points = sphere.points * radius * (1 + 0.01 * generator.normal())
            path = sphere.moved(points).write(folder / name / f"{k}.ply")
            (folder / name / f"{k}.json").write_text(json.dumps(curvcli.analyze(path).report()))
    return folder


def test_a_planted_difference_is_reported(within: Run, reports: Path) -> None:
    ended = within("compare", reports / "small", reports / "large", "--json")
    assert ended.code == 0
    report = json.loads(ended.out)
    schema = json.loads(within("compare", "--schema").out)
    jsonschema.validate(report, schema)
    rows = {row["key"]: row for row in report["differences"]}
    assert rows["totals.area"]["significant"]
    assert rows["totals.area"]["difference"] == pytest.approx(4 * np.pi * 0.44, rel=0.15)
    assert rows["columns.h.area_mean"]["difference"] < 0
    assert rows["totals.K"]["status"] == "same"  # 4π on every sphere
    areas = [
        [curvcli.analyze(reports / name / f"{k}.ply").totals["area"] for k in range(5)] for name in ("small", "large")
    ]
    assert rows["totals.area"]["mean_a"] == pytest.approx(np.mean(areas[0]), rel=1e-14)
    assert rows["totals.area"]["mean_b"] == pytest.approx(np.mean(areas[1]), rel=1e-14)
    assert within("compare", reports / "small", reports / "large", "-q", "--strict").code == 1


def test_an_equal_pair_is_not_reported(within: Run, reports: Path) -> None:
    ended = within("compare", reports / "small", reports / "small", "--strict")
    assert ended.code == 0
    assert "0 of " in ended.out
    assert "same up to" in ended.out


def test_patterns_batches_and_the_long_table_give_the_same_numbers(within: Run, reports: Path, tmp_path: Path) -> None:
    words = ("--only", "totals", "--json")
    expected = json.loads(within("compare", reports / "small", reports / "large", *words).out)["differences"]
    patterns = [str(reports / name / "*.json") for name in ("small", "large")]
    assert json.loads(within("compare", *patterns, *words).out)["differences"] == expected
    for name, option in (("small", "--long"), ("large", "-q")):
        assert within("batch", str(reports / name / "*.ply"), "-o", name, option, "-q", "-j", "1").code == 0
    assert json.loads(within("compare", "small", "large", *words).out)["differences"] == expected


def test_outputs_and_their_plot(within: Run, reports: Path, tmp_path: Path) -> None:
    names = ("d.csv", "d.json", "d.svg", "d.png")
    outputs = [word for name in names for word in ("-o", name)]
    assert within("compare", reports / "small", reports / "large", "-q", *outputs).code == 0
    assert "totals.area</text>" in (tmp_path / "d.svg").read_text()
    assert (tmp_path / "d.csv").read_text().startswith("key,region,column,statistic,status,n_a")
    again = within("compare", reports / "small", reports / "large", "-o", "d.csv")
    assert again.code == 4


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (("small", "small/0.ply"), 2, "is a group of reports; expected another folder"),
        (("small", "none/*.json"), 5, "no report (.json) there"),
        (("small", "large", "--map"), 2, "--map goes without groups"),
        (("small", "large", "-p", "K"), 2, "--pass goes without groups"),
        (("small/0.ply", "large/0.ply", "--test", "welch"), 2, "--test goes with two groups"),
        (("small", "large", "--stat", "area_meen"), 2, "nearest: area_mean"),
        (("small", "large", "-o", "d.hist.png"), 2, "it has no histogram"),
        (("small", "large", "--alpha", "1"), 2, "--alpha"),
    ],
)
def test_messages(
    within: Run, reports: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], code: int, message: str
) -> None:
    monkeypatch.chdir(reports)
    ended = within("compare", *words)
    assert (ended.code, message in ended.err) == (code, True), ended.err


def test_another_json_file_is_named(within: Run, reports: Path, tmp_path: Path) -> None:
    (tmp_path / "bad").mkdir()
    (tmp_path / "bad" / "x.json").write_text("{}")
    ended = within("compare", reports / "small", "bad")
    assert ended.code == 3
    assert "x.json" in ended.err
    assert len(ended.err.splitlines()) == 1


def test_the_plot_shows_differences_of_any_size(within: Run, tmp_path: Path) -> None:
    """Deviations of 10³⁰⁸ do not overflow; a difference beyond the axis is an arrow at its end."""
    sphere = of_sample("icosphere", size=42)
    report = curvcli.analyze((sphere.points, sphere.faces)).report()
    generator = np.random.default_rng(0)
    for name, shift in (("a", 0.0), ("b", 1e3)):
        (tmp_path / name).mkdir()
        for k in range(3):
            report["totals"] |= {"area": 1e308 * generator.random(), "K": 12 + generator.random() + shift}
            report["topology"] |= {"faces": 0, "vertices": 0}
            (tmp_path / name / f"{k}.json").write_text(json.dumps(report))
    assert within("compare", "a", "b", "--only", "totals", "-q", "-o", "d.svg").code == 0
    text = (tmp_path / "d.svg").read_text()
    assert "totals.area</text>" in text
    assert "beyond ±20</text>" in text

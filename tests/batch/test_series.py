"""Plots over the meshes of a batch: the values drawn are those of the summary, gaps where a mesh failed, refusals."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from curvcli.batch import series
from curvcli.batch.model import Row, RowStatistics
from curvcli.curvatures.catalogue import load_passes
from curvcli.errors import UsageError
from curvcli.output.pictures.series import write_series
from tests.batch.conftest import Run
from tests.helpers.meshes import of_sample


@pytest.fixture
def frames(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Spheres that become longer; the second frame is broken."""
    sphere = of_sample("icosphere", size=42)
    (tmp_path / "frames").mkdir()
    for k in range(4):
        sphere.moved(sphere.points * [1, 1, 1 + k]).write(tmp_path / "frames" / f"{k}.ply")
    (tmp_path / "frames" / "1.ply").write_text("ply\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def drawn(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Arguments of every plot that is drawn."""
    from curvcli.output.pictures import series as pictures

    calls: list[Any] = []
    original = pictures.write_series

    def caught(stream: Any, panels: Any, names: Any, suffix: str) -> None:
        calls.append((panels, names))
        original(stream, panels, names, suffix)

    monkeypatch.setattr(pictures, "write_series", caught)
    return calls


def test_a_plot_has_the_values_of_the_summary(frames: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    calls = drawn(monkeypatch)
    ended = run("batch", "frames/*.ply", "-o", "out", "-q", "-j", "1", "--plot", "area,topology.faces=a.svg")
    assert ended.code == 3
    with (frames / "out" / "summary.csv").open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    ((panels, names),) = calls
    assert names == [row["path"] for row in rows]
    areas = [float(row["totals.area"] or "nan") for row in rows]
    np.testing.assert_array_equal(panels["totals.area"]["totals.area"], areas)
    assert np.isnan(areas).tolist() == [False, True, False, False]
    text = (frames / "out" / "a.svg").read_text()
    assert "totals.area</text>" in text
    assert "1 value missing</text>" in text
    # A resumed batch draws other keys without computing anything but the mesh that failed.
    again = run("batch", "frames/*.ply", "-o", "out", "-q", "-j", "1", "--resume", "--plot", "K")
    assert again.code == 3
    assert (frames / "out" / "series.png").stat().st_size > 1000


def test_wildcards_draw_a_line_for_each_region() -> None:
    parts = [RowStatistics(name, {"area": {"total": value}}) for name, value in ((None, 3.0), ("a", 1.0), ("b.c", 2.0))]
    values = series._values(Row(path="m", totals={"area": 3.0, "A_vec": [1.0, 2.0, None]}, statistics=parts))
    assert values["totals.A_vec_y"] == 2.0
    assert "totals.A_vec_z" not in values
    lines = series._lines("regions.*.totals.area", [values, {}])
    assert {name: line.tolist()[0] for name, line in lines.items()} == {
        "regions.a.totals.area": 1.0,
        "regions.b.c.totals.area": 2.0,
    }
    assert all(np.isnan(line[1]) for line in lines.values())


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("totals.aera", "there is no total 'aera'; nearest: area"),
        ("columns.h.mean", "--long only; add --long"),
        ("area=a.csv", "unknown format"),
        ("area=a.hist.png", r"ends with \.png, \.pdf or \.svg"),
        ("area=up/a.png", "is a path"),
        ("=a.png", "expected KEY"),
    ],
)
def test_plots_that_are_refused(text: str, complaint: str) -> None:
    load_passes()
    with pytest.raises(UsageError, match=complaint):
        series.parse_plots([text], "out", [], long=False)


def test_two_plots_have_two_names() -> None:
    load_passes()
    with pytest.raises(UsageError, match="another output has the name"):
        series.parse_plots(["area", "K"], "out", [], long=False)


@pytest.mark.parametrize(
    "values", [[1.7e308, -1.7e308, 0], [1.79e308], [5e-324, 0, 1e-323], [np.nan, 2, np.nan], [1, 1 + 1e-15, 1]]
)
def test_values_of_any_size_are_drawn(values: list[float]) -> None:
    stream = io.BytesIO()
    write_series(stream, {"k": {"k": np.array(values, float)}}, ["m"] * len(values), ".svg")
    assert b">k" in stream.getvalue()

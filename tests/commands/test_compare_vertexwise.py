"""`curvcli compare --vertexwise`: scipy's numbers at every vertex, a planted patch, missing values, refusals."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from scipy import stats

import curvcli
from curvcli.analysis.moments_of_meshes import VertexMoments
from curvcli.report.groups.vertexwise import vertex_map
from tests.commands.conftest import Run
from tests.helpers.meshes import of_sample


@pytest.fixture(scope="module")
def groups(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Spheres with noise, six in each group; those of the second have a dent at the top."""
    folder = tmp_path_factory.mktemp("meshes")
    sphere = of_sample("icosphere", size=162)
    generator = np.random.default_rng(5)
    top = np.clip(sphere.points[:, 2] - 0.8, 0, None)[:, None]
    for name, dent in (("a", 0.0), ("b", 1.0)):
        (folder / name).mkdir()
        for k in range(6):
            noise = 1 + 0.002 * generator.normal(size=(162, 1))
            sphere.moved(sphere.points * noise * (1 - dent * top)).write(folder / name / f"{k}.ply")
    return folder


def test_scipy_has_the_same_numbers_at_every_vertex(within: Run, groups: Path, tmp_path: Path) -> None:
    words = ("--vertexwise", "-p", "h_signed", "-q", "-o", "map.csv", "-o", "map.ply")
    assert within("compare", groups / "a", groups / "b", *words).code == 0
    with (tmp_path / "map.csv").open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    table = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
    a, b = (
        np.array([curvcli.analyze(groups / name / f"{k}.ply").vertices["h_signed"] for k in range(6)]) for name in "ab"
    )
    expected = stats.ttest_ind(b, a, equal_var=False)
    for name, values in (
        *(("t", expected.statistic), ("p", expected.pvalue), ("mean_a", a.mean(axis=0)), ("mean_b", b.mean(axis=0))),
        *(("difference", b.mean(axis=0) - a.mean(axis=0)), ("q", stats.false_discovery_control(expected.pvalue))),
    ):
        np.testing.assert_allclose(table[f"h_signed_{name}"], values, rtol=1e-6, atol=1e-12, err_msg=name)
    top = of_sample("icosphere", size=162).points[:, 2] > 0.8
    found = table["h_signed_q"] <= 0.05
    assert found[top].mean() > 0.6
    assert found[of_sample("icosphere", size=162).points[:, 2] < 0.5].mean() < 0.05
    mesh = curvcli.load(tmp_path / "map.ply")
    assert mesh.file is not None
    np.testing.assert_array_equal(mesh.file.vertex_properties["h_signed_t"], table["h_signed_t"])
    positions = np.mean([curvcli.load(groups / "a" / f"{k}.ply").points for k in range(6)], axis=0)
    np.testing.assert_allclose(mesh.points, positions, atol=1e-12)


def test_the_report_is_valid_and_equal_groups_differ_nowhere(within: Run, groups: Path) -> None:
    ended = within("compare", groups / "a", groups / "a", "--vertexwise", "--json", "--strict")
    assert ended.code == 0
    report = json.loads(ended.out)
    jsonschema.validate(report, json.loads(within("compare", "--schema").out))
    assert [each["significant"] for each in report["vertexwise"]] == [0, 0]
    assert within("compare", groups / "a", groups / "b", "--vertexwise", "-q", "--strict").code == 1


def test_moments_leave_out_missing_values() -> None:
    values = np.array([[1.0, np.nan, 3.0], [2.0, np.nan, 3.0], [4.0, 5.0, 3.0]])
    moments = VertexMoments(["h"], 3)
    for row in values:
        moments.add(np.zeros((3, 3)), {"h": row})
    np.testing.assert_allclose(moments.mean_of("h"), [7 / 3, 5, 3])
    np.testing.assert_allclose(moments.deviation_of("h"), [np.std([1, 2, 4], ddof=1), np.nan, 0])
    other = VertexMoments(["h"], 3)
    for row in np.add(values, [5.0, 1.0, 1e-15]):
        other.add(np.zeros((3, 3)), {"h": row})
    columns = vertex_map(moments, other, {"h": 1e-14}, "bh")
    assert np.isfinite(columns["h_t"]).tolist() == [True, False, False]  # one value; rounding
    assert columns["h_n_a"].tolist() == [3, 1, 3]


def test_memory_does_not_grow_with_the_meshes() -> None:
    moments = VertexMoments(["h"], 10)
    sizes = set()
    for k in range(5):
        moments.add(np.zeros((10, 3)), {"h": np.full(10, float(k))})
        sizes.add(
            sum(array.nbytes for part in vars(moments).values() if isinstance(part, dict) for array in part.values())
        )
    assert len(sizes) == 1


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (("a", "other"), 3, "other faces than"),
        (("a", "none"), 5, "no mesh matches"),
        (("a", "a/0.ply"), 2, "one mesh, a group needs two or more"),
        (("a", "b", "--map"), 2, "--map goes without --vertexwise"),
        (("a", "b", "-p", "status"), 2, "no column of numbers"),
        (("a", "b", "-o", "x.png"), 2, "unknown format"),
    ],
)
def test_messages(
    within: Run, groups: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], code: int, message: str
) -> None:
    monkeypatch.chdir(groups)
    (groups / "other").mkdir(exist_ok=True)
    for k in range(2):
        of_sample("icosphere", size=42).write(groups / "other" / f"{k}.ply")
    ended = within("compare", *words, "--vertexwise")
    assert (ended.code, message in ended.err) == (code, True), ended.err

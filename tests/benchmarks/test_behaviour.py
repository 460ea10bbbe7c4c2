"""The table of behaviours: its files are what they claim to be, and the page of comparisons says what is measured."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import curvcli
from benchmarks import behaviour
from tests.helpers.cli.program import ROOT


@pytest.mark.parametrize("name", behaviour.CASES)
def test_ours_is_the_truth(name: str, tmp_path: Path) -> None:
    said = behaviour.ours(str(behaviour.CASES[name].make(tmp_path)))
    euler = {"hemisphere": 1, "flat square": 1}.get(name, 2)
    assert said.total == pytest.approx(2 * euler, abs=1e-12)
    if name == "loose vertex":
        assert said.rows == 163
        assert np.isnan(said.K[-1])
    elif euler == 2:
        assert said.rows == 162


def test_the_square_is_flat_and_its_corners_turn(tmp_path: Path) -> None:
    analysis = curvcli.analyze(behaviour.square(tmp_path))
    turning = analysis.vertices["kappa_g"]
    corners = np.sort(turning[~np.isnan(turning)])[-4:]
    np.testing.assert_allclose(corners, np.pi / 2, rtol=1e-14)
    assert np.nanmax(abs(analysis.vertices["h"])) < 1e-12


def test_the_seam_is_one_of_texture_only(tmp_path: Path) -> None:
    text = behaviour.seam(tmp_path).read_text()
    assert len(re.findall("^v ", text, re.MULTILINE)) == 162 < len(re.findall("^vt ", text, re.MULTILINE))


def test_the_comparison_says_what_is_measured() -> None:
    """Our row; those of others are theirs to change with every version."""
    page = (ROOT / "docs" / "comparison.md").read_text(encoding="utf-8")
    row = next(line for line in page.splitlines() if line.startswith("| curvcli | ΣK"))
    said = behaviour.measure(["curvcli"])["curvcli"]
    assert [cell.strip() for cell in row.strip("|").split("|")[1:]] == list(said.values())


def test_what_is_not_installed_or_fails_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(path: str) -> behaviour.Said:
        raise ModuleNotFoundError("No module named 'peer'", name="peer")

    def broken(path: str) -> behaviour.Said:
        raise ValueError("no\nway")

    monkeypatch.setattr(behaviour, "LIBRARIES", {"peer": missing, "other": broken})
    found = behaviour.measure()
    assert set(found["peer"].values()) == {"not installed: peer"}
    assert set(found["other"].values()) == {"fails: no way"}
    assert behaviour.markdown(found).count("\n") == 4

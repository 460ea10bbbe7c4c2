"""Prints of curves, checks, differences, maps and errors at every width: nothing cut off, nothing wider."""

from __future__ import annotations

import io
from collections.abc import Callable

import pytest
from rich.console import Console

from curvcli.analysis.maps import SurfaceMap
from curvcli.curves.collect import curves_of_surface
from curvcli.curves.measure import CurveMeasures
from curvcli.report import accuracy, advice, curves
from curvcli.report.check.model import CheckedMesh, CheckReport, Outcome, Rule
from curvcli.report.compare import model as differences
from curvcli.report.compare.cells import MovedColumn
from curvcli.report.compare.exact import ErrorNorms
from curvcli.report.compare.values import Difference
from curvcli.report.terminal import accuracy as accuracy_text
from curvcli.report.terminal import check as check_text
from curvcli.report.terminal import compare as compare_text
from curvcli.report.terminal import curves as curves_text
from curvcli.report.terminal import maps as maps_text
from tests.helpers.meshes import of_sample

SENTENCE = "a sentence of several words that says what holds on every mesh and what does not, as identities do"


def of_curves() -> None:
    curves_text.show(curves.model(CurveMeasures(curves_of_surface(of_sample("mobius").surface()))))


def of_checks(count: int = 1) -> None:
    outcomes = [
        Outcome("total_absolute_curvature", "identity", "component 12", "pass", SENTENCE),
        Outcome("closed", "requirement", "whole", "fail", SENTENCE),
        Outcome("volume", "identity", "whole", "not_applicable", SENTENCE),
    ]
    names = [f"meshes/of/a/folder/part-{k}.stl" for k in range(count)]
    checked = [CheckedMesh(name, None, "fail", 1, None, outcomes, []) for name in names]
    check_text.show(CheckReport(1, "0", [Rule("closed", "requirement", SENTENCE)], checked, 1))


def of_differences() -> None:
    change = Difference("components.3.totals.willmore_hks", "moved", 0.1 + 0.2, -1.2345678901234567e-17, 0.3, 1e-9)
    vector = Difference("totals.A_vec", "moved", [0.1 + 0.2, 1 / 3, 2 / 3], [0.5, 1 / 7, -2 / 7], 0.3, 1e-9)
    column = MovedColumn("kappa_1", 12345, 678, 90, 1 / 3, 0.1 + 0.2, 0.03, 1e-9)
    sides = (differences.Side("a.obj", "mesh"), differences.Side("b.json", "report"))
    compare_text.show(differences.Comparison(1, "0", *sides, 1e-9, 0, False, 100, [change, vector], [column], []))


def of_maps() -> None:
    surface = of_sample("cap", size=60).surface()
    maps_text.show(SurfaceMap(surface, surface.points * [1.0, 2.0, 0.5]))


def of_errors() -> None:
    norms = [
        ErrorNorms(name, "kappa_1", 0.00123, 12.3, 123456, 0.0123, -0.00123, -0.0000123, 1234, 123456)
        for name in ("kappa_1", "kappa_1_corrected_8e")
    ]
    sides = (differences.Side("a.obj", "mesh"), differences.Side("b.csv", "table"))
    accuracy_text.show(accuracy.model(*sides, "2rings", 0.1, norms, [], []))


KINDS: dict[str, tuple[Callable[[], None], tuple[str, ...]]] = {
    "curves": (of_curves, ("0 boundary", "turning_number", "fenchel")),
    "one mesh": (of_checks, ("total_absolute_curvature", "identities do")),
    "several meshes": (lambda: of_checks(3), ("meshes/of/a/folder/part-2.stl", "FAIL")),
    "differences": (
        of_differences,
        ("components.3.totals.willmore_hks", "0.30000000000000004", "-1.2345678901234567e-17"),
    ),
    "maps": (of_maps, ("nonconformality", "harmonic")),
    "errors": (of_errors, ("kappa_1_corrected_8e", "0.00123")),
}


@pytest.mark.parametrize("width", [60, 80, 100, 120])
def test_the_advice_fits(width: int) -> None:
    lines = advice.as_text(width).splitlines()
    assert max(map(len, lines)) <= width
    assert (advice.as_text() == advice.as_text(width)) == (width == 120)
    for cells in advice.ROWS:
        (row,) = [line for line in lines if f"{line} ".startswith(f"{cells[0]} ")]
        assert row.endswith(cells[4])


@pytest.mark.parametrize("width", [60, 80, 120])
@pytest.mark.parametrize("kind", KINDS)
def test_nothing_is_wider_than_the_terminal(kind: str, width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    stream = io.StringIO()
    made = Console(file=stream, width=width, force_terminal=True, color_system=None, highlight=False)
    for module in (accuracy_text, check_text, compare_text, curves_text, maps_text):
        monkeypatch.setattr(module, "report_console", lambda *options: made)
    show, words = KINDS[kind]
    show()
    lines = [line.rstrip() for line in stream.getvalue().splitlines()]
    # Failures of a check are never folded: one line each, for grep.
    tables = [line for line in lines if not line.startswith("FAIL ") and "checks hold" not in line]
    assert [line for line in tables if len(line) > width] == []
    assert "…" not in "".join(line.replace(" … ", "") for line in lines)
    told = " ".join(" ".join(lines).split())
    assert [word for word in words if word not in told] == []
    # No column of single letters.
    assert sum(len(line.strip()) == 1 for line in lines) <= 2

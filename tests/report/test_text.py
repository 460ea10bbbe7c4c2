"""The summary at every width: nothing cut off, nothing wider than the terminal, failures first."""

from __future__ import annotations

import io
from functools import cache

import numpy as np
import pytest
from rich.console import Console
from rich.table import Table

import curvcli
from curvcli.api import Analysis
from curvcli.checks import Check
from curvcli.report.terminal import summary as text
from curvcli.report.terminal.tables import fitting, plain_table
from tests.helpers.meshes import Mesh, of_sample


@cache
def analysed(name: str) -> Analysis:
    if name == "noisy":
        mesh = of_sample("irregular_torus", size=300)
        noise = 0.05 * np.random.default_rng(0).normal(size=mesh.points.shape)
        mesh = mesh.moved((mesh.points + noise) * 1e-7)
    elif name == "many":
        points, faces = of_sample("icosahedron")
        shift = np.arange(130)[:, None, None] * [5.0, 0, 0]
        mesh = Mesh((points + shift).reshape(-1, 3), np.vstack([faces + 12 * k for k in range(130)]).astype(np.int32))
    else:
        mesh = of_sample(name)
    return curvcli.analyze((mesh.points, mesh.faces), "all" if name == "torus" else "core")


def shown(analysis: Analysis, width: int, monkeypatch: pytest.MonkeyPatch, *, terminal: bool = True) -> str:
    stream = io.StringIO()
    made = Console(file=stream, width=width, force_terminal=terminal, color_system=None, highlight=False)
    monkeypatch.setattr(text, "report_console", lambda: made)
    text.show(analysis)
    return stream.getvalue()


@pytest.mark.parametrize("width", [80, 60])
@pytest.mark.parametrize("name", ["torus", "mobius", "book", "noisy", "many", "two_components"])
def test_the_summary_fits(name: str, width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    summary = shown(analysed(name), width, monkeypatch)
    assert all(len(line.rstrip()) <= width for line in summary.splitlines())
    # The one ellipsis there may be stands for rows, not for digits.
    assert all("…" not in line or line.startswith(" … ") for line in summary.splitlines())
    for column in ("K_density", "willmore_hks", "h_signed"):
        row = [line for line in summary.splitlines() if line.startswith(f" {column} ")][-1]
        assert len(row.split()) >= 4 or np.isnan(analysed(name).vertices[column]).all()


def test_at_80_columns_nothing_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("torus", "mobius", "book", "noisy"):
        lines = shown(analysed(name), 80, monkeypatch).splitlines()
        assert any(line.split() == ["column", "unit", "min", "median", "max", "mean", "null"] for line in lines), name
        assert any(line.split() == ["check", "status", "residual", "allowed", "detail"] for line in lines), name


def test_in_a_pipe_sentences_are_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    lines = shown(analysed("book"), 80, monkeypatch, terminal=False).splitlines()
    (warning,) = [line for line in lines if line.startswith("warning nonmanifold_edges")]
    assert warning.endswith("in the column faces")


@pytest.mark.parametrize("width", [100, 80, 60])
def test_what_fails_comes_first_with_its_reason(width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    analysis = analysed("two_components")
    failed = Check("volume", "component 1", "fail", 1.0, 2.0, 1.0, 1e-9, "a reason in some words")
    monkeypatch.setitem(analysis.__dict__, "checks", [*analysis.checks, failed])
    lines = shown(analysis, width, monkeypatch).splitlines()
    start = next(k for k, line in enumerate(lines) if line.startswith(" check "))
    first = " ".join(lines[start + 2 : start + 6])
    assert first.split()[0] == "volume"
    for word in ("component", "FAIL", "reason", "words"):
        assert word in first
    assert all(len(line.rstrip()) <= width for line in lines)


def test_a_table_that_fits_nowhere_is_folded() -> None:
    def table(words: int) -> Table:
        made = plain_table(*["header"] * words)
        made.add_row(*["abcdefgh"] * words)
        return made

    console = Console(file=io.StringIO(), width=20)
    assert len(fitting(console, (table(n) for n in (9, 3, 2, 1))).columns) == 2
    console.print(fitting(console, [table(3)]))
    output = console.file.getvalue()  # type: ignore[attr-defined]
    assert "…" not in output
    assert output.count("b") == 3

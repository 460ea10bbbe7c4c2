"""No work on a mesh keeps its memory: many meshes in one process need the memory of one."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

import curvcli
from curvcli.api import Analysis
from curvcli.commands.main import cli
from curvcli.errors import MissingExtraError
from curvcli.output.appearance import DEFAULT
from curvcli.output.registry import output_formats
from curvcli.output.tables.columns import TABLES
from curvcli.output.write import needs
from curvcli.report.terminal.summary import show
from tests.helpers import exact_values, meshes


@pytest.fixture
def no_collector() -> Iterator[None]:
    """Without the collector of circles, which comes when it likes."""
    gc.collect()
    gc.disable()
    yield
    gc.enable()


def _columns(analysis: Analysis) -> None:
    for columns in (analysis.vertices, analysis.edges, analysis.faces):
        assert [len(columns[name]) for name in columns]


def _said(analysis: Analysis) -> None:
    show(analysis, 1)
    assert analysis.report()
    assert analysis.notices
    assert analysis.passed is not None


def _table(analysis: Analysis, kind: str) -> None:
    analysis.include(needs((), [kind], DEFAULT, analysis.chosen))
    assert TABLES[kind](analysis) is not None


USES: dict[str, Callable[[Analysis, Path], object]] = {
    "columns": lambda analysis, _: _columns(analysis),
    "said": lambda analysis, _: _said(analysis),
    **{kind: lambda analysis, _, kind=kind: _table(analysis, kind) for kind in TABLES},  # type: ignore[misc]
    **{
        suffix: lambda analysis, folder, suffix=suffix: analysis.write(folder / f"x{suffix}")  # type: ignore[misc]
        for suffix in output_formats()
        if suffix != ".stl"
    },
}


@pytest.mark.slow
@pytest.mark.usefixtures("no_collector")
@pytest.mark.parametrize("use", USES)
def test_no_output_keeps_an_analysis(use: str, tmp_path: Path) -> None:
    """Nothing that is asked of an analysis, and nothing written of it, refers to it in a circle."""
    made = meshes.zoo("cap")
    labels = np.arange(len(made.faces)) % 2
    analysis = curvcli.analyze((made.points, made.faces), "all", regions=labels)
    try:
        USES[use](analysis, tmp_path)
    except MissingExtraError as error:
        pytest.skip(str(error))
    assert analysis.cut is not None
    objects = (analysis, analysis.surface, analysis.cut, analysis.cut.surface)
    gone = [weakref.ref(one) for one in objects]
    del analysis, objects
    assert [reference() for reference in gone] == [None] * 4


COMMANDS = (
    ["analyze", "-o", "{stem}.ply"],
    ["analyze", "--json"],
    ["check", "--format", "json"],
    ["check"],
    ["analyze"],
)


@pytest.mark.usefixtures("no_collector")
@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_one_mesh_is_let_go_before_the_next_is_read(
    command: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Many meshes in one call need the memory of one, also after one that fails."""
    from curvcli.loading import load as surfaces

    alive: list[weakref.ref[curvcli.Surface]] = []
    load = surfaces.load

    def spy(*given: Any, **options: Any) -> curvcli.Surface:
        assert [reference() for reference in alive] == [None] * len(alive)
        surface = load(*given, **options)
        alive.append(weakref.ref(surface))
        return surface

    monkeypatch.setattr(surfaces, "load", spy)
    monkeypatch.chdir(tmp_path)
    paths = [str(exact_values.MESHES[name].resolve()) for name in ("cube", "torus_irregular", "cube", "tetrahedron")]
    for number, path in enumerate(paths):
        (tmp_path / f"m{number}.obj").write_bytes(Path(path).read_bytes())
    (tmp_path / "m2.obj").write_text("v 0 0 0\nv 1 0 0\nf 1 2 7\n")
    name, *options = command
    CliRunner().invoke(cli, [name, *options, *(f"m{number}.obj" for number in range(4))], standalone_mode=False)
    assert len(alive) == 3
    assert [reference() for reference in alive] == [None] * 3


@pytest.mark.usefixtures("no_collector")
@pytest.mark.parametrize("fails", [False, True])
def test_a_worker_keeps_nothing_of_a_mesh(fails: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from curvcli.batch import run
    from curvcli.batch.model import BatchItem, BatchSettings, Limits

    alive: list[weakref.ref[Any]] = []

    def spy(analysis: Analysis, *_: Any) -> None:
        alive.append(weakref.ref(analysis))
        if fails:
            raise ValueError("a writer failed")

    monkeypatch.setattr(run, "_write", spy)
    item = BatchItem(path="cube.obj", place=str(exact_values.MESHES["cube"]))
    answer = run.run(item, BatchSettings(passes=("core",)), Limits())
    assert answer[0].status == ("error" if fails else "ok")
    assert [reference() for reference in alive] == [None]

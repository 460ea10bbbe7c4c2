"""`curvcli curves` within this process, and a file for it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.curves.shapes import Points, helix, trefoil
from tests.helpers.cli.program import Ended
from tests.helpers.cli.within import within_this


class Cli:
    """The command, as `python -m curvcli` runs it."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> None:
        self.monkeypatch, self.capfd = monkeypatch, capfd

    def run(self, *arguments: object) -> Ended:
        return within_this(self.monkeypatch, self.capfd, "curves", *arguments)

    def told(self, *arguments: object) -> dict[str, Any]:
        """The report."""
        done = self.run(*arguments, "--json")
        assert done.code == 0, done.err
        found: dict[str, Any] = json.loads(done.out)
        return found


@pytest.fixture
def cli(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Cli:
    return Cli(monkeypatch, capfd)


def polyline(path: Path, *curves: tuple[Points, bool]) -> Path:
    """An OBJ file of polylines."""
    lines, records, count = [], [], 0
    for points, closed in curves:
        lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
        index = [*range(count + 1, count + len(points) + 1)]
        records.append("l " + " ".join(map(str, index + index[:1] if closed else index)))
        count += len(points)
    path.write_text("\n".join([*lines, *records, ""]))
    return path


@pytest.fixture
def knot(tmp_path: Path) -> Path:
    return polyline(tmp_path / "knot.obj", (trefoil(80), True), (helix(20), False))

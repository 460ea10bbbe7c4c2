"""A folder as it is found in practice, and the program on it."""

from __future__ import annotations

import shutil
import signal
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pytest

from tests.helpers.cli.program import Ended
from tests.helpers.cli.within import within_this
from tests.helpers.exact_values import MESHES

GOOD = {"a.obj": "cube", "a.ply": "annulus", "deep/er/a.ply": "annulus", "deep/m.obj": "mobius"}
BAD = {"deep/empty.ply": b"", "junk.stl": b"junk", "readme.md": b"no mesh", "z.ply": b"ply\nformat ascii 1.0\n"}
ALL = sorted([*GOOD, *BAD])


Run = Callable[..., Ended]


@pytest.fixture
def scans(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder `scans`, good meshes and bad ones, in the working directory."""
    for name, sample in GOOD.items():
        path = tmp_path / "scans" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(MESHES[sample], path)
    for name, content in BAD.items():
        (tmp_path / "scans" / name).write_bytes(content)
    monkeypatch.chdir(tmp_path)
    return tmp_path / "scans"


@pytest.fixture(autouse=True)
def _signals() -> Iterator[None]:
    """Signals as a shell hands them on: the program ignores them once it is done, and children inherit that."""
    usual = {signal.SIGINT: signal.default_int_handler, signal.SIGTERM: signal.SIG_DFL}
    before = {number: signal.signal(number, handler) for number, handler in usual.items()}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Run:
    return partial(within_this, monkeypatch, capfd)


def polygon(path: Path, vertices: int) -> None:
    """A flat fan of triangles with so many vertices."""
    lines = ["v 0 0 0", *(f"v {k} {k * k} 0" for k in range(1, vertices))]
    lines += [f"f 1 {k} {k + 1}" for k in range(2, vertices)]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n")

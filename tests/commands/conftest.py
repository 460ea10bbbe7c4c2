"""The program within this process, in a folder of its own."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest

from tests.curves.conftest import cli, knot
from tests.helpers.cli.program import Ended
from tests.helpers.cli.within import within_this

__all__ = ["Run", "cli", "knot", "within"]

Run = Callable[..., Ended]


@pytest.fixture
def within(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], tmp_path: Path) -> Run:
    monkeypatch.chdir(tmp_path)
    return partial(within_this, monkeypatch, capfd)

"""The program within this process: as fast as a call, with its exit code and both streams."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from curvcli.commands.main import main
from tests.cli.program import Ended

Run = Callable[..., Ended]


@pytest.fixture
def within(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], tmp_path: Path) -> Run:
    """Run in a folder of its own; warnings, which are errors in tests, would show as a defect of the program."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments: object) -> Ended:
        capfd.readouterr()
        monkeypatch.setattr(sys, "argv", ["curvcli", *map(str, arguments)])
        with pytest.raises(SystemExit) as stop:
            main()
        out, err = capfd.readouterr()
        assert isinstance(stop.value.code, int)
        return Ended(stop.value.code, out, err)

    return call

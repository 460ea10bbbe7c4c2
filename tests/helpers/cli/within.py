"""The program within this process: as fast as a call, with its exit code and both streams."""

from __future__ import annotations

import sys

import pytest

from curvcli.commands.main import main
from tests.helpers.cli.program import Ended


def within_this(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], *arguments: object) -> Ended:
    """Run to the end; warnings, which are errors in tests, would show as a defect of the program."""
    capfd.readouterr()
    monkeypatch.setattr(sys, "argv", ["curvcli", *map(str, arguments)])
    with pytest.raises(SystemExit) as stop:
        main()
    out, err = capfd.readouterr()
    assert isinstance(stop.value.code, int)
    return Ended(stop.value.code, out, err)

"""Files that the tests of outputs write, and assertions on refusals."""

from __future__ import annotations

from pathlib import Path

import pytest

from curvcli.errors import OutputError
from curvcli.output.atomic import Outputs

OLD, NEW = b"what was there", b"what is new"


def write(*paths: str | Path, force: bool = False) -> None:
    with Outputs(paths, force) as outputs:
        for path in paths:
            with outputs.open(path) as stream:
                stream.write(NEW)


def refused(*paths: str | Path, force: bool = False) -> str:
    """The one line with which the outputs are refused before any work."""
    with pytest.raises(OutputError) as raised, Outputs(paths, force):
        raise AssertionError("the work has begun")
    assert "\n" not in str(raised.value)
    return str(raised.value)

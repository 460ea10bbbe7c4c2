"""Files made to be slow: work and memory stay in proportion to the file, whatever it holds much of."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from curvcli.loading.read import read_mesh_file
from tests.fuzz.hostile import FILES
from tests.fuzz.process import real

MEGABYTE = 10**6


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="memory of a process is told differently elsewhere")
@pytest.mark.parametrize("name", FILES)
def test_an_answer_in_time(tmp_path: Path, name: str) -> None:
    """Within a minute of processor time, and memory for the faces and the pieces of the report beside the file."""
    file = FILES[name]
    path = tmp_path / f"mesh.{file.suffix}"
    path.write_bytes(file.make(file.n))
    ran = real(["analyze", str(path), *file.options, "--json"], memory=200 * MEGABYTE + file.n * file.memory)
    assert (ran.code, ran.err) == (0, "")
    report = json.loads(ran.out)
    assert report["topology"]["faces"] > 0
    assert not [check for check in report["checks"] if check["status"] == "fail"]


@pytest.mark.parametrize("name", [name for name, file in FILES.items() if name != "swollen"])
def test_twice_the_file_is_twice_the_work(tmp_path: Path, name: str) -> None:
    """Counted in calls of Python functions while the file is read, not in seconds."""
    file = FILES[name]
    calls = []
    for n in (file.n // 8, file.n // 4):
        path = tmp_path / f"mesh.{file.suffix}"
        path.write_bytes(file.make(n))
        count = 0

        def counted(frame: object, event: str, argument: object) -> None:
            nonlocal count
            count += event == "call" or event == "c_call"

        sys.setprofile(counted)
        try:
            read_mesh_file(path)
        finally:
            sys.setprofile(None)
        calls.append(count)
    assert calls[1] < 2.5 * calls[0] + 2000

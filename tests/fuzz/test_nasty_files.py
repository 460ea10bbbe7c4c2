"""Files written by hand to be misread: each is refused in one line, or read as what it says."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.fuzz.contract import in_process
from tests.fuzz.nasty import FILES


@pytest.mark.parametrize("name", FILES)
def test_read_right_or_refused(tmp_path: Path, name: str) -> None:
    data, expected = FILES[name]
    path = tmp_path / ("mesh" + name[name.index(".", name.rindex(".obj") if ".obj" in name else name.rindex(".")) :])
    path.write_bytes(data)
    ran = in_process(["analyze", str(path), "--json"])
    assert list(tmp_path.iterdir()) == [path]
    if isinstance(expected, int):
        assert (ran.code, ran.err) == (0, "")
        assert json.loads(ran.out)["topology"]["faces"] == expected
        return
    assert (ran.code, ran.out) == (3, b"")
    assert ran.err.startswith(f"curvcli: {path}: ")
    assert expected in ran.err
    assert ran.err.count("\n") == 1
    assert len(ran.err) < 600 + len(str(path))

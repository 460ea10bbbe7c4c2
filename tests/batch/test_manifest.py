"""The manifest: what was written survives any end of the program, torn lines and damaged disks included."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from curvcli.batch.manifest import Manifest
from curvcli.batch.model import Row
from curvcli.errors import OutputError

ROWS = [
    Row(path="a.ply", sha256="1", totals={"K": 0.1 + 0.2, "H_vec": [1e-300, None, -0.0]}, topology={"closed": True}),
    Row(path="ü b\\x01.ply", status="error", exit_code=3, error="ü: broken"),
]


def written(folder: Path) -> bytes:
    with Manifest(str(folder)) as manifest:
        for row in ROWS:
            manifest.append(row)
        assert list(manifest.added().values()) == ROWS
    return (folder / "manifest.jsonl").read_bytes()


def test_rows_come_back(tmp_path: Path) -> None:
    written(tmp_path)
    with Manifest(str(tmp_path), resume=True) as manifest:
        assert list(manifest.rows.values()) == ROWS


def test_a_torn_line_is_as_if_it_were_not_there(tmp_path: Path) -> None:
    content = written(tmp_path)
    path = tmp_path / "manifest.jsonl"
    ends = [content.index(b"\n") + 1, len(content)]
    for length in range(len(content) + 1):
        path.write_bytes(content[:length])
        whole = sum(end <= length for end in ends)
        with Manifest(str(tmp_path), resume=True) as manifest:
            assert list(manifest.rows.values()) == ROWS[:whole]
            for row in ROWS[whole:]:
                manifest.append(row)
            assert list(manifest.added().values()) == ROWS[whole:]
        assert path.read_bytes() == content


def test_the_last_row_of_a_mesh_stands(tmp_path: Path) -> None:
    written(tmp_path)
    again = Row(path="a.ply", status="timeout", exit_code=3)
    with Manifest(str(tmp_path), resume=True) as manifest:
        manifest.append(again)
    with Manifest(str(tmp_path), resume=True) as manifest:
        assert manifest.rows == {"a.ply": again, ROWS[1].path: ROWS[1]}


@pytest.mark.parametrize("damage", [b"{}", b"[1]", b"\xff\xfe\x00", b'{"path": 1}', b"", b'{"path":"a","totals":[]}'])
def test_a_damaged_line_costs_its_row_only(tmp_path: Path, damage: bytes) -> None:
    content = written(tmp_path)
    (tmp_path / "manifest.jsonl").write_bytes(damage + b"\n" + content[content.index(b"\n") + 1 :])
    with Manifest(str(tmp_path), resume=True) as manifest:
        assert list(manifest.rows.values()) == ROWS[1:]


def test_folders_that_hold_something(tmp_path: Path) -> None:
    written(tmp_path)
    with pytest.raises(OutputError, match="--resume continues there, --force starts again"):
        Manifest(str(tmp_path))
    with Manifest(str(tmp_path), force=True) as manifest:
        assert manifest.rows == {}
    assert (tmp_path / "manifest.jsonl").read_bytes() == b""
    other = tmp_path / "other"
    other.mkdir()
    (other / "mine").touch()
    with pytest.raises(OutputError, match=r"no manifest\.jsonl to resume"):
        Manifest(str(other), resume=True)
    assert os.listdir(other) == ["mine"]
    with pytest.raises(OutputError, match="cannot be written"):
        Manifest(str(other / "mine"))


def test_two_at_once(tmp_path: Path) -> None:
    pytest.importorskip("fcntl", reason="locks of files are POSIX's")
    with Manifest(str(tmp_path)), pytest.raises(OutputError, match="another batch"):
        Manifest(str(tmp_path), resume=True)

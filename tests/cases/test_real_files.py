"""Every file of the collection: its exit code, its topology, its checks, and a table without a word for `undefined`."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.shared import SHARED, needs_shared


def rows() -> list[dict[str, str]]:
    if SHARED is None:
        return []
    with (SHARED / "meshes" / "index.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


ROWS = {row["file"]: row for row in rows()}

# Columns of the index and keys of the report.
TOPOLOGY = {
    "V": "vertices",
    "F": "faces",
    "components": "components",
    "chi": "euler_characteristic",
    "boundary_edges": "boundary_edges",
    "nonmanifold_edges": "nonmanifold_edges",
    "nonmanifold_vertices": "nonmanifold_vertices",
    "orientable": "orientable",
    "degenerate_faces": "degenerate_faces",
    "duplicate_faces": "duplicate_faces",
    "duplicate_vertices": "duplicate_vertices",
    "unreferenced": "unreferenced_vertices",
}

# What cannot be compared, and why.
APART = {
    ("Offset1.obj", "degenerate_faces"): "the index counts slivers whose |u × v| is above 4 ε · longest²",
    ("cornell_box.obj", "duplicate_vertices"): "the index counts unreferenced vertices too",
    ("test-nan.obj", "duplicate_vertices"): "the index counts unreferenced vertices too",
}

# Refused by the index, and read with a count of the trailing bytes.
ACCEPTED = {"HalfDonut.stl"}

# A reader that goes on into the next row of this file counts something else.
STRICT_READING = {"fuze_ascii.ply"}


def run(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    """The program itself, in this process: the exit code."""
    from curvcli.commands.main import main

    monkeypatch.setattr("sys.argv", ["curvcli", *arguments])
    with pytest.raises(SystemExit) as ended:
        main()
    assert isinstance(ended.value.code, int)
    return ended.value.code


def wanted(row: dict[str, str]) -> dict[str, int]:
    """The facts of the index that can be compared, by the report's keys."""
    left_out = {column for column in TOPOLOGY if (row["file"], column) in APART}
    if row["format"] == "stl":
        left_out.add("duplicate_vertices")  # counted before welding
    return {key: int(row[column]) for column, key in TOPOLOGY.items() if row[column] and column not in left_out}


@pytest.mark.slow
@needs_shared
@pytest.mark.parametrize("name", ROWS)
def test_a_real_file_ends_as_the_index_says(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    assert SHARED is not None
    row = ROWS[name]
    table, report = tmp_path / "t.csv", tmp_path / "r.json"
    code = run(monkeypatch, "analyze", str(SHARED / "meshes" / name), "-p", "all", "-o", str(table), "-o", str(report))
    out, err = capfd.readouterr()
    if name in ACCEPTED:
        assert code == 0, err
        return
    if row["exit"]:
        assert code == int(row["exit"]), err
    assert code in (0, 3)
    assert "Traceback" not in out + err
    if code == 3:
        assert err.startswith("curvcli: ")
        assert err.count("\n") == 1
        assert name in err
        assert not table.exists()
        assert not report.exists()
        return
    assert err == ""
    said: dict[str, Any] = json.loads(report.read_text())
    assert all(check["status"] in ("pass", "not_applicable") for check in said["checks"])
    assert all(check["detail"] for check in said["checks"])
    if name not in STRICT_READING:
        facts = wanted(row)
        assert {key: said["topology"][key] for key in facts} == facts
        if row["inconsistent_edges"]:
            found = {warning["code"]: warning["count"] for warning in said["warnings"]}
            assert found.get("inconsistent_winding", 0) == int(row["inconsistent_edges"])
            assert said["topology"]["consistent_winding"] == (row["inconsistent_edges"] == "0")
    text = table.read_text()
    assert not re.search(r"(?i)(^|,)[-+]?(nan|inf|null|none)", text, re.MULTILINE)
    assert text.count("\n") == said["input"]["vertices"] + 1


@needs_shared
def test_the_collection_is_whole() -> None:
    assert SHARED is not None
    assert len(ROWS) == 90
    missing = [name for name in ROWS if not (SHARED / "meshes" / name).is_file()]
    assert missing == []

"""A resumed batch skips only outputs that are complete to the last byte, and no output of a mesh meets another file."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path

import polars as pl
import pytest

from curvcli.batch.plan import plan
from tests.batch.conftest import Run
from tests.helpers.exact_values import MESHES

SAVE = ("--save", "csv,ply,json,edges.csv")


def rows() -> dict[str, dict[str, object]]:
    lines = map(json.loads, Path("out/manifest.jsonl").read_text().splitlines())
    return {line["path"]: line for line in lines}


def cut(path: Path) -> None:
    os.truncate(path, path.stat().st_size // 2)


def empty(path: Path) -> None:
    os.truncate(path, 0)


def flip(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[-2] ^= 1
    path.write_bytes(content)


def grow(path: Path) -> None:
    with path.open("ab") as stream:
        stream.write(b"\n")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("damage", "name"),
    [
        (cut, "a.obj.csv"),
        (empty, "a.obj.ply"),
        (flip, "a.obj.edges.csv"),
        (grow, "a.obj.json"),
        (os.unlink, "a.obj.csv"),
    ],
)
def test_an_output_that_is_not_what_was_written_is_made_again(
    scans: Path, run: Run, damage: Callable[[Path], None], name: str
) -> None:
    assert run("batch", "scans/a.*", "-o", "out", *SAVE, "-q", "-j", 1).code == 0
    summaries = Path("out/summary.csv").read_bytes(), Path("out/summary.parquet").read_bytes()
    for row in rows().values():
        outputs = row["outputs"]
        assert isinstance(outputs, list)
        for one in outputs:
            content = Path("out", one["path"]).read_bytes()
            assert (one["bytes"], one["sha256"]) == (len(content), hashlib.sha256(content).hexdigest())
    whole = Path("out", name).read_bytes()
    damage(Path("out", name))
    again = run("batch", "scans/a.*", "-o", "out", *SAVE, "--resume", "-j", 1)
    assert again.code == 0
    assert "1 unchanged" in again.out
    if not name.endswith(".json"):  # which holds times
        assert Path("out", name).read_bytes() == whole
    assert json.loads(Path("out/a.obj.json").read_text())["topology"]["closed"]
    assert (Path("out/summary.csv").read_bytes(), Path("out/summary.parquet").read_bytes()) == summaries
    assert "2 unchanged" in run("batch", "scans/a.*", "-o", "out", *SAVE, "--resume", "-j", 1).out


def test_a_manifest_without_hashes_proves_nothing(scans: Path, run: Run) -> None:
    assert run("batch", "scans/a.*", "-o", "out", "--save", "csv", "-q", "-j", 1).code == 0
    old = [row | {"outputs": [f"{Path(path).name}.csv"]} for path, row in rows().items()]
    Path("out/manifest.jsonl").write_text("".join(f"{json.dumps(row)}\n" for row in old))
    cut(Path("out/a.obj.csv"))
    assert run("batch", "scans/a.*", "-o", "out", "--save", "csv", "--resume", "-q", "-j", 1).code == 0
    assert pl.read_csv("out/a.obj.csv").height == 8


@pytest.mark.slow
@pytest.mark.parametrize("name", ["summary", "SUMMARY", "Summary", "manifest", "summary.csv", "summary.parquet"])
def test_a_mesh_that_is_called_like_the_files_of_the_batch(
    tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in").mkdir()
    shutil.copy(MESHES["cube"], tmp_path / "in" / name)
    ended = run("batch", "in/*", "-o", "out", "--save", "csv,parquet,edges.csv", "--input-format", "obj", "-j", 1, "-q")
    assert (ended.code, ended.err) == (0, "")
    assert pl.read_csv("out/summary.csv")["path"].to_list() == [f"in/{name}"]
    assert pl.read_parquet("out/summary.parquet").height == 1
    (row,) = rows().values()
    outputs = row["outputs"]
    assert isinstance(outputs, list)
    assert len(outputs) == 3
    for output in outputs:
        content = Path("out", output["path"]).read_bytes()
        assert hashlib.sha256(content).hexdigest() == output["sha256"]
        assert output["path"].casefold() not in ("summary.csv", "summary.parquet", "manifest.jsonl")


TREES = (
    ["summary.csv/a", "summary.parquet/b/c", "manifest.jsonl/d", "Summary.CSV/a"],
    ["a", "a.csv/b", "A.csv/b", "a.csv/b.csv/c", "a.csv/b"],
    ["a.csv/b", "a", "a.edges.csv/x/y", "a~2"],
    ["a.csv~2/b", "a", "a.csv/b"],
    ["x.csv/y.csv/z", "x.csv/y", "x"],
)


@pytest.mark.parametrize("names", TREES)
def test_files_and_folders_never_meet(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: list[str]) -> None:
    monkeypatch.chdir(tmp_path)
    Path("list").write_text("".join(f"in/{name}\n" for name in dict.fromkeys(names)) + "in/last\n")
    items = plan([], "list", "out", ["csv", "edges.csv"])
    out = str(tmp_path / "out")
    own = {os.path.join(out, name) for name in ("summary.csv", "summary.parquet", "manifest.jsonl")}
    written = [path.casefold() for item in items for _, path in item.outputs]
    files = {path.casefold() for path in own} | set(written)
    assert len(files) == len(own) + len(written)
    folders = {str(folder) for path in files for folder in Path(path).parents}
    assert not files & folders
    assert all(path.startswith(out.casefold() + os.sep) for path in written)

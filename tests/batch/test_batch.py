"""The command on a folder of good and bad meshes: every one accounted for, equal runs equal, nothing done twice."""

from __future__ import annotations

import csv
import io
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import msgspec
import polars as pl
import pytest

import curvcli
from curvcli.batch import outcome, processes
from curvcli.batch.batch import Batch
from curvcli.batch.locations import hash_of
from curvcli.batch.manifest import Manifest
from curvcli.batch.model import BatchSettings, Limits, Row
from curvcli.batch.plan import plan
from curvcli.errors import InputError, OutputError, exit_code
from tests.batch.conftest import ALL, BAD, GOOD, Run
from tests.helpers.cli.program import environment
from tests.helpers.shared import SHARED, needs_shared

SAVE = ("--save", "csv,json,ply,edges.csv")


def manifest(folder: str) -> dict[str, dict[str, Any]]:
    lines = Path(folder, "manifest.jsonl").read_text().splitlines()
    rows = [json.loads(line) for line in lines]
    return {row["path"]: row for row in rows}


def files(folder: str) -> set[str]:
    return {str(path.relative_to(folder)) for path in Path(folder).rglob("*") if path.is_file()}


def summary(folder: str) -> bytes:
    return Path(folder, "summary.csv").read_bytes()


def test_everything_is_accounted_for(scans: Path, run: Run) -> None:
    ended = run("batch", "scans/**/*", "-o", "out", *SAVE, "-j", 2)
    assert ended.code == 3
    assert len(ended.err.splitlines()) == len(BAD)
    assert "8 of 8 meshes" in ended.out
    rows = manifest("out")
    assert set(rows) == {f"scans/{name}" for name in ALL}
    for name in BAD:
        row = rows[f"scans/{name}"]
        assert (row["status"], row["exit_code"], row["outputs"]) == ("error", 3, [])
        assert f"curvcli: {row['error']}" in ended.err.splitlines()
        assert row["error"].startswith(f"scans/{name}: ")
    suffixes = ("csv", "json", "ply", "edges.csv")
    wanted = {f"{name}.{suffix}" for name in GOOD for suffix in suffixes}
    assert files("out") == wanted | {"manifest.jsonl", "summary.csv", "summary.parquet"}
    table = pl.read_csv("out/summary.csv")
    assert table["path"].to_list() == [f"scans/{name}" for name in ALL]
    assert table.equals(pl.read_parquet("out/summary.parquet").cast(dict(table.schema)))
    for name in GOOD:
        row = rows[f"scans/{name}"]
        assert (row["status"], row["exit_code"], row["error"]) == ("ok", 0, None)
        assert row["seconds"] > 0
        assert row["memory"] is None or row["memory"] > 1 << 20
        alone = curvcli.analyze(scans / name)
        for suffix in ("csv", "ply"):
            alone.write(f"alone.{suffix}", force=True)
            assert Path(f"alone.{suffix}").read_bytes() == Path("out", f"{name}.{suffix}").read_bytes()
        report = json.loads(Path("out", f"{name}.json").read_text())
        assert report["input"]["path"] == f"scans/{name}"
        assert report["input"]["sha256"] == row["sha256"]
        (line,) = table.filter(pl.col("path") == f"scans/{name}").to_dicts()
        for key, value in alone.report()["topology"].items():
            assert line[f"topology.{key}"] == value
        for key in ("area", "K", "willmore", "kappa_g"):
            assert line[f"totals.{key}"] == alone.totals[key]
        assert {line[f"checks.{check.name}.status"] for check in alone.checks} <= {"pass", "not_applicable"}
    once = summary("out"), Path("out/summary.parquet").read_bytes()

    # One worker, another order of ending and nothing saved: the same bytes.
    assert run("batch", "scans/**/*", "-o", "one", "-j", 1, "-q").code == 3
    assert (summary("one"), Path("one/summary.parquet").read_bytes()) == once

    # Nothing is left to do.
    before = {name: os.stat(Path("out", name)).st_mtime_ns for name in files("out") - {"summary.csv"}}
    again = run("batch", "scans/**/*", "-o", "out", *SAVE, "--resume", "--strict")
    assert (again.code, again.err) == (3, "")
    assert "8 unchanged" in again.out
    after = {name: os.stat(Path("out", name)).st_mtime_ns for name in before}
    assert [name for name in before if before[name] != after[name]] == ["summary.parquet"]
    assert summary("out") == once[0]


@pytest.mark.slow
def test_resume_does_what_changed(scans: Path, run: Run) -> None:
    assert run("batch", "scans/*.*", "-o", "out", "--save", "csv", "-q").code == 3
    first = manifest("out")

    def done() -> set[str]:
        """Names of the meshes that the run did, by the lines it added to the manifest."""
        lines = Path("out/manifest.jsonl").read_text().splitlines()[len(first) :]
        Path("out/manifest.jsonl").write_text("".join(f"{json.dumps(row)}\n" for row in manifest("out").values()))
        return {json.loads(line)["path"] for line in lines}

    (scans / "a.obj").write_bytes((scans / "deep" / "m.obj").read_bytes())
    Path("out/a.ply.csv").unlink()
    assert run("batch", "scans/*.*", "-o", "out", "--save", "csv", "-q", "--resume").code == 3
    assert done() == {"scans/a.obj", "scans/a.ply"}
    assert pl.read_csv("out/summary.csv")["topology.orientable"].to_list()[:2] == [False, True]
    assert run("batch", "scans/*.*", "-o", "out", "--save", "csv", "-q", "--resume", "--timeout", 99).code == 3
    assert done() == set()
    assert run("batch", "scans/*.*", "-o", "out", "--save", "csv", "-q", "--resume", "--mean", "average").code == 3
    assert done() == set(first)


@pytest.mark.parametrize(
    ("status", "code", "again"),
    [
        ("ok", 0, False),
        ("failed_checks", 1, False),
        ("error", 3, False),
        ("error", 4, True),
        ("error", 70, True),
        ("timeout", 3, True),
        ("out_of_memory", 3, True),
        ("out_of_memory", 70, True),
        ("crashed", 70, True),
    ],
)
def test_what_may_go_better_another_time_is_done_again(scans: Path, status: Any, code: int, again: bool) -> None:
    (item,) = plan(["scans/a.obj"], None, "out", [])
    how = BatchSettings(passes=("K",))
    row = Row(path=item.path, sha256=hash_of(item.place), options=how.digest(), status=status, exit_code=code)
    with Manifest("out") as manifest:
        manifest.append(row)
    with Manifest("out", resume=True) as manifest:
        assert Batch([item], how, "out", manifest).todo() == [item] * again
        for changed in ({"sha256": None}, {"sha256": "0"}, {"options": "0"}, {"version": "0"}, {"path": "a.obj"}):
            old = msgspec.structs.replace(row, **changed)
            manifest.rows = {old.path: old}
            assert Batch([item], how, "out", manifest).todo() == [item]


def test_a_failed_check_fails_the_batch_only_when_strict(
    scans: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert run("batch", "scans/a.*", "-o", "out", "-q").code == 0
    path = Path("out/manifest.jsonl")
    rows = manifest("out")
    rows["scans/a.obj"]["status"] = "failed_checks"
    path.write_text("".join(f"{json.dumps(row)}\n" for row in rows.values()))
    for more, code in ((["--strict"], 1), ([], 0), (["--strict"], 1)):
        ended = run("batch", "scans/a.*", "-o", "out", "--resume", *more)
        assert ended.code == code
        assert "failed checks" in ended.out
        assert pl.read_csv("out/summary.csv")["exit_code"].to_list() == [code, 0]


def test_refused_before_any_work(scans: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    Path("full").mkdir()
    Path("full/mine").touch()
    Path("list").touch()
    for code, arguments in (
        (4, ["scans/*", "-o", "full"]),
        (4, ["scans/*", "-o", "full", "--resume"]),
        (4, ["scans/*", "-o", "list"]),
        (5, ["scans/*.xyz", "-o", "new"]),
        (5, ["-o", "new", "--files-from", "list"]),
        (3, ["-o", "new", "--files-from", "none"]),
        (2, ["-o", "new"]),
        (2, ["scans/*"]),
        (2, ["scans/*", "-o", "new", "--save", "cvs"]),
        (2, ["scans/*", "-o", "new", "-p", "Kay"]),
        (2, ["scans/*", "-o", "new", "--save", "regions.csv"]),
        (2, ["scans/*", "-o", "new", "--resume", "--force"]),
        (2, ["scans/*", "-o", "new", "--timeout", "0"]),
        (2, ["scans/*", "-o", "new", "-j", "0"]),
        (2, ["scans/*", "-o", "new", "--scheduler", "local:2", "-j", "2"]),
    ):
        ended = run("batch", *arguments)
        assert (ended.code, ended.out, len(ended.err.splitlines())) == (code, "", 1), arguments
        assert not Path("new").exists()
    assert os.listdir("full") == ["mine"]


def test_a_list_on_stdin_and_force(scans: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    Path("out").mkdir()
    Path("out/old").touch()
    names = b"scans/deep/m.obj\0scans/missing.ply\0scans/a.obj\0"
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(names)))
    ended = run("batch", "-o", "out", "--files-from", "-", "--save", "csv", "--force", "--max-faces", 100)
    assert ended.code == 3
    table = pl.read_csv("out/summary.csv")
    assert table["path"].to_list() == ["scans/deep/m.obj", "scans/missing.ply", "scans/a.obj"]
    assert table["error"].to_list()[1] == "scans/missing.ply: no such file"
    assert "--max-faces sets the limit" in table["error"].to_list()[0]
    assert files("out") == {"old", "a.obj.csv", "manifest.jsonl", "summary.csv", "summary.parquet"}


def test_an_output_that_cannot_be_written_is_its_own_row(scans: Path, run: Run) -> None:
    Path("out/a.ply.csv").mkdir(parents=True)
    ended = run("batch", "scans/a.*", "-o", "out", "--save", "csv", "--force")
    assert ended.code == 4
    assert {row["path"]: row["exit_code"] for row in manifest("out").values()} == {"scans/a.obj": 0, "scans/a.ply": 4}
    assert Path("out/a.obj.csv").is_file()
    Path("out/a.ply.csv").rmdir()
    assert run("batch", "scans/a.*", "-o", "out", "--save", "csv", "--resume", "-q").code == 0
    assert Path("out/a.ply.csv").is_file()


def test_codes_are_those_of_the_program() -> None:
    for error in (InputError("x"), OutputError("x"), ZeroDivisionError("x")):
        with pytest.raises(type(error)) as raised:
            raise error
        assert outcome.explained("p", raised.value, Limits()).exit_code == exit_code(error)
    assert msgspec.json.decode(msgspec.json.encode(Row(path="x")), type=Row) == Row(path="x")


@pytest.mark.slow
def test_workers_start_before_what_only_the_parent_waits_for(scans: Path) -> None:
    """Two of them for many meshes, one for one mesh, none that a resumed batch may not need."""
    program = """
import sys
from curvcli.batch import processes
from curvcli.commands.main import main
start = processes._start
def told():
    print("scipy" in sys.modules, "polars" in sys.modules)
    return start()
processes._start = told
main()
"""

    def starts(*arguments: str) -> list[str]:
        line = [sys.executable, "-c", program, "batch", *arguments, "-o", "out", "-q", "-j", "2"]
        done = subprocess.run(line, capture_output=True, text=True, env=environment(), timeout=120)
        assert done.stderr == ""
        return done.stdout.splitlines()

    assert starts("scans/a.*") == ["False False"] * 2
    assert starts("scans/a.*", "--resume") == []
    assert starts("scans/a.obj", "--force") == ["False False"]


def test_workers_that_started_in_vain_are_gone(scans: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[subprocess.Popen[bytes]] = []
    start = processes._start

    def watched() -> subprocess.Popen[bytes]:
        started.append(start())
        return started[-1]

    monkeypatch.setattr(processes, "_start", watched)
    assert run("batch", "scans/a.*", "-o", "out", "-p", "nothing").code == 2
    assert started
    assert all(process.poll() is not None for process in started)
    assert not Path("out").exists()


def test_bars_stay_off_pipes_and_quiet_is_quiet(scans: Path, run: Run) -> None:
    assert run("batch", "scans/a.*", "-o", "out", "-q") == (0, "", "")
    ended = run("batch", "scans/a.*", "-o", "out", "--resume")
    assert "\x1b" not in ended.out + ended.err
    with Manifest("out", resume=True):
        locked = run("batch", "scans/a.*", "-o", "out", "--resume")
    assert (locked.code, locked.out) == (4, "")


# Refused by the index, and read with a count of the trailing bytes.
ACCEPTED = ("HalfDonut.stl",)


@needs_shared
def test_the_collection_ends_as_its_index_says(tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    """Real files, whole and broken: every one has its row and its code, and the table that a single run writes."""
    assert SHARED is not None
    monkeypatch.chdir(tmp_path)
    with (SHARED / "meshes" / "index.csv").open(newline="") as stream:
        promised = {row["file"]: row["exit"] for row in csv.DictReader(stream)}
    ended = run("batch", str(SHARED / "meshes" / "*"), "-o", "out", "--save", "csv", "-q")
    rows = {Path(path).name: row for path, row in manifest("out").items()}
    assert set(rows) == set(os.listdir(SHARED / "meshes")) >= set(promised)
    for name, code in promised.items():
        code = "0" if name in ACCEPTED else code
        assert str(rows[name]["exit_code"]) == code or not code, rows[name]["error"]
    assert ended.code == max(row["exit_code"] for row in rows.values())
    for name in sorted(promised)[::7]:
        if rows[name]["exit_code"] == 0:
            curvcli.analyze(SHARED / "meshes" / name).write("alone.csv", force=True)
            assert Path("alone.csv").read_bytes() == Path("out", f"{name}.csv").read_bytes()
        else:
            with pytest.raises(InputError):
                curvcli.load(SHARED / "meshes" / name)

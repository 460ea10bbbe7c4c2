"""The same input and options give the same bytes, however many threads there are, timings apart."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.helpers.cli.program import command, environment

NAMES = ("k.csv", "k.tsv", "k.parquet", "k.npz", "k.ply", "k.obj", "k.json")
TABLES = ("edges", "faces", "components")


def outputs(mesh: Path, names: tuple[str, ...], folder: Path, threads: int, passes: str) -> dict[str, bytes]:
    folder.mkdir()
    arguments = [word for name in names for word in ("-o", str(folder / name))]
    if passes == "all":
        arguments += [word for kind in TABLES for word in ("--table", f"{kind}={folder / kind}.csv")]
    counts = dict.fromkeys(("POLARS_MAX_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), str(threads))
    line = command("analyze", mesh, "-q", "-p", passes, *arguments)
    if threads == 1 and shutil.which("taskset"):
        line = ["taskset", "-c", str(min(os.sched_getaffinity(0))), *line]
    done = subprocess.run(line, capture_output=True, env=environment(**counts), timeout=300)
    assert (done.returncode, done.stderr) == (0, b"")
    found = {path.name: path.read_bytes() for path in folder.iterdir()}
    report = json.loads(found["k.json"])
    assert report.pop("timings")
    return found | {"k.json": json.dumps(report).encode()}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("size", "suffix", "passes", "names"),
    [
        ("middling", "ply", "core", NAMES),
        ("middling", "obj", "core", ("k.csv", "k.json")),
        ("small", "ply", "all", NAMES),
    ],
)
def test_threads_do_not_matter(
    size: str,
    suffix: str,
    passes: str,
    names: tuple[str, ...],
    middling: dict[str, Path],
    small: Path,
    tmp_path: Path,
) -> None:
    mesh = small if size == "small" else middling[suffix]
    one = outputs(mesh, names, tmp_path / "one", 1, passes)
    two = outputs(mesh, names, tmp_path / "two", 2, passes)
    again = outputs(mesh, names, tmp_path / "again", 2, passes)
    for name in one:
        assert one[name] == two[name], f"{name} depends on the number of threads"
        assert again[name] == two[name], f"{name} differs from run to run"


def test_the_order_of_sets_does_not_matter(small: Path, tmp_path: Path) -> None:
    line = command("analyze", small, "--rings", "1,3", "--get", "totals")
    reports = {
        subprocess.run(line, capture_output=True, env=environment(PYTHONHASHSEED=seed), check=True).stdout
        for seed in ("0", "1", "2")
    }
    assert len(reports) == 1

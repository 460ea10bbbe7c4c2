"""A Dask cluster does the same plan: a real scheduler and worker processes on loopback, one of them killed at work."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

from curvcli.batch import dask
from curvcli.batch.model import Limits
from curvcli.errors import MissingExtraError, UsageError
from tests.batch.conftest import Run, polygon
from tests.batch.test_faults import command, good, told, trapped
from tests.batch.test_faults import run as shell

distributed = pytest.importorskip("distributed", reason="curvcli[dask] is not installed")

__all__ = ["trapped"]


class Cluster(NamedTuple):
    address: str
    workers: set[int]


@pytest.fixture
def cluster(tmp_path: Path, trapped: dict[str, str]) -> Iterator[Cluster]:
    """A scheduler and two workers with one thread each, every one a process of its own."""
    trapped["TRAP_TOKEN"] = str(tmp_path / "token")
    started: list[subprocess.Popen[str]] = []

    def start(module: str, *arguments: str) -> subprocess.Popen[str]:
        line = [sys.executable, "-m", f"distributed.cli.{module}", *arguments, "--no-dashboard", "--host", "127.0.0.1"]
        log = (tmp_path / f"{module}-{len(started)}.log").open("w+")
        started.append(subprocess.Popen(line, env=trapped, cwd=tmp_path, text=True, stdout=subprocess.PIPE, stderr=log))
        log.close()
        return started[-1]

    try:
        start("dask_scheduler", "--port", "0", "--scheduler-file", "scheduler.json")
        workers = [start("dask_worker", "--scheduler-file", "scheduler.json", "--no-nanny", "--nthreads", "1")]
        workers += [start("dask_worker", "--scheduler-file", "scheduler.json", "--no-nanny", "--nthreads", "1")]
        # The workers wait for the file, so it is there once one has come up; Dask's own client waits for both.
        with distributed.Client(scheduler_file=str(tmp_path / "scheduler.json"), set_as_default=False) as client:
            client.wait_for_workers(2, timeout=60)
            address = client.scheduler.address
        yield Cluster(address, {worker.pid for worker in workers})
    finally:
        for process in started:
            process.kill()
            process.communicate()


@pytest.mark.slow
def test_a_killed_worker_costs_a_retry_and_the_summary_is_the_same(
    tmp_path: Path, trapped: dict[str, str], cluster: Cluster
) -> None:
    good(tmp_path / "scans")
    polygon(tmp_path / "scans" / "3.obj", 13)
    (tmp_path / "scans" / "bad.stl").write_bytes(b"junk")
    assert shell(trapped, tmp_path, "whole", "-j", "2").returncode == 3

    (tmp_path / "token").touch()
    line = command(tmp_path, "out", "--scheduler", cluster.address)
    process = subprocess.Popen(line, env=trapped, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        worker, _ = told(trapped, tmp_path, process)
        assert worker in cluster.workers
        os.kill(worker, signal.SIGKILL)
        out, err = process.communicate(timeout=100)
    finally:
        process.kill()
        process.communicate()
    assert process.returncode == 3, err
    assert err.startswith(f"curvcli: {tmp_path}/scans/bad.stl: ")
    assert err.count("\n") == 1
    assert "6 of 6 meshes" in out
    for name in ("summary.csv", "summary.parquet", *(path.name for path in (tmp_path / "whole").glob("*.csv"))):
        assert (tmp_path / "out" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()


@pytest.mark.slow
def test_local_workers_give_the_same_tables(scans: Path, run: Run) -> None:
    ended = run("batch", "scans/**/*", "-o", "out", "--save", "csv", "--scheduler", "local:2", "-q")
    assert ended.code == 3
    assert run("batch", "scans/**/*", "-o", "one", "--save", "csv", "-q").code == 3
    for path in Path("one").rglob("*.csv"):
        assert path.read_bytes() == ("out" / path.relative_to("one")).read_bytes()


@pytest.mark.parametrize("address", ["local:0", "local:two", "local:", "host:8786", "ftp://host", "tcp://127.0.0.1:1"])
def test_addresses_that_lead_nowhere(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dask, "_WAIT", 0.3)
    with pytest.raises(UsageError, match=address), dask.connect(address, Limits()):
        pass


def test_other_versions_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    class Client:
        def run(self, function: object, on_error: str) -> dict[str, object]:
            return {"one": dask.__version__, "two": "0.0.1", "three": ModuleNotFoundError("No module named 'curvcli'")}

    with pytest.raises(UsageError, match=r"0\.0\.1, No module named 'curvcli' on the workers"):
        dask._check_versions(Client(), "tcp://host:8786")


def test_without_dask_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'curvcli\[dask\]'"), dask.connect("local:1", Limits()):
        pass

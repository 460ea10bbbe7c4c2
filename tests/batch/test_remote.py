"""Meshes that are not files here: in the memory of fsspec, and on a server on loopback."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import polars as pl
import pytest

import curvcli
from tests.batch.conftest import BAD, GOOD, Run

fsspec = pytest.importorskip("fsspec", reason="curvcli[remote] is not installed")


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_: object) -> None:
        """Nothing."""


@pytest.fixture
def server(scans: Path) -> Iterator[str]:
    """The folder that holds `scans`, served."""
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(scans.parent))) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()
        thread.join()


def analysed_alone(folder: str, scans: Path, names: list[str]) -> None:
    """The tables of the batch are those of single runs."""
    for name in names:
        curvcli.analyze(scans / name).write("alone.csv", force=True)
        assert Path("alone.csv").read_bytes() == Path(folder, f"{name}.csv").read_bytes()


def test_meshes_in_memory_are_analysed(scans: Path, run: Run) -> None:
    memory = fsspec.filesystem("memory")
    memory.store.clear()
    for name in (*GOOD, "z.ply"):
        memory.pipe(f"/scans/{name}", (scans / name).read_bytes())
    ended = run("batch", "memory://scans/**/*", "-o", "out", "--save", "csv", "-j", 2)
    assert ended.code == 3
    analysed_alone("out", scans, list(GOOD))
    table = pl.read_csv("out/summary.csv")
    assert table["path"].to_list() == [f"memory:///scans/{name}" for name in sorted([*GOOD, "z.ply"])]
    memory.pipe("/scans/a.obj", (scans / "a.ply").read_bytes())
    again = run("batch", "memory://scans/**/*", "-o", "out", "--save", "csv", "--resume")
    assert "4 unchanged" in again.out
    assert run("batch", "memory://scans/*.xyz", "-o", "new").code == 5
    memory.store.clear()


@pytest.mark.slow
def test_meshes_on_a_server_are_analysed(scans: Path, run: Run, server: str) -> None:
    pytest.importorskip("aiohttp", reason="curvcli[remote] is not installed")
    Path("list").write_text("".join(f"{server}/scans/{name}\n" for name in (*GOOD, *BAD, "missing.ply")))
    ended = run("batch", "-o", "out", "--save", "csv", "--files-from", "list", "-j", 2)
    assert ended.code == 3
    analysed_alone("out", scans, list(GOOD))
    table = pl.read_csv("out/summary.csv")
    assert table["exit_code"].to_list() == [0] * len(GOOD) + [3] * (len(BAD) + 1)
    assert table["error"].to_list()[-1] == f"{server}/scans/missing.ply: no such file"
    # The same files here and there tell the same, but for their names.
    assert run("batch", *(f"scans/{name}" for name in (*GOOD, *BAD)), "-o", "here", "-q").code == 3
    here = pl.read_csv("here/summary.csv").drop("path", "error")
    assert here.equals(table.head(len(here)).drop("path", "error"))
    again = run("batch", "-o", "out", "--save", "csv", "--files-from", "list", "--resume")
    assert f"{len(GOOD)} unchanged" in again.out


def test_a_pattern_matches_the_listing_of_a_server(scans: Path, run: Run, server: str) -> None:
    pytest.importorskip("aiohttp", reason="curvcli[remote] is not installed")
    assert run("batch", f"{server}/scans/a.*", "-o", "out", "--save", "csv").code == 0
    analysed_alone("out", scans, ["a.obj", "a.ply"])
    refused = run("batch", "http://127.0.0.1:1/*.ply", "-o", "new")
    assert (refused.code, refused.out) == (3, "")
    assert "cannot be listed" in refused.err
    assert run("batch", "what://127.0.0.1/*.ply", "-o", "new").code == 2
    assert not Path("new").exists()

"""Faults in a batch: meshes that kill or hang their worker or eat its memory, and ends of the program at any moment."""

from __future__ import annotations

import contextlib
import os
import select
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import polars as pl
import pytest

import curvcli
from tests.batch.conftest import polygon
from tests.curvatures.test_plugin import install
from tests.helpers.cli.program import environment
from tests.helpers.exact_values import MESHES

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals and named pipes are POSIX's")

# Harm by number of vertices. The one that hangs does so once for a token, if one is named: it tells its parent's
# number into a named pipe first.
TRAP = '''
import os, signal, threading
import numpy as np
from curvcli.declare import curvature_pass

def hang():
    token = os.environ.get("TRAP_TOKEN")
    if token is not None:
        try:
            os.unlink(token)
        except FileNotFoundError:
            return
        with open(os.environ["TRAP_TOLD"], "w") as pipe:
            pipe.write(f"{os.getppid()} {os.getpid()}\\n")
    threading.Event().wait()

HARM = {
    11: lambda: os._exit(3),
    12: lambda: os.kill(os.getpid(), signal.SIGKILL),
    13: hang,
    14: lambda: np.ones(1 << 31, np.uint8),
    15: lambda: 1 / 0,
}

@curvature_pass(
    symbol="t", formula="0", length_exponent=0, preserves="nothing: a trap", boundary="0", source="the tests",
)
def trap(surface):
    """Harm done to the process that computes it."""
    HARM.get(surface.n_vertices, int)()
    return np.zeros(surface.n_vertices)
'''


@pytest.fixture
def trapped(tmp_path: Path) -> dict[str, str]:
    """The environment in which `-p trap` is there."""
    (tmp_path / "plug-in").mkdir()
    os.mkfifo(tmp_path / "told")
    more = {"TRAP_TOLD": str(tmp_path / "told"), "PYTHONDONTWRITEBYTECODE": "1"}
    return install(tmp_path / "plug-in", TRAP) | more


def good(folder: Path) -> None:
    folder.mkdir()
    for name, sample in (("1.obj", "cube"), ("2.ply", "annulus"), ("4.obj", "mobius"), ("5.obj", "tetrahedron")):
        shutil.copy(MESHES[sample], folder / name)


def command(folder: Path, out: str, *more: str) -> list[str]:
    meshes = str(folder / "scans" / "*")
    start = [sys.executable, "-m", "curvcli", "batch", meshes, "-o", str(folder / out), "-p", "core,trap"]
    return [*start, "--save", "csv", *more]


def run(environment: dict[str, str], folder: Path, out: str, *more: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        command(folder, out, *more), capture_output=True, text=True, env=environment, timeout=120, check=False
    )


def told(environment: dict[str, str], folder: Path, process: subprocess.Popen[bytes]) -> list[int]:
    """Process numbers that the hanging mesh writes: of its worker's parent and of the worker."""
    with open(os.open(environment["TRAP_TOLD"], os.O_RDONLY | os.O_NONBLOCK), "rb") as pipe:
        assert select.select([pipe], [], [], 60)[0], "the trap was not reached"
        assert process.poll() is None
        os.set_blocking(pipe.fileno(), True)
        return [int(number) for number in pipe.readline().split()]


@pytest.mark.slow
def test_harm_costs_the_mesh_that_does_it_only(tmp_path: Path, trapped: dict[str, str]) -> None:
    good(tmp_path / "scans")
    for vertices in range(11, 16):
        polygon(tmp_path / "scans" / f"2-{vertices}.obj", vertices)
    more = ["--max-memory", "1000"] if sys.platform == "linux" else []
    ended = run(trapped, tmp_path, "out", "-j", "2", "--timeout", "1.5", *more)
    assert ended.returncode == 70, ended
    table = pl.read_csv(tmp_path / "out" / "summary.csv", schema_overrides={"error": pl.String})
    rows = {Path(row["path"]).name: (row["status"], row["exit_code"], row["error"]) for row in table.to_dicts()}
    path = tmp_path / "scans"
    assert rows == {
        "1.obj": ("ok", 0, None),
        "2-11.obj": ("crashed", 70, f"{path}/2-11.obj: the worker ended with exit code 3"),
        "2-12.obj": (
            "crashed",
            70,
            f"{path}/2-12.obj: the worker was ended by SIGKILL; out of memory? try fewer jobs at once (-j)",
        ),
        "2-13.obj": ("timeout", 3, f"{path}/2-13.obj: takes longer than the 1.5 s allowed; --timeout sets the limit"),
        "2-14.obj": rows["2-14.obj"],
        "2-15.obj": rows["2-15.obj"],
        "2.ply": ("ok", 0, None),
        "4.obj": ("ok", 0, None),
        "5.obj": ("ok", 0, None),
    }
    if more:
        too_much = f"{path}/2-14.obj: needs more memory than --max-memory allows; raise the limit"
        assert rows["2-14.obj"] == ("out_of_memory", 3, too_much)
    status, code, error = rows["2-15.obj"]
    assert (status, code) == ("error", 70)
    assert "internal error: ZeroDivisionError: division by zero (curvcli_example.py:" in error
    assert sorted(ended.stderr.splitlines()) == sorted(f"curvcli: {row[2]}" for row in rows.values() if row[2])


@pytest.mark.slow
@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGINT])
def test_an_end_at_any_moment_changes_nothing(tmp_path: Path, trapped: dict[str, str], end: signal.Signals) -> None:
    good(tmp_path / "scans")
    polygon(tmp_path / "scans" / "3.obj", 13)
    trapped |= {"TRAP_TOKEN": str(tmp_path / "token")}
    whole = run(trapped, tmp_path, "whole", "-j", "1")
    assert (whole.returncode, whole.stderr) == (0, "")

    (tmp_path / "token").touch()
    process = subprocess.Popen(
        command(tmp_path, "out", "-j", "2"),
        env=trapped,
        start_new_session=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
    )
    try:
        told(trapped, tmp_path, process)
        os.killpg(process.pid, end)
        said = process.communicate(timeout=60)[1].decode()
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
    if end == signal.SIGKILL:
        assert process.returncode == -signal.SIGKILL
        assert not (tmp_path / "out" / "summary.csv").exists()
        # As if it had been killed while it wrote.
        with (tmp_path / "out" / "manifest.jsonl").open("ab") as stream:
            stream.write(b'{"path": "torn')
        (tmp_path / "out" / ".curvcli-0123456789abcdef.part").touch()
    else:
        assert (process.returncode, said) == (130, "curvcli: interrupted\n")
        finished = pl.read_csv(tmp_path / "out" / "summary.csv")["path"].to_list()
        assert str(tmp_path / "scans" / "3.obj") not in finished
        assert len(finished) == len((tmp_path / "out" / "manifest.jsonl").read_bytes().splitlines())

    resumed = run(trapped, tmp_path, "out", "-j", "1", "--resume")
    assert (resumed.returncode, resumed.stderr) == (0, "")
    files = {path.name for path in (tmp_path / "whole").iterdir()}
    assert {path.name for path in (tmp_path / "out").iterdir()} == files
    for name in files - {"manifest.jsonl"}:
        assert (tmp_path / "out" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()


def test_a_worker_does_not_outlive_its_parent(tmp_path: Path, trapped: dict[str, str]) -> None:
    (tmp_path / "scans").mkdir()
    polygon(tmp_path / "scans" / "3.obj", 13)
    (tmp_path / "token").touch()
    trapped |= {"TRAP_TOKEN": str(tmp_path / "token")}
    # Whoever holds the other end of this pipe is alive; workers inherit it.
    reader, writer = os.pipe()
    process = subprocess.Popen(command(tmp_path, "out"), env=trapped, stderr=writer, stdout=writer)
    os.close(writer)
    parent, _ = told(trapped, tmp_path, process)
    assert parent == process.pid
    process.kill()
    process.wait()
    with open(reader, "rb") as pipe:
        assert pipe.read() == b""


ONE_AFTER_THE_OTHER = """
import os, sys
from curvcli.commands.allocation import keep_memory
keep_memory()
from curvcli.batch.model import BatchItem, BatchSettings, Limits
from curvcli.batch.run import run
from curvcli.support.memory import limit_address_space
from curvcli.curvatures.catalogue import load_passes
from curvcli.loading.libraries import import_libraries, start_polars
load_passes()
import_libraries()
start_polars()
LIMIT = int(sys.argv[2]) << 20
limit_address_space(LIMIT)
for number in range(3):
    outputs = (("", os.path.abspath(f"{number}.ply")),)
    item = BatchItem(path="m", place=sys.argv[1], outputs=outputs)
    print(run(item, BatchSettings(passes=("core",)), Limits(None, LIMIT))[0].status)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have no limit of the address space")
def test_a_worker_has_the_memory_of_each_mesh_for_the_next(tmp_path: Path) -> None:
    """A mesh that fits below the limit once fits again and again."""
    from curvcli.samples import get

    made = get("torus")(size=300_000)
    curvcli.analyze((made.points, made.faces), "topology").write(tmp_path / "m.ply")
    command = [sys.executable, "-c", ONE_AFTER_THE_OTHER, "m.ply", "330"]
    ended = subprocess.run(command, cwd=tmp_path, env=environment(), capture_output=True, text=True, check=False)
    assert ended.stdout.split() == ["ok"] * 3, ended.stderr

"""A program that has read and analysed, and then forks: its children read, analyse and write, or say why not."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
import trimesh

from tests.helpers.cli.program import curvcli as run
from tests.helpers.cli.program import environment, wrote

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere libraries may not survive a fork")

# A child that waits for ever is ended after so many seconds, far more than it needs.
BEGIN = """
import multiprocessing, os, signal, sys, warnings
warnings.simplefilter("ignore")  # Python 3.12 warns of every fork of a process with threads
import curvcli
path = sys.argv[1]

def child(work):
    pid = os.fork()
    if pid == 0:
        signal.alarm(30)
        try:
            work()
            os._exit(0)
        except BaseException as error:
            print(type(error).__name__, error, flush=True)
            os._exit(9)
    assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == int(sys.argv[2] if len(sys.argv) > 2 else 0)
"""


def program(text: str, *arguments: object) -> str:
    line = [sys.executable, "-c", BEGIN + text, *map(str, arguments)]
    done = subprocess.run(line, capture_output=True, env=environment(), timeout=300)
    assert done.returncode == 0, done.stderr.decode() + done.stdout.decode()
    return done.stdout.decode()


@pytest.fixture(scope="module")
def texts(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Files that are read with polars: larger than what is read without it."""
    folder = tmp_path_factory.mktemp("texts")
    made = {suffix: folder / f"made.{suffix}" for suffix in ("obj", "ply")}
    outputs = [word for path in made.values() for word in ("-o", str(path))]
    wrote(run("sample", "irregular_torus", "--size", "9000", "-q", *outputs))
    mesh = trimesh.load_mesh(made["ply"], process=False)
    plain = made["obj"].read_bytes()
    odd = plain.replace(b"\nf ", b"\ng a\nf ", 1).replace(b"\nv ", b"\nv   ", 40).replace(b"v ", b"vn 0 nan 1\nv ", 9)
    content = {
        "obj": plain,
        "odd.obj": odd,
        "slashes.obj": re.sub(rb"(?m)^f (\d+) (\d+) (\d+)", rb"f \1/1/1 \2//2 \3/3", plain),
        "ply": mesh.export(file_type="ply", encoding="ascii"),
        "stl": mesh.export(file_type="stl_ascii").encode(),
    }
    for name, data in content.items():
        (folder / f"m.{name}").write_bytes(data)
        assert len(data) > 1 << 18
    return {name: folder / f"m.{name}" for name in content}


SAME = """
first = curvcli.analyze(path)
def again():
    found = curvcli.analyze(path)
    assert found.surface.file.sha256 == first.surface.file.sha256
    assert (found.surface.points == first.surface.points).all() and (found.surface.faces == first.surface.faces).all()
    for name in first.chosen:
        assert (found.column(name) == first.column(name)).all() or found.column(name).dtype.kind == "f"
    assert found.totals == first.totals
child(again)
child(lambda: child(again))
with multiprocessing.get_context("fork").Pool(2) as pool:
    found = pool.map_async(curvcli.load, [path] * 4).get(60)
    assert all((one.points == first.surface.points).all() for one in found)
"""


@pytest.mark.slow
@pytest.mark.parametrize("name", ["obj", "odd.obj", "slashes.obj", "ply", "stl"])
def test_reading_in_a_child(name: str, texts: dict[str, Path]) -> None:
    program(SAME, texts[name])


@pytest.mark.slow
def test_writing_in_a_child(texts: dict[str, Path], tmp_path: Path) -> None:
    text = """
from curvcli.output.write import Appearance, write_outputs
suffixes = ["csv", "tsv", "npz", "ply", "obj", "json"]
def write(name):
    found = curvcli.analyze(curvcli.load(path, weld="exact"), "paper")
    for suffix in suffixes:
        found.write(f"{sys.argv[3]}/{name}.{suffix}")
    write_outputs(found, [f"{sys.argv[3]}/{name}.6.csv"], appearance=Appearance(precision=6))
write("parent")
child(lambda: write("child"))
"""
    program(text, texts["obj"], 0, tmp_path)
    for suffix in ("csv", "tsv", "npz", "ply", "obj", "6.csv"):
        same = (tmp_path / f"parent.{suffix}").read_bytes() == (tmp_path / f"child.{suffix}").read_bytes()
        assert same, suffix


def test_what_needs_the_threads_is_refused_in_a_child(texts: dict[str, Path], tmp_path: Path) -> None:
    text = """
first = curvcli.analyze(path)
first.write(sys.argv[3] + "/parent.parquet")
child(lambda: first.write(sys.argv[3] + "/child.parquet"))
from curvcli.loading.tables import read_stored_table
child(lambda: read_stored_table(sys.argv[3] + "/parent.parquet"))
"""
    told = program(text, texts["obj"], 9, tmp_path).splitlines()
    assert len(told) == 2
    assert all(line.startswith("UsageError ") and "does not inherit" in line for line in told)
    assert [path.name for path in tmp_path.iterdir()] == ["parent.parquet"]


def test_a_child_of_who_only_imported_has_everything(texts: dict[str, Path], tmp_path: Path) -> None:
    text = """
import polars
import curvcli.output.write
child(lambda: curvcli.analyze(path).write(sys.argv[3] + "/child.parquet"))
"""
    program(text, texts["obj"], 0, tmp_path)
    assert (tmp_path / "child.parquet").exists()


def test_no_thread_of_ours_outlives_a_call(texts: dict[str, Path], tmp_path: Path) -> None:
    text = """
import threading
curvcli.analyze(path).write(sys.argv[3] + "/k.csv")
assert threading.enumerate() == [threading.main_thread()]
"""
    program(text, texts["obj"], 0, tmp_path)

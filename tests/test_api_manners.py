"""The package as a guest in somebody's program: silent, without traces, and the same from every thread."""

from __future__ import annotations

import gc
import json
import subprocess
import sys
import weakref
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from threading import Barrier

import numpy as np
import polars
import pytest
from click.testing import CliRunner

import curvcli
from curvcli.api import Analysis
from curvcli.commands.main import cli
from curvcli.curvatures.quantity import Element
from curvcli.mesh.surface import Surface
from curvcli.report.model import encode
from tests.helpers import exact_values, meshes
from tests.helpers.cli.program import environment
from tests.helpers.columns import PUBLIC

# Everything a program may have set for itself, before curvcli is imported and after the last call.
TRACES = """
import os, signal, sys, threading
folder = os.getcwd()
umask = os.umask(0o22); os.umask(umask)

import numpy as np, scipy.sparse, trimesh, polars, msgspec  # whatever these do is theirs
environment = dict(os.environ)
import builtins, decimal, gc, locale, logging, random, rich, warnings

def state():
    return {
        "signals": {number: signal.getsignal(number) for number in signal.valid_signals()},
        "numpy": (np.geterr(), np.geterrcall(), np.get_printoptions()),
        "random": (random.getstate(), str(np.random.get_state())),
        "warnings": list(warnings.filters),
        "logging": (logging.root.level, list(logging.root.handlers)),
        "hooks": (sys.excepthook, sys.unraisablehook, sys.displayhook, threading.excepthook, builtins.print),
        "streams": (sys.stdin, sys.stdout, sys.stderr, sys.argv[:], sys.path[:]),
        "decimal": str(decimal.getcontext()),
        "locale": locale.setlocale(locale.LC_ALL),
        "collector": (gc.isenabled(), gc.get_threshold()),
        "rich": rich._console,
        "switch": (sys.getrecursionlimit(), sys.getswitchinterval()),
    }

np.seterr(all="raise")
before = state()
import curvcli
for name in dir(curvcli):
    getattr(curvcli, name)
assert state() == before, "import"
for path in sys.argv[1:]:
    analysis = curvcli.analyze(path, "all", mean="average", area="voronoi", orient="outward")
    analysis.report(), analysis.passed, dict(analysis.edges), dict(analysis.faces)
    analysis.write(os.path.join(os.environ["OUT"], os.path.basename(path) + ".csv"))
    analysis.write(os.path.join(os.environ["OUT"], os.path.basename(path) + ".coloured.ply"))
    try:
        curvcli.analyze(path + ".none")
    except curvcli.errors.InputError:
        pass
found = state()
changed = [key for key in before if found[key] != before[key]]
assert not changed, changed
assert dict(os.environ) == environment, set(os.environ.items()) ^ set(environment.items())
assert os.getcwd() == folder
mask = os.umask(0o22); assert mask == umask
"""


def test_nothing_is_printed_and_nothing_is_left_behind(tmp_path: Path) -> None:
    """A program that makes numpy raise at every rounding accident gets its results too."""
    paths = [str(exact_values.MESHES[name]) for name in ("torus_irregular", "mobius", "unreferenced", "disk")]
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", TRACES, *paths],
        capture_output=True,
        text=True,
        timeout=120,
        env=environment(OUT=str(tmp_path)),
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert len(list(tmp_path.iterdir())) == 2 * len(paths)


# ---------------------------------------------------------------------------- threads


def fingerprint(result: Analysis) -> bytes:
    """Every byte of every column and of the report, timings apart."""
    report = {key: value for key, value in result.report().items() if key != "timings"}
    columns = [result.column(name) for name in PUBLIC]
    return encode(report) + b"".join(np.ascontiguousarray(column).tobytes() for column in columns)


@cache
def zoo() -> dict[str, meshes.Mesh]:
    return {name: meshes.zoo(name) for name in list(meshes.ZOO)[:8]}


def test_threads_do_not_disturb_each_other() -> None:
    work = [name for _ in range(4) for name in zoo()]
    alone = {name: fingerprint(curvcli.analyze(tuple(mesh), "all")) for name, mesh in zoo().items()}
    start = Barrier(4)

    def one(task: tuple[int, str]) -> bytes:
        if task[0] < 4:
            start.wait(30)
        return fingerprint(curvcli.analyze(tuple(zoo()[task[1]]), "all"))

    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(one, enumerate(work)))
    assert together == [alone[name] for name in work]


def test_threads_may_share_a_surface() -> None:
    """All threads request its lazy properties at once."""
    given = meshes.of_sample("irregular_torus", size=2000)
    wanted = fingerprint(curvcli.analyze(Surface(*given), "all"))
    for _ in range(2):
        shared, start = Surface(*given), Barrier(4)

        def one(_: int, shared: Surface = shared, start: Barrier = start) -> bytes:
            start.wait(30)
            return fingerprint(curvcli.analyze(shared, "all"))

        with ThreadPoolExecutor(4) as pool:
            assert set(pool.map(one, range(4))) == {wanted}


def test_the_first_calls_may_come_from_several_threads() -> None:
    """Before anything is imported or registered."""
    program = (
        "import sys\nfrom concurrent.futures import ThreadPoolExecutor\nimport curvcli\n"
        "def one(path):\n    return len(curvcli.analyze(path, 'all').vertices), len(curvcli.passes)\n"
        "with ThreadPoolExecutor(4) as pool:\n    print(len(set(pool.map(one, sys.argv[1:] * 4))))\n"
    )
    path = str(exact_values.MESHES["cube"])
    done = subprocess.run(
        [sys.executable, "-c", program, path], capture_output=True, text=True, timeout=60, env=environment()
    )
    assert (done.stdout, done.stderr) == ("1\n", "")


# ---------------------------------------------------------------------------- the same as the command line


@pytest.mark.parametrize("name", ["torus_irregular", "mobius", "two_components"])
def test_every_table_of_the_command_line_is_the_mapping_of_the_library(name: str, tmp_path: Path) -> None:
    """Every cell of edges and faces, in .csv and .npz, is the very double of the mapping; vertices in test_api.py."""
    path = exact_values.MESHES[name]
    arguments = ["analyze", str(path), "-q", "-p", "all"]
    for element in ("edges", "faces"):
        arguments += [
            "--table",
            f"{element}={tmp_path}/{element}.csv",
            "--table",
            f"{element}={tmp_path}/{element}.npz",
        ]
    arguments += ["-o", f"{tmp_path}/vertices.npz"]
    assert CliRunner().invoke(cli, arguments, standalone_mode=False).return_value == 0
    result = curvcli.analyze(path, "all")
    elements: dict[str, Element] = {"edges": "edge", "faces": "face", "vertices": "vertex"}
    for table, element in elements.items():
        with np.load(tmp_path / f"{table}.npz", allow_pickle=False) as stored:
            arrays = dict(stored)
        csv = tmp_path / f"{table}.csv"
        frame = polars.read_csv(csv, infer_schema_length=None) if csv.exists() else None
        mapping = getattr(result, table)
        for quantity in PUBLIC.values():
            if quantity.on != element:
                continue
            for column in quantity.columns:
                wanted = np.asarray(mapping[column])
                if quantity.kind not in ("count", "label"):  # whole numbers and words have codes there
                    np.testing.assert_array_equal(arrays[column], wanted, err_msg=column)
                if frame is not None and not quantity.labels:
                    found = frame[column].cast(polars.Float64).fill_null(np.nan).to_numpy()
                    np.testing.assert_array_equal(found, wanted, err_msg=column)


@pytest.mark.parametrize("options", [[], ["--mean", "average", "--area", "voronoi", "--orient", "outward"]])
def test_the_report_of_the_command_line_is_the_report_of_the_library(options: list[str]) -> None:
    path = exact_values.MESHES["torus_irregular"]
    told = CliRunner().invoke(cli, ["analyze", str(path), "-p", "all", "--json", *options], standalone_mode=False)
    given = {key.removeprefix("--"): value for key, value in zip(options[::2], options[1::2], strict=True)}
    said, own = json.loads(told.stdout), curvcli.analyze(path, "all", **given).report()  # type: ignore[arg-type]
    assert {**said, "timings": None} == {**own, "timings": None}


@pytest.fixture
def no_collector() -> Iterator[None]:
    """Without the collector of circles, which comes when it likes."""
    gc.disable()
    yield
    gc.enable()


@pytest.mark.usefixtures("no_collector")
@pytest.mark.parametrize("suffix", [".obj", ".ply", ".stl"])
def test_a_mesh_is_let_go_with_its_last_user(suffix: str) -> None:
    """Meshes read one after the other need the memory of one: no object refers to itself."""
    surface = curvcli.load(Path(__file__).parents[1] / f"sample_meshes/sphere{suffix}")
    analysis = curvcli.analyze(surface, "all")
    analysis.report()
    gone = weakref.ref(surface), weakref.ref(analysis)
    del surface, analysis
    assert [reference() for reference in gone] == [None, None]

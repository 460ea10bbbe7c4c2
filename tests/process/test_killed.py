"""Runs that end in the middle of writing: outputs are the old ones or the new ones, never a part of either."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.helpers.cli.program import curvcli, environment, start
from tests.process.watch import feed, until

OLD = b"what was there\n" * 1000
NAMES = ("k.csv", "k.ply")


def temporaries(folder: Path) -> list[str]:
    return [name for name in os.listdir(folder) if name not in NAMES]


def written(folder: Path) -> int:
    """Bytes that stand in temporaries."""
    size = 0
    for name in temporaries(folder):
        try:
            size += (folder / name).stat().st_size
        except FileNotFoundError:  # renamed meanwhile
            continue
    return size


@pytest.fixture(scope="module")
def complete(large: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The outputs of a run that nothing disturbs."""
    folder = tmp_path_factory.mktemp("complete")
    assert curvcli("analyze", large, "-q", *outputs(folder)) == (0, "", "")
    return {name: (folder / name).read_bytes() for name in NAMES}


def outputs(folder: Path) -> list[str]:
    return [word for name in NAMES for word in ("-o", str(folder / name))]


def run(large: Path, folder: Path) -> subprocess.Popen[bytes]:
    """Over outputs that exist."""
    for name in NAMES:
        (folder / name).write_bytes(OLD)
    return start("analyze", large, "-q", "--force", *outputs(folder), stderr=subprocess.PIPE)


MOMENTS = [float(x) for x in np.random.default_rng(1).uniform(0, 1, 3)]
SIGNALS = {signal.SIGKILL: -9, signal.SIGTERM: 143, signal.SIGINT: 130}


@pytest.mark.slow
@pytest.mark.parametrize("number", SIGNALS, ids=lambda number: signal.Signals(number).name)
@pytest.mark.parametrize("moment", MOMENTS)
def test_killed_while_it_writes(
    number: signal.Signals, moment: float, large: Path, complete: dict[str, bytes], tmp_path: Path
) -> None:
    """At a random share of all bytes, in the table or in the mesh."""
    share = moment * sum(map(len, complete.values()))
    process = run(large, tmp_path)
    until(lambda: written(tmp_path) > share, process)
    process.send_signal(number)
    _, words = process.communicate(timeout=120)
    found = {name: (tmp_path / name).read_bytes() for name in NAMES}
    if process.returncode == 0:  # it was faster
        assert found == complete
    else:
        assert process.returncode == SIGNALS[number]
        assert all(found[name] in (OLD, complete[name]) for name in NAMES)
    if number != signal.SIGKILL:
        assert temporaries(tmp_path) == []
        assert words == (b"curvcli: interrupted\n" if process.returncode else b"")
    else:
        assert all(name.startswith(".curvcli-") and name.endswith(".part") for name in temporaries(tmp_path))


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_killed_while_names_change(
    number: signal.Signals, large: Path, complete: dict[str, bytes], tmp_path: Path
) -> None:
    """As soon as the first output is new."""
    process = run(large, tmp_path)
    until(lambda: (tmp_path / NAMES[0]).stat().st_size != len(OLD), process)
    process.send_signal(number)
    process.communicate(timeout=120)
    assert (tmp_path / NAMES[0]).read_bytes() == complete[NAMES[0]]
    assert (tmp_path / NAMES[1]).read_bytes() in (OLD, complete[NAMES[1]])


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT])
def test_ended_while_it_waits_for_more(number: signal.Signals, tmp_path: Path) -> None:
    arguments = ("analyze", "-", "--input-format", "obj", "-o", "k.csv")
    process = start(*arguments, cwd=tmp_path, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    feed(process, b"# nothing yet\n" * 200_000)
    process.send_signal(number)
    process.send_signal(number)  # told twice, by a terminal and by a parent
    process.wait(timeout=120)
    assert process.stdin is not None
    assert process.stdout is not None
    assert process.stderr is not None
    with process.stdin, process.stdout, process.stderr:
        assert (process.returncode, process.stdout.read()) == (128 + number, b"")
        assert process.stderr.read() == b"curvcli: interrupted\n"
    assert list(tmp_path.iterdir()) == []


def test_signals_that_the_parent_ignores_stay_ignored(small: Path, tmp_path: Path) -> None:
    """As under nohup: the run ends well."""

    def ignore() -> None:
        signal.signal(signal.SIGHUP, signal.SIG_IGN)

    arguments = ("analyze", "-", "--input-format", "ply", "-q", "-o", "k.csv")
    process = start(*arguments, cwd=tmp_path, stdin=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=ignore)
    assert process.stdin is not None
    content = small.read_bytes()
    feed(process, content[:-1])
    process.send_signal(signal.SIGHUP)
    _, words = process.communicate(content[-1:], timeout=120)
    assert (process.returncode, words) == (0, b"")
    assert (tmp_path / "k.csv").stat().st_size > 0


def test_an_import_is_not_torn_apart(tmp_path: Path) -> None:
    """Its lock would stay held, and a thread that needs the module would wait for ever."""
    (tmp_path / "torn.py").write_text(
        "import os, signal\nos.kill(os.getpid(), signal.SIGTERM)\nfor _ in range(1000):\n    pass\nprint('whole')\n"
    )
    program = (
        "import signal, sys\n"
        "from curvcli.commands.signals import Ending\n"
        "ending = Ending()\n"
        "ending.expect()\n"
        "try:\n"
        "    import torn\n"
        "    while True:\n"
        "        signal.pause()\n"
        "except KeyboardInterrupt:\n"
        "    sys.exit(ending.code)\n"
    )
    line = [sys.executable, "-c", program]
    done = subprocess.run(line, cwd=tmp_path, env=environment(), capture_output=True, timeout=60)
    assert (done.returncode, done.stdout, done.stderr) == (143, b"whole\n", b"")


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux shows the libraries that a process has mapped")
@pytest.mark.parametrize("library", ["_multiarray_umath", "scipy", "polars"])
def test_interrupted_while_libraries_are_loaded(library: str, small: Path, tmp_path: Path) -> None:
    process = start("analyze", small, "-q", "-o", tmp_path / "k.csv", stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    maps = Path(f"/proc/{process.pid}/maps")
    until(lambda: library in maps.read_text(), process)
    process.send_signal(signal.SIGINT)
    out, words = process.communicate(timeout=60)
    assert (process.returncode, out, words) == (130, b"", b"curvcli: interrupted\n")
    assert list(tmp_path.iterdir()) == []

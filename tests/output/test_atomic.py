"""Outputs appear whole or not at all, whatever happens in between."""

from __future__ import annotations

import os
import signal
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from curvcli.errors import OutputError
from curvcli.output.atomic import Outputs
from tests.output.files import NEW, OLD, refused, write


def test_all_files_appear_at_the_end(tmp_path: Path) -> None:
    paths = [tmp_path / "a.csv", tmp_path / "b.ply"]
    with Outputs(paths) as outputs:
        for path in paths:
            with outputs.open(path) as stream:
                stream.write(NEW)
            assert not path.exists()
        assert all(name.startswith(".") and name.endswith(".part") for name in os.listdir(tmp_path))
    assert [path.read_bytes() for path in paths] == [NEW, NEW]
    assert sorted(os.listdir(tmp_path)) == ["a.csv", "b.ply"]


def test_an_output_never_opened_does_not_appear(file: Path) -> None:
    with Outputs([file]):
        pass
    assert os.listdir(file.parent) == []


def test_an_existing_file_needs_force(file: Path) -> None:
    file.write_bytes(OLD)
    assert refused(file) == f"{file}: exists already; --force overwrites it"
    assert file.read_bytes() == OLD
    write(file, force=True)
    assert file.read_bytes() == NEW
    assert os.listdir(file.parent) == ["out.csv"]


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt, SystemExit, MemoryError])
@pytest.mark.parametrize("inside", [True, False])
def test_an_exception_leaves_the_old_file(file: Path, error: type[BaseException], inside: bool) -> None:
    other = file.with_name("other.csv")
    file.write_bytes(OLD)

    def run() -> None:
        with Outputs([file, other], force=True) as outputs:
            with outputs.open(file) as stream:
                stream.write(NEW)
                if inside:
                    raise error
            raise error

    with pytest.raises(error):
        run()
    assert file.read_bytes() == OLD
    assert os.listdir(file.parent) == ["out.csv"]


@pytest.mark.parametrize("force", [True, False])
def test_a_killed_run_leaves_the_old_file_or_none(file: Path, force: bool) -> None:
    if force:
        file.write_bytes(OLD)
    program = (
        "import signal, sys\n"
        "from curvcli.output.atomic import Outputs\n"
        "with Outputs([sys.argv[1]], force=sys.argv[2] == 'True') as outputs:\n"
        "    with outputs.open(sys.argv[1]) as stream:\n"
        "        stream.write(b'x' * 1000000)\n"
        "        stream.flush()\n"
        "        print('written', flush=True)\n"
        "        signal.pause()\n"
    )
    process = subprocess.Popen([sys.executable, "-c", program, file, str(force)], stdout=subprocess.PIPE)
    assert process.stdout is not None
    with process.stdout as words:
        assert words.readline() == b"written\n"
        process.send_signal(signal.SIGKILL)
        assert process.wait() == -signal.SIGKILL
    assert (file.read_bytes() == OLD) if force else not file.exists()
    (left,) = {*os.listdir(file.parent)} - {"out.csv"}
    assert left.startswith(".")
    assert left.endswith(".part")
    write(file, force=force)
    assert file.read_bytes() == NEW


def test_a_full_disk_leaves_the_old_file(tiny: Path) -> None:
    file = tiny / "out.csv"
    file.write_bytes(OLD)

    def fill() -> None:
        with Outputs([file], force=True) as outputs, outputs.open(file) as stream:
            for _ in range(1000):
                stream.write(bytes(1000))

    with pytest.raises(OutputError) as raised:
        fill()
    assert str(raised.value) == f"{file}: cannot be written: No space left on device"
    assert file.read_bytes() == OLD
    assert os.listdir(tiny) == ["out.csv"]


def test_a_disk_full_at_the_last_byte(tiny: Path) -> None:
    file = tiny / "out.csv"

    def fill() -> None:
        with Outputs([file]) as outputs:
            (tiny / "filler").write_bytes(bytes(61440))
            with outputs.open(file) as stream:
                stream.write(bytes(4097))

    with pytest.raises(OutputError, match="No space left"):
        fill()
    assert os.listdir(tiny) == ["filler"]


def test_a_file_that_appears_meanwhile_is_not_overwritten(file: Path) -> None:
    outputs = Outputs([file]).__enter__()
    with outputs.open(file) as stream:
        stream.write(NEW)
    file.write_bytes(OLD)
    with pytest.raises(OutputError, match="appeared while it was computed"):
        outputs.__exit__(None, None, None)
    assert file.read_bytes() == OLD
    assert os.listdir(file.parent) == ["out.csv"]


@pytest.mark.parametrize("appears", [True, False])
def test_without_hard_links(file: Path, monkeypatch: pytest.MonkeyPatch, appears: bool) -> None:
    def refuse(source: str, target: str) -> None:
        if appears:
            file.write_bytes(OLD)
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "link", refuse)
    if appears:
        with pytest.raises(OutputError, match="appeared"):
            write(file)
    else:
        write(file)
    assert file.read_bytes() == (OLD if appears else NEW)
    assert os.listdir(file.parent) == ["out.csv"]


def test_two_runs_on_one_output(file: Path) -> None:
    first = Outputs([file]).__enter__()
    with first.open(file) as stream:
        stream.write(OLD)
    write(file)
    with pytest.raises(OutputError, match="appeared"):
        first.__exit__(None, None, None)
    assert file.read_bytes() == NEW
    assert os.listdir(file.parent) == ["out.csv"]


def test_permissions_follow_the_umask_and_are_kept(file: Path) -> None:
    before = os.umask(0o027)
    try:
        write(file)
        assert stat.S_IMODE(file.stat().st_mode) == 0o640
        file.chmod(0o600)
        write(file, force=True)
        assert stat.S_IMODE(file.stat().st_mode) == 0o600
    finally:
        os.umask(before)

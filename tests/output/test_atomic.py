"""Outputs appear whole or not at all, whatever happens in between."""

from __future__ import annotations

import os
import signal
import stat
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from curvcli.errors import OutputError
from curvcli.output.atomic import Outputs

OLD, NEW = b"what was there", b"what is new"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "out.csv"


@pytest.fixture
def tiny(tmp_path: Path) -> Iterator[Path]:
    """A file system of 64 kB."""
    place = tmp_path / "tiny"
    place.mkdir()
    done = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", place], capture_output=True, text=True)
    if done.returncode:
        pytest.skip(f"no small file system can be mounted here: {done.stderr.strip()}")
    yield place
    subprocess.run(["umount", place], check=True)


def write(*paths: str | Path, force: bool = False) -> None:
    with Outputs(paths, force) as outputs:
        for path in paths:
            with outputs.open(path) as stream:
                stream.write(NEW)


def refused(*paths: str | Path, force: bool = False) -> str:
    """The one line with which the outputs are refused before any work."""
    with pytest.raises(OutputError) as raised, Outputs(paths, force):
        raise AssertionError("the work has begun")
    assert "\n" not in str(raised.value)
    return str(raised.value)


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


def test_a_read_only_file_system(tiny: Path) -> None:
    (tiny / "old.csv").write_bytes(OLD)
    subprocess.run(["mount", "-o", "remount,ro", tiny], check=True)
    assert refused(tiny / "new.csv").endswith("cannot be written: Read-only file system")
    assert refused(tiny / "old.csv", force=True).endswith("cannot be written: Read-only file system")


def test_a_read_only_folder(tmp_path: Path) -> None:
    if os.geteuid() == 0:
        pytest.skip("the superuser may write to a read-only folder")
    tmp_path.chmod(0o500)
    assert refused(tmp_path / "out.csv").endswith("cannot be written: Permission denied")


def test_places_that_are_none(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(OLD)
    (tmp_path / "loop").symlink_to("loop")
    assert "there is no folder" in refused(tmp_path / "none" / "out.csv")
    assert "Not a directory" in refused(tmp_path / "file" / "out.csv")
    assert "is a folder" in refused(tmp_path, force=True)
    assert "names a folder" in refused(f"{tmp_path}/new/")
    assert "symbolic links" in refused(tmp_path / "loop", force=True)
    assert "not a file name" in refused("")
    assert "not a file name" in refused("a\0b")
    assert "File name too long" in refused(tmp_path / ("x" * 300))


def test_a_longest_name_has_room_for_its_temporary(tmp_path: Path) -> None:
    file = tmp_path / ("x" * 255)
    write(file)
    assert file.read_bytes() == NEW


def test_odd_names_are_written_and_shown_on_one_line(tmp_path: Path) -> None:
    file = os.fsdecode(os.fsencode(tmp_path) + b"/a\n\xff.csv")
    write(file)
    assert Path(file).read_bytes() == NEW
    assert refused(file).encode().endswith(b"a\\n\\udcff.csv': exists already; --force overwrites it")


def test_two_outputs_on_one_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sub").mkdir()
    (tmp_path / "link").symlink_to("a.csv")
    (tmp_path / "same").symlink_to("sub", target_is_directory=True)
    pairs: list[tuple[str | Path, str | Path]] = [
        ("a.csv", "a.csv"),
        ("a.csv", tmp_path / "a.csv"),
        ("a.csv", "sub/../a.csv"),
        ("link", "a.csv"),
    ]
    for one, two in [*pairs, ("sub/x", "same/x"), ("-", "-"), ("-", "/dev/stdout"), ("/dev/fd/1", "-")]:
        assert "two outputs on one file" in refused(one, two)
    (tmp_path / "hard1").write_bytes(OLD)
    (tmp_path / "hard2").hardlink_to("hard1")
    assert "two outputs on one file" in refused("hard1", "hard2", force=True)


def test_names_that_differ_in_case(tmp_path: Path) -> None:
    pair = tmp_path / "a.csv", tmp_path / "A.csv"
    (tmp_path / "probe").touch()
    if (tmp_path / "PROBE").exists():
        assert "two outputs on one file" in refused(*pair)
    else:
        write(*pair)
        assert all(path.read_bytes() == NEW for path in pair)


def test_a_link_is_followed(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    link, file = tmp_path / "link.csv", tmp_path / "sub" / "out.csv"
    link.symlink_to(file)
    write(link)
    assert link.is_symlink()
    assert file.read_bytes() == NEW
    assert "exists already" in refused(link)
    assert os.listdir(tmp_path / "sub") == ["out.csv"]


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


def test_permissions(file: Path) -> None:
    before = os.umask(0o027)
    try:
        write(file)
        assert stat.S_IMODE(file.stat().st_mode) == 0o640
        file.chmod(0o600)
        write(file, force=True)
        assert stat.S_IMODE(file.stat().st_mode) == 0o600
    finally:
        os.umask(before)


def test_devices_are_written_to_not_replaced() -> None:
    write("/dev/null")
    assert stat.S_ISCHR(os.stat("/dev/null").st_mode)


def test_a_full_device() -> None:
    if not os.path.exists("/dev/full"):
        pytest.skip("there is no /dev/full here")
    with pytest.raises(OutputError, match=r"^/dev/full: cannot be written: No space left on device$"):
        write("/dev/full")


def test_a_fifo_is_written_to(tmp_path: Path) -> None:
    fifo, read = tmp_path / "fifo", []
    os.mkfifo(fifo)
    reader = threading.Thread(target=lambda: read.append(fifo.read_bytes()))
    reader.start()
    write(fifo)
    reader.join()
    assert read == [NEW]
    assert stat.S_ISFIFO(fifo.stat().st_mode)


@pytest.mark.parametrize("name", ["-", "/dev/stdout", "/dev/fd/1"])
def test_stdout_gets_the_bytes(name: str, tmp_path: Path) -> None:
    program = (
        "import sys; from curvcli.output.atomic import Outputs; print('words before')\n"
        "with Outputs([sys.argv[1]]) as outputs, outputs.open(sys.argv[1]) as stream: stream.write(b'bytes')"
    )
    with open(tmp_path / "redirected", "wb") as file:
        subprocess.run([sys.executable, "-c", program, name], stdout=file, check=True)
    assert (tmp_path / "redirected").read_bytes() == b"words before\nbytes"
    assert os.listdir(tmp_path) == ["redirected"]


def test_a_closed_pipe_passes_through_and_keeps_what_is_complete(tmp_path: Path) -> None:
    program = (
        "import os, sys; from curvcli.output.atomic import Outputs\n"
        "try:\n"
        "    with Outputs(['a.csv', 'b.csv', '-']) as outputs:\n"
        "        with outputs.open('a.csv') as stream: stream.write(b'complete')\n"
        "        with outputs.open('-') as stream: stream.write(bytes(10_000_000))\n"
        "        with outputs.open('b.csv') as stream: stream.write(b'never')\n"
        "except BrokenPipeError:\n"
        "    os.dup2(os.open(os.devnull, os.O_WRONLY), 1); sys.exit(9)"
    )
    receive, send = os.pipe()
    os.close(receive)
    root = Path(__file__).parents[2]
    environment = {**os.environ, "PYTHONPATH": str(root)}
    done = subprocess.run([sys.executable, "-c", program], stdout=send, cwd=tmp_path, env=environment, check=False)
    os.close(send)
    assert done.returncode == 9
    assert os.listdir(tmp_path) == ["a.csv"]


def test_stdout_that_is_full() -> None:
    if not os.path.exists("/dev/full"):
        pytest.skip("there is no /dev/full here")
    program = (
        "import os, sys; from curvcli.output.atomic import Outputs; from curvcli.errors import OutputError\n"
        "try:\n"
        "    with Outputs(['-']) as outputs, outputs.open('-') as stream: stream.write(b'bytes')\n"
        "except OutputError as error:\n"
        "    print(error, file=sys.stderr); os.dup2(os.open(os.devnull, os.O_WRONLY), 1); sys.exit(4)"
    )
    with open("/dev/full", "wb") as full:
        done = subprocess.run([sys.executable, "-c", program], stdout=full, stderr=subprocess.PIPE, check=False)
    assert done.returncode == 4
    assert done.stderr == b"stdout: cannot be written: No space left on device\n"

"""Destinations of outputs: refusals before any work, links, devices, pipes and stdout."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from curvcli.errors import OutputError
from tests.output.files import NEW, OLD, refused, write


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
    assert refused(file).encode().endswith(b"a\\n\\xff.csv: exists already; --force overwrites it")


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


def test_devices_are_written_to_not_replaced() -> None:
    write("/dev/null")
    write("/dev/null", "/dev/null")
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


def test_a_link_to_a_stream_is_written_to(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to("/dev/stdout")
    program = (
        "import sys; from curvcli.output.atomic import Outputs\n"
        "with Outputs([sys.argv[1]]) as outputs, outputs.open(sys.argv[1]) as stream: stream.write(b'bytes')"
    )
    done = subprocess.run([sys.executable, "-c", program, tmp_path / "link"], stdout=subprocess.PIPE, check=True)
    assert done.stdout == b"bytes"
    assert (tmp_path / "link").is_symlink()


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


def test_a_closed_pipe_takes_what_comes_and_the_other_outputs_are_written(tmp_path: Path) -> None:
    program = (
        "from curvcli.output.atomic import Outputs\n"
        "with Outputs(['a.csv', 'b.csv', '-']) as outputs:\n"
        "    with outputs.open('a.csv') as stream: stream.write(b'before')\n"
        "    with outputs.open('-') as stream: stream.write(bytes(10_000_000))\n"
        "    with outputs.open('b.csv') as stream: stream.write(b'after')\n"
    )
    receive, send = os.pipe()
    os.close(receive)
    root = Path(__file__).parents[2]
    environment = {**os.environ, "PYTHONPATH": str(root)}
    done = subprocess.run(
        [sys.executable, "-c", program], stdout=send, stderr=subprocess.PIPE, cwd=tmp_path, env=environment, check=False
    )
    os.close(send)
    assert (done.returncode, done.stderr) == (0, b"")
    assert [(tmp_path / name).read_bytes() for name in ("a.csv", "b.csv")] == [b"before", b"after"]


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

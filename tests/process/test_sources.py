"""Inputs are read to their end and in one state of their file, else refused."""

from __future__ import annotations

import io
import os
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from curvcli.errors import InputError
from curvcli.loading import content
from curvcli.loading.content import read_limited, read_stream
from curvcli.loading.label_files.read import read_labels
from curvcli.loading.pieces import Pieces
from curvcli.loading.tables import read_stored_table
from curvcli.report.compare.stored import read_report
from tests.helpers.cli.program import CUBE, command, environment
from tests.helpers.cli.program import curvcli as run
from tests.helpers.cli.within import within_this
from tests.process.watch import feed


def torus(size: int, scale: float = 1.0) -> trimesh.Trimesh:
    """A torus of size² vertices, without an import from what is tested."""
    u, v = (angle.ravel() for angle in np.meshgrid(*[np.arange(size) * (2 * np.pi / size)] * 2, indexing="ij"))
    points = scale * np.stack([(2 + np.cos(v)) * np.cos(u), (2 + np.cos(v)) * np.sin(u), np.sin(v)], axis=1)
    i, j = (index.ravel() for index in np.indices((size, size)))
    a, b, c, d = (((i + di) % size) * size + (j + dj) % size for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)))
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return trimesh.Trimesh(points, faces, process=False)


def text(size: int = 60, scale: float = 1.0) -> bytes:
    """A torus as OBJ, of which a part is a mesh too; every number has as many letters at any scale."""
    made = torus(size, scale)
    lines = ["v " + " ".join(f"{x:+.6f}" for x in point) for point in made.vertices.tolist()]
    lines += ["f " + " ".join(map(str, corners)) for corners in (made.faces + 1).tolist()]
    return ("\n".join(lines) + "\n").encode()


@pytest.fixture(scope="module")
def mesh() -> bytes:
    return text()


LINES: tuple[tuple[str, ...], ...] = (
    ("analyze", "-", "--input-format", "obj", "--get", "topology.faces"),
    ("check", "-", "--input-format", "obj", "--require", "closed"),
    ("curves", "-", "--input-format", "obj", "--get", "curves"),
    ("compare", "-", "WHOLE", "--input-format", "obj"),
    ("compare", "WHOLE", "-", "--map", "--input-format", "obj"),
)


@pytest.mark.slow
@pytest.mark.parametrize("arguments", LINES, ids=" ".join)
def test_a_writer_that_pauses_is_waited_for(arguments: tuple[str, ...], mesh: bytes, tmp_path: Path) -> None:
    """The pipe does not block, and is empty amid the mesh."""
    whole = tmp_path / "whole.obj"
    whole.write_bytes(mesh)
    words = [str(whole) if word == "WHOLE" else word for word in arguments]
    calm = subprocess.run(command(*words), input=mesh, capture_output=True, env=environment(), timeout=120)

    read, write = os.pipe()
    os.set_blocking(read, False)
    process = subprocess.Popen(command(*words), stdin=read, stdout=-1, stderr=-1, env=environment())
    os.close(read)
    process.stdin = os.fdopen(write, "wb")
    half = mesh.index(b"\n", len(mesh) * 4 // 5) + 1
    for part in (mesh[: half // 2], mesh[half // 2 : half]):
        feed(process, part)
        time.sleep(0.05)
    out, err = process.communicate(mesh[half:], timeout=120)
    assert (process.returncode, out, err) == (calm.returncode, calm.stdout, calm.stderr)


@pytest.mark.slow
def test_a_list_of_files_whose_writer_pauses(tmp_path: Path) -> None:
    read, write = os.pipe()
    os.set_blocking(read, False)
    line = command("batch", "-o", tmp_path / "out", "--files-from", "-", "-q")
    process = subprocess.Popen(line, stdin=read, stderr=subprocess.PIPE, env=environment())
    os.close(read)
    process.stdin = os.fdopen(write, "wb")
    feed(process, f"{CUBE}\n".encode())
    time.sleep(0.05)
    second = tmp_path / "second.obj"
    second.write_bytes(Path(CUBE).read_bytes())
    _, words = process.communicate(f"{second}\n".encode(), timeout=120)
    assert (process.returncode, words) == (0, b"")
    assert (tmp_path / "out" / "summary.csv").read_text().count("\n") == 3


def test_streams_of_a_program() -> None:
    """Pipes and sockets that do not block, and what only says None."""
    read, write = os.pipe()
    os.set_blocking(read, False)
    sender = threading.Thread(target=_slowly, args=(write,))
    with os.fdopen(read, "rb") as stream:
        sender.start()
        assert read_limited(stream, None) == b"0123456789" * 3
    sender.join()

    one, two = socket.socketpair()
    one.setblocking(False)
    sender = threading.Thread(target=_slowly, args=(two.detach(),))
    with one.makefile("rb") as stream:
        sender.start()
        assert read_stream(stream, 25) == (b"0123456789" * 3)[:25]
    sender.join()
    one.close()

    class Never(io.RawIOBase):
        def readable(self) -> bool:
            return True

        def readinto(self, buffer: Any) -> None:
            return None

    with pytest.raises(InputError, match="does not block"):
        read_limited(Never(), None)  # type: ignore[arg-type]


def _slowly(descriptor: int) -> None:
    for _ in range(3):
        time.sleep(0.05)
        os.write(descriptor, b"0123456789")
    os.close(descriptor)


# ---------------------------------------------------------------------------- files that change


SAID = "the file changed while it was read; read it again once its writer is done"


@pytest.mark.parametrize("suffix", ["obj", "ply", "stl"])
@pytest.mark.parametrize("words", [("analyze",), ("check",), ("curves",), ("compare", CUBE)], ids=" ".join)
def test_a_file_that_is_rewritten_amid_its_reading(
    words: tuple[str, ...],
    suffix: str,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
    tmp_path: Path,
) -> None:
    """Half of one and half of another mesh of the same size is neither."""
    path = tmp_path / f"m.{suffix}"
    first, second = (text(40, s) if suffix == "obj" else torus(40, s).export(file_type=suffix) for s in (1.0, 2.0))
    assert len(first) == len(second)
    path.write_bytes(first)
    ahead = Pieces.ahead

    def then_rewritten(pieces: Pieces) -> bytes:
        found = ahead(pieces)
        with path.open("r+b") as stream:
            stream.write(second)
        return found

    monkeypatch.setattr(Pieces, "ahead", then_rewritten)
    ended = within_this(monkeypatch, capfd, *words, path)
    assert (ended.code, ended.complaint) == (3, f"{path}: {SAID}")


@pytest.mark.parametrize("name", ["table.csv", "report.json", "labels.npy", "labels.txt"])
def test_a_stored_side_that_is_rewritten_amid_its_reading(
    name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    path = tmp_path / name
    reader: Callable[[str], object] = {"table.csv": read_stored_table, "report.json": read_report}.get(
        name, read_labels
    )
    if reader is read_labels:
        np.save(path, np.arange(9)) if name == "labels.npy" else path.write_text("1\n2\n")
    else:
        assert run("analyze", CUBE, "-q", "-o", path).code == 0

    class Rewritten(io.FileIO):
        def read(self, size: int | None = -1, /) -> bytes:  # type: ignore[override]
            found = super().read(size)
            path.write_bytes(path.read_bytes())
            return found or b""

    monkeypatch.setattr(content.io, "FileIO", Rewritten)
    with pytest.raises(InputError, match=SAID):
        reader(str(path))


def test_labels_that_are_cut_off_while_they_are_read(tmp_path: Path) -> None:
    """A file that is mapped into memory and cut off ends the process by a signal; this one is refused."""
    path = tmp_path / "labels.npy"
    np.save(path, np.arange(1 << 21))
    program = (
        "import io, os, sys\n"
        "from curvcli.loading import content; from curvcli.loading.label_files.read import read_labels\n"
        "class Cut(io.FileIO):\n"
        "    def read(self, size=-1): os.truncate(sys.argv[1], 4096); return super().read(size)\n"
        "content.io.FileIO = Cut\n"
        "try: read_labels(sys.argv[1])\n"
        "except Exception as error: print(error)"
    )
    done = subprocess.run([sys.executable, "-c", program, path], capture_output=True, env=environment(), timeout=120)
    assert (done.returncode, b"changed while it was read" in done.stdout) == (0, True)


@pytest.mark.parametrize("change", ["rewrite", "append", "truncate", "touch back"])
def test_every_change_between_the_first_and_the_last_byte(change: str, tmp_path: Path) -> None:
    """Also by a writer that sets the time back, at once after the file was made."""
    path = tmp_path / "m.bin"
    path.write_bytes(bytes(100))
    with open(path, "rb", buffering=0) as file, Pieces(file) as pieces:
        assert pieces.size == 100
        assert len(pieces.take(50)) == 50
        status = path.stat()
        with path.open("r+b") as other:
            other.seek(60)
            other.write(b"other" if change != "append" else bytes(60))
            if change == "truncate":
                other.truncate(70)
        if change == "touch back":
            os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))
        with pytest.raises(InputError, match="the file changed while it was read"):
            pieces.sha256()

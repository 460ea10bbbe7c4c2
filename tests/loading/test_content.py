"""The bytes of a file: odd names and places, gzip, limits, and files that change."""

from __future__ import annotations

import gzip
import io
import os
import socket
from pathlib import Path

import pytest

from curvcli.loading.read import read_mesh_file
from curvcli.support.words import escape_text
from tests.loading.files import CONTENT, OBJ, PLY, STL, refused


def test_gzip_is_recognised_by_content(tmp_path: Path) -> None:
    (tmp_path / "mesh.obj").write_bytes(gzip.compress(OBJ[:30]) + gzip.compress(OBJ[30:]))
    assert read_mesh_file(tmp_path / "mesh.obj").polygons == 2
    (tmp_path / "plain.obj.gz").write_bytes(OBJ)
    assert read_mesh_file(tmp_path / "plain.obj.gz").polygons == 2


def test_a_damaged_gzip_is_refused(tmp_path: Path) -> None:
    packed = gzip.compress(OBJ)
    path = tmp_path / "mesh.obj.gz"
    for data in (packed[:-1], packed[:20], packed[:12] + b"\xff\xff\xff" + packed[15:], packed + b"garbage"):
        path.write_bytes(data)
        assert refused(path).startswith(f"{path}: damaged gzip data found")


def test_a_gzip_bomb_is_refused_early(tmp_path: Path) -> None:
    path = tmp_path / "bomb.obj.gz"
    path.write_bytes(gzip.compress(b"#" + b" " * (1 << 27), 9))
    assert "inflate to more than" in refused(path)
    small = tmp_path / "small.obj.gz"
    small.write_bytes(gzip.compress(OBJ + b" " * 10_000))
    assert "inflate to more than 5000 bytes" in refused(small, max_bytes=5000)


def test_what_is_no_regular_file(tmp_path: Path) -> None:
    folder = tmp_path / "folder.obj"
    folder.mkdir()
    assert refused(folder).startswith(f"{folder}: a directory found, a regular file expected; ")
    assert refused(tmp_path / "none.obj") == f"{tmp_path / 'none.obj'}: no such file"
    assert refused(tmp_path / "none" / "none.obj").endswith("no such file")
    assert "not a file name" in refused("a\0b.obj")
    assert "cannot be read" in refused("a" * 5000 + ".obj")
    empty = tmp_path / "empty.obj"
    empty.touch()
    assert refused(empty) == f"{empty}: no data found, a mesh expected"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes on this system")
def test_pipes_devices_and_sockets_are_not_waited_for(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.obj"
    os.mkfifo(pipe)
    assert "a named pipe found" in refused(pipe)
    (tmp_path / "device.obj").symlink_to("/dev/zero")
    assert "a device found" in refused(tmp_path / "device.obj")
    with socket.socket(socket.AF_UNIX) as end:
        here = os.getcwd()
        os.chdir(tmp_path)  # the name of a socket must be short
        try:
            end.bind("s.obj")
            assert "a socket found" in refused("s.obj")
        finally:
            os.chdir(here)
    loop = tmp_path / "loop.obj"
    loop.symlink_to(loop)
    assert refused(loop) == f"{loop}: the link leads in a circle"


@pytest.mark.parametrize("name", ["ein Würfel.obj", "a\nb.obj", "-.obj", "\x1b[31m.obj", "a\u2028b.obj", " .obj"])
def test_a_file_of_an_odd_name_is_read(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    path.write_bytes(OBJ)
    mesh = read_mesh_file(path)
    assert mesh.polygons == 2
    assert mesh.path == escape_text(str(path))
    path.write_bytes(OBJ + b"f 1 2 9\n")
    assert refused(path).endswith(
        "line 7: vertex index `9` found, 1 to 4 expected, or negative: counted back from this line"
    )


@pytest.mark.parametrize(
    ("text", "told"),
    [("π.obj", "π.obj"), ("a\udcff\n.obj", r"a\xff\n.obj"), ("\ud800\udcff", r"\ud800\udcff"), (r"\xff", r"\xff")],
)
def test_text_on_one_line(text: str, told: str) -> None:
    assert escape_text(text) == told == escape_text(told)


def test_names_that_are_not_utf_8(tmp_path: Path) -> None:
    path = os.fsencode(tmp_path) + b"/\xff\xfe.obj"
    try:
        Path(os.fsdecode(path)).write_bytes(OBJ)
    except OSError:
        pytest.skip("this file system takes only UTF-8 names")
    for source in (path, os.fsdecode(path), Path(os.fsdecode(path))):
        mesh = read_mesh_file(source)
        assert mesh.path is not None
        assert mesh.path.endswith("/\\xff\\xfe.obj")
        assert mesh.path.isprintable()


def test_limits_count_bytes_and_faces(tmp_path: Path) -> None:
    path = tmp_path / "mesh.obj"
    path.write_bytes(OBJ)
    assert read_mesh_file(path, max_bytes=len(OBJ), max_faces=2).polygons == 2
    assert refused(path, max_bytes=len(OBJ) - 1).endswith("at most 47 allowed; --max-bytes sets the limit")
    assert refused(io.BytesIO(OBJ), max_bytes=10, input_format="obj").startswith("-: more than 10 bytes found")
    for kind, data in CONTENT.items():
        assert "faces found, at most 1 allowed" in refused(io.BytesIO(data), input_format=kind, max_faces=1)


def test_a_file_that_shrinks_while_it_is_read(tmp_path: Path) -> None:
    class Shrinking(io.BytesIO):
        def read(self, size: int | None = -1) -> bytes:
            return b"" if self.tell() else super().read(70)

        def read1(self, size: int | None = -1) -> bytes:
            return self.read(size)

    assert refused(Shrinking(PLY), input_format="ply").startswith("-: no `end_header` found")
    assert refused(Shrinking(STL), input_format="stl").startswith("-: 70 bytes found")

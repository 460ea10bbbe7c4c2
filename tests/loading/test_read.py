"""From a path or a stream to its content: refused up front, recognised, and always through trimesh."""

from __future__ import annotations

import gzip
import hashlib
import io
import os
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from hypothesis import event, given, settings
from hypothesis import strategies as st

from curvcli.errors import InputError, UsageError
from curvcli.loading import text
from curvcli.loading.content import shown
from curvcli.loading.polygons import triangulate
from curvcli.loading.read import read_mesh_file
from tests.loading.spelling import ascii_stl, binary_stl
from tests.loading.test_ply import STRIPS, ascii_ply
from tests.loading.test_stl import TETRAHEDRON

OBJ = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"
PLY = ascii_ply("3 0 1 2\n3 0 2 3\n")
STL = binary_stl(TETRAHEDRON)
CONTENT = {"obj": OBJ, "ply": PLY, "stl": STL}


def refused(source: Any, **options: Any) -> str:
    with pytest.raises(InputError) as error:
        read_mesh_file(source, **options)
    assert str(error.value).isprintable(), "one line, whatever the file is called"
    return str(error.value)


@pytest.mark.parametrize("suffix", ["obj", "ply", "stl", "OBJ", "Ply", "STL"])
@pytest.mark.parametrize("packed", ["", ".gz", ".GZ"])
def test_promised_suffixes(tmp_path: Path, suffix: str, packed: str) -> None:
    data = CONTENT[suffix.lower()]
    data = gzip.compress(data) if packed else data
    path = tmp_path / f"mesh.{suffix}{packed}"
    path.write_bytes(data)
    mesh = read_mesh_file(path)
    assert (mesh.format, mesh.path, mesh.notices) == (suffix.lower(), str(path), ())
    assert mesh.sha256 == hashlib.sha256(data).hexdigest()
    assert mesh.polygons == (4 if suffix.lower() == "stl" else 2)


@pytest.mark.parametrize("kind", ["obj", "ply", "stl"])
@pytest.mark.parametrize("packed", [False, True])
def test_streams(kind: str, packed: bool) -> None:
    data = gzip.compress(CONTENT[kind]) if packed else CONTENT[kind]
    for wanted in (kind, kind.upper(), None):
        mesh = read_mesh_file(io.BytesIO(data), input_format=wanted)
        assert (mesh.format, mesh.path, mesh.notices) == (kind, "-", ())
    assert refused(io.BytesIO(b"hello")).startswith("-: content not recognised; --input-format")
    assert refused(io.BytesIO(b"")).startswith("-: no data found")


def test_gzip_is_recognised_by_content(tmp_path: Path) -> None:
    (tmp_path / "mesh.obj").write_bytes(gzip.compress(OBJ[:30]) + gzip.compress(OBJ[30:]))
    assert read_mesh_file(tmp_path / "mesh.obj").polygons == 2
    (tmp_path / "plain.obj.gz").write_bytes(OBJ)
    assert read_mesh_file(tmp_path / "plain.obj.gz").polygons == 2


def test_damaged_gzip(tmp_path: Path) -> None:
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


@pytest.mark.parametrize("told", ["obj", "ply", "stl"])
@pytest.mark.parametrize("kind", ["obj", "ply", "stl", "ascii"])
def test_content_that_is_not_what_the_suffix_says(tmp_path: Path, told: str, kind: str) -> None:
    data = ascii_stl(TETRAHEDRON) if kind == "ascii" else CONTENT[kind]
    kind = "stl" if kind == "ascii" else kind
    path = tmp_path / f"mesh.{told}"
    path.write_bytes(data)
    mesh = read_mesh_file(path)
    assert mesh.format == kind
    assert [n.code for n in mesh.notices] == ([] if told == kind else ["wrong_suffix"])


@pytest.mark.parametrize("told", ["obj", "ply", "stl"])
@pytest.mark.parametrize("data", [b"\x89PNG\r\n\x1a\n" + bytes(200), b"<html></html>", b"\0" * 83, b"1,2,3\n" * 50])
def test_content_that_cannot_be_recognised(tmp_path: Path, told: str, data: bytes) -> None:
    path = tmp_path / f"mesh.{told}"
    path.write_bytes(data)
    assert refused(path).startswith(f"{path}: ")


@pytest.mark.parametrize("told", ["obj", "ply", "stl"])
@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"version https://git-lfs.github.com/spec/v1\noid sha256:%064d\nsize 5\n" % 7, "a Git LFS pointer found, "),
        (b"/annex/objects/MD5E-s5--0.obj\n", "a git-annex pointer found, "),
        (b"../.git/annex/objects/aa/bb/MD5E-s5--0/MD5E-s5--0", "a git-annex pointer found, "),
        (b"\n <!DOCTYPE  html>\n<html lang='en'>" + bytes(100), "a web page found, "),
    ],
)
def test_what_was_brought_instead_of_the_file(tmp_path: Path, told: str, data: bytes, message: str) -> None:
    path = tmp_path / f"mesh.{told}"
    path.write_bytes(data)
    assert refused(path).startswith(f"{path}: {message}a mesh expected; ")


@pytest.mark.parametrize("normals", ["mesh", "file"])
def test_points_with_normals_are_no_surface(normals: str) -> None:
    data = b"v 0 0 0\nvn 0 0 1\nv 1 0 0\nvn 0 0 1\nv 0 1 0\nvn 0 0 1\n"
    assert refused(io.BytesIO(data), input_format="obj", normals=normals).startswith("-: no faces; ")
    assert refused(io.BytesIO(data + b"f\nf 1//1 2//2\n"), input_format="obj", normals=normals).startswith(
        "-: no faces; "
    )
    curve = read_mesh_file(io.BytesIO(data + b"l 1 2 3\n"), input_format="obj", normals=normals)
    assert [line.tolist() for line in curve.polylines] == [[0, 1, 2]]


def test_utf_16(tmp_path: Path) -> None:
    """Also without a byte-order mark: with zeros for blanks, `10` would be read as two numbers."""
    for kind in ("obj", "ply", "stl"):
        path = tmp_path / f"mesh.{kind}"
        for encoding in ("utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-32-le", "utf-32-be"):
            path.write_bytes(OBJ.replace(b"v 1 ", b"v 10 ").decode().encode(encoding))
            assert "UTF-16 or UTF-32 text found" in refused(path)


def test_other_suffixes_are_refused_unless_told(tmp_path: Path) -> None:
    for name in ("mesh.off", "mesh", "mesh.obj.bak", "mesh.gz", "obj"):
        path = tmp_path / name
        path.write_bytes(OBJ)
        message = refused(path)
        assert ".obj, .ply, .stl expected" in message
        assert "--input-format" in message
        assert read_mesh_file(path, input_format="obj").polygons == 2
    with pytest.raises(UsageError, match="`off` is not known"):
        read_mesh_file(tmp_path / "mesh.off", input_format="off")


def test_what_is_no_regular_file(tmp_path: Path) -> None:
    folder = tmp_path / "folder.obj"
    folder.mkdir()
    assert refused(folder).startswith(f"{folder}: a directory found, a regular file expected; `-`")
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


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="whoever runs this may read every file")
def test_files_that_may_not_be_read(tmp_path: Path) -> None:
    path = tmp_path / "mesh.obj"
    path.write_bytes(OBJ)
    path.chmod(0)
    assert "permission denied" in refused(path)


@pytest.mark.parametrize("name", ["ein Würfel.obj", "a\nb.obj", "-.obj", "\x1b[31m.obj", "a\u2028b.obj", " .obj"])
def test_odd_names(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    path.write_bytes(OBJ)
    mesh = read_mesh_file(path)
    assert mesh.polygons == 2
    assert mesh.path == shown(str(path))
    path.write_bytes(OBJ + b"f 1 2 9\n")
    assert refused(path).endswith(
        "line 7: vertex index `9` found, 1 to 4 expected, or negative: counted back from this line"
    )


def test_names_that_are_not_utf_8(tmp_path: Path) -> None:
    path = os.fsencode(tmp_path) + b"/\xff\xfe.obj"
    try:
        Path(os.fsdecode(path)).write_bytes(OBJ)
    except OSError:
        pytest.skip("this file system takes only UTF-8 names")
    for source in (path, os.fsdecode(path), Path(os.fsdecode(path))):
        mesh = read_mesh_file(source)
        assert mesh.path is not None
        assert mesh.path.endswith("/\\udcff\\udcfe.obj") or mesh.path.endswith("/\\xff\\xfe.obj")
        assert mesh.path.isprintable()


def test_limits(tmp_path: Path) -> None:
    path = tmp_path / "mesh.obj"
    path.write_bytes(OBJ)
    assert read_mesh_file(path, max_bytes=len(OBJ), max_faces=2).polygons == 2
    assert refused(path, max_bytes=len(OBJ) - 1).endswith("at most 47 allowed; --max-bytes sets the limit")
    assert refused(io.BytesIO(OBJ), max_bytes=10, input_format="obj").startswith("-: more than 10 bytes found")
    for kind, data in CONTENT.items():
        assert "faces found, at most 1 allowed" in refused(io.BytesIO(data), input_format=kind, max_faces=1)


def test_welding(tmp_path: Path) -> None:
    stl = {w: read_mesh_file(io.BytesIO(STL), weld=w) for w in ("auto", "exact", "none", 0.9)}
    assert [stl[w].xyz.shape[1] for w in stl] == [4, 4, 12, 4]
    assert stl["exact"].welded_to is None
    assert stl[0.9].welded_to is not None
    assert stl[0.9].corners.tolist() == [0] * 12
    seam = OBJ + b"v 0 0 0\nf 5 2 3\n"
    for weld, expected in (("auto", 4), ("none", 4), ("exact", 0), (1e-6, 0), ("1e-6", 0)):
        mesh = read_mesh_file(io.BytesIO(seam), input_format="obj", weld=weld)
        assert mesh.corners[6] == expected
        assert mesh.xyz.shape == (3, 5)
    for weld in ("some", -1.0, float("nan"), 2.0):
        with pytest.raises(UsageError, match="is not known"):
            read_mesh_file(io.BytesIO(seam), weld=weld)


def test_trimesh_is_the_door(monkeypatch: pytest.MonkeyPatch) -> None:
    from trimesh.exchange import load

    asked: list[str] = []
    true_load = load.load_scene

    def watched(*args: Any, **options: Any) -> Any:
        asked.append(options["file_type"])
        return true_load(*args, **options)

    monkeypatch.setattr(load, "load_scene", watched)
    for kind, data in CONTENT.items():
        read_mesh_file(io.BytesIO(data), input_format=kind)
    assert asked == ["curvcli-obj", "curvcli-ply", "curvcli-stl"]


def test_other_users_of_trimesh_notice_nothing() -> None:
    from trimesh.exchange import load

    before = {kind: load.mesh_loaders[kind] for kind in ("obj", "ply", "stl")}
    for kind, data in CONTENT.items():
        read_mesh_file(io.BytesIO(data), input_format=kind)
        assert load.mesh_loaders[kind] is before[kind]
        assert isinstance(trimesh.load(io.BytesIO(data), file_type=kind), trimesh.Trimesh)


def test_no_reference_inside_a_file_is_opened(tmp_path: Path) -> None:
    (tmp_path / "x.mtl").write_text("newmtl a\nmap_Kd x.png\n")
    path = tmp_path / "mesh.obj"
    path.write_bytes(b"mtllib x.mtl\ncall x.mtl\n" + OBJ.replace(b"f 1 2", b"usemtl a\nf 1 2"))
    program = (
        "import sys; from curvcli.loading.read import read_mesh_file; read_mesh_file(sys.argv[1]); opened = []\n"
        "sys.addaudithook(lambda event, args: opened.append(str(args[0])) if event == 'open' else None)\n"
        "read_mesh_file(sys.argv[1]); print([name for name in opened if name.endswith(('.mtl', '.png', '.obj'))])"
    )
    ran = subprocess.run([sys.executable, "-c", program, str(path)], capture_output=True, text=True, check=True)
    assert ran.stdout.strip() == repr([str(path)])


def test_a_file_that_shrinks_while_it_is_read(tmp_path: Path) -> None:
    class Shrinking(io.BytesIO):
        def read(self, size: int | None = -1) -> bytes:
            return b"" if self.tell() else super().read(70)

        def read1(self, size: int | None = -1) -> bytes:
            return self.read(size)

    assert refused(Shrinking(PLY), input_format="ply").startswith("-: no `end_header` found")
    assert refused(Shrinking(STL), input_format="stl").startswith("-: 70 bytes found")


def test_importing_the_reader_is_cheap() -> None:
    program = "import sys, curvcli.loading.read\nprint([m for m in ('polars', 'scipy', 'trimesh') if m in sys.modules])"
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert ran.stdout.strip() == "[]"


def test_a_large_number_of_faces_at_once() -> None:
    n = 300
    grid = np.arange(n * n).reshape(n, n)
    quads = np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], -1).reshape(-1, 4)
    lines = [f"v {i} {j} {i * j / 7!r}" for i in range(n) for j in range(n)]
    plain = "\n".join(lines + [f"f {a + 1} {b + 1} {c + 1} {d + 1}" for a, b, c, d in quads.tolist()])
    full = "\r\n".join(lines + [f"f {a + 1}/1/1  {b + 1}//2 {c + 1}/9 {d - n * n} " for a, b, c, d in quads.tolist()])
    for written in (plain, full):
        mesh = read_mesh_file(io.BytesIO(written.encode()), input_format="obj")
        np.testing.assert_array_equal(mesh.corners.reshape(-1, 4), quads)
        assert mesh.sizes is not None
        assert (mesh.sizes == 4).all()
        assert mesh.xyz[2].tolist() == [i * j / 7 for i in range(n) for j in range(n)]


def test_signalling_nans_raise_no_alarm() -> None:
    alarm = b"\x01\x00\x80\x7f"
    assert np.isnan(read_mesh_file(io.BytesIO(STL[:96] + alarm + STL[100:])).xyz).any()


MUTATIONS = b"|-1|0|nan|1e999|\n| |\\\n|#|/|\0|\xff|\r|f|v 1 2\n".split(b"|")


@settings(max_examples=400, deadline=None)
@given(st.data())
def test_damaged_files_are_read_or_refused_in_one_line(data: st.DataObject) -> None:
    texts = [OBJ + b"g a\nf 1/1 2/2 -1 4\nl 1 2\n", PLY, STL, ascii_stl(TETRAHEDRON), STRIPS.format(rows=1).encode()]
    mesh = bytearray(data.draw(st.sampled_from(texts)))
    for _ in range(data.draw(st.integers(1, 4))):
        begin = data.draw(st.integers(0, len(mesh)))
        end = min(len(mesh), begin + data.draw(st.integers(0, 30)))
        mesh[begin:end] = data.draw(st.one_of(st.sampled_from(MUTATIONS), st.binary(max_size=4)))
    kind = data.draw(st.sampled_from(["obj", "ply", "stl", None]))
    weld: str = data.draw(st.sampled_from(["auto", "none", "exact", "1e-6"]))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(text, "SMALL", data.draw(st.sampled_from([-1, 1 << 16])))
        try:
            read = read_mesh_file(io.BytesIO(bytes(mesh)), input_format=kind, weld=weld)
        except InputError as error:
            event("refused")
            message = str(error)
        else:
            event("read")
            message = ""
            faces, _, _ = triangulate(read)
            assert len(faces) or read.polylines
            assert ((faces >= 0) & (faces < read.xyz.shape[1])).all()
            per_polygon = [*read.polygon_properties.values(), *(label.codes for label in read.polygon_labels.values())]
            assert all(len(values) == read.polygons for values in per_polygon)
            assert all(len(values) == read.xyz.shape[1] for values in read.vertex_properties.values())
    assert message.isprintable()

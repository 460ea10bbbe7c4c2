"""Recognition of formats by name and content, and refused content."""

from __future__ import annotations

import gzip
import hashlib
import io
from pathlib import Path

import pytest

from curvcli.errors import UsageError
from curvcli.loading.read import read_mesh_file
from curvcli.loading.registry import suffixes
from tests.helpers.spelling import ascii_stl, binary_stl
from tests.loading.files import CONTENT, OBJ, refused
from tests.loading.test_stl import TETRAHEDRON


@pytest.mark.parametrize("suffix", ["obj", "ply", "stl", "OBJ", "Ply", "STL"])
@pytest.mark.parametrize("packed", ["", ".gz", ".GZ"])
def test_every_promised_suffix_is_read(tmp_path: Path, suffix: str, packed: str) -> None:
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
def test_streams_are_recognised_by_content(kind: str, packed: bool) -> None:
    data = gzip.compress(CONTENT[kind]) if packed else CONTENT[kind]
    for wanted in (kind, kind.upper(), None):
        mesh = read_mesh_file(io.BytesIO(data), input_format=wanted)
        assert (mesh.format, mesh.path, mesh.notices) == (kind, "-", ())
    assert refused(io.BytesIO(b"hello")).startswith("-: content not recognised; --input-format")
    assert refused(io.BytesIO(b"")).startswith("-: no data found")


def test_a_stream_has_no_name_to_be_wrong() -> None:
    (notice,) = read_mesh_file(io.BytesIO(CONTENT["obj"]), input_format="ply").notices
    assert "not PLY as --input-format says" in notice.message
    assert notice.hint == "--input-format obj"


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


def test_text_in_utf_16_is_refused(tmp_path: Path) -> None:
    """Also without a byte-order mark: with zeros for blanks, `10` would be read as two numbers."""
    for kind in ("obj", "ply", "stl"):
        path = tmp_path / f"mesh.{kind}"
        for encoding in ("utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-32-le", "utf-32-be"):
            path.write_bytes(OBJ.replace(b"v 1 ", b"v 10 ").decode().encode(encoding))
            assert "UTF-16 or UTF-32 text found" in refused(path)


def test_other_suffixes_are_refused_unless_told(tmp_path: Path) -> None:
    for name in ("mesh.raw", "mesh", "mesh.obj.bak", "mesh.gz", "obj"):
        path = tmp_path / name
        path.write_bytes(OBJ)
        message = refused(path)
        assert f"{', '.join(f'.{suffix}' for suffix in suffixes())} expected" in message
        assert "--input-format" in message
        assert read_mesh_file(path, input_format="obj").polygons == 2
    with pytest.raises(UsageError, match="`raw` is not known"):
        read_mesh_file(tmp_path / "mesh.raw", input_format="raw")


@pytest.mark.parametrize(
    "header",
    [
        b"\x1f\x8b",
        b"\x1f\x8b\x08\0\0\0\0\0\0\x03",
        gzip.compress(b"a header", mtime=0)[:80],
        b"\x1f\x8b\x08 made by a scanner",
    ],
)
@pytest.mark.parametrize("rest", [b"", b"\n"])
@pytest.mark.parametrize("name", ["part.stl", "part.STL.gz"])
def test_a_header_that_begins_as_gzip_does(tmp_path: Path, header: bytes, rest: bytes, name: str) -> None:
    """A binary STL is one where it is no gzip; its hash is that of the file."""
    data = binary_stl(TETRAHEDRON, header.ljust(80, b"\0")) + rest
    path = tmp_path / name
    path.write_bytes(data)
    mesh = read_mesh_file(path)
    assert (mesh.format, mesh.polygons, mesh.sha256) == ("stl", 4, hashlib.sha256(data).hexdigest())
    assert [notice.code for notice in mesh.notices] == ["trailing_data"] * len(rest)
    assert read_mesh_file(io.BytesIO(data), input_format="stl").polygons == 4
    if not rest:
        assert read_mesh_file(io.BytesIO(data)).polygons == 4


def test_damaged_gzip_is_no_stl(tmp_path: Path) -> None:
    packed = gzip.compress(CONTENT["stl"])
    for data in (packed[:-9], packed[:20] + b"\xff" + packed[21:]):
        path = tmp_path / "part.stl.gz"
        path.write_bytes(data)
        assert "damaged gzip data found" in refused(path)


def test_a_solid_with_a_byte_too_many_from_a_stream() -> None:
    data = binary_stl(TETRAHEDRON, b"solid") + b"\n"
    for wanted in (None, "stl", "obj", "ply"):
        assert read_mesh_file(io.BytesIO(data), input_format=wanted).polygons == 4

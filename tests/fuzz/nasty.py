"""Files that a stranger with bad intentions, a broken exporter or another country's locale would write, each by hand.

FILES: by name the content, and what is expected: the faces that are read, or words of the refusal.
"""

from __future__ import annotations

import bz2
import gzip
import io
import lzma
import struct
import tarfile
import zlib

TETRAHEDRON = b"v 0 0 0\nv 10 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
POINTS = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
XYZ = b"property float x\nproperty float y\nproperty float z\n"
ROWS = b"0 0 0\n1 0 0\n0 1 0\n"
BINARY = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
FACE = struct.pack("<B3i", 3, 0, 1, 2)
LITTLE = b"binary_little_endian"
FACET = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
TEXT_STL = b"""solid x
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
endsolid x
"""

FILES: dict[str, tuple[bytes, int | str]] = {}


def _ply(elements: bytes, body: bytes, order: bytes = b"ascii") -> bytes:
    return b"ply\nformat " + order + b" 1.0\n" + elements + b"end_header\n" + body


def _elements(vertices: object = 3, faces: object = 1, kind: bytes = b"uchar int", more: bytes = b"") -> bytes:
    head = f"element vertex {vertices}\n".encode() + XYZ + more + f"element face {faces}\n".encode()
    return head + b"property list " + kind + b" vertex_indices\n"


def _stl(count: int, body: bytes, head: bytes = b"") -> bytes:
    return head.ljust(80, b"\0")[:80] + struct.pack("<I", count) + body


def _tar(content: bytes) -> bytes:
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode="w") as archive:
        info = tarfile.TarInfo("mesh.obj")
        info.size = len(content)
        archive.addfile(info, io.BytesIO(content))
    return stream.getvalue()


def _ply_files() -> None:
    body = ROWS + b"3 0 1 2\n"
    for count in (2**31, 2**63, 10**40, -3, "0x3", "0_3", "\u0663", "1e1", "3.0"):
        FILES[f"{count} vertices.ply"] = (_ply(_elements(count), body), ": ")
        FILES[f"{count} faces.ply"] = (_ply(_elements(3, count), body), ": ")
        FILES[f"{count} vertices, binary.ply"] = (_ply(_elements(count), BINARY + FACE, LITTLE), ": ")
    lists = {
        "negative": (b"char int", struct.pack("<b3i", -1, 0, 1, 2), "list length -1"),
        "short": (b"uchar int", struct.pack("<B3i", 255, 0, 1, 2), "end inside a row"),
        "huge": (b"uint int", struct.pack("<I3i", 2**32 - 1, 0, 1, 2), "end inside a row"),
        "of fractions": (b"uchar double", struct.pack("<B3d", 3, 0, 1, 2), "an integer type expected"),
        "of a fraction": (b"float int", struct.pack("<f3i", 3, 0, 1, 2), "an integer type expected"),
        "of lists": (b"uchar list uchar int", FACE, "a PLY header statement expected"),
        "beyond": (b"uchar uint", struct.pack("<B3I", 3, 0, 1, 2**32 - 1), "vertex index 4294967295"),
        "of 255": (b"uchar int", struct.pack("<B255i", 255, *([0, 1, 2] * 85)), 85),
    }
    for name, (kind, row, expected) in lists.items():
        FILES[f"list {name}.ply"] = (_ply(_elements(kind=kind), BINARY + row, LITTLE), expected)
    twice = b"element vertex 3\n" + XYZ + b"property float x\n" + _elements().partition(XYZ)[2]
    rows = ROWS.replace(b"\n", b" 7\n") + b"3 0 1 2\n"
    FILES.update(
        {
            "negative list in text.ply": (_ply(_elements(kind=b"char int"), ROWS + b"-3 0 1 2\n"), "list length -3"),
            "x twice.ply": (_ply(twice, rows), "property `x` announced 2 times"),
            "vertex twice.ply": (_ply(_elements() * 2, body * 2), "element `vertex` announced 2 times"),
            "format twice.ply": (_ply(b"format " + LITTLE + b" 1.0\n" + _elements(), body), "a second `format`"),
            "letters of Latin-1.ply": (_ply("comment \u00c5\x85 \u00e0\n".encode("latin-1") + _elements(), body), 1),
            "letters of UTF-8.ply": (
                _ply(
                    "comment \u00c5ngstr\u00f6m\n".encode() + _elements(more="property float \u00e0b\n".encode()), rows
                ),
                1,
            ),
            "a megabyte of comment.ply": (_ply(b"comment " + b"x" * 2**20 + b"\n" + _elements(), body), 1),
            "obj_info.ply": (_ply(b"obj_info element vertex 9\ncomment end_header\n" + _elements(), body), 1),
            "rows without bytes.ply": (_ply(b"element e 9999999999\n" + _elements(), BINARY + FACE, LITTLE), 1),
            "faces first.ply": (
                _ply(
                    b"element face 1\nproperty list uchar int vertex_indices\nelement vertex 3\n" + XYZ,
                    b"3 0 1 2\n" + ROWS,
                ),
                1,
            ),
            "big as little.ply": (
                _ply(_elements(), struct.pack(">9fB3i", 0, 0, 0, 1, 0, 0, 0, 1, 0, 3, 0, 1, 2), LITTLE),
                "vertex index 16777216",
            ),
            "text as binary.ply": (_ply(_elements(), body, LITTLE), "room for at most"),
            "binary as text.ply": (_ply(_elements(), BINARY + FACE), ": "),
            "line ends of DOS in binary.ply": (_ply(_elements(), BINARY + FACE, LITTLE).replace(b"\n", b"\r\n", 9), 1),
            "one line.ply": (_ply(_elements(), body.replace(b"\n", b" ")), "3 rows announced, 1 found"),
            "capitals.ply": (_ply(_elements(), body).upper(), "no PLY header"),
            "fraction as index.ply": (_ply(_elements(), ROWS + b"3 0 1 2.5\n"), "a whole number expected"),
            "no end.ply": (_ply(_elements(), b"")[:-12], "no `end_header`"),
            "strip of -2.ply": (
                _ply(
                    b"element vertex 3\n" + XYZ + b"element tristrips 1\nproperty list int int vertex_indices\n",
                    ROWS + b"3 0 1 -2\n",
                ),
                "vertex index -2",
            ),
        }
    )


def _numbers() -> None:
    words = "0x1p3 0x10 1_000 \u0663 \uff11 \u00bd 1,5 1.5f 1d3 --1 1e e5 1e+ 1.0.0 0b1 1j True 1L nan(0x1)"
    for word in words.split():
        FILES[f"x = {word}.obj"] = (
            TETRAHEDRON.replace(b"v 10", b"v " + word.encode()),
            f"line 2: `{word}` found",
        )
        FILES[f"x = {word}.ply"] = (
            _ply(_elements(), ROWS.replace(b"\n1 ", b"\n" + word.encode() + b" ") + b"3 0 1 2\n"),
            f"line 11: `{word}` found",
        )
    for word in ("nan", "-NaN", "inf", "-Infinity", "1e400", "9" * 400, "1.#QNAN", "-1.#IND", "-nan(ind)", "1.#INF00"):
        FILES[f"x = {word[:20]}.obj"] = (TETRAHEDRON.replace(b"v 10", b"v " + word.encode()), "are not finite")
    for word in ("1.", "+.5", "1E0", "1.0" + "0" * 10_000 + "1"):
        FILES[f"x = {word[:20]}.obj"] = (TETRAHEDRON.replace(b"v 10", b"v " + word.encode()), 4)


def _obj_files() -> None:
    faces: dict[str, int | str] = {
        "1// 2// 3//": 1, "1/ 2/ 3/": 1, "1/2/3/4 2/2/3/4 3/2/3/4": 1, "+1 02 3": 1, "-4 -3 -2": 1, "1 2 3\\\n4": 2,
        "1 2 3 \\": 1, "1\t2\x0c3": 1, "/ 2 3": "a vertex index expected", "-0 1 2": "vertex index `-0`",
        "1.0 2.0 3.0": "a vertex index expected", "1 2 4294967299": "a vertex index expected", "1 2 -5": "`-5` found",
        "1\u00a02\u00a03": "a vertex index expected", "1 2 3\u2028f 1 2 4": "a vertex index expected",
        "1 2": "no faces", "1 1 1": "no faces", "1 2 3 1 2 3": 2,
    }  # fmt: skip
    for words, expected in faces.items():
        FILES[f"f {words!r}.obj".replace("/", "|")] = (POINTS + b"f " + words.encode() + b"\n", expected)
    FILES.update(
        {
            "v of two.obj": (b"v 1 2\n" + POINTS + b"f 1 2 3\n", "with 2 numbers"),
            "v of eight.obj": (POINTS + b"v 1 1 1 1 1 1 1 1\nf 1 2 3\n", 1),
            "faces before vertices.obj": (b"f 1 2 3\n" + POINTS, 1),
            "back before vertices.obj": (b"f -1 -2 -3\n" + POINTS, "vertex index `-1`"),
            "calls.obj": (b"call nasty.obj a b\ncsh -rm\nmtllib " + b"../" * 99 + b"etc/passwd\n" + TETRAHEDRON, 4),
            "empty.obj": (b"", "no data found"),
            "zeros.obj": (bytes(1000), "no OBJ record"),
            "html.obj": (b"<html><body>404</body></html>", "a web page found"),
            "pointer.obj": (
                b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 9\n",
                "a Git LFS pointer found",
            ),
            "capitals.obj": (TETRAHEDRON.upper(), "no OBJ record"),
            "tar.obj": (_tar(b"#\n" + TETRAHEDRON), "a tar archive found"),
            "zip.obj": (b"PK\x03\x04" + bytes(50) + TETRAHEDRON, "a ZIP archive found"),
            "bzip2.obj": (bz2.compress(TETRAHEDRON), "bzip2 data found"),
            "xz.obj": (lzma.compress(TETRAHEDRON), "xz data found"),
            "lines of all kinds.obj": (TETRAHEDRON.replace(b"\n", b"\r\n", 3).replace(b"\nf", b"\rf", 1), 4),
            "no last line end.obj": (TETRAHEDRON[:-1], 4),
            "largest.obj": (TETRAHEDRON.replace(b"10", b"1e308"), 4),
            "smallest.obj": (TETRAHEDRON.replace(b"10", b"5e-324"), 4),
            "one place.obj": (b"v 1 1 1\n" * 4 + b"f 1 2 3\nf 1 2 4\n", 2),
        }
    )


def _stl_files() -> None:
    FILES.update(
        {
            "too many.stl": (_stl(5, FACET * 2), "5 facets announced, room for 2"),
            "too few.stl": (_stl(1, FACET * 3), 1),
            "none.stl": (_stl(0, FACET), "no faces"),
            "all there are.stl": (_stl(2**32 - 1, FACET), "4294967295 facets announced"),
            "solid.stl": (_stl(2, FACET * 2, b"solid exported\nfacet normal 0 0 1\nouter loop\n"), 2),
            "normal of nothing.stl": (_stl(1, struct.pack("<3f", *[float("nan")] * 3) + FACET[12:]), 1),
            "attribute.stl": (_stl(1, FACET[:-2] + b"\xff\xff"), 1),
            "83 bytes.stl": (bytes(83), "83 bytes found"),
            "capitals.stl": (TEXT_STL.upper(), 1),
            "commas.stl": (TEXT_STL.replace(b"1 0 0", b"1,0 0,0 0,0"), "`1,0` found"),
            "four vertices.stl": (TEXT_STL.replace(b"vertex 0 0 0", b"vertex 0 0 0\n" * 2), "facet with 4 vertices"),
            "four numbers.stl": (TEXT_STL.replace(b"vertex 0 0 0", b"vertex 0 0 0 0"), "vertex with 4 numbers"),
            "cut.stl": (TEXT_STL[:60], "facet with 2 vertices"),
            "name.stl": (TEXT_STL.replace(b"solid x", b"solid \xff\0 facet normal vertex", 1), 1),
            "text and binary.stl": (TEXT_STL + _stl(1, FACET), "inside a facet"),
            "ply.stl": (_ply(_elements(), ROWS + b"3 0 1 2\n"), 1),
        }
    )


def _packed() -> None:
    packed = gzip.compress(TETRAHEDRON)
    FILES.update(
        {
            "members.obj.gz": (gzip.compress(TETRAHEDRON[:40]) + gzip.compress(TETRAHEDRON[40:]), 4),
            "many members.obj.gz": (gzip.compress(b"\n") * 2000 + packed, 4),
            "padded.obj.gz": (packed + bytes(99), 4),
            "named.obj.gz": (b"\x1f\x8b\x08\x08\0\0\0\0\0\xff../../etc/passwd\0" + packed[10:], 4),
            "plain.obj.gz": (TETRAHEDRON, 4),
            "hidden.obj": (packed, 4),
            "cut.obj.gz": (packed[:-6], "damaged gzip data"),
            "wrong sum.obj.gz": (packed[:-8] + bytes(8), "damaged gzip data"),
            "garbage after.obj.gz": (packed + b"garbage", "damaged gzip data"),
            "two bytes.obj.gz": (b"\x1f\x8b", "damaged gzip data"),
            "twice.obj.gz": (gzip.compress(packed), "gzip data within gzip data"),
            "zlib.obj.gz": (zlib.compress(TETRAHEDRON), "no OBJ record"),
            "bomb.obj.gz": (gzip.compress(bytes(80_000_000), 9), "--max-bytes sets the limit"),
        }
    )


_ply_files()
_numbers()
_obj_files()
_stl_files()
_packed()

"""Bytes one piece after the other: all of them, once, hashed, and none that came or went meanwhile."""

from __future__ import annotations

import gzip
import hashlib
import os
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from curvcli.errors import InputError
from curvcli.loading.pieces import Pieces
from curvcli.loading.read import read_mesh_file
from tests.helpers.cli.program import environment
from tests.helpers.spelling import binary_stl, polygons
from tests.loading.parsing import Small, parsed
from tests.loading.test_ply import HEAD, binary_ply
from tests.loading.test_stl import TETRAHEDRON

ACTS = st.lists(st.sampled_from(["take", "ahead", "back", "whole"]), max_size=40)


@given(st.binary(max_size=2000), ACTS, st.booleans(), st.data())
def test_every_byte_once(
    tmp_path_factory: pytest.TempPathFactory, data: bytes, acts: list[str], on_disk: bool, draw: st.DataObject
) -> None:
    path = tmp_path_factory.getbasetemp() / "bytes"
    path.write_bytes(data)
    with path.open("rb", buffering=0) as file, Small(file if on_disk else data) as pieces:
        seen, last = b"", None
        for act in acts:
            assert pieces.left == len(data) - len(seen)
            if act == "take":
                last = pieces.take(draw.draw(st.integers(0, min(pieces.left, pieces.longest))))
                seen += last
            elif act == "back" and last is not None:
                seen = seen[: len(seen) - len(last)]
                pieces.back(last)
                last = None
            elif act == "whole":
                assert pieces.whole() == data[len(seen) :]
                last = None
            else:
                assert pieces.ahead() == data[len(seen) :][: Small.window]
        if draw.draw(st.booleans()):
            assert pieces.rest() == data[len(seen) :]
            assert pieces.left == 0
        assert pieces.sha256() == hashlib.sha256(data).hexdigest()


def test_pieces_stay_until_two_more_are_taken(tmp_path: Path) -> None:
    path = tmp_path / "bytes"
    path.write_bytes(bytes(range(250)))
    with path.open("rb", buffering=0) as file, Small(file) as pieces:
        taken = [pieces.take(80) for _ in range(3)]
        assert [bytes(piece) for piece in taken] == [bytes(range(k, k + 80)) for k in (0, 80, 160)]


@pytest.mark.parametrize("change", [-60, -1, 1])
@pytest.mark.parametrize("taken", [0, 70, 100])
def test_a_file_that_changes(tmp_path: Path, change: int, taken: int) -> None:
    path = tmp_path / "bytes"
    path.write_bytes(bytes(100))
    with path.open("rb", buffering=0) as file, Pieces(file) as pieces:
        pieces.take(taken)
        os.truncate(path, 100 + change)
        with pytest.raises(InputError, match=r"100 bytes expected, \d+ read: the file changed while it was read"):
            pieces.sha256()


@pytest.mark.parametrize("end", [b"", b"more than was announced"])
def test_the_hash_is_that_of_the_file_however_it_is_read(tmp_path: Path, end: bytes) -> None:
    contents = {
        "plain.ply": binary_ply([(0, 1, 2), (0, 2, 3)]),
        "mixed.ply": binary_ply([(0, 1, 2), (0, 1, 2, 3)]),
        "m.stl": binary_stl(TETRAHEDRON),
    }
    for name, data in contents.items():
        for path, stored in ((tmp_path / name, data + end), (tmp_path / f"{name}.gz", gzip.compress(data + end))):
            path.write_bytes(stored)
            mesh = read_mesh_file(path)
            assert mesh.sha256 == hashlib.sha256(stored).hexdigest()
            assert [notice.code for notice in mesh.notices] == ["trailing_data"] * bool(end)


def test_binary_content_needs_no_reader_of_text(tmp_path: Path) -> None:
    points = np.random.default_rng(1).standard_normal((30_000, 3)).astype("<f4")
    faces = np.empty(10_000, [("size", "u1"), ("corners", "<i4", 3)])
    faces["size"], faces["corners"] = 3, np.arange(30_000).reshape(-1, 3)
    head = binary_ply([]).replace(b"vertex 4", b"vertex 30000").replace(b"face 0", b"face 10000")
    head = head[: head.index(b"end_header\n") + 11]
    (tmp_path / "large.ply").write_bytes(head + points.tobytes() + faces.tobytes())
    program = (
        "import sys\nfrom curvcli.loading.read import read_mesh_file\n"
        "mesh = read_mesh_file('large.ply')\nprint(mesh.polygons, float(mesh.xyz[1, 2]), 'polars' in sys.modules)"
    )
    ran = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, cwd=tmp_path, env=environment(), check=True
    )
    assert ran.stdout.split() == ["10000", str(float(points[2, 1])), "False"]


@given(st.lists(st.integers(0, 3), min_size=20, max_size=20), st.integers(0, 20))
def test_lists_at_vertices_that_change_their_length_anywhere(lengths: list[int], same: int) -> None:
    """The first rows are alike, so that they may be read at once."""
    lengths = [2] * same + lengths[same:]
    head = HEAD.format(order="binary_little_endian", faces=1).replace("vertex 4", "vertex 20")
    head = head.replace("property float y", "property list uchar int rings\nproperty float y\nproperty double mark")
    body = b"".join(
        struct.pack(f"<fB{n}ifdf", k, n, *range(n), 2 * k, k / 7, 3 * k) for k, n in enumerate(lengths)
    ) + struct.pack("<B3i", 3, 0, 1, 19)
    mesh = parsed("ply", head.encode() + body)
    assert mesh.xyz.T.tolist() == [[k, 2 * k, 3 * k] for k in range(20)]
    assert list(mesh.vertex_properties) == ["mark"]
    assert mesh.vertex_properties["mark"].tolist() == [k / 7 for k in range(20)]
    assert polygons(mesh) == [(0, 1, 19)]

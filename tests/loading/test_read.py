"""From a path or a stream to its content: welded as told, always through trimesh, and nothing else opened."""

from __future__ import annotations

import io
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
from curvcli.loading.read import read_mesh_file
from curvcli.mesh.polygons import triangulate
from tests.helpers.spelling import ascii_stl
from tests.loading.files import CONTENT, OBJ, PLY, STL, refused
from tests.loading.test_ply import STRIPS
from tests.loading.test_stl import TETRAHEDRON


@pytest.mark.parametrize("normals", ["mesh", "file"])
def test_points_with_normals_are_no_surface(normals: str) -> None:
    data = b"v 0 0 0\nvn 0 0 1\nv 1 0 0\nvn 0 0 1\nv 0 1 0\nvn 0 0 1\n"
    assert refused(io.BytesIO(data), input_format="obj", normals=normals).startswith("-: no faces; ")
    assert refused(io.BytesIO(data + b"f\nf 1//1 2//2\n"), input_format="obj", normals=normals).startswith(
        "-: no faces; "
    )
    curve = read_mesh_file(io.BytesIO(data + b"l 1 2 3\n"), input_format="obj", normals=normals)
    assert [line.tolist() for line in curve.polylines] == [[0, 1, 2]]


def test_only_stl_is_welded_by_default(tmp_path: Path) -> None:
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
    for weld in ("some", "", 0, "0", -1.0, float("nan"), 1, 2.0):
        with pytest.raises(UsageError, match=r"^--weld .*: expected auto, none, exact or a tolerance"):
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

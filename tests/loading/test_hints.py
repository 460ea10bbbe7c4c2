"""Ways out for what is not read: true of the suffix, fit for a shell, and commands that work."""

from __future__ import annotations

import io
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
import trimesh

import curvcli
from curvcli.loading.read import read_mesh_file
from curvcli.loading.registry import input_formats
from tests.helpers.cli.program import CUBE
from tests.helpers.cli.program import curvcli as program
from tests.helpers.meshes import tetrahedron
from tests.loading.files import OBJ, refused

BODY = tetrahedron()
POINTS, FACES = BODY.points, BODY.faces


def run(message: str, folder: Path) -> None:
    """Run the command that a message names."""
    found = re.search("`((?:meshio|python) .*?)` converts", message)
    assert found
    command = shlex.split(found[1])
    program = {"meshio": f"from meshio._cli import main; main({command[1:]!r})", "python": command[2]}[command[0]]
    done = subprocess.run([sys.executable, "-c", program], cwd=folder, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("suffix", ["mesh", "inp", "nas", "bdf", "vol", "avs", "dat", "tec", "fem", "mdpa", "meshb"])
def test_meshio_converts_what_it_is_said_to(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"a part.{suffix}"
    meshio.Mesh(POINTS, [("triangle", FACES)]).write(path)
    message = refused(path)
    assert f"`meshio convert {shlex.quote(str(path))} OUT.ply`" in message
    run(message, tmp_path)
    assert read_mesh_file(tmp_path / "OUT.ply").polygons == 4


@pytest.mark.parametrize("suffix", ["vtkhdf", "vtm"])
def test_pyvista_converts_what_it_is_said_to(suffix: str, tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    mesh = pyvista.PolyData.from_regular_faces(POINTS, FACES)
    path = tmp_path / f"part.{suffix}"
    (pyvista.MultiBlock([mesh]) if suffix == "vtm" else mesh).save(path)
    run(refused(path), tmp_path)
    assert read_mesh_file(tmp_path / "OUT.ply").polygons == 4


@pytest.mark.parametrize("suffix", ["3ds", pytest.param("wrl", marks=pytest.mark.slow), "ctm"])
def test_pymeshlab_converts_what_it_is_said_to(suffix: str, tmp_path: Path) -> None:
    pymeshlab = pytest.importorskip("pymeshlab")
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(POINTS, FACES))
    meshes.save_current_mesh(str(tmp_path / f"part.{suffix}"))
    run(refused(tmp_path / f"part.{suffix}"), tmp_path)
    assert read_mesh_file(tmp_path / "OUT.ply").polygons == 4


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("part.step", "a CAD program"),
        ("PART.STP", "a CAD program"),
        ("part.SLDPRT", "a CAD program"),
        ("lh.aparc.annot", "--regions"),
        ("head.nii.gz", "marching_cubes"),
        ("scan.las", "points have no faces"),
        ("scene.blend", "Blender"),
        ("parts.zip", "unpack it first"),
        ("report.json", "curvcli compare"),
        ("table.csv", "curvcli compare"),
    ],
)
@pytest.mark.parametrize("command", ["analyze", "check", "curves"])
def test_no_option_is_promised_to_read_another_format(name: str, words: str, command: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_bytes(b"anything")
    ended = program(command, path)
    assert ended.code == 3
    assert words in ended.complaint
    assert "--input-format" not in ended.complaint


@pytest.mark.parametrize("name", ["mesh", "mesh.obj.bak", "mesh.1"])
def test_an_unknown_suffix_may_hide_a_known_format(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_bytes(OBJ)
    names = "|".join(input_formats())
    assert f"--input-format {names} reads a file of such a format under another name" in refused(path)


@pytest.mark.parametrize("name", ["a'b.inp", 'a"$(touch gone).vtm', "a`touch gone`.mesh", "a\nb.vts", "a{plain}.vti"])
def test_a_name_ends_no_quotes(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(b"anything")
    message = refused(tmp_path / name)
    assert "IN." in message or "meshio" in message
    assert len(message.splitlines()) == 1


@pytest.mark.parametrize("command", [["analyze"], ["check"], ["curves"]])
def test_a_folder_names_the_glob_and_batch(command: list[str], tmp_path: Path) -> None:
    folder = tmp_path / "my parts"
    folder.mkdir()
    (folder / "notes.txt").write_text("")
    for name, suffix in (("b.STL.gz", "STL.gz"), ("a.obj", "obj")):
        if suffix == "obj":
            (folder / "b.STL.gz").unlink()
        (folder / name).write_bytes(b"")
        ended = program(*command, folder)
        assert ended.code == 3
        assert f"'{folder}'/*.{suffix} names the meshes in it" in ended.complaint
        assert f"`curvcli batch '{folder}/**/*.{suffix}' -o OUT`" in ended.complaint


@pytest.mark.parametrize("command", [["analyze"], ["check"], ["curves"], ["compare", CUBE]])
@pytest.mark.parametrize("url", ["https://example.org/a.ply", "s3://bucket/a.stl", "file:///tmp/a.ply", "HTTP://a/b"])
def test_a_url_names_batch(command: list[str], url: str) -> None:
    ended = program(*command, url)
    assert ended.code == 3
    assert f"`curvcli batch {url} -o OUT` reads a URL" in ended.complaint
    assert ("pip install 'curvcli[remote]'" in ended.complaint) == (not url.startswith("file"))


def test_batch_reads_a_file_url_and_the_glob_of_a_folder(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    BODY.write(tmp_path / "in" / "a.obj")
    for number, place in enumerate((f"file://{tmp_path}/in/a.obj", f"{tmp_path}/in/**/*.obj")):
        assert program("batch", place, "-o", tmp_path / f"OUT{number}").code == 0


def test_a_pattern_between_quotes_names_batch(tmp_path: Path) -> None:
    ended = program("check", f"{tmp_path}/*.ply")
    assert ended.code == 3
    assert "expands patterns" in ended.complaint


def given() -> dict[str, Any]:
    pyvista = pytest.importorskip("pyvista")
    mesh = trimesh.Trimesh(POINTS, FACES, process=False)
    x, y = np.meshgrid(np.arange(3.0), np.arange(3.0))
    return {
        "StructuredGrid": (pyvista.StructuredGrid(x, y, x * y), "mesh.extract_surface()"),
        "MultiBlock": (pyvista.MultiBlock([pyvista.Sphere()]), "blocks.combine().extract_surface()"),
        "trimesh.Scene": (trimesh.Scene(mesh), "scene.to_mesh()"),
        "trimesh.PointCloud": (trimesh.PointCloud(POINTS), ""),
        "the class Mesh": (meshio.Mesh, "pass an object of it"),
        "the class Trimesh": (trimesh.Trimesh, "pass an object of it"),
        "ndarray": (POINTS, ""),
        "NoneType": (None, ""),
        "io.StringIO": (io.StringIO("v 0 0 0"), "mode 'rb'"),
        "list": (["a.ply", "b.ply"], ""),
        "tuple": ((POINTS, FACES, FACES), ""),
        "dict": ({"vertices": POINTS, "faces": FACES}, ""),
    }


@pytest.mark.parametrize("kind", ["analyze", "load"])
def test_other_objects_are_a_type_error_that_says_what_is_accepted(kind: str) -> None:
    for name, (one, instead) in given().items():
        with pytest.raises(TypeError) as error:
            getattr(curvcli, kind)(one)
        message = str(error.value)
        assert "a path" in message
        assert "a binary stream" in message
        assert f"{name}" in message.partition(", not ")[2]
        assert instead in message


def test_what_is_to_be_passed_instead_is_accepted() -> None:
    pyvista = pytest.importorskip("pyvista")
    blocks = pyvista.MultiBlock([pyvista.PolyData.from_regular_faces(POINTS, FACES)])
    for surface in (
        blocks.combine().extract_surface(algorithm=None),
        trimesh.Scene(trimesh.Trimesh(POINTS, FACES)).to_mesh(),
    ):
        assert abs(curvcli.analyze(surface, passes="topology").totals["K"] - 4 * np.pi) < 1e-12


def test_streams_are_read() -> None:
    with open(CUBE, "rb") as stream:
        assert curvcli.load(stream).n_faces == 12
    with open(CUBE, "rb", buffering=0) as stream:
        assert curvcli.load(stream).n_faces == 12

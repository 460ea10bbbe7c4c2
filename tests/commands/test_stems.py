"""`{stem}` never leads out of the folder that an output names, whatever the mesh is called."""

from __future__ import annotations

import gzip
import os
import shutil
from pathlib import Path

import pytest

from curvcli.commands.stems import expand, stem
from tests.commands.conftest import Run
from tests.helpers.cli.program import CUBE

DOTS = ["...ply", "..ply", ".ply", "....ply", ".obj.ply", "...ply.gz", "....obj.stl", "..PLY", ". .ply", " .ply"]
ODD = ["{stem}.obj", "a b.ply", "~.ply", "-.ply", "--force.ply", "a\\..\\b.obj", "a\nb.ply", "CON.obj", "a..ply"]
MARKED = ["\x1b[31m.ply", "$HOME.ply", "%2e%2e.ply", "\u202e.ply", "c:x.obj", "..\\...ply", "x" * 251 + ".ply"]
NAMES = [*DOTS, *ODD, *MARKED]
FOLDERS = ["", ".", "..", "./", "a/..", "a/.", "a/", "/", "//", "../..", "a/../", "/..", "."]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("before", ["", "./", "../", "/", "a/b/", "../../"])
def test_a_stem_is_one_name(name: str, before: str) -> None:
    found = stem(before + name)
    assert found
    assert "/" not in found
    assert found.strip(".") or len(found) > 2
    for output in ("out/{stem}.csv", "out/{stem}/k.csv", "out/{stem}", "out/a{stem}/../{stem}/k.csv"):
        path = os.path.normpath(expand(output, before + name, 1))
        assert os.path.commonpath([path, "out"]) == "out", path
        assert path != "out"


@pytest.mark.parametrize("mesh", FOLDERS)
def test_a_folder_goes_by_its_name(mesh: str) -> None:
    found = stem(mesh)
    assert found not in ("", ".", "..")
    assert "/" not in found


def test_usual_names_keep_their_stems() -> None:
    stems = {
        "bunny.obj": "bunny",
        "a/b.PLY": "b",
        "m.ply.gz": "m",
        "x.stl": "x",
        "part.v2.obj": "part.v2",
        "plain": "plain",
    }
    assert {name: stem(name) for name in stems} == stems
    assert expand("{stem}", "./-", 1) == "./-"
    assert expand("{stem}.csv", "-", 1) == "stdin.csv"


def test_devices_and_dots_on_windows() -> None:
    for name in ("con.ply", "NUL.obj", "com1.v2.stl", "Aux", "lpt9 .ply", "a..ply", "a .ply"):
        assert stem(name, windows=True).endswith("_")
    assert stem("bacon.ply", windows=True) == "bacon"


@pytest.mark.parametrize("name", NAMES)
def test_outputs_stay_in_the_folder_that_was_named(within: Run, name: str, tmp_path: Path) -> None:
    mesh = tmp_path / "in" / name
    mesh.parent.mkdir()
    shutil.copy(CUBE, mesh)
    out = tmp_path / "a" / "out"
    out.mkdir(parents=True)
    (out / stem(name)).mkdir()
    if ".gz" in name:
        mesh.write_bytes(gzip.compress(Path(CUBE).read_bytes()))
    ended = within("analyze", mesh, "-o", "a/out/{stem}/k.csv", "-o", "a/out/{stem}.tsv", "--input-format", "obj", "-q")
    assert ended.code == 0, ended
    assert {str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*") if path.is_file()} == {
        os.path.join("in", name),
        os.path.join("a", "out", stem(name), "k.csv"),
        os.path.join("a", "out", stem(name) + ".tsv"),
    }


def test_a_name_that_is_too_long_is_told(within: Run, tmp_path: Path) -> None:
    mesh = tmp_path / ("x" * 251 + ".obj")
    shutil.copy(CUBE, mesh)
    ended = within("analyze", mesh, "-o", "{stem}.parquet", "-q")
    assert ended.code == 4
    assert "File name too long" in ended.complaint
    assert list(tmp_path.iterdir()) == [mesh]

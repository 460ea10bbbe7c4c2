"""The plan: which meshes, in which order, once each, and outputs that never meet."""

from __future__ import annotations

import io
import os
import sys
from pathlib import Path

import pytest

from curvcli.batch.locations import parts_of
from curvcli.batch.plan import plan, saves
from curvcli.errors import InputError, MissingExtraError, NoMatchError, UsageError
from tests.batch.conftest import ALL


def stems(folder: str, *patterns: str, files_from: str | None = None) -> list[str]:
    """Place of the one output of each mesh, relative to the folder."""
    items = plan(patterns, files_from, folder, ["csv"])
    return [os.path.relpath(item.outputs[0][1], folder).removesuffix(".csv") for item in items]


def paths(*patterns: str) -> list[str]:
    return [item.path for item in plan(patterns, None, "out", ["csv"])]


def test_the_tree_is_mirrored_in_a_fixed_order(scans: Path) -> None:
    assert paths("scans/**/*") == [f"scans/{name}" for name in ALL]
    assert stems("out", "scans/**/*") == ALL
    assert stems("out", "scans/deep/**/*.ply") == ["empty.ply", "er/a.ply"]
    assert stems("out", str(scans / "*.ply")) == ["a.ply", "z.ply"]


def test_expanded_by_the_shell_or_here_is_the_same(scans: Path) -> None:
    assert stems("out", *sorted(map(str, scans.glob("*.*")))) == stems("out", "scans/*.*")


def test_each_mesh_once(scans: Path) -> None:
    assert paths("scans/a.ply", "scans/*.ply", "./scans/a.ply", str(scans / "a.ply")) == ["scans/a.ply", "scans/z.ply"]
    assert paths("scans/z.ply", "scans/*.ply") == ["scans/z.ply", "scans/a.ply"]


def test_equal_names_in_other_roots_do_not_meet(scans: Path) -> None:
    assert stems("out", "scans/*.ply", "scans/deep/er/*.ply") == ["a.ply", "z.ply", "deep/er/a.ply"]
    assert stems("out", "scans/deep/er/*.ply", "scans/deep/*.obj") == ["er/a.ply", "m.obj"]


def test_outputs_that_would_meet_are_numbered(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("a.ply", "A.ply", "a.ply.edges"):
        (tmp_path / name).touch()
    items = plan(["a.ply", "A.ply", "a.ply.edges"], None, "out", ["csv", "edges.csv"])
    written = [path for item in items for _, path in item.outputs]
    assert len({path.casefold() for path in written}) == 6
    assert written[0] == str(tmp_path / "out" / "a.ply.csv")


def test_outputs_of_an_earlier_run_are_no_inputs(scans: Path) -> None:
    (scans / "out").mkdir()
    (scans / "out" / "a.ply.ply").touch()
    items = plan(["scans/**/*.ply"], None, "scans/out", ["csv"])
    assert "scans/out/a.ply.ply" not in [item.path for item in items]
    assert len(items) == 4
    with pytest.raises(NoMatchError):
        plan(["scans/out/*.ply"], None, "scans/out", ["csv"])


def test_a_name_with_wildcards_in_it_is_a_name_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("a[1].ply", "a1.ply"):
        (tmp_path / name).touch()
    assert paths("a[1].ply") == ["a[1].ply"]
    assert paths("a[1]*") == ["a1.ply"]


@pytest.mark.skipif(sys.platform != "linux", reason="names that are not UTF-8 are Linux's")
def test_names_that_are_no_text(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in (b"\xff.ply", b"\\udcff.ply", b"a\nb.ply"):
        Path(os.fsdecode(name)).touch()
    items = plan(["*.ply"], None, "out", ["csv"])
    assert all(item.path.isprintable() for item in items)
    assert len({item.path for item in items}) == len({item.outputs for item in items}) == 3


@pytest.mark.parametrize("end", ["\n", "\r\n", "\0"])
def test_a_list_of_files_keeps_order_without_duplicates(scans: Path, monkeypatch: pytest.MonkeyPatch, end: str) -> None:
    names = ["scans/z.ply", "scans/a.ply", "scans/missing.ply", "scans/z.ply"]
    content = "".join(name + end for name in names).encode()
    Path("list").write_bytes(content)
    assert stems("out", files_from="list") == ["z.ply", "a.ply", "missing.ply"]
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(content)))
    assert stems("out", "scans/*.obj", files_from="-") == ["a.obj", "z.ply", "a.ply", "missing.ply"]


@pytest.mark.parametrize("pattern", ["nothing/*.ply", "scans/*.PLYX", "scans/missing.ply", "scans", "scans/deep/"])
def test_a_pattern_without_a_match_is_refused(scans: Path, pattern: str) -> None:
    with pytest.raises(NoMatchError, match="no file matches"):
        plan(["scans/*.ply", pattern], None, "out", [])


def test_lists_that_name_nothing(tmp_path: Path) -> None:
    (tmp_path / "list").write_text("\n \n")
    with pytest.raises(NoMatchError):
        plan([], str(tmp_path / "list"), "out", [])
    with pytest.raises(InputError, match="the list cannot be read"):
        plan([], str(tmp_path / "none"), "out", [])


def test_file_urls_are_local_paths(scans: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "fsspec.core", None)
    assert paths(f"file://{scans}/a.*") == [str(scans / "a.obj"), str(scans / "a.ply")]


def test_urls_without_their_package(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "fsspec.core", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'curvcli\[remote\]'"):
        plan(["s3://bucket/*.ply"], None, "out", [])


def test_what_to_save() -> None:
    assert saves(["csv,json", ".PLY", "edges.csv", "csv"]) == ("csv", "json", "ply", "edges.csv")
    for wrong in ("cvs", "edges", "edge.csv", "faces.ply", "vertices.csv", ""):
        with pytest.raises(UsageError):
            saves([wrong])


def test_parts_of_urls_are_names() -> None:
    url = "http://host/%2e%2e/a/%00b%0A.ply/..%2F..%2Fc//%2e/d.ply"
    assert parts_of(url) == ("http", "host", "a", r"\x00b\n.ply", "c", "d.ply")

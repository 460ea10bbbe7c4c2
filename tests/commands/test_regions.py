"""`--regions` as a user types it: files of labels, records of an OBJ, properties of a PLY, and what is refused."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.helpers.cli.program import Ended, wrote

Run = Callable[..., Ended]

POINTS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (2, 2, 1))
VERTICES = "".join(f"v {x} {y} {z}\n" for x, y, z in POINTS)


@pytest.fixture(autouse=True)
def meshes(tmp_path: Path) -> None:
    """A square, which is cut in two, and two triangles: three polygons, four faces."""
    (tmp_path / "plain.obj").write_text(f"{VERTICES}f 1 2 3 4\nf 2 5 3\nf 5 6 3\n")
    (tmp_path / "labelled.obj").write_text(
        f"o body\ng left\nusemtl red\n{VERTICES}f 1 2 3 4\ng right\nusemtl blue\nf 2 5 3\no wing\ng left\nf 5 6 3\n"
    )


def named(run: Run, mesh: str, regions: str) -> dict[str, dict[str, Any]]:
    ended = run("analyze", mesh, "--regions", regions, "-p", "all", "--json")
    wrote(ended)
    report = json.loads(ended.out)
    assert report["conventions"]["regions"] == regions
    scopes = {check["scope"] for check in report["checks"] if check["scope"].startswith("region")}
    assert scopes == {f"region {region['name']}" for region in report["regions"]}
    assert all(check["status"] != "fail" for check in report["checks"])
    return {region["name"]: region for region in report["regions"]}


def faces(regions: dict[str, dict[str, Any]]) -> dict[str, int]:
    return {name: region["topology"]["faces"] for name, region in regions.items()}


@pytest.mark.parametrize(
    ("regions", "counted"),
    [
        ("groups", {"left": 3, "right": 1}),
        ("materials", {"red": 2, "blue": 2}),
        ("objects", {"body": 3, "wing": 1}),
    ],
)
def test_records_of_an_obj(within: Run, regions: str, counted: dict[str, int]) -> None:
    found = named(within, "labelled.obj", regions)
    assert faces(found) == counted
    if regions == "objects":
        assert found["body"]["totals"]["area"] == pytest.approx(1.5, rel=1e-15)
        assert found["wing"]["totals"]["area"] == pytest.approx(np.sqrt(6.0) / 2, rel=1e-15)


@pytest.mark.parametrize("per", ["polygon", "triangle"])
@pytest.mark.parametrize("suffix", [".npy", ".csv", ".txt", ".NPY"])
def test_files_of_labels(within: Run, suffix: str, per: str) -> None:
    labels = [7, 0, 7] if per == "polygon" else [7, 7, 0, 7]
    name = f"labels{suffix}"
    if suffix.lower() == ".npy":
        with open(name, "wb") as stream:
            np.save(stream, np.array(labels))
    else:
        Path(name).write_text("\n".join(map(str, labels)) + "\n")
    assert faces(named(within, "plain.obj", name)) == {"0": 1, "7": 3}


@pytest.mark.parametrize(
    "text",
    ["label\n1\n2\n2\n", "\ufeff1\n2\n2", "1\r\n2\r\n2\r\n", "  1 \n\n2\n\n2\n", "1.0\n2e0\n2\n", "-1\n2\n2\n"],
)
def test_spellings_of_labels(within: Run, text: str) -> None:
    Path("labels.csv").write_text(text, encoding="utf-8", newline="")
    counted = faces(named(within, "plain.obj", "labels.csv"))
    assert counted == ({"2": 2} if text.startswith("-1") else {"1": 2, "2": 2})


@pytest.mark.parametrize("kind", ["char", "uchar", "short", "ushort", "int", "uint", "float", "double"])
def test_property_of_a_ply(within: Run, kind: str) -> None:
    head = f"ply\nformat ascii 1.0\nelement vertex {len(POINTS)}\n"
    head += "".join(f"property double {axis}\n" for axis in "xyz") + "element face 3\n"
    head += f"property {kind} part\nproperty list uchar int vertex_indices\nproperty uchar quality\nend_header\n"
    rows = "".join(f"{x} {y} {z}\n" for x, y, z in POINTS)
    Path("parts.ply").write_text(head + rows + "4 4 0 1 2 3 9\n2 3 1 4 2 9\n4 3 4 5 2 8\n")
    assert faces(named(within, "parts.ply", "part")) == {"2": 1, "4": 3}
    assert faces(named(within, "parts.ply", "quality")) == {"8": 1, "9": 3}
    ended = within("analyze", "parts.ply", "--regions", "vertex_indices")
    assert (ended.code, "known: part, quality" in ended.complaint) == (2, True)


def npy(header: str, content: bytes = b"\0" * 24) -> bytes:
    text = header.encode()
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text + content


GARBAGE = {
    "few.npy": (npy("{'descr': '<i8', 'fortran_order': False, 'shape': (2,)}\n", b"\0" * 16), "2 labels, expected 3"),
    "far too many.npy": (npy("{'descr': '<i8', 'fortran_order': False, 'shape': (9999999999999,)}\n"), "damaged"),
    "more than numbers hold.npy": (
        npy(f"{{'descr': '<i8', 'fortran_order': False, 'shape': ({10**30},)}}\n"),
        "damaged",
    ),
    "cut.npy": (npy("{'descr': '<i8', 'fortran_order': False, 'shape': (3,)}\n", b"\0" * 23), "damaged"),
    "header.npy": (npy("{'descr': "), "damaged"),
    "code.npy": (npy("__import__('os').getcwd()\n"), "damaged"),
    "version.npy": (b"\x93NUMPY\x09\x00", "damaged"),
    "pickle.npy": (npy("{'descr': '|O', 'fortran_order': False, 'shape': (3,)}\n"), "damaged"),
    "text.npy": (b"1\n2\n2\n", "not a .npy file"),
    "archive.npy": (b"PK\x03\x04 and so on", "not a .npy file"),
    "empty.npy": (b"", "not a .npy file"),
    "table.npy": (npy("{'descr': '<i8', 'fortran_order': False, 'shape': (3, 1)}\n"), "shape (3, 1)"),
    "words.npy": (npy("{'descr': '<U2', 'fortran_order': False, 'shape': (3,)}\n"), "<U2"),
    "empty.txt": (b"", "0 labels, expected 3 (polygons), 4 (triangles) or 6 (vertices)"),
    "many.txt": (b"1\n" * 5, "5 labels, expected 3 (polygons), 4 (triangles) or 6 (vertices)"),
    "word.csv": (b"label\n1\ntwo\n2\n", "line 3: 'two'"),
    "columns.csv": (b"0,1\n1,2\n2,2\n", "a table without a header"),
    "half.txt": (b"1\n2.5\n2\n", "label 2.5 of face 1"),
    "nan.txt": (b"1\n2\nnan\n", "label nan of face 2"),
    "huge.txt": (b"1\n1e300\n2\n", "label 1e+300 of face 1"),
    "bytes.txt": (bytes(range(256)), "utf-8"),
    "wide.txt": ("1\n2\n2\n".encode("utf-16"), "utf-8"),
    "none.txt": (b"-1\n-1\n-5\n", "no face has a label"),
}


@pytest.mark.parametrize("name", GARBAGE)
def test_garbage_for_labels_is_refused(within: Run, tmp_path: Path, name: str) -> None:
    content, words = GARBAGE[name]
    Path(name).write_bytes(content)
    before = sorted(tmp_path.iterdir())
    ended = within("analyze", "plain.obj", "--regions", name, "-o", "t.csv", "--table", "regions=r.csv")
    assert ended.code == 3
    assert f"{name}: " in ended.complaint
    assert words in ended.complaint
    assert sorted(tmp_path.iterdir()) == before


def test_what_is_no_file(within: Run) -> None:
    os.mkdir("folder.txt")
    for name in ("folder.txt", "missing.txt", "missing.npy"):
        ended = within("analyze", "plain.obj", "--regions", name)
        assert (ended.code, ended.complaint.startswith(f"{name}: ")) == (3, True)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_pipe_is_not_waited_for(within: Run) -> None:
    os.mkfifo("pipe.txt")
    ended = within("analyze", "plain.obj", "--regions", "pipe.txt")
    assert (ended.code, "regular file" in ended.complaint) == (3, True)


@pytest.mark.parametrize("regions", ["groups", "objects", "materials", "part", "labels.dat", ""])
def test_an_unknown_property_is_refused(within: Run, regions: str) -> None:
    ended = within("analyze", "plain.obj", "--regions", regions)
    assert ended.code == 2
    assert f"--regions {regions}" in ended.complaint
    assert "labels of its own" in ended.complaint


def test_known_names_are_offered(within: Run) -> None:
    ended = within("analyze", "labelled.obj", "--regions", "group")
    assert ended.code == 2
    assert ended.complaint.endswith("; nearest: groups")
    ended = within("analyze", "labelled.obj", "--regions", "xyzzy")
    assert all(name in ended.complaint for name in ("groups", "objects", "materials"))


def test_a_table_of_regions_needs_regions(within: Run) -> None:
    ended = within("analyze", "plain.obj", "--table", "regions=r.csv")
    assert (ended.code, "--regions" in ended.complaint, os.path.exists("r.csv")) == (2, True, False)


def test_one_file_of_labels_for_two_meshes(within: Run) -> None:
    """The one it does not fit is refused, the other is done."""
    Path("labels.txt").write_text("1\n2\n2\n2\n")
    Path("single.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    ended = within("analyze", "single.obj", "plain.obj", "--regions", "labels.txt", "-q", "-o", "{stem}.csv")
    assert (ended.code, ended.complaint) == (3, "single.obj: labels.txt: 4 labels, expected 1 (faces) or 3 (vertices)")
    assert not os.path.exists("single.csv")
    assert os.path.exists("plain.csv")


@pytest.mark.parametrize("regions", ["groups", "part"])
def test_labels_that_one_of_several_meshes_lacks(within: Run, regions: str) -> None:
    """It is an error of that mesh, and the others are done."""
    ply = parts_of_a_ply(regions)
    ended = within("analyze", "plain.obj", ply, "--regions", regions, "-q", "-o", "{stem}.csv")
    assert ended.code == 3
    assert ended.complaint.startswith(f"plain.obj: --regions {regions}: ")
    assert (os.path.exists("plain.csv"), os.path.exists("parts.csv")) == (False, True)
    ended = within("check", "plain.obj", ply, "--regions", regions, "--format", "json")
    assert ended.code == 3
    assert [mesh["status"] for mesh in json.loads(ended.out)["meshes"]] == ["error", "pass"]
    assert within("check", "plain.obj", "--regions", regions).code == 2


@pytest.mark.parametrize("name", ["groups", "objects", "materials"])
def test_a_property_may_be_called_as_records_are(within: Run, name: str) -> None:
    assert faces(named(within, parts_of_a_ply(name), name)) == {"2": 1, "4": 3}


def parts_of_a_ply(name: str) -> str:
    """The three polygons as PLY, with a property of faces."""
    head = f"ply\nformat ascii 1.0\nelement vertex {len(POINTS)}\n"
    head += "".join(f"property double {axis}\n" for axis in "xyz") + f"element face 3\nproperty int {name}\n"
    head += "property list uchar int vertex_indices\nend_header\n"
    rows = "".join(f"{x} {y} {z}\n" for x, y, z in POINTS)
    Path("parts.ply").write_text(head + rows + "4 4 0 1 2 3\n2 3 1 4 2\n4 3 4 5 2\n")
    return "parts.ply"

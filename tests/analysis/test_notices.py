"""Warnings: every one has a count, words that agree with it, examples and a way out."""

from __future__ import annotations

import ast
import json
from pathlib import Path
from typing import Any

import pytest

import curvcli
from curvcli.support.words import counted, number_of, pluralize
from tests.fuzz.contract import in_process
from tests.fuzz.nasty import TETRAHEDRON, TEXT_STL

SOURCES = sorted(Path(curvcli.__file__).parent.rglob("*.py"))
LOOSE = b"v 5 5 5\n"
LINE = b"v 20 0 0\nf 1 2 5\n"
MOBIUS = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\nf 1 2 3\nf 2 3 4\nf 3 4 5\nf 4 5 1\nf 5 1 2\n"
FOLDED = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 1 4\n"
INWARDS = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n"

# Content, options, code, and the beginning of the message for one and, from the content twice, for two.
KINDS: dict[str, tuple[bytes, tuple[str, ...], str]] = {
    "unreferenced_vertices": (TETRAHEDRON + LOOSE, (), "vertex that no face uses; its row is empty"),
    "short_faces": (TETRAHEDRON + b"f 1 2\n", (), "face with fewer than 3 corners, dropped"),
    "repeated_corner_faces": (TETRAHEDRON + b"f 1 1 2\n", (), "face with a repeated corner, dropped"),
    "duplicate_faces": (TETRAHEDRON + b"f 1 3 2\n", (), "face with the same corners as an earlier one"),
    "degenerate_faces": (TETRAHEDRON + LINE, (), "face without area; the mean curvature is undefined at its corners"),
    "duplicate_vertices": (
        TETRAHEDRON + b"v 0 0 0\nv 0 -1 -1\nf 5 2 6\n",
        (),
        "vertex at exactly the position of an earlier one",
    ),
    "welded_vertices": (
        TETRAHEDRON + b"v 0 0 0\n",
        ("--weld", "exact"),
        "vertex merged with an earlier one, whose row",
    ),
    "polygons_triangulated": (
        TETRAHEDRON + b"v 1 1 0\nf 1 2 5 3\n",
        (),
        "polygon of more than 3 corners, triangulated",
    ),
    "not_orientable": (MOBIUS, (), "patch without orientation, named by its lowest face"),
    "inside_out": (INWARDS, (), "closed patch of negative volume, named by its lowest face: its normals point inwards"),
    "folded_edges": (FOLDED, ("-p", "H_tan"), "edge where the surface folds onto itself; H_tan has no value there"),
    "unknown_statements": (TETRAHEDRON + b"what 1\n", (), "unknown statement, ignored: `what`"),
    "ignored_statements": (TETRAHEDRON + b"call a\n", (), "free-form, point or drawing statement, ignored: `call`"),
    "rational_weights": (TETRAHEDRON.replace(b"v 10 0 0", b"v 10 0 0 2"), (), "vertex with a rational weight `w`"),
    "extra_values": (TETRAHEDRON.replace(b"v 10 0 0", b"v 10 0 0 1 1"), (), "vertex with numbers that are neither"),
    "missing_endsolid": (TEXT_STL.replace(b"endsolid x\n", b""), ("--input-format", "stl"), "text that ends without"),
    "wrong_suffix": (TEXT_STL, ("--input-format", "obj"), "file whose content is STL, not OBJ as --input-format says"),
}


def warnings(folder: Path, data: bytes, options: tuple[str, ...]) -> dict[str, Any]:
    path = folder / "mesh.obj"
    path.write_bytes(data)
    ran = in_process(["analyze", str(path), "--json", *options])
    assert (ran.code, ran.err) == (0, "")
    found = {one["code"]: one for one in json.loads(ran.out)["warnings"]}
    for one in found.values():
        assert one["hint"], one
        assert not set("[|]") & set(one["message"] + one["hint"]), one
        assert len(one["examples"]) <= min(one["count"], 5)
    return found


@pytest.mark.parametrize("code", KINDS)
def test_one_of_each(tmp_path: Path, code: str) -> None:
    data, options, message = KINDS[code]
    found = warnings(tmp_path, data, options)
    assert code in found
    assert found[code]["count"] == 1
    assert found[code]["message"].startswith(message)


def test_faults_are_counted_with_examples(tmp_path: Path) -> None:
    found = warnings(tmp_path, TETRAHEDRON + 3 * LOOSE + 2 * b"f 1 2\n" + 2 * b"f 1 1 2\n", ())
    said = {code: (one["count"], one["message"], one["examples"]) for code, one in found.items()}
    assert said == {
        "short_faces": (2, "faces with fewer than 3 corners, dropped", [4, 5]),
        "repeated_corner_faces": (2, "faces with a repeated corner, dropped", [4, 5]),
        "unreferenced_vertices": (3, "vertices that no face uses; their rows are empty", [4, 5, 6]),
    }


def test_where_they_are_without_orientation(tmp_path: Path) -> None:
    moved = MOBIUS.replace(b"v ", b"v 9").replace(b"f 1 2 3\nf 2 3 4\nf 3 4 5\nf 4 5 1\nf 5 1 2", b"")
    both = MOBIUS + moved + b"f 6 7 8\nf 7 8 9\nf 8 9 10\nf 9 10 6\nf 10 6 7\n"
    found = warnings(tmp_path, both, ())["not_orientable"]
    assert (found["count"], found["examples"]) == (2, [0, 5])
    assert found["message"].startswith("patches without orientation, named by their lowest face")


def test_welding_is_advised_where_it_helps(tmp_path: Path) -> None:
    for more, options, hint in (
        (LINE, (), "remesh there: its corners lie on a line"),
        (b"v 0 0 0\nf 1 2 5\n", (), "--weld exact drops those with two corners at one place; remesh the others"),
        (2 * b"v 20 0 0\nf 1 2 5\n", ("--weld", "exact"), "remesh there: their corners lie on a line"),
    ):
        assert warnings(tmp_path, TETRAHEDRON + more, options)["degenerate_faces"]["hint"] == hint


def test_every_warning_of_the_source_has_a_hint() -> None:
    calls = 0
    for path in SOURCES:
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in ("Notice", "Notice.at"):
                calls += 1
                given = len(node.args) + len(node.keywords)
                assert given >= 4, f"{path.name}:{node.lineno}: no hint"
    assert calls > 25


def test_words_agree_with_their_number() -> None:
    assert pluralize(1, "[face|faces] [that is|that are] [|no] x") == "face that is  x"
    assert pluralize(0, "[face|faces]") == pluralize(2, "[face|faces]") == "faces"
    assert [counted(n, "face") for n in (0, 1, 1000)] == ["0 faces", "1 face", "1,000 faces"]
    assert [number_of(n, "vertex", "vertices") for n in (1, 1000)] == ["1 vertex", "1000 vertices"]

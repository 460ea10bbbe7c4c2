"""Datafiles of the Surface Evolver: rows in file order, loops of edges, bodies, colours, refusals of other models."""

from __future__ import annotations

import io
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from curvcli import analyze
from curvcli.loading.read import read_mesh_file
from curvcli.mesh.file import MeshFile
from curvcli.mesh.polygons import from_file
from tests.helpers.every_format import (
    SHAPES,
    Shape,
    assert_reads,
    assert_refused,
    is_refused,
    moebius,
    read_cuts,
    sphere,
)
from tests.helpers.meshes import tetrahedron
from tests.properties.test_evolver import PROGRAM

HEADER = "PARAMETER angle = 30 // degrees\n/* a comment\nvertices\n*/\nconstraint 1\nformula: z = 0\n"
BODY = tetrahedron()


def read(data: str | bytes, **options: Any) -> MeshFile:
    return read_mesh_file(io.BytesIO(data.encode() if isinstance(data, str) else data), **options)


def fe(shape: Shape, header: str = "", tail: str = "", spread: bool = False, dressed: bool = False) -> str:
    """A datafile. spread: numbers that are not consecutive. dressed: with attributes, comments and continued lines."""
    rng = np.random.default_rng(5)

    def numbers(count: int) -> list[int]:
        return (rng.permutation(3 * count)[:count] + 1).tolist() if spread else list(range(1, count + 1))

    edges: dict[tuple[int, int], int] = {}
    loops = []
    for polygon in shape.polygons:
        loop = []
        for a, b in zip(polygon, (*polygon[1:], polygon[0]), strict=True):
            if (b, a) in edges:
                loop.append(-1 - edges[b, a])
            else:
                loop.append(1 + edges.setdefault((a, b), len(edges)))
        loops.append(loop)
    vertex, edge, facet = numbers(len(shape.points)), numbers(len(edges)), numbers(len(loops))
    comment, more, turn = (" // 7 8 9", " fixed original 5 /* 1 2 */", "\\\n   ") if dressed else ("", "", "")
    lines = [header, f"vertices{comment}"]
    lines += [
        f"  {n}  {x!r} {y!r} {turn}{z!r}{more}" for n, (x, y, z) in zip(vertex, shape.points.tolist(), strict=True)
    ]
    lines += ["", "Edges"]
    lines += [f"{n} {vertex[a]} {vertex[b]}{more}{comment}" for n, (a, b) in zip(edge, edges, strict=True)]
    lines.append("FACETS:")
    for n, loop in zip(facet, loops, strict=True):
        words = [str(edge[e - 1] if e > 0 else -edge[-e - 1]) for e in loop]
        lines.append(f"{n} {words[0]} {turn}{' '.join(words[1:])}{' density 2' if dressed and n % 3 else ''}")
    return "\n".join([*lines, tail])


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("spread", [False, True])
@pytest.mark.parametrize("dressed", [False, True])
def test_every_dialect_gives_the_same_table(dressed: bool, spread: bool, shape: str) -> None:
    meant = SHAPES[shape]()
    file = assert_reads(fe(meant, HEADER, "read\nfaces\nrefine 2", spread, dressed).encode(), meant)
    counts = {notice.message[:20]: notice.count for notice in file.notices}
    assert len(counts) == 2 + dressed
    assert {notice.code for notice in file.notices} >= {"ignored_statements"}


def test_the_fast_reader_reads_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("curvcli.loading.text.SMALL", 0)
    for shape in (sphere(), moebius()):
        for dressed in (False, True):
            assert_reads(fe(shape, "", "", True, dressed).encode(), shape)


def test_content_decides(tmp_path: Path) -> None:
    (tmp_path / "a.OBJ").write_text(fe(sphere(), HEADER))
    file = read_mesh_file(tmp_path / "a.OBJ")
    assert file.format == "fe"
    assert "wrong_suffix" in [notice.code for notice in file.notices]
    (tmp_path / "A.DMP").write_text(fe(sphere()))
    assert read_mesh_file(tmp_path / "A.DMP").polygons == len(sphere().polygons)


def test_attributes_and_colours_are_properties() -> None:
    text = (
        "define vertex attribute heat real\ndefine vertex attribute many real[3]\ndefine facet attribute rank integer\n"
        "vertices\n1 0 0 0 heat 2.5 fixed\n2 1 0 0 fixed HEAT -1\n3 0 1 0\n4 0 0 1 many {1 2 3} heat 7\n"
        "edges\n1 1 2\n2 2 3\n3 3 1\n4 1 4\n5 2 4\n6 3 4\n"
        "faces\n1 -3 -2 -1 color red rank 4\n2 1 5 -4 color 40\n3 2 6 -5 rank 1\n4 3 4 -6 color clear\n"
    )
    file = read(text)
    np.testing.assert_array_equal(file.vertex_properties["heat"], [2.5, -1, np.nan, 7])
    np.testing.assert_array_equal(file.polygon_properties["rank"], [4, np.nan, 1, np.nan])
    assert file.polygon_properties["color"].tolist() == [4, 40, 15, -1]
    assert list(file.vertex_properties) == ["heat"]
    assert file.polygon_labels["materials"].names == ("clear", "red", "white", "40")
    assert file.polygon_labels["materials"].codes.tolist() == [1, 3, 2, 0]


def test_bodies_are_groups() -> None:
    plain = fe(Shape(BODY.points, tuple(tuple(face) for face in BODY.faces.tolist())))
    file = read(plain + "bodies\n7 1 2 \\\n 3 volume 2\n3 -3 4\n")
    assert file.polygon_labels["objects"].names == ("3", "7", "3|7")
    assert file.polygon_labels["groups"].codes.tolist() == [1, 1, 2, 0]
    file = read(plain.replace("FACETS:\n1 1 2 3", "FACETS:\n1 1 2 3 backbody 5") + "bodies\n5 pressure 1\n")
    assert file.polygon_labels["objects"].names == ("5",)
    assert file.polygon_labels["objects"].codes.tolist() == [0, -1, -1, -1]
    assert not read(plain).polygon_labels


FACETS = "vertices\n1 0 0 0\n2 1 0 0\n3 0 1 0\nedges\n1 1 2\n2 2 3\n3 3 1\nfaces\n1 1 2 3\n"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("vertices", "string\nvertices"), "line 1: the string model"),
        (("vertices", "// a\n\nQUADRATIC\nvertices"), "line 3: the quadratic model"),
        (("vertices", "Lagrange 4\nvertices"), "a Lagrange model"),
        (("vertices", "simplex_representation\nvertices"), "the simplex model"),
        (("vertices", "torus_filled\nperiods\n1 0 0\nvertices"), "edges wrap around periods"),
        (("vertices", 'symmetry_group "rotate"\nvertices'), "a symmetry group"),
        (("vertices", "space_dimension 4\nvertices"), "`space_dimension 4` found, 3 expected"),
        (("vertices", "surface_dimension 1\nvertices"), "2 expected"),
        (("2 1 0 0", "2 0.5 boundary 1 fixed"), "line 3: vertex on a boundary found"),
        (("2 1 0 0", "2 2*pi boundary 1 fixed"), "line 3: vertex on a boundary found"),
        (("2 1 0 0", "2 sqrt(2) 0 0"), "vertex with 0 numbers found, 3 coordinates expected; expressions are not"),
        (("2 1 0 0", "2 2*x 0 0"), r"line 3: `2\*x` found, a number or an attribute expected"),
        (("2 1 0 0", "2 1 0"), "line 3: vertex with 2 numbers found"),
        (("2 1 0 0", "2 1 0 0 0"), "line 3: vertex with 4 numbers found"),
        (("2 1 0 0", "1 1 0 0"), "two elements with the number 1"),
        (("2 1 0 0", "0 1 0 0"), "line 3: no number of a vertex"),
        (("2 1 0 0", "2.5 1 0 0"), "line 3: no number of a vertex"),
        (("2 2 3", "2 2 9"), "line 7: edge of vertex 9 found, which does not exist"),
        (("2 2 3", "2 2 3 4"), "line 7: edge with 3 numbers"),
        (("2 2 3", "2 2 3 * + -"), r"`\*` found"),
        (("1 1 2 3", "1 1 2 8"), "line 10: facet of edge 8 found"),
        (("1 1 2 3", "1 1 -2 3"), "line 10: edge -2 does not begin where edge 1 ends"),
        (("1 1 2 3", "1 1 2"), "line 10: facet with 2 numbers"),
        (("1 1 2 3", ""), "no faces"),
        (("faces\n1 1 2 3", ""), "no section `faces`"),
        (("edges", "vertices"), "a second section `vertices`"),
        (("faces", "bodies\n1 7\nfaces"), "body of facet 7 found"),
        (("2 1 0 0", "2 nan 0 0"), "finite"),
    ],
)
def test_refusals(change: tuple[str, str], message: str) -> None:
    assert change[0] in FACETS
    assert_refused(FACETS.replace(*change, 1).encode(), message, input_format="fe")


def test_an_include_is_not_opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "more.inc").write_text("string\n")
    (notice,) = read('#include "more.inc"\n' + FACETS).notices
    assert "`#include`" in notice.message


def test_damaged_files_never_break() -> None:
    data = fe(
        Shape(moebius().points[:6], ((0, 1, 2), (0, 2, 3, 4), (3, 4, 5))), "PARAMETER a=1", "bodies\n1 1 2\n"
    ).encode()
    cuts = [cut for cut in read_cuts(data, input_format="fe") if data[cut:].strip()]
    # A datafile announces no number of facets: one that ends behind a facet is a datafile of fewer facets.
    first = data.index(b"\n", data.index(b"FACETS") + 8)
    assert all(cut >= first for cut in cuts)
    dump = b"facets_predicted 3\n" + data
    assert read_cuts(dump + b"read\n", input_format="fe") == [len(dump) + 4]
    for at in range(len(data)):
        for byte in b'9- x\n*"\\\xff':
            is_refused(data[:at] + bytes([byte]) + data[at + 1 :], input_format="fe")


@pytest.mark.skipif(PROGRAM is None, reason="the Surface Evolver is not installed; Debian's package is evolver-nox")
def test_a_dump_of_the_evolver(tmp_path: Path) -> None:
    """Refined and evolved by the Evolver: the same counts, and its area as energy."""
    plain = fe(Shape(BODY.points, tuple(tuple(face) for face in BODY.faces.tolist()))) + "bodies\n1 1 2 3 4 volume 1\n"
    (tmp_path / "a.fe").write_text(plain)
    commands = 'r\nr\ng 3\nset facet color red where id < 9\ndump "b.dmp"\nprint total_energy\nq\nq\n'
    ended = subprocess.run(
        [str(PROGRAM), "a.fe"], input=commands, cwd=tmp_path, capture_output=True, text=True, timeout=60
    )
    result = analyze(from_file(read_mesh_file(tmp_path / "b.dmp")))
    assert result.report()["topology"]["faces"] == 64
    assert result.report()["topology"]["euler_characteristic"] == 2
    energy = float(ended.stdout.rpartition("print total_energy")[2].split()[0])
    assert result.totals["area"] == pytest.approx(energy, rel=1e-13)

"""Gmsh files, written by Gmsh, by meshio and by hand: the same table to the last digit, groups as labels."""

from __future__ import annotations

import io
import struct
from pathlib import Path

import numpy as np
import pytest

from curvcli import analyze
from curvcli.loading.read import read_mesh_file
from tests.helpers.every_format import SHAPES, Shape, assert_reads, assert_refused, is_refused, moebius, read_cuts
from tests.helpers.gmsh_files import GMSH, MESHIO, write_gmsh, write_meshio

TEXT = (
    b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n10 0 0 0\n20 1 0 0\n30 1 1 0\n7 0 1 0.5\n$EndNodes\n"
    b"$Elements\n4\n1 15 2 0 1 10\n2 1 2 0 1 10 20\n3 2 2 5 1 10 20 30\n4 2 2 0 1 10 30 7\n$EndElements\n"
)


@pytest.mark.parametrize("dialect", GMSH)
def test_every_version_of_gmsh_is_read_to_the_last_digit(dialect: str, tmp_path: Path) -> None:
    for name, make in SHAPES.items():
        shape = make().short() if "text" in dialect else make()  # Gmsh writes 16 digits
        expected = write_gmsh(shape, dialect, tmp_path / f"{name}.msh")
        file = assert_reads(tmp_path / f"{name}.msh", expected, table=dialect == "4.1-binary")
        groups, entity = file.polygon_labels["groups"], file.polygon_properties["entity"]
        assert np.array_equal([groups.names[k] for k in groups.codes], np.where(entity == 2, "cap", "rest"))
        assert len(file.polylines) == 1


@pytest.mark.parametrize("dialect", MESHIO)
def test_every_version_of_meshio_is_read_to_the_last_digit(dialect: str, tmp_path: Path) -> None:
    for name, make in SHAPES.items():
        shape = write_meshio(make(), dialect, tmp_path / f"{name}.msh")
        file = assert_reads(tmp_path / f"{name}.msh", shape, table=False)
        if dialect.startswith("2"):  # meshio writes other groups into versions 4
            groups = file.polygon_labels["groups"]
            assert [groups.names[k] for k in groups.codes] == [("ring", "2", "3")[part] for part in shape.part]


def test_tags_may_be_any_numbers_and_other_elements_are_counted() -> None:
    file = read_mesh_file(io.BytesIO(TEXT))
    assert file.corners.tolist() == [0, 1, 2, 0, 2, 3]
    assert [(notice.code, notice.count, notice.message.rpartition(": ")[2]) for notice in file.notices] == [
        ("other_cells", 1, "1 vertex")
    ]
    assert file.polygon_labels["groups"].names == ("5",)
    regions = analyze(io.BytesIO(TEXT), regions="groups").report()["regions"]
    assert [region["name"] for region in regions] == ["5"]


def big_endian(shape: Shape) -> bytes:
    """Version 4.1 as a machine of the other byte order writes it."""
    nodes, elements = len(shape.points), len(shape.polygons)
    text = b"$MeshFormat\n4.1 1 8\n" + struct.pack(">i", 1) + b"\n$EndMeshFormat\n$Nodes\n"
    text += struct.pack(">4q3iq", 1, nodes, 1, nodes, 2, 1, 0, nodes) + np.arange(1, nodes + 1).astype(">i8").tobytes()
    text += shape.points.astype(">f8").tobytes() + b"\n$EndNodes\n$Elements\n"
    text += struct.pack(">4q3iq", 1, elements, 1, elements, 2, 1, 2, elements)
    for k, polygon in enumerate(shape.polygons):
        text += struct.pack(">4q", k + 1, *(corner + 1 for corner in polygon))
    return text + b"\n$EndElements\n"


def test_the_other_byte_order_is_read() -> None:
    for make in SHAPES.values():
        shape = make().halved()
        assert_reads(big_endian(shape), shape, table=False)


@pytest.mark.parametrize(
    ("damage", "match"),
    [
        ((b"$Nodes\n4", b"$Nodes\n5"), "announced"),
        ((b"$Nodes\n4", b"$Nodes\n3"), "more data"),
        ((b"$Nodes\n4", b"$Nodes\n99999999999999"), "announced"),
        ((b"$Elements\n4", b"$Elements\n5"), "missing"),
        ((b"$Elements\n4", b"$Elements\n3"), "more data"),
        ((b"10 30 7", b"10 30 8"), "node 8"),
        ((b"7 0 1 0.5", b"30 0 1 0.5"), "twice"),
        ((b"4 2 2 0", b"4 999 2 0"), "type 999"),
        ((b"4 2 2 0", b"4 2 -1 0"), "tags"),
        ((b"4 2 2 0 1 10 30 7", b"4 9 2 0 1 10 30 7 10 20 7"), "curved"),
        ((b"0.5", b"x"), "`x`"),
        ((b"2.2 0 8", b"1.0 0 8"), "version"),
        ((b"$EndElements", b"$EndElement"), "EndElements"),
        ((b"1 10 20 30", b"1 10.5 20 30"), "whole"),
    ],
)
def test_what_does_not_fit_is_refused(damage: tuple[bytes, bytes], match: str) -> None:
    assert not is_refused(TEXT)
    assert_refused(TEXT.replace(*damage), match)


def test_every_cut_is_refused() -> None:
    end = len(TEXT) - len(b"\n")
    assert read_cuts(TEXT) == [end]
    data = big_endian(moebius().halved())
    assert read_cuts(data) == [len(data) - 1]


def test_solids_alone_are_refused() -> None:
    begin, _, _ = TEXT.partition(b"$Elements")
    assert_refused(begin + b"$Elements\n1\n1 4 2 0 1 10 20 30 7\n$EndElements\n", "no faces, but 1 tetrahedron")
    assert_refused(begin, "Elements")

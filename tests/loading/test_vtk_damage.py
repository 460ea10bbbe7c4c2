"""Damaged and hostile VTK files: exit code 3 with one line, no other file opened, time and memory within bounds."""

from __future__ import annotations

import base64
import io
import os
import random
import struct
import sys
import tracemalloc
import zlib
from pathlib import Path

import pytest

from curvcli.errors import MissingExtraError
from curvcli.loading.read import read_mesh_file
from tests.helpers.cli.program import curvcli
from tests.helpers.every_format import assert_reads, assert_refused, is_refused, moebius, read_cuts
from tests.helpers.vtk_files import data_set, write_legacy, write_xml


def xml(array: str = "", *, points: int = 4, polys: int = 2, head: str = "", tail: str = "") -> bytes:
    """A file of two triangles in text, with an array of cells."""
    return f"""<?xml version="1.0"?>{head}
<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian" compressor="vtkZLibDataCompressor"><PolyData>
<Piece NumberOfPoints="{points}" NumberOfPolys="{polys}"><CellData>{array}</CellData><Points>
<DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 1 1 0 0 1 0.5</DataArray></Points><Polys>
<DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 0 2 3</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">3 6</DataArray></Polys>
</Piece></PolyData>{tail}</VTKFile>""".encode()


def packed(data: bytes, *, blocks: int = 1, size: int | None = None) -> str:
    """An inline array compressed by zlib in one block, with a header that may lie."""
    body = zlib.compress(data)
    header = struct.pack("<4I", blocks, len(data) if size is None else size, 0, len(body))
    return (base64.b64encode(header) + base64.b64encode(body)).decode()


def array(text: str, *, form: str = "binary", kind: str = "Int32") -> str:
    return f'<DataArray type="{kind}" Name="a" format="{form}">{text}</DataArray>'


GOOD = struct.pack("<2i", 7, 8)


def test_the_undamaged_files_are_read() -> None:
    assert not is_refused(xml())
    assert not is_refused(xml(array(packed(GOOD))))
    assert not is_refused(xml(head="<!-- a > b -->", array='<DataArray Name="a>b" type="Int8">1 2</DataArray>'))
    assert not is_refused(xml(array('<InformationKey name="k"/> 1 <!-- c --> 2', form="ascii")))


@pytest.mark.parametrize(
    ("content", "match"),
    [
        (xml(points=5), "12 values found, 15 expected"),
        (xml(points=3), "12 values found, 9 expected"),
        (xml(points=10**15), "expected"),
        (xml(polys=3), "values found"),
        (xml(polys=10**15), "values found"),
        (xml(array("7 8 9", form="ascii")), "3 values found"),
        (xml(array("7 x", form="ascii")), "`x`"),
        (xml(array("7 99999999999", form="ascii")), "int32"),
        (xml(array("7 8", form="ascii", kind="Complex")), "type `Complex`"),
        (xml(array("7 8", form="csv")), "format `csv`"),
        (xml(array("7 8", form="appended")), "appended"),
        (xml(array("!" * 40)), "base64"),
        (xml(array(packed(GOOD)[:-4])), "cut off|found"),
        (xml(array(packed(GOOD, size=9))), "expected"),
        (xml(array(packed(GOOD, blocks=2**31))), "announced|expected"),
        (xml(array(packed(GOOD + b"x" * 4))), "expected"),
        (xml(array(packed(GOOD + b"x" * 4, size=8))), "expected"),
        (xml(array(packed(GOOD)[:24] + "A" * 20)), "zlib|announced"),
        (xml(head="<!DOCTYPE VTKFile>"), "document type"),
        (xml(head='<!DOCTYPE VTKFile [<!ENTITY a "b">]>', array=array("&a;", form="ascii")), "document type"),
        (xml(head='<!DOCTYPE VTKFile SYSTEM "file:///etc/passwd">'), "document type"),
        (xml(array("<![CDATA[7 8]]>", form="ascii")), "CDATA"),
        (xml(array("&#55; 8", form="ascii")), "number"),
        (xml(tail="<a>"), "XML"),
        (xml().replace(b"PolyData", b"PPolyData"), "other files"),
        (xml().replace(b"PolyData", b"ImageData"), "ImageData"),
        (xml().replace(b"LittleEndian", b"Middle"), "byte order"),
        (xml().replace(b"vtkZLib", b"vtkZip"), "compressor"),
        (xml().replace(b">3 6<", b">6 3<"), "offset|values"),
        (xml().replace(b">3 6<", b">3 -6<"), "offset"),
        (xml().replace(b"0 2 3<", b"0 2 4<"), "vertex index 4"),
        (xml().replace(b"0 0 0 1", b"nan 0 0 1"), "finite"),
        (xml().replace(b"0 0 0 1", b"1e400 0 0 1"), "finite"),
        (b"<a>" * 100_000, "deeper"),
        (b"<VTKFile type='PolyData' a='" + b"x" * 100_000, "cut off|tag"),
    ],
)
def test_what_does_not_fit_is_refused(content: bytes, match: str) -> None:
    assert_refused(content, match, input_format="vtp")


def test_every_cut_of_a_small_file_is_refused() -> None:
    assert read_cuts(xml(), input_format="vtp") == []
    assert read_cuts(xml(array(packed(GOOD))), input_format="vtp") == []


@pytest.mark.slow
@pytest.mark.parametrize("dialect", ["Ascii-Little-32-None", "Raw-Big-64-ZLib", "Appended-Little-32-None"])
def test_every_cut_of_xml_is_refused_or_loses_nothing(dialect: str, tmp_path: Path) -> None:
    """Behind the last array, a file with raw data has a closing tag only."""
    shape = moebius().short()
    data = write_xml(data_set(shape, "polydata", arrays=False), dialect, tmp_path / "a.vtp").read_bytes()
    for cut in read_cuts(data):
        assert len(data) - cut < 60
        assert_reads(data[:cut], shape, table=False)


@pytest.mark.parametrize("dialect", ["Binary-51", "ASCII-42"])
def test_every_cut_of_a_legacy_file_is_refused_or_loses_nothing(dialect: str, tmp_path: Path) -> None:
    shape = moebius().short()
    data = write_legacy(data_set(shape, "grid", arrays=False), dialect, tmp_path / "a.vtk").read_bytes()
    for cut in read_cuts(data):
        assert len(data) - cut < 12
        assert_reads(data[:cut], shape, table=False)


@pytest.mark.parametrize(
    "name", ["Raw-Little-32-ZLib.vtp", "Ascii-Little-32-None.vtu", "Binary-51.vtk", "ASCII-42.vtk"]
)
def test_flipped_bytes_are_read_or_refused(name: str, tmp_path: Path) -> None:
    dialect, _, suffix = name.rpartition(".")
    kind = "grid" if suffix == "vtu" else "polydata"
    write = write_legacy if suffix == "vtk" else write_xml
    data = write(data_set(moebius().short(), kind), dialect, tmp_path / f"a.{suffix}").read_bytes()
    rng = random.Random(5)
    for _ in range(200):
        damaged = bytearray(data)
        for _ in range(rng.choice((1, 1, 3))):
            damaged[rng.randrange(len(data))] = rng.choice((0, 255, 32, 48, 57, 60, 62, rng.randrange(256)))
        is_refused(bytes(damaged), input_format=suffix)


def test_lz4_without_its_library_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "lz4.block", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'curvcli\[formats\]'"):
        read_mesh_file(io.BytesIO(xml().replace(b"vtkZLib", b"vtkLZ4")))


def test_a_bomb_takes_no_memory() -> None:
    """A million zeros per kilobyte: the limit falls with each array."""
    zeros = packed(bytes(1 << 24))
    bombs = "".join(array(zeros).replace('"a"', f'"a{k}"') for k in range(40))
    content = xml(bombs).replace(b'NumberOfPolys="2"', f'NumberOfPolys="{1 << 22}"'.encode())
    tracemalloc.start()
    try:
        assert_refused(content, "expected|allowed")
        assert_refused(xml(array(packed(bytes(1 << 26)))), "expected")
        assert tracemalloc.get_traced_memory()[1] < 400 << 20
    finally:
        tracemalloc.stop()


def test_the_command_line_names_the_place(tmp_path: Path) -> None:
    for name, content in (
        ("a.vtp", xml(points=5)),
        ("a.vtk", b"# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\n"),
    ):
        path = tmp_path / name
        path.write_bytes(content)
        ended = curvcli("analyze", path, "-o", tmp_path / "out.csv")
        assert ended.code == 3
        assert ended.complaint.startswith(f"{path}: ")
        assert len(ended.complaint.splitlines()) == 1
        assert sorted(os.listdir(tmp_path)) == sorted({"a.vtp", name})


def test_content_decides_over_the_suffix(tmp_path: Path) -> None:
    path = tmp_path / "A.PLY"
    path.write_bytes(xml())
    assert [notice.code for notice in read_mesh_file(path).notices] == ["wrong_suffix"]
    path = tmp_path / "A.VTP"
    path.write_bytes(xml())
    assert read_mesh_file(path).notices == ()

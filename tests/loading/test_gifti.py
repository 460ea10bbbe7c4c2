"""GIFTI surfaces: the same table in every dialect, further arrays, and refusals of damaged and hostile files."""

from __future__ import annotations

import base64
import io
import itertools
import sys
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from curvcli.errors import InputError, MissingExtraError
from curvcli.loading.read import read_mesh_file
from tests.helpers.cli.program import curvcli
from tests.helpers.cortex import ENCODINGS, data_array, gifti, surface_gii
from tests.helpers.every_format import SHAPES, Shape, assert_reads, assert_refused, is_refused, read_cuts

nibabel = pytest.importorskip("nibabel", reason="nibabel reads GIFTI")

FORMAT = {"input_format": "gii"}
SQUARE = Shape(np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0.25]]), ((0, 1, 2), (0, 2, 3)))
POINTS, TRIANGLES = SQUARE.points.astype("f4"), SQUARE.triangles
DIALECTS = [
    {"encoding": encoding, "big": big, "columns": columns}
    for encoding, big, columns in itertools.product(ENCODINGS, (False, True), (False, True))
]


@pytest.mark.parametrize("name", SHAPES)
def test_every_dialect_gives_the_same_table(name: str) -> None:
    shape = SHAPES[name]().halved()
    for options in DIALECTS:
        assert_reads(surface_gii(shape.single(), **options), shape.single(), **FORMAT)
        assert_reads(surface_gii(shape, "f8", **options), shape, **FORMAT)


def image_of(shape: Shape, **options: Any) -> Any:
    points = nibabel.gifti.GiftiDataArray(shape.points.astype("f4"), "NIFTI_INTENT_POINTSET", **options)
    return nibabel.GiftiImage(
        darrays=[points, nibabel.gifti.GiftiDataArray(shape.triangles, "NIFTI_INTENT_TRIANGLE", **options)]
    )


def test_text_in_lines_of_any_kind() -> None:
    data = surface_gii(SQUARE, encoding="ASCII")
    for lines in (b"<Data>\n\n  ", b"<Data>\r\n\t\r\n"):
        assert_reads(data.replace(b"<Data>", lines).replace(b"\n0.25", b"   \n\n 0.25 \t"), SQUARE, **FORMAT)
    assert_refused(data.replace(b"<Data>", b"<Data>\n\n").replace(b"0.25", b"1/4"), "`1/4` found", **FORMAT)


@pytest.mark.parametrize("name", SHAPES)
def test_files_by_nibabel(name: str, tmp_path: Path) -> None:
    shape = SHAPES[name]().halved().short()
    for encoding, endian, order in itertools.product(ENCODINGS, ("big", "little"), "CF"):
        image = image_of(shape, encoding=encoding, endian=endian, ordering=order)
        for suffix in (".surf.gii", ".gii.gz"):
            nibabel.save(image, tmp_path / f"lh{suffix}")
            mesh = assert_reads(tmp_path / f"lh{suffix}", shape)
            points, faces = nibabel.load(tmp_path / f"lh{suffix}").agg_data()
            np.testing.assert_array_equal(mesh.xyz.T, points)
            np.testing.assert_array_equal(mesh.corners.reshape(-1, 3), faces)


def test_further_arrays_are_properties_and_labels() -> None:
    named = "<MetaData><MD><Name>Name</Name><Value>/subjects/bert/surf/lh.thickness</Value></MD></MetaData>"
    table = '<Label Key="7" Red="1" Green="0.5" Blue="0" Alpha="1">insula</Label><Label Key="9">cuneus</Label>'
    data = gifti(
        data_array(np.array([0.5, 1, 2, 4], "f4"), "SHAPE", inside=named),
        data_array(POINTS, "POINTSET"),
        data_array(TRIANGLES, "TRIANGLE"),
        data_array(POINTS, "VECTOR"),
        data_array(np.array([7, 7, 9, 11], "i4"), "LABEL"),
        data_array(np.array([7, 9], "i4"), "LABEL"),
        table=table,
    )
    mesh = read_mesh_file(io.BytesIO(data), **FORMAT)
    assert list(mesh.vertex_properties) == ["lh.thickness", "vector_x", "vector_y", "vector_z"]
    assert mesh.vertex_properties["lh.thickness"].tolist() == [0.5, 1, 2, 4]
    labels = mesh.vertex_labels["label"]
    assert [labels.names[code] for code in labels.codes] == ["insula", "insula", "cuneus", "11"]
    assert labels.colors is not None
    assert labels.colors[0].tolist() == [255, 128, 0]
    assert [(notice.code, notice.count) for notice in mesh.notices] == [("ignored_arrays", 1)]


def test_a_matrix_is_not_applied_and_is_counted() -> None:
    matrix = (
        "<CoordinateSystemTransformMatrix><DataSpace><![CDATA[NIFTI_XFORM_OTHER]]></DataSpace><TransformedSpace>x"
        "</TransformedSpace><MatrixData>{}</MatrixData></CoordinateSystemTransformMatrix>"
    )
    for numbers, codes in (
        ("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", []),
        ("2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1", ["transform_ignored"]),
    ):
        data = gifti(data_array(POINTS, "POINTSET", inside=matrix.format(numbers)), data_array(TRIANGLES, "TRIANGLE"))
        mesh = assert_reads(data, SQUARE, **FORMAT)
        assert [notice.code for notice in mesh.notices] == codes


def test_every_truncation_is_refused() -> None:
    for encoding in ENCODINGS:
        data = surface_gii(SQUARE, encoding=encoding)
        assert read_cuts(data, **FORMAT) == [len(data) - 1]


def test_every_changed_count_is_refused() -> None:
    for encoding in ENCODINGS:
        data = surface_gii(SQUARE, encoding=encoding)
        for old in (b'Dim0="4"', b'Dim0="2"', b'Dim1="3"', b'Dimensionality="2"', b'NumberOfDataArrays="2"'):
            for new in (b"1", b"5", b"-1", b"x", b"", b"999999999999999999999", b"9" * 5000):
                assert is_refused(data.replace(old, old.partition(b'"')[0] + b'"' + new + b'"', 1), **FORMAT), (
                    old,
                    new,
                )


HEAD = b'<?xml version="1.0"?><!DOCTYPE GIFTI [%s]><GIFTI Version="1.0" NumberOfDataArrays="0">%s</GIFTI>'
LAUGHS = b'<!ENTITY a "ha">' + b"".join(b'<!ENTITY %c "%s">' % (98 + k, b"&%c;" % (97 + k) * 10) for k in range(12))
HOSTILE = {
    "laughs": (HEAD % (LAUGHS, b"&m;"), "declarations of entities"),
    "external": (HEAD % (b'<!ENTITY x SYSTEM "file:///etc/passwd">', b"&x;"), "declarations of entities"),
    "parameter": (HEAD % (b'<!ENTITY % p SYSTEM "file:///etc/passwd"> %p;', b""), "declarations of entities"),
    "attributes": (
        HEAD % (b"<!ATTLIST a " + b"".join(b'b%d CDATA "x" ' % k for k in range(9)) + b">", b""),
        "declarations",
    ),
    "undefined": (surface_gii(SQUARE).replace(b"<Data>", b"<Data>&other;"), "`other`"),
    "rubbish": (surface_gii(SQUARE).replace(b"<Data>", b"<Data>*()"), "data array 0: malformed base64"),
    "letters": (surface_gii(SQUARE).replace(b"<Data>", "<Data>ä".encode()), "data array 0: malformed base64"),
    "words": (surface_gii(SQUARE, encoding="ASCII").replace(b"0.25", b"west"), "`west` found, a number"),
    "elsewhere": (
        surface_gii(SQUARE)
        .replace(b"GZipBase64Binary", b"ExternalFileBinary")
        .replace(b'Name=""', b'Name="/etc/passwd"'),
        "data in another file found, which is not opened",
    ),
    "nothing": (gifti(), "0 arrays of positions found, one expected"),
    "values": (gifti(data_array(POINTS[:, 0], "SHAPE")), "0 arrays of positions"),
    "two": (gifti(*[data_array(POINTS, "POINTSET")] * 2, data_array(TRIANGLES, "TRIANGLE")), "2 arrays of positions"),
    "flat": (gifti(data_array(POINTS[:, :2], "POINTSET"), data_array(TRIANGLES, "TRIANGLE")), "rows of three"),
    "fractions": (
        gifti(data_array(POINTS, "POINTSET"), data_array(TRIANGLES.astype("f4"), "TRIANGLE")),
        "triangles: float32 in the shape",
    ),
    "none": (gifti(data_array(POINTS, "POINTSET"), data_array(TRIANGLES[:0], "TRIANGLE")), "no faces"),
    "range": (gifti(data_array(POINTS[:3], "POINTSET"), data_array(TRIANGLES, "TRIANGLE")), "face 1: vertex index 3"),
    "empty": (surface_gii(SQUARE).replace(b"<Data>", b"<Date>").replace(b"</Data>", b"</Date>"), "no data found"),
    "twice": (surface_gii(SQUARE).replace(b"</Data>", b"</Data><Data>AAAA</Data>"), "Data outside"),
    "outside": (surface_gii(SQUARE).replace(b"</GIFTI>", b"<Data>AAAA</Data></GIFTI>"), "Data outside"),
    "colours": (surface_gii(SQUARE).replace(b"FLOAT32", b"RGB24"), "numbers expected"),
    "type": (surface_gii(SQUARE).replace(b"FLOAT32", b"FLOAT99"), "damaged GIFTI"),
    "xml": (b"<GIFTI><a></b></GIFTI>", "malformed XML"),
    "other": (b"<VTKFile></VTKFile>", "no element GIFTI"),
    "loops": (surface_gii(SQUARE).replace(b'Dimensionality="2"', b'Dimensionality="99999999999"'), "dimensions"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_files_are_refused(name: str) -> None:
    data, words = HOSTILE[name]
    assert is_refused(data, **FORMAT)
    with pytest.raises(InputError, match=words):
        read_mesh_file(io.BytesIO(data), **FORMAT)


def test_a_bomb_is_refused_before_it_is_inflated() -> None:
    """Four kilobytes of zlib data hold four megabytes, and two hundred such arrays 800."""
    bomb = base64.b64encode(zlib.compress(bytes(1 << 22), 9)).decode()
    array = data_array(np.zeros((1, 3), "f4"), "POINTSET")
    begin = array.partition("<Data>")[0]
    for head in (begin, begin.replace('Dim0="1"', 'Dim0="99999999999"')):
        assert_refused(gifti(f"{head}<Data>{bomb}</Data></DataArray>"), "bytes", **FORMAT)
    exact = begin.replace('Dim0="1"', f'Dim0="{1 << 20}"').replace('Dim1="3"', 'Dim1="1"')
    many = gifti(*[f"{exact}<Data>{bomb}</Data></DataArray>"] * 200)
    assert_refused(many, "of zlib data may hold", **FORMAT)


def test_without_nibabel_the_extra_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "lh.surf.gii").write_bytes(surface_gii(SQUARE))
    monkeypatch.setitem(sys.modules, "nibabel", None)
    monkeypatch.setattr("curvcli.loading.registry.find_spec", lambda name: None)
    with pytest.raises(MissingExtraError, match=r"GIFTI needs nibabel: `pip install 'curvcli\[cortex\]'`"):
        read_mesh_file(tmp_path / "lh.surf.gii")


def test_the_command_line(tmp_path: Path) -> None:
    (tmp_path / "LH.SURF.GII").write_bytes(surface_gii(SHAPES["sphere"]().halved().single()))
    ended = curvcli("analyze", str(tmp_path / "LH.SURF.GII"), "--get", "input.format")
    assert (ended.code, ended.out) == (0, "gii\n")
    (tmp_path / "rubbish.gii").write_bytes(HOSTILE["laughs"][0])
    ended = curvcli("analyze", str(tmp_path / "rubbish.gii"))
    assert (ended.code, len(ended.err.splitlines())) == (3, 1)


def test_labels_of_a_table_with_gaps_are_kept_in_outputs(tmp_path: Path) -> None:
    table = (
        '<Label Key="1" Red="1">no green</Label><Label Key="2"/><Label Key="3" Red="0" Green="0" Blue="1">blue</Label>'
    )
    data = gifti(
        data_array(POINTS, "POINTSET"),
        data_array(TRIANGLES, "TRIANGLE"),
        data_array(np.array([1, 2, 3, 3], "i4"), "LABEL"),
        table=table,
    )
    (tmp_path / "lh.gii").write_bytes(data)
    labels = read_mesh_file(tmp_path / "lh.gii").vertex_labels["label"]
    assert labels.names == ("no green", "2", "blue")
    assert labels.colors is not None
    assert labels.colors.tolist() == [[128, 128, 128], [128, 128, 128], [0, 0, 255]]
    ended = curvcli("analyze", tmp_path / "lh.gii", "-q", "-o", tmp_path / "lh.ply")
    assert ended.code == 0, ended.err
    assert read_mesh_file(tmp_path / "lh.ply").vertex_properties["label"].tolist() == [0, 1, 2, 2]
    assert b"comment label: 0 no green, 1 2, 2 blue" in (tmp_path / "lh.ply").read_bytes()

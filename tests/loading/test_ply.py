"""PLY files of every format and type, and what is refused."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from curvcli.errors import InputError
from curvcli.loading import text
from curvcli.loading.formats.ply.header import parse_header
from tests.helpers.spelling import PLY_NAMES, Meant, meant, ply_file, polygons, same
from tests.loading.parsing import parsed

HEAD = """ply
format {order} 1.0
element vertex 4
property float x
property float y
property float z
element face {faces}
property list uchar int vertex_indices
end_header
"""
POINTS = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)]
ASCII_POINTS = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"


def ascii_ply(faces: str) -> bytes:
    return (
        HEAD.format(order="ascii", faces=len(faces.split("\n")) - 1 - faces.count("\n\n")) + ASCII_POINTS + faces
    ).encode()


def binary_ply(faces: list[tuple[int, ...]], order: str = "little") -> bytes:
    sign = "<" if order == "little" else ">"
    body = b"".join(struct.pack(sign + "3f", *p) for p in POINTS)
    body += b"".join(struct.pack(f"{sign}B{len(f)}i", len(f), *f) for f in faces)
    return HEAD.format(order=f"binary_{order}_endian", faces=len(faces)).encode() + body


def codes(data: bytes) -> dict[str, int]:
    return {notice.code: notice.count for notice in parsed("ply", data).notices}


@given(st.data(), meant(), st.booleans())
def test_every_spelling_means_the_same_mesh(data: st.DataObject, mesh: Meant, large: bool) -> None:
    spelt = data.draw(ply_file(mesh))
    with pytest.MonkeyPatch.context() as patch:
        if large:
            patch.setattr(text, "SMALL", -1)
        read = parsed("ply", spelt)
    same(read, mesh)
    if "mark" in read.vertex_properties:
        assert read.vertex_properties["mark"].tolist() == [1000 + k for k in range(len(mesh.points))]
        assert read.polygon_properties["part"].tolist() == [-k for k in range(len(mesh.polygons))]
        assert read.polygon_properties["part"].dtype == np.int16
    assert not read.notices


@given(st.data(), meant(triangles=True, single=True))
def test_float32_positions_are_kept_exactly(data: st.DataObject, mesh: Meant) -> None:
    same(parsed("ply", data.draw(ply_file(mesh, "f4"))), mesh)


@pytest.mark.parametrize("kind", sorted(PLY_NAMES))
@pytest.mark.parametrize("order", ["<", ">"])
def test_every_scalar_type(kind: str, order: str) -> None:
    for name in PLY_NAMES[kind]:
        sign = "little" if order == "<" else "big"
        head = HEAD.format(order=f"binary_{sign}_endian", faces=1).replace(
            "element face", f"property {name} extra\nelement face"
        )
        value = np.array(-3 if kind[0] in "if" else 200, order + kind)
        body = b"".join(struct.pack(order + "3f", *p) + value.tobytes() for p in POINTS)
        mesh = parsed("ply", head.encode() + body + struct.pack(order + "B3i", 3, 0, 1, 2))
        assert mesh.vertex_properties["extra"].tolist() == [value] * 4
        assert mesh.vertex_properties["extra"].dtype == np.dtype(kind)


@pytest.mark.parametrize("order", ["little", "big"])
def test_mixed_polygons_in_binary(order: str) -> None:
    faces = [(0, 1, 2), (0, 1, 2, 3), (3, 2, 1), (0, 1, 2, 3, 0, 1)] * 5
    mesh = parsed("ply", binary_ply(faces, order))
    assert polygons(mesh) == faces


def test_several_lists_of_differing_lengths() -> None:
    head = HEAD.format(order="binary_big_endian", faces=2).replace(
        "end_header", "property list ushort double uv\nproperty short part\nend_header"
    )
    body = b"".join(struct.pack(">3f", *p) for p in POINTS)
    body += struct.pack(">B3iH2dh", 3, 0, 1, 2, 2, 0.5, 1.5, -7) + struct.pack(">B4iHh", 4, 0, 1, 2, 3, 0, 300)
    mesh = parsed("ply", head.encode() + body)
    assert polygons(mesh) == [(0, 1, 2), (0, 1, 2, 3)]
    assert mesh.polygon_properties["part"].tolist() == [-7, 300]


STRIPS = """ply
format ascii 1.0
element vertex 6
property float x
property float y
property float z
element tristrips {rows}
property list int int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
1 1 0
0 2 0
1 2 0
"""


def test_triangle_strips_alternate_and_restart() -> None:
    data = STRIPS.format(rows=1) + "11 0 1 2 3 -1 2 3 4 5 -1 5\n"
    assert polygons(parsed("ply", data.encode())) == [(0, 1, 2), (2, 1, 3), (2, 3, 4), (4, 3, 5)]


def test_triangle_strips_end_with_their_row() -> None:
    data = STRIPS.format(rows=3) + "4 0 1 2 3\n2 4 5\n3 3 4 5\n"
    assert polygons(parsed("ply", data.encode())) == [(0, 1, 2), (2, 1, 3), (3, 4, 5)]


def test_triangle_strips_in_binary_agree_with_text() -> None:
    strip = [0, 1, 2, 3, -1, 2, 3, 4, 5]
    written = STRIPS.format(rows=1).replace("ascii", "binary_little_endian").partition("end_header\n")
    body = b"".join(struct.pack("<3f", k % 2, k // 2, 0) for k in range(6)) + struct.pack("<i9i", 9, *strip)
    mesh = parsed("ply", (written[0] + written[1]).encode() + body)
    assert polygons(mesh) == [(0, 1, 2), (2, 1, 3), (2, 3, 4), (4, 3, 5)]


def test_ascii_fractions_stay_as_written() -> None:
    data = ascii_ply("3 0 1 2\n").replace(b"1 1 0\n", b"0.1 1e-40 3.4e39\n")
    assert parsed("ply", data).xyz[:, 2].tolist() == [0.1, 1e-40, 3.4e39]


def test_old_line_ends() -> None:
    assert polygons(parsed("ply", ascii_ply("3 0 1 2\n").replace(b"\n", b"\r"))) == [(0, 1, 2)]
    data = binary_ply([(0, 1, 2)])
    head, sign, body = data.partition(b"end_header\n")
    assert polygons(parsed("ply", (head + sign).replace(b"\n", b"\r") + body)) == [(0, 1, 2)]
    mixed = (head + sign).replace(b"\n", b"\r\n") + body
    assert polygons(parsed("ply", mixed)) == [(0, 1, 2)]


def test_empty_lines_and_blanks_in_the_body() -> None:
    data = ascii_ply("3 0 1 2 \n").replace(b"1 1 0\n", b"\n  1\t1   0\n\n")
    same(parsed("ply", data), Meant(POINTS, [(0, 1, 2)]))


@pytest.mark.parametrize("small", [-1, 1 << 16])
def test_rows_with_more_values_than_announced_are_counted(small: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(text, "SMALL", small)
    mesh = parsed("ply", ascii_ply("3 0 1 2 9 9\n3 0 2 3\n"))
    assert polygons(mesh) == [(0, 1, 2), (0, 2, 3)]
    (notice,) = mesh.notices
    assert (notice.code, notice.count) == ("extra_values", 1)
    assert (notice.hint or "").endswith("; the first is line 14")


def test_short_faces_and_trailing_data_are_counted() -> None:
    assert codes(ascii_ply("3 0 1 2\n2 0 1\n1 0\n")) == {"short_faces": 2}
    assert codes(ascii_ply("3 0 1 2\n") + b"7 7\n8\n\n") == {"trailing_data": 2}
    assert codes(ascii_ply("3 0 1 2\n") + b"\n \n") == {}
    assert codes(binary_ply([(0, 1, 2)]) + b"12345") == {"trailing_data": 5}


def refused(data: bytes) -> str:
    with pytest.raises(InputError) as error:
        parsed("ply", data)
    message = str(error.value)
    assert "\n" not in message
    return message


class TestRefused:
    def test_index_out_of_range(self) -> None:
        message = "face 1: vertex index 4 found, 0 to 3 expected"
        assert refused(ascii_ply("3 0 1 2\n3 0 1 4\n")) == message
        assert refused(binary_ply([(0, 1, 2), (0, 1, 4)])) == message
        assert refused(binary_ply([(0, 1, 2, 3), (0, 1, 4)])) == message
        assert refused(ascii_ply("3 0 1 2\n3 0 -1 2\n")).startswith("face 1: vertex index -1 found")
        assert refused(ascii_ply("3 0 1 1.5\n")).startswith("face 0: vertex index 1.5 found, a whole number")
        assert refused((STRIPS.format(rows=1) + "3 0 1 -2\n").encode()).startswith("tristrips 0: vertex index -2 found")

    def test_truncated_data_at_every_byte(self) -> None:
        for data in (binary_ply([(0, 1, 2), (0, 2, 3)]), binary_ply([(0, 1, 2), (0, 1, 2, 3)], "big")):
            for end in range(len(data)):
                assert refused(data[:end])

    def test_truncated_text_at_every_line(self) -> None:
        lines = ascii_ply("3 0 1 2\n3 0 2 3\n").splitlines(keepends=True)
        for end in range(len(lines)):
            assert refused(b"".join(lines[:end]))

    @pytest.mark.parametrize("small", [-1, 1 << 16])
    def test_rows_that_cannot_be_read(self, small: int, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(text, "SMALL", small)
        assert refused(ascii_ply("3 0 1 2\n4 0 1 2\n")) == "line 15: too few values in a row of element `face`"
        assert refused(ascii_ply("3 0 1 2\n-1 0 1 2\n")).startswith("line 15: list length -1 found")
        assert refused(ascii_ply("3 0 1 2\n2.5 0 1 2\n")).startswith("line 15: list length 2.5 found")
        assert refused(ascii_ply("nan 0 1 2\n")).startswith("line 14: list length nan found")
        assert refused(ascii_ply("inf 0 1 2\n")) == "line 14: too few values in a row of element `face`"
        assert refused(ascii_ply("3 0 1 2\n\n3 0 x 2\n")).startswith("line 16: `x` found, a number expected")
        data = ascii_ply("3 0 1 2\n").replace(b"\n1 1 0\n", b"\n1 1\n")
        assert refused(data) == "line 12: too few values in a row of element `vertex`"

    def test_lengths_in_binary(self) -> None:
        data = binary_ply([(0, 1, 2), (0, 1, 2, 3)]).replace(b"list uchar", b"list char")
        at = data.index(b"end_header\n") + 11 + 48
        assert refused(data[:at] + b"\xff" + data[at + 1 :]) == "face 0: list length -1 found, 0 or more expected"
        assert refused(data[: at + 13] + b"\x80" + data[at + 14 :]).startswith("face 1: list length -128 found")
        assert refused(data[:at] + b"\x7f" + data[at + 1 :]).startswith("face 0: the data end inside a row")

    def test_huge_counts_are_refused_before_anything_is_allocated(self) -> None:
        for data in (ascii_ply("3 0 1 2\n"), binary_ply([(0, 1, 2)])):
            for element in (b"vertex 4", b"face 1"):
                huge = data.replace(element, element.split()[0] + b" 99999999999999999")
                assert "99999999999999999 rows announced" in refused(huge)

    @pytest.mark.parametrize(
        ("change", "message"),
        [
            (("ply\n", "plx\n"), "line 1: no PLY header found"),
            (("ascii 1.0", "utf8 1.0"), "line 2: format `utf8` found"),
            (("format ascii 1.0\n", ""), "line 3: `property float x` found"),
            (("vertex 4", "vertex -4"), "line 3: element count `-4` found"),
            (("vertex 4", "vertex four"), "line 3: element count `four` found"),
            (("float x", "real x"), "line 4: type `real` found"),
            (("float x", "float w"), "header: no vertex element with the properties x, y, z"),
            (("element vertex", "element point"), "header: no vertex element"),
            (("element face", "element vertex"), "header: element `vertex` announced 2 times"),
            (("list uchar int", "list float int"), "line 8: list length of type `float` found"),
            (("list uchar int", "list uchar float"), "header: `vertex_indices` holds fractions"),
            (("vertex_indices", "corners"), "header: element `face` without a list `vertex_indices`"),
            (("list uchar int", "int"), "header: element `face` without a list `vertex_indices`"),
            (("end_header", "end"), "no `end_header` found"),
            (("element vertex 4\n", "elements vertex 4\n"), "line 4: `property float x` found"),
            (("element face", "elements face"), "line 7: `elements face"),
            (("property float y", "properties float y"), "line 5: `properties float y` found"),
            (("element vertex 4\n", "element vertex\n"), "line 3: `element vertex` found, a PLY header statement"),
        ],
    )
    def test_a_wrong_header_is_refused(self, change: tuple[str, str], message: str) -> None:
        assert refused(ascii_ply("3 0 1 2\n").decode().replace(*change, 1).encode()).startswith(message)

    def test_nothing_to_compute(self) -> None:
        assert refused(ascii_ply("")).startswith("no faces")
        assert refused(ascii_ply("2 0 1\n")).startswith("no faces")
        assert refused(binary_ply([])).startswith("no faces")
        assert refused((STRIPS.format(rows=1) + "2 0 1\n").encode()).startswith("no faces")

    def test_more_faces_than_allowed(self) -> None:
        with pytest.raises(InputError, match="2 faces found, at most 1 allowed"):
            parsed("ply", ascii_ply("3 0 1 2\n3 0 2 3\n"), max_faces=1)


def test_properties_that_are_not_numbers_as_some_libraries_write_them() -> None:
    header = ascii_ply("3 0 1 2\n").decode().partition("end_header\n")[0].replace("vertex 4", "vertex 3")
    header = header.replace("property float x", "property float quality\nproperty float x")
    mesh = parsed("ply", (header + "end_header\n-1.#IND 0 0 0\n1.#INF 1 0 0\n-nan(ind) 0 1 0\n3 0 1 2\n").encode())
    np.testing.assert_array_equal(mesh.vertex_properties["quality"], [np.nan, np.inf, np.nan])
    assert mesh.xyz.T.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def test_a_comment_without_its_keyword_in_the_header() -> None:
    """As an old exporter writes them; what belongs to no element can be no loss."""
    for data in (ascii_ply("3 0 1 2\n"), binary_ply([(0, 1, 2)])):
        before, after = data.split(b"element vertex", 1)
        mesh = parsed("ply", before + b"Created by hand: a.b\nComment no\nelement vertex" + after)
        np.testing.assert_array_equal(mesh.xyz, parsed("ply", data).xyz)
        assert mesh.corners.tolist() == [0, 1, 2]
        (notice,) = mesh.notices
        assert (notice.code, notice.count, notice.hint) == ("unknown_statements", 2, "the first is line 3")


def test_a_header_of_many_elements_takes_no_quadratic_time() -> None:
    lines = "".join(f"element e{k} 0\nproperty float p\n" for k in range(50_000))
    header = parse_header(b"ply\nformat ascii 1.0\n" + lines.encode() + b"end_header\n")
    assert len(header.elements) == 50_000

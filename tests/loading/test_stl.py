"""STL files, binary and ASCII, and what is refused."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from curvcli.errors import InputError
from curvcli.loading import text
from tests.helpers.spelling import ascii_stl, binary_stl
from tests.loading.parsing import parsed

TETRAHEDRON = np.array(
    [
        [[0, 0, 0], [0, 1, 0], [1, 0, 0]],
        [[0, 0, 0], [1, 0, 0], [0, 0, 1]],
        [[0, 0, 0], [0, 0, 1], [0, 1, 0]],
        [[0, 0, 1], [1, 0, 0], [0, 1, 0]],
    ],
    float,
)
CORNERS = [0, 1, 2, 0, 2, 3, 0, 3, 1, 3, 2, 1]

singles = arrays(
    np.float32,
    st.tuples(st.integers(1, 12), st.just(3), st.just(3)),
    elements=st.one_of(st.sampled_from([0.0, -0.0, 1.0]), st.floats(width=32, allow_nan=False, allow_infinity=False)),
)


def codes(data: bytes) -> dict[str, int]:
    return {notice.code: notice.count for notice in parsed("stl", data).notices}


def refused(data: bytes) -> str:
    with pytest.raises(InputError) as error:
        parsed("stl", data)
    assert "\n" not in str(error.value)
    return str(error.value)


@given(singles, st.booleans())
def test_binary_positions_are_exactly_those_of_the_file(corners: np.ndarray, weld: bool) -> None:
    mesh = parsed("stl", binary_stl(corners), weld=weld)
    np.testing.assert_array_equal(mesh.xyz[:, mesh.corners].T, corners.reshape(-1, 3).astype(float))
    distinct = list(dict.fromkeys(map(tuple, (corners.reshape(-1, 3) + np.float32(0)).tolist())))
    assert mesh.xyz.shape[1] == (len(distinct) if weld else corners.size // 3)
    if weld:
        assert list(map(tuple, mesh.xyz.T.tolist())) == distinct


@given(singles, st.sampled_from(["\n", "\r\n", "\r"]), st.booleans(), st.sampled_from(["", "  ", "\t"]), st.booleans())
def test_ascii_says_the_same_as_binary(corners: np.ndarray, end: str, upper: bool, indent: str, large: bool) -> None:
    with pytest.MonkeyPatch.context() as patch:
        if large:
            patch.setattr(text, "SMALL", -1)
        mesh = parsed("stl", ascii_stl(corners, end=end, upper=upper, indent=indent))
    twin = parsed("stl", binary_stl(corners))
    np.testing.assert_array_equal(mesh.xyz, twin.xyz)
    np.testing.assert_array_equal(mesh.corners, twin.corners)


def test_ascii_numbers_are_doubles() -> None:
    assert parsed("stl", ascii_stl(TETRAHEDRON * 0.1)).xyz.max() == 0.1


def test_rows_come_in_order_of_first_appearance() -> None:
    assert parsed("stl", binary_stl(TETRAHEDRON)).corners.tolist() == CORNERS


@pytest.mark.parametrize("scale", [1e-9, 1e-30, 1.0, 1e9])
def test_welding_knows_no_scale(scale: float) -> None:
    for data in (binary_stl(TETRAHEDRON * scale), ascii_stl(TETRAHEDRON * scale)):
        assert parsed("stl", data).corners.tolist() == CORNERS
        assert parsed("stl", data, weld=False).corners.tolist() == list(range(12))


def test_a_binary_file_may_begin_with_solid() -> None:
    assert parsed("stl", binary_stl(TETRAHEDRON, b"solid facet outer loop")).corners.tolist() == CORNERS
    assert parsed("stl", binary_stl(TETRAHEDRON, b"\xff\xfe\x80 solid", 0xBEEF)).corners.tolist() == CORNERS


def test_all_on_one_line() -> None:
    data = b" ".join(ascii_stl(TETRAHEDRON).replace(b"made for a test", b"name").split())
    assert parsed("stl", data).corners.tolist() == CORNERS
    by_facet = ascii_stl(TETRAHEDRON).replace(b"\n      vertex", b" vertex").replace(b"\n    endloop", b" endloop")
    assert parsed("stl", by_facet).corners.tolist() == CORNERS


def test_a_keyword_in_the_name_of_the_solid() -> None:
    data = ascii_stl(TETRAHEDRON).replace(b"made for a test", b"my facet vertex endloop")
    assert parsed("stl", data).corners.tolist() == CORNERS
    data = b" ".join(ascii_stl(TETRAHEDRON).replace(b"made for a test", b"part #3").split())
    assert parsed("stl", data).corners.tolist() == CORNERS


def test_comments_are_no_statements() -> None:
    """Text STL knows none, but some programs write them: before the first line, between lines and behind numbers."""
    lines = ascii_stl(TETRAHEDRON).replace(b"made for a test", b"part #3").splitlines()
    data = b"# solid\n\n  # facet\r\n" + b"".join(line + b" # vertex 1 2 3\n  # more\n" for line in lines)
    assert parsed("stl", data).corners.tolist() == CORNERS
    assert codes(data) == {}
    assert (
        refused(data.replace(b"vertex 0.0 1.0 0.0", b"vertex 0.0 1.0"))
        == "line 12: vertex with 2 numbers found, 3 expected"
    )


def test_normals_that_are_not_numbers_do_not_matter() -> None:
    data = re.sub(rb"normal .*", b"normal -1.#IND 1.#QNAN -nan(ind)", ascii_stl(TETRAHEDRON))
    assert parsed("stl", data).corners.tolist() == CORNERS
    assert np.isnan(parsed("stl", data.replace(b"vertex 1.0 ", b"vertex 1.#QNAN ")).xyz).any()


def test_what_is_counted() -> None:
    assert codes(ascii_stl(TETRAHEDRON)) == {}
    assert codes(ascii_stl(TETRAHEDRON, last=False)) == {"missing_endsolid": 1}
    assert codes(ascii_stl(TETRAHEDRON[:2]) + b"\n" + ascii_stl(TETRAHEDRON[2:])) == {"several_solids": 2}
    assert codes(ascii_stl(TETRAHEDRON).replace(b"  endfacet", b"  colour 1 0 0\n  endfacet")) == {
        "unknown_statements": 4
    }
    assert codes(binary_stl(TETRAHEDRON) + b"1234567") == {"trailing_data": 7}


@pytest.mark.parametrize(
    "header", [b"solid", b"solid test.stl    2014-10-16", b"  SOLID facet", b"made by", b"\x1f\x8b"]
)
@pytest.mark.parametrize("rest", [b"\n", b"\r\n", b"\0" * 46, b"x" * 500])
def test_bytes_after_the_last_facet_are_counted_whatever_the_header_says(header: bytes, rest: bytes) -> None:
    data = binary_stl(TETRAHEDRON, header) + rest
    assert parsed("stl", data).corners.tolist() == CORNERS
    assert codes(data) == {"trailing_data": len(rest)}


class TestRefused:
    def test_binary_shorter_than_announced(self) -> None:
        data = binary_stl(TETRAHEDRON)
        assert refused(data[:-1]) == "byte 80: 4 facets announced, room for 3 found: 1 byte is missing"
        for end in range(len(data)):
            assert refused(data[:end])

    def test_text_without_its_first_line(self) -> None:
        data = ascii_stl(TETRAHEDRON)
        assert refused(data[data.index(b"facet") :]).endswith("; it is text, and text that is STL begins with `solid`")

    def test_a_huge_counter(self) -> None:
        data = binary_stl(TETRAHEDRON)
        assert refused(data[:80] + b"\xff\xff\xff\xff" + data[84:]).startswith("byte 80: 4294967295 facets announced")

    def test_neither_text_nor_binary(self) -> None:
        message = refused(binary_stl(TETRAHEDRON, b"solid")[:-1])
        assert "begins with `solid`" in message
        assert "asks for 284 bytes, not 283" in message

    def test_wrong_numbers_of_vertices(self) -> None:
        lines = ascii_stl(TETRAHEDRON).splitlines(keepends=True)
        assert refused(b"".join(lines[:11] + lines[12:])) == "line 9: facet with 2 vertices found, 3 expected"
        assert refused(b"".join(lines[:4] + lines[3:])) == "line 2: facet with 4 vertices found, 3 expected"
        assert refused(b"".join(lines[:1] + lines[3:4] + lines[1:])) == "line 2: vertex outside a facet found"

    def test_cut_off_inside_a_facet(self) -> None:
        lines = ascii_stl(TETRAHEDRON).splitlines(keepends=True)
        assert refused(b"".join(lines[:6])).startswith("line 6: the data end inside a facet")
        assert refused(b"".join(lines[:5])) == "line 2: facet with 2 vertices found, 3 expected"

    @pytest.mark.parametrize(
        ("old", "new", "message"),
        [
            (b"vertex 0.0 0.0 0.0", b"vertex 0.0 0.0", "line 4: vertex with 2 numbers found, 3 expected"),
            (b"vertex 0.0 0.0 0.0", b"vertex 0.0 0.0 0.0 1", "line 4: vertex with 4 numbers found, 3 expected"),
            (b"vertex 0.0 0.0 0.0", b"vertex 0.0 0,0 0.0", "line 4: `0,0` found, a number expected"),
        ],
    )
    @pytest.mark.parametrize("small", [-1, 1 << 16])
    def test_a_wrong_vertex_is_refused(
        self, old: bytes, new: bytes, message: str, small: int, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(text, "SMALL", small)
        assert refused(ascii_stl(TETRAHEDRON).replace(old, new, 1)) == message

    def test_nothing_to_compute(self) -> None:
        assert refused(b"solid empty\nendsolid empty\n").startswith("no faces")
        assert refused(binary_stl(TETRAHEDRON[:0])).startswith("no faces")
        assert refused(b"").startswith("0 bytes found")

    def test_more_faces_than_allowed(self) -> None:
        for data in (binary_stl(TETRAHEDRON), ascii_stl(TETRAHEDRON)):
            with pytest.raises(InputError, match="4 faces found, at most 3 allowed"):
                parsed("stl", data, max_faces=3)


@pytest.mark.parametrize(("wrong", "place"), [("vertdx", "line 4"), ("vertexes", "line 4"), ("facets", "line 2")])
def test_a_misspelt_keyword_is_refused_with_its_line(wrong: str, place: str) -> None:
    data = ascii_stl(TETRAHEDRON).decode()
    with pytest.raises(InputError, match=f"`{wrong}` found, `{wrong[:3]}") as error:
        parsed("stl", re.sub(wrong[:3] + r"\w+", wrong, data, count=1).encode())
    assert error.value.place == place


def test_solids_are_labels() -> None:
    facet = b"facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    names = [b"Inlet a", b"", b"walls", b"walls", b"empty"]
    text = b"".join(
        b"solid " + name + b"\n" + facet * count + b"endsolid\n"
        for name, count in zip(names, (1, 2, 1, 3, 0), strict=True)
    )
    for data in (text, text.replace(b"\nvertex", b" vertex").replace(b"\nouter", b" outer")):
        labels = parsed("stl", data).polygon_labels["solids"]
        assert [labels.names[code] for code in labels.codes] == [
            "Inlet a",
            *["solid 2"] * 2,
            "walls 3",
            *["walls 4"] * 3,
        ]
    assert parsed("stl", binary_stl(TETRAHEDRON)).polygon_labels == {}

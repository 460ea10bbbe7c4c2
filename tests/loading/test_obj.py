"""OBJ files: every spelling means the same mesh, and what cannot be read is refused with its line."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from curvcli.errors import InputError
from curvcli.loading import text
from curvcli.loading.formats.obj.parse import parse_obj
from curvcli.mesh.polygons import from_file
from tests.helpers.spelling import Meant, meant, obj_text, polygons, same

SQUARE = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


@pytest.fixture(params=["small", "large"])
def any_size(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Both ways of reading numbers: the one for small texts and the one for large ones."""
    if request.param == "large":
        monkeypatch.setattr(text, "SMALL", -1)


def codes(data: bytes) -> dict[str, int]:
    return {notice.code: notice.count for notice in parse_obj(data).notices}


@given(st.data(), meant(), st.booleans())
def test_every_spelling_means_the_same_mesh(data: st.DataObject, mesh: Meant, large: bool) -> None:
    spelt = data.draw(obj_text(mesh))
    with pytest.MonkeyPatch.context() as patch:
        if large:
            patch.setattr(text, "SMALL", -1)
        same(parse_obj(spelt), mesh)


@given(st.lists(st.tuples(st.integers(-(2**80), 2**80), st.integers(-360, 310)), min_size=3, max_size=3))
def test_decimals_are_rounded_correctly(parts: list[tuple[int, int]]) -> None:
    words = [f"{mantissa}e{exponent}" for mantissa, exponent in parts]
    data = f"v {' '.join(words)}\nv 0 0 0\nv 1 1 1\nf 1 2 3\n".encode()
    for small in (-1, 1 << 16):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(text, "SMALL", small)
            assert parse_obj(data).xyz[:, 0].tolist() == [float(word) for word in words]


@given(st.floats(allow_nan=False, allow_infinity=False, min_value=1e-300, max_value=1e300), st.booleans())
def test_halfway_cases_go_to_the_even_double(x: float, above: bool) -> None:
    from decimal import Decimal, localcontext

    with localcontext() as context:
        context.prec = 2000
        half = str((Decimal(x) + Decimal(math.nextafter(x, math.inf))) / 2) + ("1" if above else "")
    half = half.replace("E+", "e+") if "." in half else half
    data = f"v {half} 0 0\nv 0 0 0\nv 1 1 1\nf 1 2 3\n".encode()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(text, "SMALL", -1)
        assert parse_obj(data).xyz[0, 0] == float(half)


@pytest.mark.usefixtures("any_size")
class TestTraps:
    def test_texture_seams_and_materials_never_cut_the_surface(self) -> None:
        data = SQUARE + b"vt 0 0\nvt 1 1\nvn 0 0 1\nusemtl a\nf 1/1/1 2/2/1 3/1/1\nusemtl b\no x\nf 1/2/1 3/2/1 4/1/1\n"
        mesh = parse_obj(data)
        assert mesh.xyz.shape == (3, 4)
        assert polygons(mesh) == [(0, 1, 2), (0, 2, 3)]
        assert mesh.sizes is None

    def test_relative_indices_count_from_where_they_stand(self) -> None:
        data = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nv 1 0 1\nf -1 -2 -5\nf 1 2 -1\n"
        assert polygons(parse_obj(data)) == [(0, 1, 2), (4, 3, 0), (0, 1, 4)]

    def test_a_face_may_come_before_its_vertices(self) -> None:
        assert polygons(parse_obj(b"f 1 2 3\n" + SQUARE)) == [(0, 1, 2)]

    def test_polygons_of_all_sizes(self) -> None:
        mesh = parse_obj(SQUARE + b"f 1 2 3\nf 1 2 3 4\nf 4 3 2 1 2\n")
        assert mesh.sizes is not None
        assert mesh.sizes.tolist() == [3, 4, 5]
        assert polygons(mesh) == [(0, 1, 2), (0, 1, 2, 3), (3, 2, 1, 0, 1)]

    def test_continued_lines_keep_the_line_numbers(self) -> None:
        data = b"v 0 0 \\\n 0\nv 1 0 0\nv 0 1 \\\r\n0\nf 1 \\\n2 \\\n3\nf 1 2 9\n"
        with pytest.raises(InputError, match=r"^line 9: vertex index `9` found, 1 to 3 expected"):
            parse_obj(data)
        assert polygons(parse_obj(data.replace(b"9\n", b"3\n"))) == [(0, 1, 2), (0, 1, 2)]

    def test_a_backslash_at_the_end_of_a_comment_continues_nothing(self) -> None:
        assert polygons(parse_obj(b"# C:\\meshes\\\n" + SQUARE + b"f 1 2 3 # \\\nf 1 3 4\n")) == [(0, 1, 2), (0, 2, 3)]

    def test_old_line_ends_nuls_and_byte_order_mark(self) -> None:
        data = b"\xef\xbb\xbf" + (SQUARE + b"f 1\t2\0 3\v\f\n").replace(b"\n", b"\r")
        same(parse_obj(data), Meant([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2)]))

    def test_latin_1_in_comments_and_names(self) -> None:
        mesh = parse_obj(b"# r\xe4umlich\ng r\xe4der\n" + SQUARE + "g räder\nf 1 2 3\n".encode())
        assert mesh.polygon_labels["groups"].names == ("räder",)

    def test_a_hash_in_a_name_is_part_of_it(self) -> None:
        for tail in (b"", b" # shiny"):
            mesh = parse_obj(SQUARE + b"usemtl red#2" + tail + b"\nf 1 2 3 # the only one\n")
            assert mesh.polygon_labels["materials"].names == ("red#2",)

    def test_labels_in_force(self) -> None:
        data = SQUARE + b"f 1 2 3\ng a\nf 1 2 3\nf 1 2 4\ng b\ng a\nf 2 3 4\ng b\nf 1 3 4\no only\n"
        labels = parse_obj(data).polygon_labels
        assert labels["groups"].codes.tolist() == [-1, 0, 0, 0, 1]
        assert labels["groups"].names == ("a", "b")
        assert labels["objects"].codes.tolist() == [-1] * 5

    def test_colours_and_weights(self) -> None:
        mesh = parse_obj(b"v 0 0 0 1 0.5 0\nv 1 0 0\nv 0 1 0 2\nv 1 1 0 1 .25 .5 .75\nf 1 2 3\n")
        np.testing.assert_array_equal(mesh.xyz, [[0, 1, 0, 1], [0, 0, 1, 1], [0, 0, 0, 0]])
        nan = np.nan
        np.testing.assert_array_equal(mesh.vertex_properties["red"], [1, nan, nan, 0.25])
        np.testing.assert_array_equal(mesh.vertex_properties["blue"], [0, nan, nan, 0.75])
        (notice,) = mesh.notices
        assert (notice.code, notice.count, notice.examples) == ("rational_weights", 1, (2,))

    def test_colours_are_properties_of_vertices(self) -> None:
        mesh = parse_obj(b"v 0 0 0 1 2 3\nv 1 0 0 4 5 6\nv 0 1 0 7 8 9\nf 1 2 3\n")
        assert {name: values.tolist() for name, values in mesh.vertex_properties.items()} == {
            "red": [1, 4, 7],
            "green": [2, 5, 8],
            "blue": [3, 6, 9],
        }

    def test_records_of_lines_are_polylines(self) -> None:
        mesh = parse_obj(SQUARE + b"l 1 2\nl 3/1 -1 1\nf 1 2 3\n")
        assert [line.tolist() for line in mesh.polylines] == [[0, 1], [2, 3, 0]]

    def test_polylines_alone_are_no_surface_but_can_be_read(self) -> None:
        mesh = parse_obj(SQUARE + b"l 1 2 3\n")
        assert mesh.polygons == 0
        assert mesh.polylines[0].tolist() == [0, 1, 2]
        with pytest.raises(InputError, match="no faces, only `l` polylines"):
            from_file(mesh)

    def test_short_faces_are_dropped_and_counted(self) -> None:
        mesh = parse_obj(SQUARE + b"g a\nf 1 2\nf 1 2 3\ng b\nf\nf 1 3 4\n")
        assert polygons(mesh) == [(0, 1, 2), (0, 2, 3)]
        assert mesh.polygon_labels["groups"].codes.tolist() == [0, 1]
        (notice,) = mesh.notices
        assert (notice.code, notice.count, notice.examples) == ("short_faces", 2, (0, 2))
        assert notice.message == "faces with fewer than 3 corners, dropped"
        assert (notice.hint or "").startswith("the first is in line 6; ")

    def test_unreferenced_vertices_stay(self) -> None:
        assert parse_obj(SQUARE + b"f 1 2 4\nv 5 5 5\n").xyz.shape == (3, 5)

    def test_statements_that_are_ignored_are_counted(self) -> None:
        data = b"cstype bezier\ncurv 0 1 1 2\nvp 1 2\nwhat is this\n" + SQUARE + b"s 1\nmtllib x.mtl\nf 1 2 3\n"
        assert codes(data) == {"ignored_statements": 3, "unknown_statements": 1}

    def test_not_a_number_is_delivered_but_not_a_word(self) -> None:
        assert np.isnan(parse_obj(b"v 0 nan 0\n" + SQUARE + b"f 2 3 4\n").xyz[1, 0])
        assert np.isinf(parse_obj(b"v 0 -inf 0\n" + SQUARE + b"f 2 3 4\n").xyz[1, 0])

    @pytest.mark.parametrize("spelled", [b"1.#QNAN", b"-1.#IND00", b"1.#J", b"-1.#IO", b"-nan(ind)", b"nan(snan)"])
    @pytest.mark.parametrize("after", [b"", b" ", b" # 1", b"\r"])
    def test_not_a_number_as_some_libraries_write_it(self, spelled: bytes, after: bytes) -> None:
        """Its `#` begins no comment: what is left of it would be a number."""
        xyz = parse_obj(SQUARE + b"v 1 2 " + spelled + after + b"\nv " + spelled + b" 2 3\nf 1 2 3\n").xyz
        assert np.isnan(xyz[2, 4])
        assert np.isnan(xyz[0, 5])
        assert parse_obj(SQUARE + b"v 1 2 -1.#INF00" + after + b"\nf 1 2 3\n").xyz[2, 4] == -np.inf
        assert parse_obj(SQUARE + b"v 1 2 1.#comment" + after + b"\nf 1 2 3\n").xyz[2, 4] == 1

    @pytest.mark.parametrize(
        ("data", "message"),
        [
            (SQUARE + b"f 0 1 2\n", "line 5: vertex index `0` found, 1 to 4 expected"),
            (SQUARE + b"f 1 2 3\nf 1 2/2 5/1\n", "line 6: vertex index `5/1` found, 1 to 4 expected"),
            (SQUARE + b"f 1 2 -5\nv 1 2 3\n", "line 5: vertex index `-5` found"),
            (b"f -1 -2 -3\n" + SQUARE, "line 1: vertex index `-1` found"),
            (SQUARE + b"f 1 2 99999999999\n", "line 5: `99999999999` found, a vertex index expected"),
            (SQUARE + b"\n\nf 1 2 3\nf 1 two 3\n", "line 8: `two` found, a vertex index expected"),
            (SQUARE + b"f 1 2 3.0\n", "line 5: `3.0` found, a vertex index expected"),
            (SQUARE + b"f 1 2 /3\n", "line 5: `/3` found, a vertex index expected"),
            (SQUARE + b"l 1 7\nf 1 2 3\n", "line 5: vertex index `7` found"),
            (SQUARE + b"v 1 2\nf 1 2 3\n", "line 5: `v` record with 2 numbers, at least 3 expected"),
            (b"v 1 2\nv 1 2\nf 1 2 1\n", "line 1: `v` record with 2 numbers, at least 3 expected"),
            (SQUARE + b"v\nf 1 2 3\n", "line 5: `v` record with 0 numbers, at least 3 expected"),
            (SQUARE + b"v 1 2 1d5\nf 1 2 3\n", "line 5: `1d5` found, a number expected"),
            (SQUARE + b"v 1 1/2 3\nf 1 2 3\n", "line 5: `1/2` found, a number expected"),
            (SQUARE + b"v 1 1_0 3\nf 1 2 3\n", "line 5: `1_0` found, a number expected"),
            (SQUARE + b"  v 1 \xff 3\nf 1 2 3\n", "line 5: `\\xff` found, a number expected"),
            (SQUARE, "no faces"),
            (SQUARE + b"f 1 2\n", "no faces"),
            (b"f 1 2 3\n", "line 1: vertex index `1` found, but no vertex"),
            (b"hello\nworld\n", "no OBJ record found"),
            (b"\n", "no OBJ record found"),
            (b"#\n", "no OBJ record found"),
        ],
    )
    def test_what_is_refused(self, data: bytes, message: str) -> None:
        with pytest.raises(InputError) as refused:
            parse_obj(data)
        assert str(refused.value).startswith(message)
        assert "\n" not in str(refused.value)


def test_max_faces_is_checked_before_numbers_are_read() -> None:
    with pytest.raises(InputError, match="3 faces found, at most 2 allowed"):
        parse_obj(b"v what\n" + b"f 1 2 3\n" * 3, max_faces=2)


def test_many_objects_and_one_very_long_line() -> None:
    count = 20_000
    data = "".join(f"o part{k}\nv {k} 0 0\nv {k} 1 0\nv {k} 0 1\nf -1 -2 -3\n" for k in range(count)).encode()
    data += b"f " + b" ".join(b"%d" % (3 * k + 1) for k in range(count)) + b"\n"
    mesh = parse_obj(data)
    assert mesh.sizes is not None
    assert mesh.sizes.tolist() == [3] * count + [count]
    assert mesh.polygon_labels["objects"].codes.tolist() == [*range(count), count - 1]
    assert mesh.corners[: 3 * count].reshape(-1, 3)[777].tolist() == [2333, 2332, 2331]
    np.testing.assert_array_equal(mesh.corners[3 * count :], 3 * np.arange(count))

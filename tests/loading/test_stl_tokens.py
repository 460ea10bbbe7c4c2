"""Text STL is tokens: facets wherever lines end, names and comments with any words, and nothing lost or invented."""

from __future__ import annotations

import re
import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from curvcli.errors import InputError
from curvcli.loading import text
from tests.helpers.spelling import ascii_stl
from tests.loading.parsing import parsed
from tests.loading.test_stl import CORNERS, TETRAHEDRON

FACETS = [
    f"facet normal 0 0 1 outer loop {' '.join('vertex {} {} {}'.format(*p) for p in facet)} endloop endfacet"
    for facet in TETRAHEDRON.tolist()
]
TEXT = ascii_stl(TETRAHEDRON)
WORDS = st.sampled_from(["vertex", "facet", "my", "solid", "loop", "1", "endloop", "#3", "normal", "endfacet", "Outer"])
NAMES = st.lists(WORDS, max_size=5).map(" ".join).filter(lambda name: not re.search("facet normal|facet outer", name))


def corners(data: bytes) -> list[int]:
    mesh = parsed("stl", data)
    np.testing.assert_array_equal(mesh.xyz.T[mesh.corners].reshape(-1, 3, 3), TETRAHEDRON)
    return mesh.corners.tolist()


def codes(data: bytes) -> dict[str, int]:
    return {notice.code: notice.count for notice in parsed("stl", data).notices}


@given(st.data(), st.sampled_from(["\n", "\r\n", "\r"]), st.booleans(), st.booleans())
def test_any_white_space_separates_tokens(data: st.DataObject, end: str, upper: bool, large: bool) -> None:
    separator = st.sampled_from([" ", "\n", "\n", "\t", "  \n\n ", "\n\t", "\f", " \v"])
    words = " ".join(FACETS).split()
    spelt = "".join(word + data.draw(separator) for word in words)
    spelt = spelt.upper() if upper else spelt
    name, other = data.draw(NAMES), data.draw(NAMES)
    whole = f"solid {name}\n{spelt}\nendsolid {other}\n".replace("\n", end).encode()
    with pytest.MonkeyPatch.context() as patch:
        if large:
            patch.setattr(text, "SMALL", -1)
        assert corners(whole) == CORNERS
        assert codes(whole) == {}


@given(NAMES, NAMES, st.integers(1, 3))
def test_names_on_the_line_of_facets(name: str, other: str, cut: int) -> None:
    first, second = " ".join(FACETS[:cut]), " ".join(FACETS[cut:])
    name, other = name.replace("#3", "3"), other.replace("#3", "3")
    for between in ("\n", " "):
        joined = f"solid {name} {first} endsolid {other}{between}solid {other} {second} endsolid"
        assert corners(joined.encode()) == CORNERS
        assert codes(joined.encode()) == {"several_solids": 2}


@pytest.mark.parametrize("before", ["endfacet ", "endfacet endsolid a solid b "])
def test_a_facet_behind_the_end_of_another_is_not_lost(before: str) -> None:
    """Line by line only the facets that begin a line would be seen, with three vertices each."""
    behind = re.sub(rb"\s+endfacet\s+facet", b"\n" + before.encode() + b"facet", TEXT, count=2)
    assert corners(behind) == CORNERS
    whole = "solid a\n" + "\n".join(FACETS[:2]) + " " + FACETS[2] + "\n" + FACETS[3].replace(" vertex", "\nvertex")
    assert corners(f"{whole}\nendsolid a\n".encode()) == CORNERS


def test_a_second_solid_on_one_line_is_not_lost() -> None:
    one = ascii_stl(TETRAHEDRON[:2])
    for name in ("b", "vertex b", ""):
        other = f"solid {name} {FACETS[2]} {FACETS[3]} endsolid {name}\n".encode()
        assert corners(one + other) == CORNERS
        assert codes(one + other) == {"several_solids": 2}
        assert corners(one + other.replace(b" endsolid", b"\nendsolid")) == CORNERS


@pytest.mark.parametrize("comment", ["# vertex 1 2 3", "# a facet normal 0 0 1 outer loop", "#facet", "# endfacet"])
def test_comments_hold_any_words(comment: str) -> None:
    lines = [f"solid part #3 {FACETS[0]} {comment}", comment, *(f"{facet} {comment}" for facet in FACETS[1:])]
    assert corners("\n".join([*lines, "endsolid", ""]).encode()) == CORNERS
    split = "\n".join(lines).replace(" vertex 1.", f" {comment}\nvertex 1.").replace(" endloop", f" {comment}\nendloop")
    assert corners(f"{split}\nendsolid\n".encode()) == CORNERS


def test_statements_of_others_are_counted_as_before() -> None:
    plain = TEXT
    assert codes(plain.replace(b"  endfacet", b"  colour 1 0 0\n  endfacet")) == {"unknown_statements": 4}
    assert codes(plain.replace(b"  facet", b"made of vertex lists\n  facet", 1)) == {"unknown_statements": 1}
    assert codes(b"solid\n" + b"\n".join(facet.encode() for facet in FACETS)) == {"missing_endsolid": 1}


@pytest.mark.parametrize("comment", ["// vertex 1 2 3", "; the first vertex", "! facet 1", "comment: a vertex list"])
def test_comments_of_other_languages_are_counted(comment: str) -> None:
    assert corners("\n".join(["solid a", FACETS[0], comment, *FACETS[1:], "endsolid a", ""]).encode()) == CORNERS


@pytest.mark.parametrize(
    "part", ["vertex 0 0 0", "outer loop", "endloop", "endfacet", "a outer loop b", "normal 0 0 1"]
)
def test_parts_of_a_facet_outside_are_refused(part: str) -> None:
    with pytest.raises(InputError, match="line 3: "):
        parsed("stl", "\n".join(["solid a", FACETS[0], part, *FACETS[1:], "endsolid a", ""]).encode())


def test_a_token_on_each_line() -> None:
    for end in ("\n", "\r\n", "\r"):
        data = end.join(" ".join(["solid", "a", "vertical", *FACETS, "endsolid", "a"]).split()).encode()
        assert corners(data) == CORNERS
        assert codes(data) == {}


def test_facets_without_a_normal() -> None:
    data = "solid a " + " ".join(facet.replace("normal 0 0 1 ", "") for facet in FACETS) + " endsolid a"
    assert corners(data.encode()) == CORNERS


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("endloop endfacet", "endfacet", "line 3: `endfacet` found, `endloop` expected"),
        ("vertex 0.0 1.0 0.0", "vertex 0.0 1.0", "line 3: "),
        ("vertex 0.0 1.0 0.0", "vertex 0.0 1.0 0.0 0.0", "line 3: `0.0` found, `vertex` expected"),
        ("vertex 0.0 1.0 0.0", "vertex 0.0 1,0 0.0", "line 3: `1,0` found, a number expected"),
        ("vertex 0.0 1.0 0.0", "vertdx 0.0 1.0 0.0", "line 3: `vertdx` found, `vertex` expected"),
        ("facet normal", "facets normal", "line 3: "),
        ("outer loop", "loop", "line 3: `loop` found, `outer` expected"),
        (" endloop endfacet", "", "line 4: `facet` found, `endloop` expected"),
    ],
)
def test_faults_have_their_line(old: str, new: str, message: str) -> None:
    lines = ["solid a", "", FACETS[0].replace(old, new, 1), *FACETS[1:], "endsolid a", ""]
    assert old in FACETS[0]
    with pytest.raises(InputError) as error:
        parsed("stl", "\n".join(lines).encode())
    assert str(error.value).startswith(message)


@pytest.mark.parametrize("cut", range(1, 21))
def test_text_that_ends_inside_a_facet(cut: int) -> None:
    words = " ".join(["solid a", *FACETS]).split()
    with pytest.raises(InputError):
        parsed("stl", " ".join(words[:-cut]).encode())


def test_more_facets_than_allowed() -> None:
    with pytest.raises(InputError, match="4 faces found, at most 3 allowed"):
        parsed("stl", " ".join(["solid a", *FACETS]).encode(), max_faces=3)


@pytest.mark.parametrize(
    "unit", [b" facet normal", b" facet", b" vertex 1 2", b" # facet normal", b"\nfacet normal", b" solid"]
)
def test_time_is_proportional_to_the_file(unit: bytes) -> None:
    begin = time.process_time()
    with pytest.raises(InputError):
        parsed("stl", b"solid a" + unit * 100_000 + b"\n")
    assert time.process_time() - begin < 20

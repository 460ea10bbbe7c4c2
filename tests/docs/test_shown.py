"""The comparison of shown output can fail."""

from __future__ import annotations

from tests.docs.shown import missing

PRINTED = "V 4  E 6\n\n K      pass  1.8e-13\n area   15.663886\n"


def test_rounding_and_width_do_not_count() -> None:
    assert missing("V 4 E 6\nK pass 2.1e-13\narea  15.663886\n", PRINTED) == []


def test_lines_may_be_left_out_where_the_page_says_so() -> None:
    assert missing("V 4 E 6\n…\narea 15.663886\n", PRINTED) == []
    assert missing("V 4 E 6\n…\n", PRINTED) == []
    assert missing("V 4 E 6\narea 15.663886\n", PRINTED) == ["area 15.663886"]
    assert missing("V 4 E 6\nK pass 0\n", PRINTED) == [" area   15.663886"]


def test_another_number_or_word_is_missing() -> None:
    assert missing("V 4 E 7\n…\n", PRINTED) == ["V 4 E 7", "…"]
    assert missing("…\narea 15.664\n", PRINTED) == ["area 15.664"]
    assert missing("…\nK FAIL 1.8e-13\n…\n", PRINTED) == ["K FAIL 1.8e-13", "…"]


def test_cells_of_tables_are_compared_one_by_one() -> None:
    assert missing("0,1.0000000000000002,\n", "0,1.0,\n") == []
    assert missing("0,1.0,\n", "0,,1.0\n") == ["0,1.0,"]
    assert missing("E 2,400\n", "E 2,401\n") == ["E 2,400"]

"""Comparison of two commits: times do not count, known kinds explain a file only as a whole, tables name columns."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from click.testing import CliRunner

from benchmarks.same_outputs.__main__ import main
from benchmarks.same_outputs.differences import Difference, Kind, between, known_kinds
from tests.helpers.cli.program import ROOT


def compared(
    tmp_path: Path, old: str, new: str, file: str = ".stdout", kinds: tuple[Kind, ...] = ()
) -> list[Difference]:
    for side, text in (("old", old), ("new", new)):
        (tmp_path / side / "cube" / "check").mkdir(parents=True)
        (tmp_path / side / "cube" / "check" / file).write_text(text)
    return list(between(tmp_path / "old", tmp_path / "new", kinds))


def test_seconds_are_no_difference(tmp_path: Path) -> None:
    report = '{"totals": {"K": 1}, "timings": {"read": %s, "compute": 2}}'
    assert compared(tmp_path, report % 1, report % 3, "k.json") == []


def test_a_difference_names_the_first_line(tmp_path: Path) -> None:
    (found,) = compared(tmp_path, "same\nK 1\n", "same\nK 2\n")
    assert (found.case, found.file, found.old, found.new, found.kinds) == ("cube/check", ".stdout", "K 1", "K 2", ())


def test_the_first_value_of_a_report_that_differs(tmp_path: Path) -> None:
    (found,) = compared(tmp_path, '{"a": 1, "K": 2, "timings": {"read": 1}}', '{"a": 1, "K": 3}', "k.json")
    assert (found.old.strip(), found.new.strip()) == ('"K": 2', '"K": 3')


def test_a_table_names_its_columns(tmp_path: Path) -> None:
    (found,) = compared(tmp_path, "v,K,h\n0,4,1\n1,2,1\n", "v,K,h\n0,4,1\n1,2.5,\n", "k.csv")
    assert found.old == "K: 1 rows, 1.2e-01; h: 1 rows, nan, ('1', '')"


def test_a_lost_column_is_named(tmp_path: Path) -> None:
    (found,) = compared(tmp_path, "v,K\n1,4\n", "v,h\n2,4\n", "k.csv")
    assert (found.old, found.new) == ("columns lost: K; v: 1 rows, 1.0e+00", "columns new: h")


def test_a_file_of_one_side(tmp_path: Path) -> None:
    found = compared(tmp_path, "", "")
    (tmp_path / "new" / "cube" / "check" / "k.csv").write_text("")
    assert found == []
    (found,) = between(tmp_path / "old", tmp_path / "new")
    assert (found.file, found.old, found.new) == ("k.csv", "missing", "there")


REWORDED = Kind("reworded", case="*/check", old=r"(\d+) holes", new=r"\1 boundary loops")


@pytest.mark.parametrize(("rest", "kinds"), [("", ("reworded",)), ("!", ())])
def test_a_kind_explains_a_file_completely_or_not_at_all(tmp_path: Path, rest: str, kinds: tuple[str, ...]) -> None:
    (found,) = compared(tmp_path, "2 holes\nend", f"2 boundary loops\nend{rest}", kinds=(REWORDED,))
    assert found.kinds == kinds
    assert (found.old == "2 holes") == (not rest)


def test_lines_may_be_known(tmp_path: Path) -> None:
    kind = Kind("a new column", drop="^kappa_max ")
    (found,) = compared(tmp_path, "K 1\n", "K 1\nkappa_max 2\n", kinds=(kind,))
    assert found.kinds == ("a new column",)


def test_differences_of_one_kind_have_one_signature() -> None:
    lines = [Difference(f"{mesh}/check", ".stderr", f"/tmp/{mesh}: 3 faces", "none") for mesh in ("cube", "torus")]
    assert len({each.signature for each in lines}) == 1


def test_kinds_of_a_file(tmp_path: Path) -> None:
    file = tmp_path / "known.toml"
    file.write_text("[[kind]]\nname = 'reworded'\ncase = '*/check'\nold = '(\\d+) holes'\nnew = '\\1 boundary loops'\n")
    assert known_kinds(file) == [REWORDED]


@pytest.mark.slow
def test_a_commit_equals_itself() -> None:
    if subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True).returncode:
        pytest.skip("without git there are no commits")
    result = CliRunner().invoke(main, ["HEAD", "HEAD", "--samples", "cube"])
    assert result.exit_code == 0, result.output
    assert "0 files differ" in result.output

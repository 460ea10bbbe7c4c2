"""LaTeX tables: every character stands for itself, digits are readable, rows are those of the other tables."""

from __future__ import annotations

import io
import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import curvcli
from curvcli.errors import OutputError, UsageError
from curvcli.mesh.file import Labels
from curvcli.output.latex.table import MOST_ROWS
from curvcli.output.latex.text import escape_latex, typeset, unit
from curvcli.output.tables.columns import chosen_columns
from curvcli.output.tables.write import write_table
from curvcli.support.words import escape_text
from tests.commands.conftest import within
from tests.helpers.meshes import of_sample

__all__ = ["within"]

# Commands of TeX and their characters, for a reader of our cells.
COMMANDS = {
    r"\textbackslash{}": "\\",
    r"\textasciitilde{}": "~",
    r"\textasciicircum{}": "^",
    r"\textless{}": "<",
    r"\textgreater{}": ">",
    r"\textbar{}": "|",
    **{f"{{\\char{code}}}": chr(code) for code in (34, 39, 96)},
    **{f"{{{sign}}}": sign for sign in "[]*="},
    **{f"\\{sign}": sign for sign in "{}$&#%_"},
    r"\ ": " ",
    "{}": "",
}
TOKEN = re.compile("|".join(map(re.escape, sorted(COMMANDS, key=len, reverse=True))) + r"|[^\\{}$&#%_~^<>|\"'`\[\]*=]")


def read(cell: str) -> str:
    """Text of a cell; the commands are read one by one, and nothing else of TeX may stand in it."""
    text, place = "", 0
    while place < len(cell):
        token = TOKEN.match(cell, place)
        assert token, cell[place:]
        text += COMMANDS.get(token[0], token[0])
        place = token.end()
    return text


@given(st.text(st.characters(codec="utf-8"), max_size=20) | st.text("-,`'\"\\{}[]*& ~^%$#_<>|=\n", max_size=12))
def test_every_character_stands_for_itself(text: str) -> None:
    cell = escape_latex(text)
    assert read(cell) == escape_text(text)
    assert not re.search(r"--|,,|  |\n|^ |(?<!\\) $", cell)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "$0$"),
        (-0.0, "$0$"),
        (1234.5678, "$1234.6$"),
        (12345.678, r"$12\,346$"),
        (-1.5e-7, r"$-1.5 \times 10^{-7}$"),
        (math.nan, "--"),
        (None, "--"),
        (-math.inf, r"$-\infty$"),
        (1234567, r"$1\,234\,567$"),
        (-1234567, r"$-1\,234\,567$"),
        (9999, "$9999$"),
        (True, "yes"),
    ],
)
def test_numbers_are_typeset(value: float | None, text: str) -> None:
    assert typeset(value) == text


def test_digits_and_units() -> None:
    assert typeset(math.pi, 3) == "$3.14$"
    assert [unit(text) for text in ("1", "mm", "mm^2", "length^-1", "a_b^2", "k_BT")] == [
        *("", "mm", "mm$^{2}$", "length$^{-1}$", r"a\_b$^{2}$", r"k\_BT"),
    ]


def test_a_table_has_its_rows() -> None:
    stream = io.BytesIO()
    columns = {
        "region": Labels(np.array([0, -1, 1], np.int32), ("a & b", "[x]")),
        "n_": np.ma.masked_array([1, 2, 30000], [False, True, False]),
        "h": np.array([0.5, np.nan, -2.0]),
    }
    write_table(stream, columns, ".tex", precision=3)
    lines = stream.getvalue().decode().splitlines()
    assert r"\begin{tabular}{lrr}" in lines
    body = [line for line in lines if line.endswith(r"\\")]
    assert body == [
        r"region & n\_ & h \\",
        r"a \& b & $1$ & $0.5$ \\",
        r"-- & -- & -- \\",
        r"{[}x{]} & $30\,000$ & $-2$ \\",
    ]
    assert lines[-1] == r"\end{tabular}"
    assert not [line for line in lines if re.match(r"\s*[\[*]", line)]  # behind \\ they would be an argument of it


def test_too_many_rows_are_refused() -> None:
    with pytest.raises(OutputError, match="10,001 rows in a LaTeX table"):
        write_table(io.BytesIO(), {"x": np.zeros(MOST_ROWS + 1)}, ".tex")


def test_totals_have_units_and_the_digits_of_the_report(within, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    of_sample("icosphere", size=42).write(tmp_path / "s_1.ply")
    assert within("analyze", "s_1.ply", "-q", "--unit", "mm", "-o", "t.tex").code == 0
    text = (tmp_path / "t.tex").read_text()
    area = curvcli.analyze(tmp_path / "s_1.ply").totals["area"]
    assert f"area & ${area:.5g}$ & mm$^{{2}}$ \\\\" in text
    assert r"kappa\_g & $0$ &  \\" in text
    assert "s_1.ply" in text.splitlines()[0]
    assert all(line.startswith("%") for line in text.splitlines()[:3])
    assert within("analyze", "s_1.ply", "-q", "--precision", "3", "-o", "u.tex").code == 0
    assert f"area & ${area:.3g}$ & length$^{{2}}$" in (tmp_path / "u.tex").read_text()


def test_columns_are_chosen_in_their_order(within, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng left_1\nf 1 2 3\ng right\nf 1 3 4\n"
    (tmp_path / "square.obj").write_text(text)
    words = ("analyze", "square.obj", "--regions", "groups", "--stat", "mean", "-q")
    tables = ("--table", "regions=r.tex", "--table", "regions=r.csv")
    assert within(*words, "--columns", "region,area,h_mean", *tables).code == 0
    assert (tmp_path / "r.csv").read_text() == "region,area,h_mean\nleft_1,0.5,\nright,0.5,\n"
    assert r"left\_1 & $0.5$ & -- \\" in (tmp_path / "r.tex").read_text()
    ended = within(*words, "--columns", "region,aera", "--table", "regions=s.csv")
    assert (ended.code, (tmp_path / "s.csv").exists()) == (2, False)
    assert "--columns aera: the table has no such column; nearest: area" in ended.err
    assert within(*words, "--table", "regions=brief.tex").code == 0
    brief = (tmp_path / "brief.tex").read_text()
    assert "euler" not in brief
    assert r"h\_mean" in brief


def test_a_table_without_the_column_is_named() -> None:
    with pytest.raises(UsageError, match="--columns b: "):
        chosen_columns({"a": np.zeros(1)}, ["b"])

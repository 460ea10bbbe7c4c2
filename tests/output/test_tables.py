"""Tables read back: every double bit for bit, every null as a null."""

from __future__ import annotations

import csv
import io
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from curvcli.errors import OutputError, UsageError
from curvcli.mesh.file import Labels
from curvcli.output.tables.write import Column, write_table

HARD = [
    5e-324,
    2.2250738585072014e-308,
    1e308,
    1.7976931348623157e308,
    -0.0,
    0.0,
    3.0,
    1e15,
    1e16,
    1e22,
    1e23,
    0.1,
    -1 / 3,
]
STATUS = Labels(np.array([1, -1, 0], np.int32), ("interior", "boundary"))
COLUMNS: dict[str, Column] = {
    "vertex": np.arange(3),
    "K": np.array([0.1, np.nan, -0.0]),
    "closed": np.array([True, False, True]),
    "welded_to": np.ma.array([7, 0, 9], mask=[False, True, False]),
    "status": STATUS,
}


def text(columns: dict[str, Column], suffix: str = ".csv", **options: str | int) -> str:
    stream = io.BytesIO()
    write_table(stream, columns, suffix, **options)
    return stream.getvalue().decode()


def bits(values: object) -> list[bytes]:
    return [struct.pack("<d", value) for value in values]  # type: ignore[attr-defined]


def test_csv_has_the_known_text() -> None:
    assert text(COLUMNS) == (
        "vertex,K,closed,welded_to,status\n0,0.1,true,7,boundary\n1,,false,,\n2,-0.0,true,9,interior\n"
    )


def test_tsv_has_the_known_text() -> None:
    assert text({"a": np.array([1, 2]), "b": np.array([np.nan, 2.5])}, ".tsv") == "a\tb\n1\t\n2\t2.5\n"


@pytest.mark.parametrize("suffix", [".csv", ".tsv"])
def test_hard_doubles_read_back(suffix: str) -> None:
    lines = text({"a": np.array(HARD)}, suffix).splitlines()
    assert bits(map(float, lines[1:])) == bits(HARD)


@given(hnp.arrays(np.float64, st.integers(1, 50), elements=st.floats(allow_infinity=False)))
def test_every_double_reads_back_from_csv(values: np.ndarray) -> None:
    rows = list(csv.DictReader(io.StringIO(text({"n": np.arange(len(values)), "a": values}))))
    assert [row["a"] == "" for row in rows] == np.isnan(values).tolist()
    there = ~np.isnan(values)
    assert bits(float(row["a"]) for row in rows if row["a"]) == bits(values[there])


def test_shortest_is_no_longer_than_python_text() -> None:
    values = np.random.default_rng(1).integers(0, 2**64, 20_000, dtype=np.uint64).view(np.float64)
    values = values[np.isfinite(values)]
    lines = text({"a": values}).splitlines()[1:]
    assert bits(map(float, lines)) == bits(values)
    significant = [line.lower().partition("e")[0].replace(".", "").strip("-0") for line in lines]
    expected = [repr(float(value)).partition("e")[0].replace(".", "").strip("-0") for value in values]
    assert significant == expected


@pytest.mark.parametrize(
    ("value", "digits", "cell"),
    [
        (1 / 3, 5, "0.33333"),
        (2 / 3, "3", "0.667"),
        (3.0, 4, "3.0"),
        (-123456.0, 2, "-120000.0"),
        (1.7976931348623157e308, 3, "1.7976931348623157e+308"),
        (np.nan, 3, '""'),
    ],
)
def test_precision_is_digits_of_a_cell(value: float, digits: str | int, cell: str) -> None:
    assert text({"a": np.array([value])}, precision=digits).splitlines()[1:] == [cell.strip('"')]


@pytest.mark.parametrize("precision", ["0", "18", "-1", "short", "1.5", ""])
def test_precision_out_of_place(precision: str) -> None:
    with pytest.raises(UsageError, match=r"--precision .*1 to 17"):
        text({"a": np.zeros(1)}, precision=precision)


@given(hnp.arrays(np.float64, st.integers(1, 30), elements=st.floats(allow_infinity=False)), st.integers(1, 17))
def test_precision_is_pythons_rounding(values: np.ndarray, digits: int) -> None:
    lines = text({"n": np.arange(len(values)), "a": values}, precision=digits).splitlines()[1:]
    for value, line in zip(values, lines, strict=True):
        rounded = float(f"{value:.{digits - 1}e}")
        cell = line.partition(",")[2]
        assert cell == "" if np.isnan(value) else float(cell) == (rounded if np.isfinite(rounded) else value)


def test_parquet_reads_back_with_types(tmp_path: Path) -> None:
    with open(tmp_path / "t.parquet", "wb") as stream:
        write_table(stream, COLUMNS, ".parquet")
    frame = pl.read_parquet(tmp_path / "t.parquet")
    assert frame.to_dict(as_series=False) == {
        "vertex": [0, 1, 2],
        "K": [0.1, None, -0.0],
        "closed": [True, False, True],
        "welded_to": [7, None, 9],
        "status": ["boundary", None, "interior"],
    }
    assert frame["K"].is_nan().sum() == 0


def test_npz_without_pickle() -> None:
    stream = io.BytesIO()
    write_table(stream, COLUMNS, ".npz")
    stream.seek(0)
    with np.load(stream, allow_pickle=False) as table:
        np.testing.assert_array_equal(table["K"], [0.1, np.nan, -0.0])
        np.testing.assert_array_equal(table["welded_to"], [7, np.nan, 9])
        assert table["closed"].dtype == np.bool_
        assert table["status_names"][table["status"]].tolist() == ["boundary", "boundary", "interior"]
        assert table["status"].tolist() == [1, -1, 0]


def test_npz_refuses_to_blow_up_one_long_name() -> None:
    names = ("x" * 1_000_000, *map(str, range(1000)))
    with pytest.raises(OutputError, match="parquet"):
        write_table(io.BytesIO(), {"region": Labels(np.zeros(2, np.int32), names)}, ".npz")


@pytest.mark.parametrize("suffix", [".csv", ".tsv", ".parquet", ".npz"])
def test_equal_input_gives_equal_bytes(suffix: str) -> None:
    tables = [io.BytesIO(), io.BytesIO()]
    for stream in tables:
        write_table(stream, COLUMNS, suffix)
    assert tables[0].getvalue() == tables[1].getvalue()


def test_a_table_without_rows_has_its_header() -> None:
    assert text({"a": np.zeros(0), "s": Labels(np.zeros(0, np.int32), ())}) == "a,s\n"


def test_labels_without_a_name() -> None:
    assert text({"n": np.arange(2), "region": Labels(np.full(2, -1, np.int32), ())}) == "n,region\n0,\n1,\n"


@pytest.mark.parametrize("suffix", [".csv", ".tsv", ".parquet", ".npz"])
def test_a_pipe_gets_the_same_table(suffix: str, tmp_path: Path) -> None:
    program = (
        "import sys, numpy as np; from curvcli.output.tables.write import write_table\n"
        "columns = {'n': np.arange(100_000), 'a': np.linspace(0, 1, 100_000)}\n"
        "write_table(sys.stdout.buffer, columns, sys.argv[1])"
    )
    piped = subprocess.run([sys.executable, "-c", program, suffix], stdout=subprocess.PIPE, check=True).stdout
    with open(tmp_path / "file", "w+b") as file:
        subprocess.run([sys.executable, "-c", program, suffix], stdout=file, check=True)
    if suffix == ".npz":
        with np.load(io.BytesIO(piped)) as table:
            np.testing.assert_array_equal(table["a"], np.linspace(0, 1, 100_000))
    else:
        assert piped == (tmp_path / "file").read_bytes()


def test_names_are_quoted_and_utf8() -> None:
    labels = Labels(np.array([0, 1, 2], np.int32), ('a,"b"', "Flügel\n2", "a"))
    rows = list(csv.reader(io.StringIO(text({"region": labels}), newline="")))
    assert rows == [["region"], ['a,"b"'], ["Flügel\n2"], ["a"]]


def test_labels_may_share_a_name() -> None:
    assert text({"region": Labels(np.array([0, 1, -1], np.int32), ("a", "a")), "n": np.arange(3)}) == (
        "region,n\na,0\na,1\n,2\n"
    )


def test_strided_and_swapped_columns() -> None:
    xyz = np.arange(6.0).reshape(2, 3)
    assert text({"x": xyz[:, 1], "y": np.array([1.5, 2.5], ">f8")}) == "x,y\n1.0,1.5\n4.0,2.5\n"


@pytest.mark.parametrize("suffix", [".csv", ".parquet", ".npz"])
@pytest.mark.parametrize("failure", [BrokenPipeError(32, "gone"), OSError(28, "full"), KeyboardInterrupt()])
def test_a_failing_stream_is_told_as_it_failed(suffix: str, failure: BaseException) -> None:
    class Failing(io.RawIOBase):
        def writable(self) -> bool:
            return True

        def write(self, data: object) -> int:
            raise failure

    with pytest.raises(type(failure)) as raised:
        write_table(Failing(), {"a": np.zeros(10)}, suffix)  # type: ignore[arg-type]
    assert raised.value is failure

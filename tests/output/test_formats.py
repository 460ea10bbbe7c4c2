"""One list of formats, by suffix."""

from __future__ import annotations

import subprocess
import sys

import pytest

from curvcli.errors import UsageError
from curvcli.output.registry import format_of, output_formats, suffixes


@pytest.mark.parametrize("suffix", output_formats())
def test_every_format_is_found_by_path_and_by_name(suffix: str) -> None:
    assert format_of(f"folder.x/b.c{suffix.upper()}") is output_formats()[suffix]
    assert format_of("-", name=suffix[1:]) is format_of("b.txt", name=suffix) is output_formats()[suffix]


@pytest.mark.parametrize("path", ["b.xlsx", "b", "b.csv.gz", ".csv", "folder.csv/b"])
def test_an_unknown_suffix_is_answered_with_the_list(path: str) -> None:
    with pytest.raises(UsageError) as raised:
        format_of(path)
    assert str(raised.value).startswith(f"{path}: ")
    assert str(raised.value).endswith(" ".join(suffixes()))


def test_a_near_suffix_is_named() -> None:
    with pytest.raises(UsageError, match=r"nearest: \.parquet"):
        format_of("b.parqet")


def test_only_the_kinds_asked_for() -> None:
    with pytest.raises(UsageError, match=r"known: \.csv, \.tsv, \.parquet, \.npz, \.jsonl, \.tex$"):
        format_of("b.ply", kinds=["table"])


def test_a_stream_needs_a_name() -> None:
    with pytest.raises(UsageError, match="--format"):
        format_of("-")


def test_the_list_costs_no_imports() -> None:
    program = "import sys, curvcli.output.registry, curvcli.output.atomic; print(*{'numpy', 'polars'} & {*sys.modules})"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout == "\n"

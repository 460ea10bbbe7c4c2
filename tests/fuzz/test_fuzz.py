"""Thousands of damaged files, each read or refused as promised; the same ones in every run."""

from __future__ import annotations

import sys
import tracemalloc
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.fuzz.cases import Case, ends, mutated, noise, sound
from tests.fuzz.contract import Ran, arguments, in_process, kept
from tests.fuzz.corpus import FOLDER, load
from tests.fuzz.process import real

MEGABYTE = 1 << 20


def held(cases: st.SearchStrategy[Case], folder: Path, many: int, run: Any = in_process) -> Counter[str]:
    """Numbers of cases read and refused, all within the contract."""
    counts: Counter[str] = Counter()

    @settings(
        max_examples=many, deadline=20_000, derandomize=True, database=None, suppress_health_check=list(HealthCheck)
    )
    @given(case=cases)
    def one(case: Case) -> None:
        counts[kept(case, folder / "work", run)] += 1

    one()
    assert counts.total() >= many
    return counts


@pytest.mark.slow
@pytest.mark.parametrize("part", range(2))
def test_whole_files_are_read(tmp_path: Path, part: int) -> None:
    counts = held(sound().filter(lambda case: len(case.data) % 2 == part), tmp_path, 250)
    assert counts["read"] > 60


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "read"), [("obj", 40), ("ply", 15), ("stl", 30), ("strips", 5)])
def test_damaged_files_are_read_or_refused(tmp_path: Path, kind: str, read: int) -> None:
    counts = held(mutated(kind), tmp_path, 350)
    assert counts["read"] >= read
    assert counts["refused"] > 100


@pytest.mark.slow
def test_noise_is_read_or_refused(tmp_path: Path) -> None:
    counts = held(noise(), tmp_path, 250)
    assert counts["refused"] > 150


@pytest.mark.slow
def test_coordinates_at_the_ends_of_the_range(tmp_path: Path) -> None:
    counts = held(ends(), tmp_path, 120)
    assert counts["read"] > 60


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.case")), ids=lambda path: path.stem)
def test_what_once_broke_the_contract(tmp_path: Path, path: Path) -> None:
    assert kept(load(path), tmp_path / "work") in ("read", "refused")


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="memory of a process is told differently elsewhere")
@pytest.mark.parametrize("what", ["whole", "damaged"])
def test_real_processes_keep_the_contract(tmp_path: Path, what: str) -> None:
    kinds = st.one_of(*(mutated(kind) for kind in ("obj", "ply", "stl", "strips")), noise())
    counts = held(sound() if what == "whole" else kinds, tmp_path, 15, real)
    assert counts["read" if what == "whole" else "refused"] > 3


def test_memory_is_in_proportion(tmp_path: Path) -> None:
    """Nothing that a small file says makes curvcli ask for much memory."""
    kinds = [mutated(kind) for kind in ("obj", "ply", "stl", "strips")]
    in_process(
        arguments(Case("mesh.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", options=("-p", "all")), tmp_path / "work")
    )

    def measured(words: list[str]) -> Ran:
        size = Path(words[1]).stat().st_size
        tracemalloc.start()
        try:
            ran = in_process(words)
            _, peak = tracemalloc.get_traced_memory()
        finally:
            tracemalloc.stop()
        assert peak < 32 * MEGABYTE + 200 * size, (peak, size)
        return ran

    held(st.one_of(*kinds), tmp_path, 60, measured)

"""Work that is divided among threads gives what one thread gives, to the last bit."""

from __future__ import annotations

import numpy as np
import pytest

import curvcli
from curvcli.curvatures.catalogue import load_passes
from curvcli.samples import get
from curvcli.support.blocks import background_thread, for_each, map_pieces
from tests.helpers import meshes

NAMES = ("K_plus", "K_abs", "theta", "edge_H_vec", "beta", "willmore_conformal", "dir_1", "dir_2")


def test_threads_and_blocks_change_no_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    given = meshes.torus()
    load_passes()  # in their order, before a module is patched

    def found(threads: str, directions: int, edges: int) -> list[bytes]:
        monkeypatch.setenv("OMP_NUM_THREADS", threads)
        monkeypatch.setattr("curvcli.curvatures.absolute._DIRECTIONS", directions)
        for module in ("edges", "conformal"):
            monkeypatch.setattr(f"curvcli.curvatures.{module}.EDGES_PER_BLOCK", edges)
        analysis = curvcli.analyze(given.surface(), NAMES)
        return [analysis.column(name).tobytes() for name in NAMES]

    whole = found("1", 1 << 16, 1 << 15)
    for threads, directions, edges in (("2", 1 << 16, 1 << 15), ("1", 128, 50), ("2", 128, 50)):
        assert found(threads, directions, edges) == whole


def test_angles_worked_out_beside_the_rest_are_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    given = get("torus")(size=20_000, jitter=0.3)  # of three blocks of faces
    names = ("K", "A", "A_vec", "H_vec")

    def found(threads: str) -> list[bytes]:
        monkeypatch.setenv("OMP_NUM_THREADS", threads)
        analysis = curvcli.analyze((given.points, given.faces), names)
        return [analysis.column(name).tobytes() for name in names]

    assert found("2") == found("1")


@pytest.mark.parametrize("threads", ["1", "2"])
def test_a_failure_in_another_thread_is_raised_where_it_is_asked_for(
    threads: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", threads)

    def work() -> int:
        raise MemoryError

    with background_thread() as begun:
        result = begun(work)
        with pytest.raises(MemoryError):
            result()


@pytest.mark.parametrize("threads", ["1", "2"])
@pytest.mark.parametrize("failing", [0, 1, 99])
def test_a_failure_in_a_thread_is_raised(threads: str, failing: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", threads)

    def work(piece: int) -> None:
        if piece == failing:
            raise MemoryError

    with pytest.raises(MemoryError):
        for_each(range(100), work)


@pytest.mark.parametrize("threads", ["1", "2"])
def test_what_numpy_is_to_do_about_errors_holds_in_threads_too(threads: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", threads)
    huge = np.array([1e300])

    def square(piece: int) -> float:
        return float((huge * huge)[0])

    with np.errstate(over="ignore"):
        assert list(map_pieces(range(3), square)) == [np.inf] * 3
        with background_thread() as begun:
            assert begun(lambda: square(0))() == np.inf
    with np.errstate(over="raise"), pytest.raises(FloatingPointError):
        list(map_pieces(range(3), square))

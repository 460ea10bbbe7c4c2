"""`pytest benchmarks/test_passes.py`: what every registered pass costs; pytest-benchmark keeps and compares."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from pytest_benchmark.fixture import BenchmarkFixture

from benchmarks.meshes import make
from curvcli.curvatures.catalogue import load_passes, loaded
from curvcli.curvatures.engine import arguments, evaluate
from curvcli.curvatures.registry import passes
from curvcli.mesh.neighbourhoods import clear_cache
from curvcli.mesh.surface import Surface

Columns = dict[str, NDArray[Any]]

ROUNDS = 7

load_passes()


@pytest.fixture(scope="session")
def mesh(pytestconfig: pytest.Config) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    return make(*(pytestconfig.getoption(name) for name in ("shape", "size", "order")))


@pytest.fixture(scope="session")
def everything(mesh: tuple[NDArray[np.float64], NDArray[np.int64]]) -> tuple[Surface, Columns]:
    """The surface with its edges and topology, and all columns, so that every pass finds what it needs."""
    surface = Surface(*mesh)
    surface.compute_topology()
    return surface, evaluate(loaded(), surface, [quantity.name for quantity in passes.quantities(public=False)])


def test_topology(benchmark: BenchmarkFixture, mesh: tuple[NDArray[np.float64], NDArray[np.int64]]) -> None:
    benchmark.pedantic(lambda: Surface(*mesh).compute_topology(), rounds=ROUNDS, warmup_rounds=1)


@pytest.mark.parametrize("name", passes)
def test_pass(benchmark: BenchmarkFixture, everything: tuple[Surface, Columns], name: str) -> None:
    surface, columns = everything
    given = arguments(passes[name], surface, columns)
    # Neighbourhoods are kept from one pass to the next: here each pass makes its own.
    benchmark.pedantic(passes[name].compute, given, setup=lambda: clear_cache(surface), rounds=ROUNDS, warmup_rounds=1)

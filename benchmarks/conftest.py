"""Options of `pytest benchmarks`: the mesh on which passes are timed."""

from __future__ import annotations

from typing import get_args

import pytest

from benchmarks.meshes import Order, Shape


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("the mesh of the benchmarks")
    group.addoption("--size", type=int, default=100_000, help="Vertices, about. Default: 100000.")
    group.addoption("--shape", choices=get_args(Shape), default="sphere")
    group.addoption("--order", choices=get_args(Order), default="regular", help="Order of the vertices.")

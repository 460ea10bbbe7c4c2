"""Meshes and samples with everything computed."""

from __future__ import annotations

from functools import cache

import curvcli
from curvcli.api import Analysis
from tests.helpers.meshes import Mesh, of_sample


def analyse(given: Mesh) -> Analysis:
    return curvcli.analyze((given.points, given.faces), "all")


@cache
def sample(name: str, **parameters: float) -> Analysis:
    return analyse(of_sample(name, **parameters))


def total(result: Analysis, name: str) -> float:
    value = result.totals[name]
    assert isinstance(value, float)
    return value

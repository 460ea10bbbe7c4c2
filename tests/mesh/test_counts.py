"""Counts of groups that come and go."""

from __future__ import annotations

import gc
import inspect

import numpy as np

import curvcli
from curvcli.mesh.counts import count_groups
from curvcli.mesh.groups import Groups, by_label
from curvcli.mesh.surface import Surface
from curvcli.support.cache import cached
from tests.helpers import meshes
from tests.helpers.exact_values import MESHES


def test_groups_that_are_gone_are_not_mistaken_for_new_ones() -> None:
    """An object may get the number of one that was let go."""
    surface = meshes.two_bodies().surface()
    for count in range(1, 60):
        label = (np.arange(surface.n_faces) < count).astype(np.int32)
        found = count_groups(surface, by_label(surface, label, 2, "region"))
        assert found.faces.tolist() == [surface.n_faces - count, count]


def test_groups_answer_for_the_surface_that_is_asked_about() -> None:
    """Results of one surface are not reused for another."""
    torus, cube = meshes.zoo("torus").surface(), curvcli.load(MESHES["cube"])
    assert torus.whole.edges(torus).size == len(torus.edges)
    assert torus.whole.edges(cube).size == len(cube.edges) == 18
    assert torus.whole.edges(torus).size == len(torus.edges)
    assert count_groups(torus, torus.whole).edges.tolist() == [len(torus.edges)]
    assert count_groups(cube, torus.whole).edges.tolist() == count_groups(cube, cube.whole).edges.tolist()


def test_results_go_with_what_they_were_found_of() -> None:
    calls = []

    @cached
    def count(surface: Surface, groups: Groups) -> int:
        calls.append(surface.n_faces)
        return surface.n_faces

    def ask() -> None:
        one, other = (meshes.zoo(name).surface() for name in ("cap", "torus"))
        for surface in (one, other, one, other):
            assert count(surface, one.whole) == surface.n_faces
        assert count(one, other.whole) == one.n_faces

    gc.disable()
    try:
        ask()
        kept = inspect.getclosurevars(count).nonlocals["cache"]
        assert len(kept) == 0
    finally:
        gc.enable()
    assert len(calls) == 3

"""Counts of groups that come and go."""

from __future__ import annotations

import numpy as np

from curvcli.census import census
from curvcli.groups import by_label
from tests import meshes


def test_groups_that_are_gone_are_not_mistaken_for_new_ones() -> None:
    """An object may get the number of one that was let go."""
    surface = meshes.two_bodies().surface()
    for count in range(1, 60):
        label = (np.arange(surface.n_faces) < count).astype(np.int32)
        found = census(surface, by_label(surface, label, 2, "region"))
        assert found.faces.tolist() == [surface.n_faces - count, count]

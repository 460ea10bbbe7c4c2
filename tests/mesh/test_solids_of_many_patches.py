"""Solids of many patches take time in proportion to their number."""

from __future__ import annotations

import time

import numpy as np
import pytest

from tests.helpers import meshes, nests
from tests.helpers.meshes import Mesh
from tests.helpers.nests import box, together
from tests.mesh.test_solids import BALL, OCTAHEDRON


def lattice(part: Mesh, count: int, size: float) -> Mesh:
    """Many copies of a part, apart from one another, as one mesh."""
    side = round(count ** (1 / 3))
    grid = np.stack(np.meshgrid(*[np.linspace(-0.5, 0.5, side)] * 3), axis=-1).reshape(-1, 1, 3)
    points = (part.points * (size / side) + grid).reshape(-1, 3)
    faces = part.faces + (np.arange(side**3) * len(part.points))[:, None, None]
    return Mesh(points, faces.reshape(-1, 3).astype(np.int32))


@pytest.mark.parametrize("around", [None, BALL, meshes.of_sample("icosphere", size=10000)])
def test_many_patches_take_little_time(around: Mesh | None) -> None:
    """Ten thousand bodies, and as many bubbles in a ball: not a hundred million pairs of them."""
    many = lattice(OCTAHEDRON, 22**3, 0.4)
    parts = [many] if around is None else [around, many]
    surface = together(parts)[0].surface()
    assert surface.orientation.patch.max() >= 22**3 - 1
    begun = time.process_time()
    depth = surface.solids.depth
    assert not len(surface.solids.crossing)
    assert depth.sum() == (0 if around is None else 22**3)
    assert time.process_time() - begun < 30


def test_a_bed_of_touching_bodies_takes_little_time() -> None:
    """Walls are no contact that has to be looked at, and large ones are looked at in places."""
    cells = [box([i, j, k], [i + 1, j + 1, k + 1]) for i in range(10) for j in range(10) for k in range(10)]
    fine = nests.block(30)
    for parts in (cells, [fine, fine.moved(fine.points @ np.diag([-1.0, 1, 1]) + [2, 0, 0])]):
        made, _ = together(parts)
        begun = time.process_time()
        solids = made.surface().solids
        assert not solids.depth.any()
        assert not len(solids.crossing)
        assert time.process_time() - begun < 20

"""Assembled surfaces: a block with two holes, and two surfaces in one file."""

from __future__ import annotations

import math

import numpy as np

from .catalogue import sample
from .facts import orientable
from .model import FloatArray, IntArray, Sample, demand_positive
from .spheres import icosphere
from .tubes import torus


@sample(
    summary="a block with two square holes: a closed surface of genus 2",
    exact="K = pi/2 at the 8 outer corners, -pi/2 at the 16 of the holes, 0 elsewhere; exact area, volume and H_theta.",
)
def genus_2(*, size: int = 1250, edge: float = 1.0) -> Sample:
    """5 x 3 x 1 cubes of the given edge without two of them, each square of the boundary cut into n x n."""
    demand_positive(size=size, edge=edge)
    cut = max(1, round(math.sqrt(size / 50)))
    solid = np.ones((5, 3, 1), bool)
    solid[[1, 3], 1] = False
    lattice, faces = boundary(solid.repeat(cut, 0).repeat(cut, 1).repeat(cut, 2))
    x, y, z = lattice.T
    flat = np.isin(z, [0, cut])
    outer = flat & np.isin(x, [0, 5 * cut]) & np.isin(y, [0, 3 * cut])
    hole = flat & np.isin(x, [cut, 2 * cut, 3 * cut, 4 * cut]) & np.isin(y, [cut, 2 * cut])
    defect = (outer.astype(np.float64) - hole) * (math.pi / 2)
    # Convex edges: 36 of the block and 16 of the rims of the holes; hollow ones: 8 upright in the holes.
    facts = orientable(
        genus=2, convex=False, area=50 * edge**2, volume=13 * edge**3, H_theta=(36 + 16 - 8) * edge * math.pi / 2
    )
    return Sample(lattice * (edge / cut), faces, {"K": defect}, facts)


def boundary(solid: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]) -> tuple[FloatArray, IntArray]:
    """Lattice points and outward triangles of the boundary of a set of unit cubes, given as a grid of booleans."""
    padded = np.pad(solid, 1).astype(np.int8)
    quads = []
    for axis in range(3):
        step = np.diff(padded, axis=axis)
        right, up = np.eye(3, dtype=np.int64)[[(axis + 1) % 3, (axis + 2) % 3]]
        shift = np.eye(3, dtype=np.int64)[axis]
        for sign, first, second in ((-1, right, up), (1, up, right)):
            corner = np.argwhere(step == sign) + shift
            quads.append(np.stack([corner, corner + first, corner + first + second, corner + second], axis=1))
    squares = np.concatenate(quads)
    wide = np.array(padded.shape) + 1
    keys = np.ravel_multi_index(tuple(squares.reshape(-1, 3).T), tuple(wide))
    unique, number = np.unique(keys, return_inverse=True)
    numbers = number.reshape(-1, 4)
    lattice = np.stack(np.unravel_index(unique, tuple(wide)), axis=1) - 1
    return lattice.astype(np.float64), numbers[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3).astype(np.int32)


@sample(
    summary="a sphere inside the hole of a torus: two components",
    exact="The exact curvatures of both; chi = 2 + 0, total curvature 4 pi.",
)
def two_components(*, size: int = 1500, radius: float = 1.0, tube: float = 0.3) -> Sample:
    """A third of the vertices on the sphere, whose radius is half the width of the hole."""
    outer: Sample = torus.function(size=2 * size // 3, radius=radius, tube=tube)
    inner: Sample = icosphere.function(size=size // 3, radius=(radius - tube) / 2)
    return Sample(
        np.concatenate([inner.points, outer.points]),
        np.concatenate([inner.faces, outer.faces + np.int32(len(inner.points))]),
        {name: np.concatenate([inner.exact[name], outer.exact[name]]) for name in inner.exact},
        orientable(genus=1, components=2, convex=False),
        {name: inner.limit[name] + outer.limit[name] for name in inner.limit},
    )

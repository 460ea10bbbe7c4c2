"""Cells of vertices for pictures of creased meshes: each keeps its colour to its own surroundings."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..support.arrays import Floats

Colors = NDArray[np.uint8]

# Larger meshes are drawn without cells, which would be smaller than a pixel.
MOST_FACES = 400_000


class Cells(NamedTuple):
    """Triangles with corners of their own: positions (n, 3), faces (m, 3), colors (n, 3)."""

    positions: Floats
    faces: NDArray[np.int32]
    colors: Colors


def own_cells(positions: Floats, faces: NDArray[np.int32], colors: Colors, between: tuple[int, int, int]) -> Cells:
    """Corners of faces in the colour of their vertex, up to half the shortest edge there; the rest in another colour.

    A density of a creased mesh belongs to its edges and corners; between them the faces are flat, however large.
    """
    corner = positions[faces]
    ahead = corner[:, [1, 2, 0]]
    length = np.sqrt(((ahead - corner) ** 2).sum(axis=2))
    reach = np.full(len(positions), np.inf)
    for tail, head in ((0, 1), (1, 2), (2, 0)):
        np.minimum.at(reach, faces[:, tail], length[:, tail])
        np.minimum.at(reach, faces[:, head], length[:, tail])
    reach = 0.5 * reach[faces]
    with np.errstate(divide="ignore", invalid="ignore"):
        out = np.nan_to_num(np.minimum(reach / length, 0.5))[..., None]
        back = np.nan_to_num(np.minimum(reach[:, [1, 2, 0]] / length, 0.5))[..., None]
    # Points on each edge: the end of the cell of its tail and the beginning of that of its head.
    leave, enter = corner + out * (ahead - corner), ahead + back * (corner - ahead)
    tips = np.stack([corner, leave, enter[:, [2, 0, 1]]], axis=2)
    rim = np.stack([leave, enter], axis=2).reshape(-1, 6, 3)
    inner = rim[:, [0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5]].reshape(-1, 4, 3, 3)
    points = np.concatenate([tips.reshape(-1, 3), inner.reshape(-1, 3)])
    tinted = np.repeat(colors[faces].reshape(-1, 3), 3, axis=0)
    rest = np.broadcast_to(np.array(between, np.uint8), (len(points) - len(tinted), 3))
    triangles = np.arange(len(points), dtype=np.int32).reshape(-1, 3)
    return Cells(points, triangles, np.concatenate([tinted, rest]))

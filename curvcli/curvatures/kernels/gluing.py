"""Gluing of faces along their sides into coherently wound pieces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...mesh.orientation import same_direction
from ...support.arrays import Index, Mask

if TYPE_CHECKING:
    from ...mesh.surface import Surface


@dataclass(frozen=True)
class Gluing:
    """Coherently wound faces and the pairing of their sides.

    tail: (3F,) vertex at the tail of each side; side 3 f + k runs from corner k to corner k + 1 of face f.
    half_edge, twin: both sides of each edge with n_e = 2, running opposite ways. single: sides of the other edges.
    twofold: (F,) mask of the faces of patches replaced by their orientable double cover, each original face twice;
    None without such patches.
    """

    tail: Index
    half_edge: Index
    twin: Index
    single: Index
    twofold: Mask | None


def glue(surface: Surface) -> Gluing:
    """Wind faces by the surface's orientation; a non-orientable patch is replaced by its double cover.

    Intrinsic quantities lift to the cover and are counted twice there, so one-sided patches need no other rule.
    """
    edges, faces = surface.edges, surface.faces
    half_edge, twin = edges.pairs
    single = edges.half_edges(edges.unpaired)
    orientation = surface.orientation
    if orientation.face_sign is None and surface.orientable:
        return Gluing(faces.flatten(), half_edge, twin, single, None)
    n = len(faces)
    turned = np.zeros(n, bool) if orientation.face_sign is None else orientation.face_sign < 0
    covered = ~orientation.orientable[orientation.patch]
    copied = np.flatnonzero(covered)
    copy = np.arange(n)
    copy[copied] = n + np.arange(len(copied))
    crossing = same_direction(faces, half_edge, twin)
    turned = np.append(turned, np.ones(len(copied), bool))
    corners = np.concatenate([faces, faces[copied]])
    corners[turned] = corners[turned][:, [0, 2, 1]]

    def sides(half_edge: Index, upper: Mask) -> Index:
        """The side of a half-edge in the file's own faces or in their copies."""
        face, k = half_edge // 3, half_edge % 3
        face = np.where(upper, copy[face], face)
        return np.asarray(3 * face + np.where(turned[face], 2 - k, k), np.int32)

    def both(half_edge: Index, upper: Mask) -> Index:
        """Sides on the lower sheet, then those of covered patches on the upper one."""
        again = covered[half_edge // 3]
        return np.concatenate([sides(half_edge, upper), sides(half_edge[again], ~upper[again])])

    below = np.zeros(len(half_edge), bool)
    return Gluing(
        corners.ravel(),
        both(half_edge, below),
        both(twin, crossing & covered[twin // 3]),
        both(single, np.zeros(len(single), bool)),
        np.append(covered, np.ones(len(copied), bool)) if len(copied) else None,
    )

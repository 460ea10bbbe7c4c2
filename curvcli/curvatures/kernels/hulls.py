"""Normal cones of hulls of stars by incremental insertion of directions in any position.

The extreme directions are determined exactly, also for thin stars: linear maps do not change them, so axes and
directions are scaled to one size, and exact signs decide where floating point cannot. Only the angles between extreme
directions are rounded. The cost is n d (d + extreme directions) for d directions at n apices.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...mesh.exact_signs import exact_sides, sides
from ...mesh.triangles import cross, dot
from ...support.arrays import Floats, Mask

# Factors beyond this power of two are applied in steps.
_LARGEST_POWER = 1000
# Initial number of rows, and number of spare rows after packing.
_ROOM, _SPARE = 24, 16

Positions = NDArray[np.intp]


def hull_cone_areas(directions: Floats) -> Floats:
    """(n,) solid angle of the normal cone of the cone that directions (3, d, n) span, as `normal_cone_areas` has it.

    The rounding error is that of d angles: the solid angle changes by at most twice the change of the directions.
    """
    directions = _of_one_size(directions)
    if directions.shape[1] < 3:
        return 2 * np.pi - 2 * _angles(directions[:, 0], directions[:, -1])
    cone, at, to = _extreme(_round(directions))
    turns = _angles(directions[:, at, cone], directions[:, to, cone])
    count = directions.shape[2]
    area = np.where(np.bincount(cone, minlength=count) > 0, 2 * np.pi, 0.0) - np.bincount(cone, turns, minlength=count)
    return np.maximum(area, 0.0)


def _angles(u: Floats, v: Floats) -> Floats:
    normal = cross(u, v)
    angle: Floats = np.arctan2(np.sqrt(dot(normal, normal)), dot(u, v))
    return angle


def _of_one_size(directions: Floats) -> Floats:
    """The directions times powers of two, the largest component of each from ½ to 1 in size."""
    for _ in range(2):
        x, y, z = np.abs(directions)
        size = np.maximum(np.maximum(x, y), z)
        directions = directions * _powers(size)
        if size.min() > 2.0**-_LARGEST_POWER:
            break
    return directions


def _round(directions: Floats) -> Floats:
    """Scale the axes of directions of one size so that all axes have equal extent; returns directions of one size."""
    for _ in range(2):
        directions = _of_one_size(directions * _powers(np.abs(directions).max(axis=1))[:, None])
    return directions


def _powers(size: Floats) -> Floats:
    """Powers of two that scale sizes to [½, 1], 1 for 0."""
    exponent = np.clip(np.frexp(size)[1], -_LARGEST_POWER, _LARGEST_POWER)
    factor: Floats = np.ldexp(1.0, -exponent)
    return factor


@dataclass
class _Hulls:
    """Hulls of the first k directions of some cones, one row per facet, indexed by the direction at its start.

    cones: (m,) index of each cone. who: (r, m) the direction of each row. following: (r, m) the row of the next extreme
    direction counterclockwise, -1 in an empty row. normal: (3, r, m) of the facet.
    """

    directions: Floats
    cones: Positions
    who: Positions
    following: Positions
    normal: Floats

    def keep(self, kept: Positions) -> None:
        """Keep some of the cones."""
        self.directions, self.normal = self.directions[:, :, kept], self.normal[:, :, kept]
        self.cones, self.who, self.following = self.cones[kept], self.who[:, kept], self.following[:, kept]

    def pack(self, rows: int) -> None:
        """Remove empty rows and add spare ones. rows: number of rows in use."""
        used = self.following[:rows] >= 0
        most = int(used.sum(axis=0).max())
        order = (~used).argsort(axis=0, kind="stable")[:most]
        place = used.cumsum(axis=0) - 1
        old = np.take_along_axis(self.following, order, axis=0)
        new = np.where(old >= 0, np.take_along_axis(place, np.maximum(old, 0), axis=0), -1)
        size = 2 * most + _SPARE
        who, following = np.zeros((size, len(self.cones)), np.intp), np.full((size, len(self.cones)), -1)
        normal = np.zeros((3, *who.shape))
        who[:most], following[:most] = np.take_along_axis(self.who, order, axis=0), new
        normal[:, :most] = np.take_along_axis(self.normal, order[None], axis=1)
        self.who, self.following, self.normal = who, following, normal

    def facet(self, row: Positions | int, to: Positions, cones: Positions) -> None:
        """Set facets from a row to another row."""
        self.following[row, cones] = to
        a, b = (self.directions[:, self.who[end, cones], cones] for end in (row, to))
        self.normal[:, row, cones] = cross(a, b)

    def seen(self, k: int, rows: int) -> Mask:
        """(rows, m) mask of the facets with direction k on their outer side."""
        used = self.following[:rows] >= 0
        side = sides(self.normal[:, :rows], self.directions[:, k])
        at, cone = np.nonzero(used & (side == 0))
        if len(at):
            a, b = self.who[at, cone], self.who[self.following[at, cone], cone]
            first, second = (self.directions[:, end, cone] for end in (np.minimum(a, b), np.maximum(a, b)))
            signs = exact_sides(first, second, self.directions[:, k, cone])
            side[at, cone] = np.where(a < b, signs, -signs)
        return used & (side < 0)

    def insert(self, k: int, row: int, seen: Mask) -> None:
        """Replace the facets that direction k sees, if any, by two facets at a new row."""
        self.who[row] = k
        cones = np.flatnonzero(seen.any(axis=0))
        if not len(cones):
            return
        seen = seen[:, cones]
        arriving = np.zeros_like(seen)
        at, which = np.nonzero(seen)
        arriving[self.following[at, cones[which]], which] = True
        first, last = (seen & ~arriving).argmax(axis=0), (arriving & ~seen).argmax(axis=0)
        at, which = np.nonzero(seen & arriving)
        self.following[at, cones[which]] = -1
        self.facet(first, np.full(len(cones), row), cones)
        self.facet(row, last, cones)


def _extreme(directions: Floats) -> tuple[Positions, Positions, Positions]:
    """The extreme directions of the pointed ones of n cones: each one's cone, itself, and the next counterclockwise.

    The hull of three directions has three facets. A further direction replaces the facets that it sees, which are
    neighbours; if it sees all of them, the cone is all of space.
    """
    d, n = directions.shape[1:]
    rows, room = 3, min(d, _ROOM)
    who, following = np.zeros((room, n), np.intp), np.full((room, n), -1)
    who[:3] = np.arange(3)[:, None]
    hulls = _Hulls(directions, np.arange(n), who, following, np.zeros((3, room, n)))
    forward = _first_turn(directions[:, 0], directions[:, 1], directions[:, 2])
    for row in range(3):
        hulls.facet(row, np.where(forward, (row + 1) % 3, (row + 2) % 3), hulls.cones)
    for k in range(3, d):
        if rows == len(hulls.who):
            hulls.pack(rows)
            rows = int((hulls.following >= 0).sum(axis=0).max())
        seen = hulls.seen(k, rows)
        alive = (seen != (hulls.following[:rows] >= 0)).any(axis=0)
        if not alive.all():
            kept = np.flatnonzero(alive)
            hulls.keep(kept)
            if not len(kept):
                break
            seen = seen[:, kept]
        hulls.insert(k, rows, seen)
        rows += 1
    at, cone = np.nonzero(hulls.following >= 0)
    return hulls.cones[cone], hulls.who[at, cone], hulls.who[hulls.following[at, cone], cone]


def _first_turn(first: Floats, second: Floats, third: Floats) -> Mask:
    """Test whether the first three directions are in counterclockwise order."""
    side = sides(cross(first, second), third)
    doubt = np.flatnonzero(side == 0)
    side[doubt] = exact_sides(first[:, doubt], second[:, doubt], third[:, doubt])
    return side > 0

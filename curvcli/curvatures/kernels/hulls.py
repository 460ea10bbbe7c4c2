"""Normal cones of the hulls of stars by inserting direction after direction, for directions in any position.

Which directions are extreme is decided exactly, however thin the star is: linear maps do not change it, so axes and
directions are brought to one size, and what floating point leaves in doubt is left to exact signs. Only the angles
between the extreme directions are rounded. The cost is n d (d + extreme directions) for d directions at n apices.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...mesh.signs import exact_sides, sides
from ...mesh.topology import Mask
from ...mesh.triangles import Floats, cross, dot

# Factors beyond this power of two are applied in steps.
_LARGEST_POWER = 1000
# Rows to begin with, and rows to spare when they are packed.
_ROOM, _SPARE = 24, 16

Places = NDArray[np.intp]


def hull_cone_areas(directions: Floats) -> Floats:
    """(n,) solid angle of the normal cone of the cone that directions (3, d, n) span, as `normal_cone_areas` has it.

    Errors of the result are those of d angles: the solid angle moves by no more than twice as much as directions do.
    """
    directions = _of_one_size(directions)
    if directions.shape[1] < 3:
        return 2 * np.pi - 2 * _angles(directions[:, 0], directions[:, -1])
    cone, at, to = _extreme(_round(directions))
    turns = _angles(directions[:, at, cone], directions[:, to, cone])
    count = directions.shape[2]
    area = np.where(np.bincount(cone, minlength=count) > 0, 2 * np.pi, 0.0) - np.bincount(cone, turns, minlength=count)
    return np.maximum(area, 0.0)


def _angles(one: Floats, other: Floats) -> Floats:
    normal = cross(one, other)
    angle: Floats = np.arctan2(np.sqrt(dot(normal, normal)), dot(one, other))
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
    """The images of directions of one size under the scaling of axes that makes all of them as wide, at one size."""
    for _ in range(2):
        directions = _of_one_size(directions * _powers(np.abs(directions).max(axis=1))[:, None])
    return directions


def _powers(size: Floats) -> Floats:
    """Powers of two that bring sizes to between ½ and 1, 1 for 0."""
    exponent = np.clip(np.frexp(size)[1], -_LARGEST_POWER, _LARGEST_POWER)
    factor: Floats = np.ldexp(1.0, -exponent)
    return factor


@dataclass
class _Hulls:
    """The hulls of the first k directions of some cones, a row for each facet, by the direction where it begins.

    cones: (m,) which of all cones they belong to. who: (r, m) the direction of each row. following: (r, m) the row of
    the next extreme direction counterclockwise, -1 where the row holds none. normal: (3, r, m) of the facet.
    """

    directions: Floats
    cones: Places
    who: Places
    following: Places
    normal: Floats

    def keep(self, kept: Places) -> None:
        """Some of the cones."""
        self.directions, self.normal = self.directions[:, :, kept], self.normal[:, :, kept]
        self.cones, self.who, self.following = self.cones[kept], self.who[:, kept], self.following[:, kept]

    def pack(self, rows: int) -> None:
        """Room for the next directions in the place of rows that hold none; so many are filled so far."""
        here = self.following[:rows] >= 0
        most = int(here.sum(axis=0).max())
        order = (~here).argsort(axis=0, kind="stable")[:most]
        place = here.cumsum(axis=0) - 1
        old = np.take_along_axis(self.following, order, axis=0)
        new = np.where(old >= 0, np.take_along_axis(place, np.maximum(old, 0), axis=0), -1)
        size = 2 * most + _SPARE
        who, following = np.zeros((size, len(self.cones)), np.intp), np.full((size, len(self.cones)), -1)
        normal = np.zeros((3, *who.shape))
        who[:most], following[:most] = np.take_along_axis(self.who, order, axis=0), new
        normal[:, :most] = np.take_along_axis(self.normal, order[None], axis=1)
        self.who, self.following, self.normal = who, following, normal

    def facet(self, row: Places | int, to: Places, cones: Places) -> None:
        """Let facets begin at a row and end at another one."""
        self.following[row, cones] = to
        a, b = (self.directions[:, self.who[end, cones], cones] for end in (row, to))
        self.normal[:, row, cones] = cross(a, b)

    def seen(self, k: int, rows: int) -> Mask:
        """(rows, m) the facets on whose outer side direction k is."""
        here = self.following[:rows] >= 0
        side = sides(self.normal[:, :rows], self.directions[:, k])
        at, cone = np.nonzero(here & (side == 0))
        if len(at):
            a, b = self.who[at, cone], self.who[self.following[at, cone], cone]
            first, second = (self.directions[:, end, cone] for end in (np.minimum(a, b), np.maximum(a, b)))
            found = exact_sides(first, second, self.directions[:, k, cone])
            side[at, cone] = np.where(a < b, found, -found)
        return here & (side < 0)

    def insert(self, k: int, row: int, seen: Mask) -> None:
        """Put direction k, at a new row, in the place of the facets that it sees, where it sees any."""
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


def _extreme(directions: Floats) -> tuple[Places, Places, Places]:
    """The extreme directions of the pointed ones of n cones: each one's cone, itself, and the next counterclockwise.

    The hull of three directions is a cone of three facets. A further one takes the place of the facets that it sees,
    which are neighbours; if it sees all of them, the cone is all of space.
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


def _first_turn(one: Floats, two: Floats, three: Floats) -> Mask:
    """Whether the first three directions follow each other counterclockwise."""
    side = sides(cross(one, two), three)
    doubt = np.flatnonzero(side == 0)
    side[doubt] = exact_sides(one[:, doubt], two[:, doubt], three[:, doubt])
    return side > 0

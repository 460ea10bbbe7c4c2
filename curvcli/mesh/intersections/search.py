"""Search for pairs of faces in contact: a tree of boxes proposes them, exact predicates decide."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...support.arrays import Floats, Ints, Mask, Sign
from ...support.blocks import map_pieces
from ...support.cache import cached
from ..counts import duplicate_vertices
from ..solids.boxes import BoxTree
from ..surface import Surface
from ..welding import weld_exact
from .contact_points import contact_points, corners_of
from .pairs import APART, contacts
from .predicates import orient2d


class FaceContacts(NamedTuple):
    """Pairs of faces in contact beyond the corners and the edge that they share, sorted by face.

    one, other: (n,) faces, one < other. kind: (n,) index into `pairs.KINDS`.
    """

    one: Ints
    other: Ints
    kind: Sign

    def points(self, surface: Surface) -> Floats:
        """(n, 3) a point of contact of each pair, in the unit of the file."""
        positions = contact_points(*(corners_of(surface.xyz, surface.faces[faces]) for faces in (self.one, self.other)))
        return surface.in_file_unit(positions, 1).T

    def first_of(self, kind: int, most: int) -> FaceContacts:
        """The first contacts of a kind."""
        rows = np.flatnonzero(self.kind == kind)[:most]
        return FaceContacts(self.one[rows], self.other[rows], self.kind[rows])


@cached
def face_contacts(surface: Surface) -> FaceContacts:
    """Pairs of faces that cross, overlap, fold over or touch, each once.

    Corners at one position count as one, so that seams are no contacts. Faces without area and pairs of faces with the
    same corners are left out: the counts of degenerate and of duplicate faces have them.
    Time and memory: O(F log F + pairs of boxes that meet).
    """
    corners = _corners(surface)
    low, high = np.empty((3, surface.n_faces)), np.empty((3, surface.n_faces))
    for axis, x in enumerate(surface.xyz):
        a, b, c = (x.take(corner) for corner in corners)
        np.minimum(np.minimum(a, b), c, out=low[axis])
        np.maximum(np.maximum(a, b), c, out=high[axis])
    whole, nothing = np.zeros(1, np.int64), np.zeros(0, np.int64)
    tree = BoxTree(low, high, np.zeros(surface.n_faces, np.int64), 1)

    def decide(candidates: tuple[Ints, Ints, Ints]) -> FaceContacts:
        return _decide(surface.xyz, corners, candidates[1], candidates[2])

    decided = [FaceContacts(nothing, nothing, nothing.astype(np.int8)), *map_pieces(tree.meeting(whole, whole), decide)]
    face, other, kind = (np.concatenate(part) for part in zip(*decided, strict=True))
    face, other = np.minimum(face, other), np.maximum(face, other)
    order = np.lexsort((other, face))
    return FaceContacts(face[order], other[order], kind[order])


def _corners(surface: Surface) -> NDArray[np.intp]:
    """(3, F) corners; vertices at one position have the number of the first."""
    faces = surface.faces.T
    duplicates = duplicate_vertices(surface)
    if len(duplicates):
        first, into = weld_exact(surface.xyz_given)
        faces = first[into][faces]
    return np.ascontiguousarray(faces, np.intp)


def _decide(xyz: Floats, corners: NDArray[np.intp], face: Ints, other: Ints) -> FaceContacts:
    """The contacts among some pairs of faces."""
    ends, others = corners.take(face, axis=1), corners.take(other, axis=1)
    code = np.zeros(len(face), np.intp)
    for bit, (a, b) in enumerate((a, b) for a in ends for b in others):
        code |= (a == b).view(np.int8).astype(np.intp) << bit
    shared = _SHARED.take(code)
    kind = np.full(len(face), APART, np.int8)
    for number in range(3):
        rows = np.flatnonzero(shared == number)
        if len(rows):
            p, q = _gather(xyz, ends, others, code.take(rows), rows)
            kind[rows] = contacts(p, q, number)
    meet = np.flatnonzero(kind != APART)
    if len(meet):
        p, q = _gather(xyz, ends, others, code.take(meet), meet)
        meet = meet[_have_area(p) & _have_area(q)]
    return FaceContacts(face[meet], other[meet], kind[meet])


def _gather(
    xyz: Floats, ends: NDArray[np.intp], others: NDArray[np.intp], code: NDArray[np.intp], rows: NDArray[np.intp]
) -> tuple[Floats, Floats]:
    """(3, 3, n) corners of the two faces of some pairs, the shared ones first: corner, coordinate, pair."""
    first, second = (
        each.ravel().take(order.take(code, axis=1) * each.shape[1] + rows)
        for each, order in ((ends, _ORDERS[0]), (others, _ORDERS[1]))
    )
    return xyz.take(first, axis=1).swapaxes(0, 1), xyz.take(second, axis=1).swapaxes(0, 1)


def _orders() -> tuple[Ints, Ints, Ints]:
    """By the nine bits of equal pairs of corners: the number of shared corners, and for each of the two faces
    (3, 512) its corners, the shared ones first, in the order of the first face."""
    shared, orders = np.zeros(512, np.int64), np.zeros((2, 3, 512), np.int64)
    for code in range(512):
        pairs = [(bit // 3, bit % 3) for bit in range(9) if code >> bit & 1]
        shared[code] = len(pairs)
        for face in (0, 1):
            first = [pair[face] for pair in pairs][:3]
            orders[face, :, code] = [*first, *(k for k in range(3) if k not in first)][:3]
    return shared, orders[0], orders[1]


_SHARED, *_ORDERS = _orders()


def _have_area(corners: Floats) -> Mask:
    """(n,) flags: the corners are not collinear, exactly."""
    planes = (corners[:, [axis, (axis + 1) % 3]] for axis in range(3))
    area: Mask = np.logical_or.reduce([orient2d(plane[0], plane[1], plane[2]) != 0 for plane in planes])
    return area

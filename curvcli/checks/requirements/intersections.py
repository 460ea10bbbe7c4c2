"""Requirements of embedding: no two faces cross, overlap, fold over or touch."""

from __future__ import annotations

import numpy as np

from ...mesh.intersections.pairs import CROSSING, FOLDED, OVERLAPPING, TOUCHING
from ...mesh.intersections.search import FaceContacts, face_contacts
from ...mesh.surface import Surface
from ...support.words import counted, format_point
from .base import requirement
from .faults import Fault, FaultyElements
from .wording import join_problems

# Pairs named with their place.
_FIRST = 3


@requirement(
    "no-self-intersections",
    remedy="`--table intersections=PATH` of `curvcli analyze` lists the pairs; unite or part the bodies there, and "
    "remesh faces that fold over",
    after="no-duplicate-vertices",
)
def no_self_intersections(surface: Surface) -> str:
    """No two faces cross, overlap in one plane or fold over, decided exactly; faces that only touch may stay."""
    contacts = face_contacts(surface)
    return join_problems(
        _listed(surface, contacts, CROSSING, "pair of faces crosses", "pairs of faces cross"),
        _listed(
            surface, contacts, OVERLAPPING, "pair of faces overlaps in its plane", "pairs of faces overlap in a plane"
        ),
        _listed(surface, contacts, FOLDED, "pair of neighbours is folded over", "pairs of neighbours are folded over"),
    )


@requirement(
    "no-self-contacts",
    remedy="`--table intersections=PATH` of `curvcli analyze` lists the pairs; move them apart, or give the faces "
    "common corners",
    after="no-self-intersections",
)
def no_self_contacts(surface: Surface) -> str:
    """No two faces meet outside the corners and edges that they share: the surface is embedded."""
    return join_problems(
        no_self_intersections(surface),
        _listed(surface, face_contacts(surface), TOUCHING, "pair of faces touches", "pairs of faces touch"),
    )


def _listed(surface: Surface, contacts: FaceContacts, kind: int, singular: str, plural: str) -> str:
    """Number of pairs of a kind of contact, and the first ones with a point of contact; empty for none."""
    rows = contacts.kind == kind
    count = int(np.count_nonzero(rows))
    if not count:
        return ""
    first = contacts.first_of(kind, _FIRST)
    names = (FaultyElements("face", faces).names(surface) for faces in (first.one, first.other))
    pairs = [
        f"{face} and {other} at {format_point(point)}"
        for face, other, point in zip(*names, first.points(surface), strict=True)
    ]
    more = [] if count == len(pairs) else ["…"]
    faces = np.unique(np.concatenate([contacts.one[rows], contacts.other[rows]]))
    return Fault(f"{counted(count, singular, plural)} ({'; '.join([*pairs, *more])})", FaultyElements("face", faces))

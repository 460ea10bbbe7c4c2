"""Requirements of soundness: no degenerate or duplicate faces, no unreferenced or duplicate vertices."""

from __future__ import annotations

import numpy as np

from ...mesh.counts import duplicate_faces, duplicate_vertices
from ...mesh.surface import Surface
from ...mesh.walls import describe_walls
from ...support.arrays import Flags
from ...support.words import counted
from .base import requirement
from .wording import faces, join_problems, located, vertices, with_explanation

# Notices of faces that the reader or the surface dropped; later counts do not include them.
_DROPPED = {"repeated_corner_faces": "with a repeated corner", "short_faces": "with fewer than three corners"}


@requirement(
    "no-degenerate",
    default=True,
    remedy="`--weld exact` drops faces with two corners at one place; remesh the others",
    after="cmc",
)
def no_degenerate(surface: Surface, degenerate_face: Flags) -> str:
    """Every face has an area, and none had to be dropped."""
    dropped = [
        located(notice.count, f"face {what}", f"faces {what}", f"face {notice.examples[0]}")
        if notice.examples
        else counted(notice.count, f"face {what}", f"faces {what}")
        for notice in surface.notices
        if (what := _DROPPED.get(notice.code))
    ]
    return join_problems(faces(surface, np.flatnonzero(degenerate_face), "without area"), *dropped)


@requirement(
    "no-duplicate-faces",
    default=True,
    remedy="remove the later of each two: both add to areas and angles",
    after="no-degenerate",
)
def no_duplicate_faces(surface: Surface) -> str:
    """No two faces have the same corners."""
    result = faces(surface, duplicate_faces(surface), "with the corners of an earlier one")
    return with_explanation(result, describe_walls(surface))


@requirement("no-unreferenced", remedy="remove them from the file; they change no value", after="no-duplicate-faces")
def no_unreferenced(surface: Surface) -> str:
    """Every vertex belongs to a face."""
    loose = ~surface.referenced
    if surface.file is not None and surface.file.welded_to is not None:
        loose &= surface.file.welded_to < 0
    return vertices(surface, np.flatnonzero(loose), "that no face uses", "that no face uses")


@requirement("no-duplicate-vertices", remedy="`--weld exact` merges them", after="no-unreferenced")
def no_duplicate_vertices(surface: Surface) -> str:
    """No two vertices of faces are at the same position."""
    twice = duplicate_vertices(surface)
    return vertices(surface, twice, "at the position of an earlier one", "at the position of an earlier one")

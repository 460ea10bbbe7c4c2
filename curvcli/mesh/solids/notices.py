"""Notices of solid patches that are inside out or cross each other."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...errors import Notice
from ...support.words import counted

if TYPE_CHECKING:
    from ..surface import Surface


def solid_notices(surface: Surface) -> Iterator[Notice]:
    """The notices of a surface's solid patches, each named by its lowest face."""
    solids = surface.solids
    wrong = np.flatnonzero(solids.inside_out)
    faces = solids.first_face[wrong] if len(wrong) else wrong
    if surface.orient == "outward":
        message = (
            f"closed [patch|patches], named by [its|their] lowest face, turned outwards: {list_kinds(surface, wrong)}"
        )
        yield Notice.at("inside_out", faces, message, "--orient file keeps the sides that the file gives")
    else:
        yield Notice.at("inside_out", faces, _inside_out(surface, wrong), "--orient outward turns [it|them]")
    crossing = np.unique(solids.crossing)
    yield Notice.at(
        "crossing_patches",
        solids.first_face[crossing] if len(crossing) else crossing,
        f"closed patches that cross or coincide, named by their lowest faces ({first_pair(surface)}): inside and "
        "outside are undecided, the file's winding is kept, and the volume counts their overlap twice",
        "unite the bodies in the program that made them, or move them apart; `curvcli check --require outward` refuses "
        "such files",
    )


def _inside_out(surface: Surface, wrong: NDArray[np.intp]) -> str:
    """Describe patches that are inside out."""
    cavities = int((surface.solids.depth[wrong] % 2).sum())
    if not cavities:
        return (
            "closed [patch|patches] of negative volume, named by [its|their] lowest face: [its|their] normals point "
            "inwards, into the [body|bodies], and signs are reversed"
        )
    if cavities == len(wrong):
        return (
            "closed [patch|patches] of positive volume, named by [its|their] lowest face: [its|their] normals point "
            "out of the [cavity|cavities], into the solid, and signs are reversed"
        )
    return (
        f"closed patches inside out, named by their lowest faces: {list_kinds(surface, wrong)}; their normals point "
        "into the solid and signs are reversed"
    )


def list_kinds(surface: Surface, patches: NDArray[np.intp]) -> str:
    """Number of bodies and of cavities among these (n,) patches, in words."""
    cavities = int((surface.solids.depth[patches] % 2).sum())
    bodies = len(patches) - cavities
    counts = [(bodies, "body", "bodies"), (cavities, "cavity", "cavities")]
    return " and ".join(counted(*part) for part in counts if part[0])


def first_pair(surface: Surface) -> str:
    """The first pair of crossing patches, by their lowest faces, in words."""
    if not len(surface.solids.crossing):
        return ""
    first, second = surface.solids.first_face[surface.solids.crossing[0]]
    return f"faces {first} and {second}" if len(surface.solids.crossing) == 1 else f"first: faces {first} and {second}"

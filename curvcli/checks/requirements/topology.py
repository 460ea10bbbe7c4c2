"""Requirements of topology: boundary, manifoldness, orientation, components and genus."""

from __future__ import annotations

import math

import numpy as np

from ...mesh.bodies import split_bodies
from ...mesh.counts import classify, count_groups
from ...mesh.seams import describe_best_welding
from ...mesh.solids.notices import list_kinds
from ...mesh.surface import Surface
from ...mesh.walls import describe_walls
from .base import requirement
from .faults import Fault, FaultyElements
from .wording import edges, join_problems, located, place, vertices, with_explanation


@requirement(
    "closed",
    remedy="fill the holes; where positions repeat, `--weld exact` or a tolerance may close the seams",
    after="",
)
def closed(surface: Surface) -> str:
    """No edge has only one face."""
    result = edges(surface, surface.boundary_edges, "with only one face")
    return with_explanation(result, describe_best_welding(surface) if result else "")


@requirement(
    "manifold",
    default=True,
    remedy="part the surface where more than two faces meet, give each fan that only touches a vertex of its "
    "own; `--table edges=PATH` lists the edges",
    after="closed",
)
def manifold(surface: Surface) -> str:
    """Every edge has at most two faces and every star is one fan."""
    split = np.flatnonzero(surface.split_stars)
    result = join_problems(
        edges(surface, surface.nonmanifold_edges, "with more than two faces"),
        vertices(surface, split, "whose star is not one fan", "whose stars are not one fan"),
    )
    return with_explanation(result, describe_walls(surface))


@requirement(
    "oriented",
    remedy="a one-sided surface has no orientation: cut it open, or look for a face that joins two sides",
    after="manifold",
)
def oriented(surface: Surface) -> str:
    """Every patch has an orientation, whether or not the file winds it so."""
    lost = ~surface.orientation.orientable
    faces = np.flatnonzero(lost[surface.orientation.patch])
    patches = int(np.count_nonzero(lost))
    if not patches:
        return ""
    first = place(surface, "face", faces[0])
    singular, plural = "patch without an orientation", "patches without an orientation"
    return located(patches, singular, plural, first, FaultyElements("face", faces))


@requirement(
    "consistent-winding",
    default=True,
    remedy="turn the faces in the file; the computation turns its own copies and counts them",
    after="oriented",
)
def consistent_winding(surface: Surface) -> str:
    """Neighbouring faces run along their common edge opposite ways."""
    return edges(surface, surface.winding_conflicts, "along which both faces run the same way")


@requirement(
    "outward",
    remedy="reverse all faces of the patch named, or analyse with `--orient outward`; unite bodies that cross",
    after="consistent-winding",
)
def outward(surface: Surface) -> str:
    """Bodies have a positive volume and cavities a negative one as the file winds them; no two closed patches cross."""
    apart = split_bodies(surface)
    if not apart.solids.count:
        return "no patch is closed and orientable, so that none has an outside"
    return join_problems(_inside_out(surface, apart), _crossing(surface, apart))


def _inside_out(surface: Surface, apart: Surface) -> str:
    """The fault of bodies and cavities of the wrong sign. apart: the surface with each body on its own vertices."""
    solids = apart.solids
    turned = np.flatnonzero(solids.inside_out)
    if not len(turned):
        return ""
    first = place(surface, "face", solids.first_face[turned[0]])
    faces = FaultyElements("face", np.flatnonzero(np.isin(apart.orientation.patch, turned)))
    fault = located(len(turned), "closed patch is inside out", "closed patches are inside out", first, faces)
    if len(turned) > 1:
        return fault + f": {list_kinds(apart, turned)}"
    return fault + f": a {'cavity of positive' if solids.depth[turned[0]] % 2 else 'body of negative'} volume"


def _crossing(surface: Surface, apart: Surface) -> str:
    """The fault of bodies that cross. apart: the surface with each body on its own vertices."""
    solids = apart.solids
    if not len(solids.crossing):
        return ""
    some = [FaultyElements("face", solids.first_face[pair]).names(surface) for pair in solids.crossing[:3]]
    more = len(solids.crossing) - len(some)
    listed = ", ".join(" and ".join(pair) for pair in some) + (f", {more:,} more" if more else "")
    patches = len(np.unique(solids.crossing))
    text = f"{patches:,} closed patches cross or coincide ({listed}): they have no depth and are kept as wound"
    return Fault(text, FaultyElements("face", solids.first_face[np.unique(solids.crossing)]))


@requirement("connected", remedy="remove loose parts; `--table components=PATH` lists them", after="outward")
def connected(surface: Surface) -> str:
    """There is one component."""
    return components(surface, 1)


@requirement(
    "genus",
    "N",
    remedy="look for an unintended handle or hole; `--table components=PATH` has χ and loops of each part",
    after="connected",
)
def genus(surface: Surface, wanted: float) -> str:
    """The genus, summed over the components, is N."""
    total = float(classify(surface, surface.whole).genus[0])
    if math.isnan(total):
        why = manifold(surface) or oriented(surface)
        return f"the genus is undefined, expected {wanted}: {why}"
    return "" if total == wanted else f"the genus is {round(total)}, expected {wanted}"


@requirement(
    "euler",
    "N",
    remedy="look for an unintended handle, hole or part; `--table components=PATH` has χ of each part",
    after="genus",
)
def euler(surface: Surface, wanted: float) -> str:
    """The Euler characteristic V − E + F is N."""
    counts = count_groups(surface, surface.whole)
    characteristic = int(counts.euler_characteristic[0])
    return "" if characteristic == wanted else f"χ = {characteristic}, expected {wanted}"


@requirement(
    "components",
    "N",
    remedy="remove loose parts or join what belongs together; `--table components=PATH` lists them",
    after="euler",
)
def components(surface: Surface, wanted: float) -> str:
    """There are N components."""
    count = surface.components.count
    if count == wanted:
        return ""
    if count == 1:
        return f"1 component, expected {wanted}"
    second = place(surface, "face", np.flatnonzero(surface.components.face == 1)[0])
    return f"{count:,} components, expected {wanted} (the second starts at {second})"

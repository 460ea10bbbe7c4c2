"""Notices of a surface: its defects with their counts, their first places and a hint."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..curvatures.quantity import AT_SCALE, Quantity
from ..curvatures.registry import passes
from ..errors import Notice
from ..mesh.counts import duplicate_faces, duplicate_vertices
from ..mesh.precision import is_single, last_place
from ..mesh.scale import describe_scales
from ..mesh.seams import describe_closing, describe_exact_welding, near_seam
from ..mesh.solids.notices import solid_notices
from ..mesh.surface import Surface
from ..mesh.triangles import dot, span
from ..mesh.walls import WALL, facing_pairs
from ..support.words import counted, pluralize

# A change of K above this, in radians, by rounding of the coordinates is reported: to doubles; and to
# float32, the format of most files, where it spoils K altogether.
TRUSTED, TRUSTED_SINGLE = 1e-6, 0.5


def of_surface(surface: Surface, columns: Mapping[str, Any]) -> list[Notice]:
    """Notices of a surface, the gravest first."""
    return [notice for notice in _all(surface, columns) if notice.count]


def out_of_range(overflows: Mapping[str, int]) -> list[Notice]:
    """Notice of results beyond the range of doubles in the file's unit; overflows: the count by column and total."""
    names = [name for name, count in overflows.items() if count]
    if not names:
        return []
    count = sum(overflows.values())
    message = pluralize(count, "[result|results] beyond the range of doubles in the file's unit, left undefined: ")
    hint = "scale the mesh to an extent near 1: angles and energies stay, lengths and areas become numbers"
    return [Notice("out_of_range", count, message + ", ".join(names), hint)]


def _all(surface: Surface, columns: Mapping[str, Any]) -> Iterator[Notice]:
    yield from _not_a_manifold(surface)
    yield from _vertices_and_faces(surface, columns)
    yield from _winding(surface)
    yield from solid_notices(surface)
    if "star_extent" in columns:
        yield from _coordinate_rounding(surface, columns)
    for quantity in passes.flags():
        yield from _of_flag(quantity, surface, columns)


def _of_flag(quantity: Quantity, surface: Surface, columns: Mapping[str, Any]) -> Iterator[Notice]:
    """Notices of the elements that a hidden flag marks, one for each scale."""
    declared = quantity.notice
    if declared is None:
        return
    for name in sorted(name for name in columns if name.partition(AT_SCALE)[0] == quantity.name):
        scale = name.partition(AT_SCALE)[2]
        message = declared.message.replace("{scale}", f" ({describe_scales(scale)})" if scale else "")
        marked = declared.select(surface, columns) if declared.select else np.flatnonzero(columns[name])
        yield Notice.at(declared.code, marked, message, declared.hint)


def _not_a_manifold(surface: Surface) -> Iterator[Notice]:
    yield Notice.at(
        "nonmanifold_edges",
        np.flatnonzero(surface.nonmanifold_edges),
        "[edge|edges] where more than two faces meet; densities at [its|their] ends are undefined",
        "--table edges=PATH has [it|them], with more than 2 in the column faces",
    )
    yield Notice.at(
        "nonmanifold_vertices",
        np.flatnonzero(surface.split_stars),
        "[vertex|vertices] whose star is not one fan; densities there are undefined",
        "give each fan a vertex of its own where parts only touch; weld where a seam cuts the surface",
    )


def _vertices_and_faces(surface: Surface, columns: Mapping[str, Any]) -> Iterator[Notice]:
    loose = ~surface.referenced
    if surface.file is not None and surface.file.welded_to is not None:
        loose &= surface.file.welded_to < 0  # merged rows have their own notice
    yield Notice.at(
        "unreferenced_vertices",
        np.flatnonzero(loose),
        "[vertex|vertices] that no face uses; [its row is|their rows are] empty",
        "no other result depends on [it|them]; `curvcli check --require no-unreferenced` refuses such files",
    )
    flat = np.flatnonzero(columns["degenerate_face"])
    corners = surface.xyz[:, surface.faces[flat]]
    together = (corners == np.roll(corners, 1, axis=2)).all(axis=0).any(axis=1)
    yield Notice.at(
        "degenerate_faces",
        flat,
        "[face|faces] without area; the mean curvature is undefined at [its|their] corners",
        "--weld exact drops those with two corners at one place; remesh the others"
        if together.any()
        else "remesh there: [its|their] corners lie on a line",
    )
    twice, pairs = duplicate_faces(surface), facing_pairs(surface)
    yield Notice.at(
        "duplicate_faces",
        twice,
        "[face|faces] with the same corners as an earlier one",
        "see facing_faces: each side of a common wall belongs to its body"
        if len(twice) == len(pairs)
        else "remove [it|them], unless you mean both sides: each adds to area and angles",
    )
    yield Notice.at(
        "facing_faces",
        pairs[:, 1],
        f"[pair|pairs] of coincident faces [faces|face] each other: {WALL}",
        "unite the bodies, which removes the wall, or write each to a file of its own; "
        "`curvcli check --allow manifold,no-duplicate-faces` accepts it",
    )
    vertices = duplicate_vertices(surface)
    yield Notice.at(
        "duplicate_vertices",
        vertices,
        "[vertex|vertices] at exactly the position of an earlier one",
        describe_exact_welding(surface) if len(vertices) else None,
    )
    seam = near_seam(surface)
    if seam is not None:
        yield Notice.at(
            "near_vertices",
            seam.vertices,
            "boundary vertices nearly coincide",
            describe_closing(surface, seam),
        )


def _winding(surface: Surface) -> Iterator[Notice]:
    flipped = surface.orientation.flipped
    turned = f"; {counted(flipped, 'face')} {pluralize(flipped, '[was|were]')} turned for the computation"
    yield Notice.at(
        "inconsistent_winding",
        np.flatnonzero(surface.winding_conflicts),
        f"[edge|edges] whose two faces run along [it|them] the same way{turned if flipped else ''}",
        "results are unaffected: each patch follows its lowest-numbered face"
        if flipped
        else "no orientation is consistent there: see not_orientable",
    )
    yield Notice.at(
        "not_orientable",
        _first_faces(surface, ~surface.orientation.orientable),
        "[patch|patches] without orientation, named by [its|their] lowest face; "
        "signed mean curvature is undefined there",
        "K, areas and H_vec need none; `curvcli check --require oriented` refuses such files",
    )


def _first_faces(surface: Surface, patches: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Lowest face of each of these patches."""
    if not patches.any():
        return np.empty(0, np.intp)
    return np.unique(surface.orientation.patch, return_index=True)[1][patches]


def _coordinate_rounding(surface: Surface, columns: Mapping[str, Any]) -> Iterator[Notice]:
    """Notice of vertices where rounding of the coordinates, to doubles or to float32, may change K."""
    shortest = max(last_place(surface) / TRUSTED, last_place(surface, np.float32) / TRUSTED_SINGLE)
    if _edges_are_longer(columns, surface.faces, 2 * np.sqrt(3) * surface.degree.max() * shortest):
        return
    along = span(surface.xyz, surface.edges.a, surface.edges.b)
    edge_length = np.sqrt(dot(along, along))
    blurred = np.flatnonzero(rounding_of_K(surface, edge_length, last_place(surface), TRUSTED) > TRUSTED)
    what, bound = "coordinates", TRUSTED
    if not len(blurred) and is_single(surface.xyz_given):
        place = last_place(surface, np.float32)
        blurred = np.flatnonzero(rounding_of_K(surface, edge_length, place, TRUSTED_SINGLE) > TRUSTED_SINGLE)
        what, bound = "coordinates, which are all float32 numbers,", TRUSTED_SINGLE
    yield Notice.at(
        "coordinate_rounding",
        blurred,
        f"[vertex|vertices] where the rounding of the {what} alone may change K by more than {bound:g} radians",
        _more_digits(surface) if len(blurred) else None,
    )


def _edges_are_longer(columns: Mapping[str, Any], faces: NDArray[Any], length: float) -> bool:
    """True if every edge is surely longer than `length`, by a bound that needs no edges: an edge is at least twice the
    area of its face over the longest edge there, which is less than the sum of the extents of the faces at a vertex."""
    area, extent = columns["face_area"], columns["star_extent"]
    if 2 * area.min() > length * np.nanmax(extent):
        return True
    return bool((2 * area > length * extent[faces[:, 0]]).all())


def _more_digits(surface: Surface) -> str:
    """Hint: the cause of the lost digits of K."""
    used = surface.used_coordinates()
    largest = np.abs(used).max()
    if largest < np.finfo(np.float64).tiny:
        return "near the end of the range numbers have fewer digits: scale the mesh before it is written"
    if largest / 16 > (used.max(axis=1) / 2 - used.min(axis=1) / 2).max():
        return "the mesh is small against its distance from the origin: move it there before it is written"
    return "edges are that short against the mesh: more digits in the file, or --weld TOL, which merges their ends"


def rounding_of_K(
    surface: Surface, edge_length: NDArray[np.float64], place: float, trusted: float
) -> NDArray[np.float64]:
    """(V,) bound on the change of K by rounding of the coordinates; 0 where it cannot exceed `trusted`.

    Ends that move by δ each turn an edge e by up to 2δ/|e|; δ = ½ √3 place. place: the unit in the last place of the
    largest coordinate. Edges without length are left out. trusted: the change that may be ignored.
    """
    turn = np.divide(np.sqrt(3) * place, edge_length, where=edge_length > 0, out=np.zeros_like(edge_length))
    if 2 * surface.degree.max() * turn.max() <= trusted:
        return np.zeros(surface.n_vertices)
    ends = np.concatenate([surface.edges.a, surface.edges.b])
    return np.asarray(2 * np.bincount(ends, np.tile(turn, 2), minlength=surface.n_vertices), np.float64)

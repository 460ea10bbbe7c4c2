"""What a mesh has that its user should know: defects counted, with the first few and the way out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .census import duplicate_faces, duplicate_vertices
from .errors import Notice
from .loading.weld import weld_exact
from .surface import Surface
from .topology import find_edges

# Rounding of the coordinates that moves K by more than this many radians is worth a warning: to doubles; and to
# float32, which is what most files hold and what their users know, where it spoils K altogether.
TRUSTED, TRUSTED_SINGLE = 1e-6, 0.5


def _some(indices: NDArray[Any]) -> tuple[int, ...]:
    return tuple(int(i) for i in indices[:5])


def of_surface(surface: Surface, columns: Mapping[str, Any]) -> list[Notice]:
    """The notices of a surface, from the gravest down."""
    return [notice for notice in _all(surface, columns) if notice.count]


def out_of_range(lost: Mapping[str, int]) -> list[Notice]:
    """The notice of results that no double holds in the file's unit; lost: how many of each column and total."""
    names = [name for name, count in lost.items() if count]
    if not names:
        return []
    message = f"results are beyond the range of doubles in the file's unit and left undefined: {', '.join(names)}"
    hint = "scale the mesh to an extent near 1: angles and energies stay, lengths and areas become numbers"
    return [Notice("out_of_range", sum(lost.values()), message, hint)]


def _all(surface: Surface, columns: Mapping[str, Any]) -> Iterator[Notice]:
    yield from _not_a_manifold(surface)
    yield from _vertices_and_faces(surface, columns)
    yield from _winding(surface)
    if "edge_length" in columns:
        yield _coordinate_rounding(surface, columns["edge_length"])
    if "kappa_clamped" in columns:
        clamped = np.flatnonzero(columns["kappa_clamped"])
        yield Notice(
            "clamped_radicand",
            len(clamped),
            "vertices with H² < 4K; their principal curvatures are taken equal",
            hint="the mesh is coarse or rough there: no smooth surface has such curvatures",
            examples=_some(clamped),
        )
    if "voronoi_unfinished" in columns:
        unfinished = np.flatnonzero(columns["voronoi_unfinished"])
        yield Notice(
            "voronoi_unfinished",
            len(unfinished),
            "vertices whose Voronoi cell would take too many flips to find; it is left empty",
            hint="--area mixed needs none; a mesh without long fans of thin triangles needs few",
            examples=_some(unfinished),
        )


def _not_a_manifold(surface: Surface) -> Iterator[Notice]:
    edges = np.flatnonzero(surface.nonmanifold_edges)
    yield Notice(
        "nonmanifold_edges",
        len(edges),
        "edges where more than two faces meet; densities at their ends are undefined",
        hint="--table edges=PATH has them, with more than 2 in the column faces",
        examples=_some(edges),
    )
    vertices = np.flatnonzero(surface.split_stars)
    yield Notice(
        "nonmanifold_vertices",
        len(vertices),
        "vertices whose star is not one fan; densities there are undefined",
        hint="give each fan a vertex of its own where parts only touch; weld where a seam cuts the surface",
        examples=_some(vertices),
    )


def _vertices_and_faces(surface: Surface, columns: Mapping[str, Any]) -> Iterator[Notice]:
    loose = ~surface.referenced
    if surface.file is not None and surface.file.welded_to is not None:
        loose &= surface.file.welded_to < 0  # merged rows have a notice of their own
    unreferenced = np.flatnonzero(loose)
    yield Notice(
        "unreferenced_vertices",
        len(unreferenced),
        "vertices that no face uses; their rows are empty",
        examples=_some(unreferenced),
    )
    faces = np.flatnonzero(columns["degenerate_face"])
    yield Notice(
        "degenerate_faces",
        len(faces),
        "faces without area; the mean curvature is undefined at their corners",
        hint="--weld exact drops those with two corners at one place; remesh the others",
        examples=_some(faces),
    )
    faces = duplicate_faces(surface)
    yield Notice(
        "duplicate_faces",
        len(faces),
        "faces with the same corners as an earlier one",
        hint="remove them unless both sides are meant: each adds to area and angles",
        examples=_some(faces),
    )
    vertices = duplicate_vertices(surface)
    yield Notice(
        "duplicate_vertices",
        len(vertices),
        "vertices at exactly the position of an earlier one",
        hint=welding(surface) if len(vertices) else None,
        examples=_some(vertices),
    )


def _winding(surface: Surface) -> Iterator[Notice]:
    conflicts = np.flatnonzero(surface.winding_conflicts)
    flipped = surface.orientation.flipped
    turned = f"{flipped} {'face was' if flipped == 1 else 'faces were'} turned for the computation"
    yield Notice(
        "inconsistent_winding",
        len(conflicts),
        f"edges whose two faces run along them the same way; {turned}",
        hint="nothing is lost: the lowest face of each patch decides",
        examples=_some(conflicts),
    )
    without = int(np.count_nonzero(~surface.orientation.orientable))
    yield Notice("not_orientable", without, "patches have no orientation; signed mean curvature is undefined there")
    inside_out = np.flatnonzero(surface.inside_out)
    outward = surface.orient == "outward"
    yield Notice(
        "inside_out",
        len(inside_out),
        "closed patches were turned outwards"
        if outward
        else "closed patches have negative volume: their normals point inwards and signs are reversed",
        hint=None if outward else "--orient outward turns them",
    )


def welding(surface: Surface) -> str:
    """What `--weld exact` would do to the boundary, counted on the faces that it would touch."""
    way_out = "--weld exact merges them"
    old, boundary = surface.edges, int(np.count_nonzero(surface.boundary_edges))
    if not boundary:
        return way_out
    first, number = weld_exact(surface.xyz_given)
    lowest = first[number]
    merged = np.zeros(surface.n_vertices, bool)
    merged[lowest[surface.referenced & (lowest != np.arange(len(lowest)))]] = True
    touched = merged[lowest]
    # Edges without a merged end stay as they are, and all faces of the others are among the chosen.
    ours = touched[old.a] | touched[old.b]
    open_now, crowded_now = (int(np.count_nonzero(which & ours)) for which in (old.valence == 1, old.valence > 2))
    if not open_now:
        return f"{way_out}; none lies on the boundary"
    faces = lowest[surface.faces[touched[surface.faces].any(axis=1)]]
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    new = find_edges(faces, surface.n_vertices)
    ours = merged[new.a] | merged[new.b]
    open_then, crowded_then = (int(np.count_nonzero(which & ours)) for which in (new.valence == 1, new.valence > 2))
    words = way_out
    if open_now > open_then:
        closed = open_now - open_then
        all_of = "all " if closed == boundary > 1 else ""
        words = f"--weld exact would close {all_of}{closed:,} boundary edge{'s' if closed > 1 else ''}"
    more = crowded_then - crowded_now
    return (
        f"{words}, and more than two faces would meet at {more:,} edge{'s' if more > 1 else ''}" if more > 0 else words
    )


def _coordinate_rounding(surface: Surface, edge_length: NDArray[np.float64]) -> Notice:
    """How much K may owe to the rounding of the coordinates, to doubles or to the float32 numbers they all are."""
    blurred = np.flatnonzero(rounding_of_K(surface, edge_length, last_place(surface), TRUSTED) > TRUSTED)
    what, bound = "coordinates", TRUSTED
    if not len(blurred) and _all_single(surface):
        place = last_place(surface, np.float32)
        blurred = np.flatnonzero(rounding_of_K(surface, edge_length, place, TRUSTED_SINGLE) > TRUSTED_SINGLE)
        what, bound = "coordinates, which are all float32 numbers,", TRUSTED_SINGLE
    return Notice(
        "coordinate_rounding",
        len(blurred),
        f"vertices where the rounding of the {what} alone may change K by more than {bound:g} radians",
        hint=_more_digits(surface) if len(blurred) else None,
        examples=_some(blurred),
    )


def _more_digits(surface: Surface) -> str:
    """Where the digits went that K would need."""
    used = surface.xyz_given[:, surface.referenced]
    largest = np.abs(used).max()
    if largest < np.finfo(np.float64).tiny:
        return "numbers near the end of the range have fewer digits: scale the mesh before it is written"
    if largest / 16 > (used.max(axis=1) / 2 - used.min(axis=1) / 2).max():
        return "the mesh is small against its distance from the origin: move it there before it is written"
    return "edges are that short against the mesh: more digits in the file, or --weld TOL, which merges their ends"


def _all_single(surface: Surface) -> bool:
    """Whether every coordinate is a float32 number, as in binary STL and most PLY files."""
    with np.errstate(over="ignore", under="ignore"):
        return all(bool((row.astype(np.float32) == row).all()) for row in surface.xyz_given)


def last_place(surface: Surface, kind: type[np.floating[Any]] = np.float64) -> float:
    """The unit in the last place of the largest coordinate that a face uses, in the unit of computation."""
    used = surface.xyz_given if surface.referenced.all() else surface.xyz_given[:, surface.referenced]
    largest = min(np.abs(used).max(), float(np.finfo(kind).max) / 2)  # beyond the last one there is no number
    place = np.float64(np.spacing(kind(largest)))
    return float(np.ldexp(place, -surface.unit_exponent))


def rounding_of_K(
    surface: Surface, edge_length: NDArray[np.float64], place: float, trusted: float
) -> NDArray[np.float64]:
    """(V,) how far K could be from that of the surface before its coordinates were rounded; 0 where nobody asks.

    Ends that move by δ each turn an edge e by up to 2δ/|e|; δ = ½ √3 place. place: the unit in the last place of the
    largest coordinate. Edges without length are left out. trusted: what may be ignored.
    """
    turn = np.divide(np.sqrt(3) * place, edge_length, where=edge_length > 0, out=np.zeros_like(edge_length))
    if 2 * surface.degree.max() * turn.max() <= trusted:
        return np.zeros(surface.n_vertices)
    ends = np.concatenate([surface.edges.a, surface.edges.b])
    return np.asarray(2 * np.bincount(ends, np.tile(turn, 2), minlength=surface.n_vertices), np.float64)

"""What a mesh has that its user should know: defects counted, with the first few and the way out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .census import duplicate_faces, duplicate_vertices
from .errors import Notice
from .surface import Surface

# Rounding of the coordinates that moves K by more than this many radians is worth a warning.
TRUSTED = 1e-6


def _some(indices: NDArray[Any]) -> tuple[int, ...]:
    return tuple(int(i) for i in indices[:5])


def of_surface(surface: Surface, columns: Mapping[str, Any]) -> list[Notice]:
    """The notices of a surface, from the gravest down."""
    return [notice for notice in _all(surface, columns) if notice.count]


def _all(surface: Surface, columns: Mapping[str, Any]) -> Iterator[Notice]:
    edges = np.flatnonzero(surface.nonmanifold_edges)
    yield Notice(
        "nonmanifold_edges",
        len(edges),
        "edges where more than two faces meet; densities at their ends are undefined",
        examples=_some(edges),
    )
    vertices = np.flatnonzero(surface.split_stars)
    yield Notice(
        "nonmanifold_vertices",
        len(vertices),
        "vertices whose star is not one fan; densities there are undefined",
        examples=_some(vertices),
    )
    if surface.file is not None and surface.file.welded_to is not None:
        merged = np.flatnonzero(surface.file.welded_to >= 0)
        yield Notice("welded_vertices", len(merged), "vertices were merged into others", examples=_some(merged))
        loose = ~surface.referenced & (surface.file.welded_to < 0)
    else:
        loose = ~surface.referenced
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
        examples=_some(faces),
    )
    faces = duplicate_faces(surface)
    yield Notice("duplicate_faces", len(faces), "faces with the same corners as an earlier one", examples=_some(faces))
    vertices = duplicate_vertices(surface)
    yield Notice(
        "duplicate_vertices",
        len(vertices),
        "vertices at exactly the position of an earlier one",
        hint="--weld exact merges them",
        examples=_some(vertices),
    )
    conflicts = np.flatnonzero(surface.winding_conflicts)
    flipped = surface.orientation.flipped
    yield Notice(
        "inconsistent_winding",
        len(conflicts),
        f"edges whose two faces run along them the same way; {flipped} faces were turned for the computation",
        examples=_some(conflicts),
    )
    without = int(np.count_nonzero(~surface.orientation.orientable))
    yield Notice(
        "not_orientable",
        without,
        "patches without an orientation, like a Möbius strip; signed mean curvature is undefined there",
    )
    turned = np.flatnonzero(surface.inside_out)
    yield Notice(
        "inside_out",
        len(turned),
        "closed patches were turned outwards"
        if surface.orient == "outward"
        else "closed patches have negative volume: their normals point inwards and signs are reversed",
        hint=None if surface.orient == "outward" else "--orient outward turns them",
    )
    if "edge_length" in columns:
        blurred = np.flatnonzero(rounding_of_K(surface, columns["edge_length"]) > TRUSTED)
        yield Notice(
            "coordinate_rounding",
            len(blurred),
            f"vertices where the rounding of the coordinates alone may change K by more than {TRUSTED:g} radians",
            hint="the mesh is small against its distance from the origin: move it there before it is written",
            examples=_some(blurred),
        )
    if "kappa_clamped" in columns:
        clamped = np.flatnonzero(columns["kappa_clamped"])
        yield Notice(
            "clamped_radicand",
            len(clamped),
            "vertices with H² < 4K; their principal curvatures are taken equal",
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


def rounding_of_K(surface: Surface, edge_length: NDArray[np.float64]) -> NDArray[np.float64]:
    """(V,) how far K could be from that of the surface before its coordinates were rounded to doubles.

    A corner that moves by δ turns an edge e by up to δ/|e|; δ is half a unit in the last place of the largest
    coordinate that a face uses. The file's own numbers may have fewer digits. Edges without length are left out.
    """
    used = surface.xyz if surface.referenced.all() else surface.xyz[:, surface.referenced]
    last_place = np.spacing(np.abs(used).max()) * np.sqrt(3)
    turn = np.divide(last_place, edge_length, where=edge_length > 0, out=np.zeros_like(edge_length))
    if 2 * surface.degree.max() * turn.max() <= TRUSTED:
        return np.zeros(surface.n_vertices)
    ends = np.concatenate([surface.edges.a, surface.edges.b])
    return np.asarray(2 * np.bincount(ends, np.tile(turn, 2), minlength=surface.n_vertices), np.float64)

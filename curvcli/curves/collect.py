"""Curves of a mesh file: the boundary of its surface and its polylines."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ..errors import InputError, Notice
from ..mesh.file import MeshFile
from ..mesh.polygons import from_file
from ..mesh.surface import Surface
from ..mesh.welding import weld_exact
from ..support.words import pluralize
from .boundary import Boundary, boundary_loops
from .joined import Joined, join
from .polygon import Curves, Rows


@dataclass(frozen=True)
class CurveSet:
    """Curves with the vertex rows of their points.

    curves: all, first the boundary curves, then the polylines. vertex: (n,) row of the file of each of their vertices.
    boundary: the boundary curves; None without a surface.
    """

    curves: Curves
    vertex: Rows
    boundary: Boundary | None = None
    file: MeshFile | None = None
    notices: list[Notice] = field(default_factory=list)

    @property
    def boundaries(self) -> int:
        """Number of boundary curves."""
        return 0 if self.boundary is None else len(self.boundary.curves)


def curves_of_file(file: MeshFile) -> CurveSet:
    """The boundary curves of the file's surface and its `l` polylines.

    Records that share ends are joined (see `join`); a polyline whose last index is its first is closed.
    Errors: InputError for a file without curves, or for coordinates of curves that are not finite.
    """
    notices = list(file.notices)
    boundary = None
    if len(file.corners):
        surface = from_file(file)
        notices = list(surface.notices)
        boundary = boundary_loops(surface)
    joined = join(file.polylines)
    vertex, start, closed = joined.vertex, joined.start, joined.closed
    if boundary is not None:
        vertex = np.concatenate([boundary.vertex, vertex])
        start = np.concatenate([boundary.start, boundary.start[-1] + start[1:]])
        closed = np.concatenate([boundary.closed, closed])
    if not len(closed):
        raise InputError(
            "no curve found: the surface has no boundary and there are no polylines",
            path=file.path,
            hint="expected a surface with a boundary, or `l` records in an OBJ file",
        )
    _check_finite(file, vertex)
    notices += [notice for notice in _of_ends(file, joined) if notice.count]
    curves = Curves(np.ascontiguousarray(file.xyz[:, vertex]), start, closed)
    return CurveSet(curves, vertex, boundary, file, notices)


def curves_of_surface(surface: Surface) -> CurveSet:
    """The boundary curves of a surface."""
    boundary = boundary_loops(surface)
    return CurveSet(boundary.curves, boundary.vertex, boundary, surface.file, list(surface.notices))


def _check_finite(file: MeshFile, vertex: Rows) -> None:
    bad = ~np.isfinite(file.xyz[:, vertex]).all(axis=0)
    if bad.any():
        first = int(vertex[bad].min())
        at = ", ".join(f"{value:g}" for value in file.xyz[:, first])
        raise InputError(
            f"coordinates ({at}) are not finite, expected finite numbers at every vertex of a curve",
            path=file.path,
            place=f"vertex {first}",
        )


def _of_ends(file: MeshFile, joined: Joined) -> Iterator[Notice]:
    """Notices of vertices at which polylines branch, and of ends at the position of another end."""
    yield Notice.at(
        "branching_vertices",
        joined.branching,
        "[vertex|vertices] where more than two edges of polylines meet; curves end there",
        "split the network into curves that share no vertex, or name a way through in one `l` record",
    )
    ends = np.flatnonzero(~joined.closed & (np.diff(joined.start) > 1))
    vertex = np.unique(np.concatenate([joined.vertex[joined.start[ends]], joined.vertex[joined.start[ends + 1] - 1]]))
    first, number = weld_exact(np.ascontiguousarray(file.xyz[:, vertex]))
    doubled = np.bincount(number, minlength=len(first))[number] > 1
    yield Notice.at(
        "coincident_ends",
        vertex[doubled],
        "[end|ends] of polylines exactly at the place of another end with a vertex of its own; the curves stay apart",
        "--weld exact joins them, and closes a curve that repeats its first point",
    )


def curve_notices(
    curve_set: CurveSet, repeated: Rows, reversed_: Rows, refused: int, limit: int | None
) -> list[Notice]:
    """Notices of curves. repeated: vertices equal to the next. reversed_: vertices at which a curve turns back."""
    return [notice for notice in _all(curve_set, repeated, reversed_, refused, limit) if notice.count]


def _all(curve_set: CurveSet, repeated: Rows, reversed_: Rows, refused: int, limit: int | None) -> Iterator[Notice]:
    yield from curve_set.notices
    if curve_set.boundary is not None:
        ends = np.flatnonzero(~curve_set.boundary.closed)
        yield Notice.at(
            "open_boundary",
            ends,
            "boundary [curve that ends|curves that end] at edges with more than two faces",
            "`curvcli analyze --table edges=PATH` has these edges, with more than 2 in the column faces",
        )
    yield Notice.at(
        "repeated_points",
        repeated,
        "[vertex of a curve|vertices of curves] at the place of the next one; [its row is|their rows are] empty",
        "nothing is lost: an edge without length adds nothing",
    )
    yield Notice.at(
        "reversals",
        reversed_,
        "[vertex|vertices] where a curve turns back on itself; frames and holonomy are undefined from there on",
        "the binormal has no direction there: move the vertex by any little to give it one",
    )
    message = "[curve|curves] too large together for [its|their] writhe, a double sum over at most"
    yield Notice(
        "writhe_refused", refused, f"{pluralize(refused, message)} {limit} edges", "--max-writhe sets the limit"
    )

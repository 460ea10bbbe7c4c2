"""Cells of VTK data sets: polygons of a surface, polylines, and counts of the others."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ..corners import checked_corners
from ..strips import strip_triangles
from .cell_types import CORNERS, FACES, LINES, PIXEL, STRIP, cell_type_name, count_of, is_curved

WholeNumbers = NDArray[np.integer[Any]]


@dataclass(frozen=True)
class CellLists:
    """Cells by their corners: indices of all, concatenated, and the number of each."""

    corners: WholeNumbers
    sizes: WholeNumbers

    @classmethod
    def of_ends(cls, corners: WholeNumbers, ends: WholeNumbers, place: str) -> CellLists:
        """Cells whose corners end before the given positions.

        Errors: InputError for ends that descend, or that do not fit the number of corners.
        """
        sizes: Any = np.diff(ends.astype(np.int64, copy=False), prepend=0)
        wrong = np.flatnonzero(sizes < 0)
        if len(wrong):
            problem = (
                f"offset {int(ends[wrong[0]])} found, at least {int(ends[wrong[0] - 1]) if wrong[0] else 0} expected"
            )
            raise InputError(problem, place=f"{place}, offset {int(wrong[0])}")
        if (last := int(ends[-1]) if len(ends) else 0) != len(corners):
            raise InputError(f"{len(corners)} corners found, {last} announced by the offsets", place=place)
        return cls(corners, sizes)

    @classmethod
    def of_lengths(cls, flat: WholeNumbers, place: str, cells: int | None = None) -> CellLists:
        """Cells of rows of a length and so many corners, one row after the other. cells: their number, if it is known.

        Errors: InputError for lengths that do not fit the numbers.
        """
        size = len(flat)
        width = (int(flat[0]) + 1 if cells is None else size // max(cells, 1)) if size else 0
        if width > 1 and size % width == 0 and cells in (None, size // width) and (flat[::width] == width - 1).all():
            return cls(flat.reshape(-1, width)[:, 1:].reshape(-1), np.full(size // width, width - 1))
        # The place of a length depends on the one before.
        starts: list[int] = []
        at, numbers = 0, flat.tolist()
        while at < size and (cells is None or len(starts) < cells):
            if numbers[at] < 0:
                raise InputError(
                    f"length {numbers[at]} found, 0 or more expected", place=f"{place}, cell {len(starts)}"
                )
            starts.append(at)
            at += numbers[at] + 1
        if cells is not None and len(starts) < cells:
            raise InputError(f"{len(starts)} cells found, {cells} announced", place=place)
        if at != size:
            raise InputError(f"{at} numbers expected by the lengths of the cells, {size} found", place=place)
        is_corner = np.ones(size, np.bool_)
        is_corner[starts] = False
        return cls(flat[is_corner], flat[starts].astype(np.int64))

    @property
    def count(self) -> int:
        """Number of cells."""
        return len(self.sizes)

    def of(self, chosen: NDArray[np.bool_]) -> CellLists:
        """Some of the cells."""
        return self if chosen.all() else CellLists(self.corners[np.repeat(chosen, self.sizes)], self.sizes[chosen])


NONE = CellLists(np.empty(0, np.int32), np.empty(0, np.int64))


@dataclass(frozen=True)
class CellFaces:
    """Polygons: corners, concatenated, the size of each, and the cell of each; None: every cell is a polygon.

    lines: the polylines. cells: number of all cells. others: number of cells by name that are neither.
    """

    corners: NDArray[np.int32]
    sizes: WholeNumbers
    cell: WholeNumbers | None
    cells: int
    lines: CellLists = NONE
    others: Counter[str] = field(default_factory=Counter)


def of_lists(lists: Sequence[CellLists], vertices: int) -> CellFaces:
    """Faces of polygonal data: vertices, lines, polygons and strips; values of cells are in this order."""
    verts, lines, polygons, strips = lists
    before = verts.count + lines.count
    others = Counter({"vertex": verts.count} if verts.count else {})
    lines = _checked(lines, "line", vertices)
    cells = before + polygons.count + strips.count
    corners = checked_corners(polygons.corners, polygons.sizes, "polygon", vertices)
    if not strips.count:
        cell = None if before == 0 else np.arange(before, cells)
        return CellFaces(corners, polygons.sizes, cell, cells, lines, others)
    checked = checked_corners(strips.corners, strips.sizes, "strip", vertices)
    triangles, strip = strip_triangles(checked, strips.sizes.astype(np.int64, copy=False))
    cell = np.concatenate((np.arange(before, before + polygons.count), before + polygons.count + strip))
    sizes = np.concatenate((polygons.sizes, np.full(len(triangles), 3)))
    return CellFaces(np.concatenate((corners, triangles.reshape(-1))), sizes, cell, cells, lines, others)


def of_types(cells: CellLists, types: WholeNumbers, vertices: int) -> CellFaces:
    """Faces of an unstructured grid, in the order of its cells.

    Errors: InputError for curved faces, and for a number of corners that the type does not have.
    """
    if len(types) and not 0 <= int(types.min()) <= int(types.max()) <= 255:
        raise InputError("type of a cell beyond 0 to 255 found")
    types = types.astype(np.uint8, copy=False)
    counts = np.bincount(types, minlength=256)
    present = {kind: int(counts[kind]) for kind in np.flatnonzero(counts).tolist()}
    if curved := {cell_type_name(kind): count for kind, count in present.items() if is_curved(kind)}:
        raise InputError(f"{count_of(sum(curved.values()), 'curved face')} found", hint=STRAIGHT)
    for kind in present.keys() & CORNERS.keys():
        wrong = np.flatnonzero((types == kind) & (cells.sizes != CORNERS[kind]))
        if len(wrong):
            problem = f"cell of type {kind} with {int(cells.sizes[wrong[0]])} corners, {CORNERS[kind]} expected"
            raise InputError(problem, place=f"cell {int(wrong[0])}")
    others: Counter[str] = Counter()
    for kind, count in present.items():
        if kind not in (*FACES, *LINES):
            others[cell_type_name(kind)] += count
    lines = _checked(cells.of(_is_in(types, LINES)), "line", vertices) if present.keys() & {*LINES} else NONE
    is_face = _is_in(types, FACES)
    faces = cells.of(is_face)
    corners = checked_corners(faces.corners, faces.sizes, "face", vertices)
    cell = None if is_face.all() else np.flatnonzero(is_face)
    if PIXEL in present:
        corners = _turned_pixels(corners, faces.sizes, types[is_face] == PIXEL)
    if STRIP not in present:
        return CellFaces(corners, faces.sizes, cell, cells.count, lines, others)
    return _with_strips(
        CellLists(corners, faces.sizes), types[is_face] == STRIP, np.flatnonzero(is_face), cells, lines, others
    )


STRAIGHT = (
    "a surface of flat triangles or polygons is expected: "
    """`python -c "import pyvista; pyvista.read('IN').extract_surface().save('OUT.ply')"` makes one"""
)


def _is_in(types: WholeNumbers, kinds: Sequence[int]) -> NDArray[np.bool_]:
    table = np.zeros(256, np.bool_)
    table[[*kinds]] = True
    return table[types]


def _checked(cells: CellLists, name: str, vertices: int) -> CellLists:
    return CellLists(checked_corners(cells.corners, cells.sizes, name, vertices), cells.sizes)


def _turned_pixels(corners: NDArray[np.int32], sizes: WholeNumbers, pixel: NDArray[np.bool_]) -> NDArray[np.int32]:
    """Corners in which pixels, whose corners lie in rows, are quadrilaterals."""
    turned = corners.copy()
    third = (np.cumsum(sizes) - sizes)[pixel] + 2
    turned[third], turned[third + 1] = corners[third + 1], corners[third]
    return turned


def _with_strips(
    faces: CellLists,
    strip: NDArray[np.bool_],
    cell: NDArray[np.int64],
    cells: CellLists,
    lines: CellLists,
    others: Counter[str],
) -> CellFaces:
    """Faces of which some are strips, whose triangles take their place."""
    polygons, strips = faces.of(~strip), faces.of(strip)
    triangles, row = strip_triangles(strips.corners, strips.sizes.astype(np.int64, copy=False))
    every = CellLists(
        np.concatenate((polygons.corners, triangles.reshape(-1))),
        np.concatenate((polygons.sizes, np.full(len(triangles), 3))),
    )
    origin = np.concatenate((cell[~strip], cell[strip][row]))
    order = np.argsort(origin, kind="stable")
    begin = (np.cumsum(every.sizes) - every.sizes)[order]
    sizes = every.sizes[order]
    at = np.arange(int(sizes.sum())) + np.repeat(begin - (np.cumsum(sizes) - sizes), sizes)
    return CellFaces(every.corners[at].astype(np.int32), sizes, origin[order], cells.count, lines, others)


def concatenate_faces(pieces: Sequence[CellFaces], vertices: Sequence[int]) -> CellFaces:
    """Faces of consecutive pieces, given the number of vertices of each."""
    if len(pieces) == 1:
        return pieces[0]
    first = np.cumsum([0, *vertices])
    cells = np.cumsum([0, *(piece.cells for piece in pieces)])
    return CellFaces(
        np.concatenate([piece.corners + np.int32(at) for piece, at in zip(pieces, first[:-1], strict=True)]),
        np.concatenate([piece.sizes for piece in pieces]),
        np.concatenate(
            [
                (np.arange(piece.cells) if piece.cell is None else piece.cell) + at
                for piece, at in zip(pieces, cells[:-1], strict=True)
            ]
        ),
        int(cells[-1]),
        CellLists(
            np.concatenate([piece.lines.corners + np.int32(at) for piece, at in zip(pieces, first[:-1], strict=True)]),
            np.concatenate([piece.lines.sizes for piece in pieces]),
        ),
        sum((piece.others for piece in pieces), Counter()),
    )

"""Copies of meshes in a scene: transforms, labels of the copies, and the bound on their number."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..mesh.file import Labels
from ..support.words import number_of
from .content import free_inflation
from .limits import check_faces

Matrix = NDArray[np.float64]
"""(4, 4) transform of positions as columns."""
Runs = list[tuple[int, int]]
"""A label and a number of consecutive faces; -1 for no label."""
# Copies that any file may have, and bytes of a file for each further one.
_FREE_COPIES, _PER_COPY = 10_000, 16
# Bytes of a vertex and of a triangle in memory.
_PER_VERTEX, _PER_TRIANGLE = 24, 12


def check_copies(copies: int, vertices: int, faces: int, size: int, max_faces: int | None) -> None:
    """Check the numbers of all copies, vertices and faces of a scene against the size of its file in bytes.

    Errors: InputError for more than max_faces, or for copies out of proportion to the file.
    """
    if copies > _FREE_COPIES + size // _PER_COPY:
        raise InputError(f"{copies} copies of meshes in all, too many for {size} bytes")
    check_faces(faces, max_faces)
    if _PER_VERTEX * vertices + _PER_TRIANGLE * faces > free_inflation(size):
        raise InputError(f"copies of meshes with {number_of(faces, 'face')} in all, too many for {size} bytes")


def compose(outer: Matrix, inner: Matrix) -> Matrix:
    """outer · inner, exact where one of them is the identity."""
    if (inner == np.eye(4)).all():
        return outer
    with np.errstate(over="ignore", invalid="ignore"):
        return inner if (outer == np.eye(4)).all() else outer @ inner


def transformed(points: NDArray[np.float64], matrix: Matrix) -> NDArray[np.float64]:
    """Points (n, 3) under a transform; exact where it moves nothing."""
    linear, shift = matrix[:3, :3], matrix[:3, 3]
    with np.errstate(over="ignore", invalid="ignore"):
        if not (linear == np.eye(3)).all():
            points = points @ linear.T
        return points + shift if shift.any() else points


def flip_mirrored(faces: NDArray[np.int32], matrix: Matrix) -> NDArray[np.int32]:
    """Faces (n, 3), wound the other way round if the transform mirrors them."""
    with np.errstate(over="ignore", invalid="ignore"):
        mirrors = np.linalg.det(matrix[:3, :3]) < 0
    return faces[:, [0, 2, 1]] if mirrors else faces


def label_runs(runs: Runs, names: list[str]) -> Labels:
    """One label per face from the label of each run of faces; names that no face has are left out."""
    codes, counts = np.array(runs, np.int64).reshape(-1, 2).T
    return label_faces(np.repeat(codes, counts), names)


def label_faces(codes: NDArray[np.integer], names: list[str]) -> Labels:
    """Labels from the number of each face's name, -1 for none; names that no face has are left out."""
    used = np.unique(codes[codes >= 0])
    new = np.full(len(names) + 1, -1, np.int32)
    new[used] = np.arange(len(used))
    return Labels(new[codes], tuple(names[k] for k in used.tolist()))


def unique_names(names: list[str]) -> list[str]:
    """Names of which each stands once: a repeated one gets its number."""
    seen: set[str] = set()
    for k in range(len(names)):
        while names[k] in seen:
            names[k] += f" #{k}"
        seen.add(names[k])
    return names
